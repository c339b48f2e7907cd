"""Native module. The package wraps it: use `freebound`."""

from collections.abc import Callable, Sequence
from typing import Any, Self, final

import numpy as np
from numpy.typing import NDArray

VERSION: str

@final
class Mesh:
    def __new__(
        cls,
        vertices: NDArray[np.float64],
        corners: NDArray[np.int64],
        starts: NDArray[np.int64] | None,
        corner_uv: NDArray[np.float64] | None,
    ) -> Self: ...
    @staticmethod
    def read(path: str) -> Mesh: ...
    def with_uv(self, corner_uv: NDArray[np.float64]) -> Mesh: ...
    @property
    def path(self) -> str | None: ...
    @property
    def vertices(self) -> NDArray[np.float64]: ...
    @property
    def corners(self) -> NDArray[np.int64]: ...
    @property
    def starts(self) -> NDArray[np.int64] | None: ...
    @property
    def corner_uv(self) -> NDArray[np.float64] | None: ...
    @property
    def has_uv(self) -> bool:
        """True if the mesh has texture coordinates."""

    @property
    def face_count(self) -> int:
        """Number of faces."""

    @property
    def warnings(self) -> list[str]: ...

@final
class Job:
    def __new__(cls, mesh: Mesh, options: str, lists: dict[str, Any]) -> Self: ...
    def cancel(self) -> None: ...
    def wait(self, timeout: float | None = None) -> bool: ...
    def result(self, timeout: float | None = None) -> _Layout: ...
    @property
    def done(self) -> bool: ...
    @property
    def progress(self) -> dict[str, Any]: ...

@final
class _Packed:
    @property
    def corner_uv(self) -> NDArray[np.float64]: ...
    @property
    def chart(self) -> NDArray[np.int64]: ...
    @property
    def planar(self) -> bool: ...
    @property
    def report(self) -> dict[str, Any]: ...
    def write(self, path: str, precision: str | None = None) -> tuple[list[str], bool]: ...

class _Layout:
    @property
    def vertices(self) -> NDArray[np.float64]: ...
    @property
    def uv(self) -> NDArray[np.float64]: ...
    @property
    def corners(self) -> NDArray[np.int64]: ...
    @property
    def vertex_corners(self) -> NDArray[np.int64]: ...
    @property
    def starts(self) -> NDArray[np.int64] | None: ...
    @property
    def corner_uv(self) -> NDArray[np.float64]: ...
    @property
    def source(self) -> NDArray[np.int64]: ...
    @property
    def new_vertex_edges(self) -> NDArray[np.int64]: ...
    @property
    def new_vertex_at(self) -> NDArray[np.float64]: ...
    @property
    def face_of(self) -> NDArray[np.int64]: ...
    @property
    def chart(self) -> NDArray[np.int64]: ...
    @property
    def cut_edges(self) -> NDArray[np.int64]: ...
    @property
    def triangle_face(self) -> NDArray[np.int64]: ...
    @property
    def singular_values(self) -> NDArray[np.float64]: ...
    @property
    def planar(self) -> bool: ...
    @property
    def unmet_pins(self) -> list[int]: ...
    @property
    def summary(self) -> str: ...
    @property
    def report(self) -> dict[str, Any]: ...
    @property
    def triangle_area(self) -> NDArray[np.float64]: ...
    @property
    def triangle_energy(self) -> NDArray[np.float64]: ...
    def write(self, path: str, precision: str | None = None) -> tuple[list[str], bool, str]: ...

class _Flattener:
    def __new__(cls, mesh: Mesh, options: str, lists: dict[str, Any]) -> Self: ...
    def __iter__(self) -> _Flattener: ...
    def __next__(self) -> Step: ...
    @property
    def ending(self) -> str | None: ...

@final
class Step:
    """Step of a method."""

    @property
    def index(self) -> int:
        """Number of the step, from 0."""

    @property
    def stage(self) -> str:
        """Stage that made the step."""

    @property
    def uv(self) -> NDArray[np.float64]:
        """Position of each vertex in the plane, shape (n, 2). New vertices come last."""

    @property
    def triangles(self) -> NDArray[np.int64]:
        """Triangles of the step, shape (m, 3)."""

    @property
    def planar(self) -> bool:
        """True if the step is proved planar."""

    @property
    def flipped(self) -> NDArray[np.int64]:
        """Flipped triangles."""

    @property
    def verdict(self) -> dict[str, Any]:
        """Verdict. Faces have the numbers of the input."""

    @property
    def report(self) -> dict[str, Any]:
        """Numbers of the step as the report has them."""

class _Drag:
    def __new__(cls, layout: _Layout, threads: int | None = None) -> Self: ...
    @property
    def at_rest(self) -> bool:
        """True if no vertex moved in the last frame."""

    def advance(
        self, vertex: int, target: Sequence[float], frames: int | None = None
    ) -> tuple[NDArray[np.float64], dict[str, Any]]: ...

def charts(mesh: Mesh) -> NDArray[np.int64]: ...
def check(
    mesh: Mesh,
    options: str,
    stop: Callable[[], bool] | None = None,
) -> dict[str, Any]: ...
def check_options(options: str, lists: dict[str, Any]) -> None: ...
def equations(
    mesh: Mesh, family: str, free: bool
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.complex128]]: ...

def pack(
    mesh: Mesh,
    options: str,
    rules: dict[str, Any],
    stop: Callable[[], bool] | None = None,
) -> _Packed: ...
