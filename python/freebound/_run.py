"""Runs of the solver."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Callable

import numpy as np

from . import _arrays, _freebound
from ._errors import OptionError
from ._layout import Layout

#: Seconds between two calls of a progress function.
_INTERVAL = 0.1


@dataclass(frozen=True)
class Pack:
    """Packing of charts into the unit square.

    Args:
        size: width and height of the picture in pixels, or one number for both. Default: 1024.
        gap: smallest distance between charts in pixels. Default: 4.
        rotations: "free", "quarter" or "none". Default: free.
        density: pixels per unit of length of the mesh. Default: the largest that fits.
        tiles: most tiles (UDIM). Default: 1.
        stack: "none", "congruent" or "mirrored". Default: none.
    """

    size: int | tuple[int, int] | None = None
    gap: int | None = None
    rotations: str | None = None
    density: float | None = None
    tiles: int | None = None
    stack: str | None = None


class Job:
    """Run in the background. Made by :func:`start`. A job that is forgotten is cancelled."""

    def __init__(self, native: Any) -> None:
        self._native = native

    @property
    def done(self) -> bool:
        """True if the run has ended, with or without a result."""
        return self._native.done

    @property
    def progress(self) -> dict[str, Any]:
        """State of the run: ``stage``, ``phase``, ``steps``, ``planar`` and ``seconds``."""
        return self._native.progress

    def cancel(self) -> None:
        """Asks the run to stop. :meth:`result` then raises :class:`Cancelled`, unless the run had ended before."""
        self._native.cancel()

    def wait(self, timeout: float | None = None) -> bool:
        """Waits for the end, at most ``timeout`` seconds. Returns True if the run has ended."""
        return self._native.wait(timeout)

    def result(self, timeout: float | None = None) -> Layout:
        """Layout of the run. Waits for it, at most ``timeout`` seconds.

        Raises:
            TimeoutError: the run has not ended yet.
            NotProved, InputError, OptionError, Cancelled: there is no proved layout.
        """
        return _layout(self._native.result, timeout)


def _layout(call: Callable[..., Any], *arguments: Any) -> Layout:
    """Layout of a native call. An error that holds a layout holds one of this package."""
    from ._errors import NotProved

    try:
        return Layout(call(*arguments))
    except NotProved as error:
        if error.layout is not None and not isinstance(error.layout, Layout):
            error.layout = Layout(error.layout)
        raise


def _start(vertices: Any, faces: Any, layout: Any, options: dict[str, Any]) -> Job:
    corner_uv = None
    if layout is not None:
        options["start"] = True
        corner_uv = None if layout is True else layout
    mesh = _arrays.mesh_of(vertices, faces, corner_uv)
    return Job(_freebound.Job(mesh, *_arrays.request(options)))


def _finished(job: Job, progress: Callable[[dict[str, Any]], None] | None) -> Layout:
    try:
        while not job.wait(_INTERVAL if progress else None):
            if progress:
                progress(job.progress)
    except BaseException:
        job.cancel()
        raise
    return job.result()


def start(
    vertices: Any,
    faces: Any = None,
    *,
    unwrap: bool = False,
    layout: Any = None,
    **options: Any,
) -> Job:
    """Starts :func:`flatten`, or :func:`unwrap` if ``unwrap`` is true, in the background.

    >>> job = freebound.start("scan.ply", unwrap=True)
    >>> job.progress
    {'stage': '', 'phase': '', 'steps': 0, 'planar': False, 'seconds': 0.01}
    >>> layout = job.result(timeout=60)
    """
    return _start(vertices, faces, layout, {"unwrap": unwrap, **options})


def flatten(
    vertices: Any,
    faces: Any = None,
    *,
    pins: Any = None,
    corner_pins: Any = None,
    method: str | None = None,
    layout: Any = None,
    progress: Callable[[dict[str, Any]], None] | None = None,
    **options: Any,
) -> Layout:
    """Flattens a disk, or the charts of a mesh, and proves the map.

    >>> layout = freebound.flatten(vertices, faces, pins={12: (0, 0), 907: (1, 0.25)})
    >>> layout.uv.shape
    (1024, 2)

    Args:
        vertices: positions, shape (n, 3), 32 or 64 bits; or a :class:`Mesh`; or the path of a mesh file.
        faces: shape (m, 3) or (m, 4), or (indices, offsets); any type of integers.
        pins: targets by vertex: ``{vertex: (u, v)}`` for hard pins, ``{vertex: (u, v, weight)}`` for soft ones; or
            arrays ``(vertices, places)`` or ``(vertices, places, weights)``, where a weight of NaN makes a pin hard.
        corner_pins: targets by corner, in the same forms. A vertex on a seam has a place for each of its charts; a
            corner names one of them.
        method: "auto" by default. ``freebound methods`` lists the others.
        layout: texture coordinates of the corners to start from, shape (c, 2); or True for those of the file.
        progress: function that receives :attr:`Job.progress`, at most ten times a second.
        options: options of ``freebound flatten`` with underscores for dashes: family, boundary, spacing, layers,
            treatment, max_steps, relax, new_vertices (False: never split edges), growth, aspect (width over height),
            repair, weld, holes, cut, distortion, max_charts, seam_visibility, charts, parts, fit, precision,
            threads; ``seams``, an array of edges of shape (e, 2) or kinds such as "sharp=60"; ``cut_weights``,
            ``{(a, b): cost}``; ``pack``, a :class:`Pack`; ``chart_size``, ``{chart: size}``; ``lock``, charts of the given
            layout that stay in place, or True for all, which may then overlap.

    Returns:
        The proved layout, with all hard pins at their targets to the last bit.

    Raises:
        NotProved: the map is not planar or misses a hard pin. The error holds the layout.
        InputError: the mesh cannot be used. The error lists the faults.
        OptionError: an option or a pin is wrong.
    """
    given = {"pins": pins, "corner_pins": corner_pins, "method": method, **options}
    return _finished(_start(vertices, faces, layout, given), progress)


def unwrap(
    vertices: Any,
    faces: Any = None,
    *,
    distortion: float | None = None,
    pack: Pack | None = None,
    progress: Callable[[dict[str, Any]], None] | None = None,
    **options: Any,
) -> Layout:
    """Cuts any mesh open along short seams, flattens it with little distortion, packs and proves its charts.

    >>> layout = freebound.unwrap(vertices, faces, distortion=4.1, pack=freebound.Pack(size=1024, gap=4))

    Args:
        vertices: positions, shape (n, 3); or a :class:`Mesh`; or the path of a mesh file.
        faces: shape (m, 3) or (m, 4), or (indices, offsets); any type of integers.
        distortion: largest mean symmetric Dirichlet energy of each part; 4 is an isometric map. Default: 4.1.
        pack: packing of the charts.
        progress: function that receives :attr:`Job.progress`, at most ten times a second.
        options: those of :func:`flatten`. Other defaults: all repairs, and automatic seams.

    Raises:
        The errors of :func:`flatten`.
    """
    given = {"unwrap": True, "distortion": distortion, "pack": pack, **options}
    layout = given.pop("layout", None)
    return _finished(_start(vertices, faces, layout, given), progress)


class Flattener(_freebound._Flattener):
    """Method step by step on a disk: an iterator of :class:`Step`.

    >>> for step in freebound.Flattener(vertices, faces, pins=pins, method="iterate"):
    ...     print(step.index, step.stage, len(step.flipped))

    The arguments are those of :func:`flatten`, but for those of the layout: fit, pack, lock, chart_size and precision.
    The mesh must be one disk after its repairs.
    """

    def __new__(cls, vertices: Any, faces: Any = None, *, layout: Any = None, **options: Any) -> Flattener:
        for name in ("fit", "pack", "lock", "chart_size", "precision"):
            if name in options:
                raise OptionError(f"{name}: steps are not laid out: use flatten")
        if layout is not None:
            options["start"] = True
        mesh = _arrays.mesh_of(vertices, faces, None if layout is True else layout)
        return super().__new__(cls, mesh, *_arrays.request(options))


class Drag(_freebound._Drag):
    """Vertices of a proved layout of one chart, moved with the layout proved at every frame.

    >>> drag = freebound.Drag(layout)
    >>> uv, verdict = drag.move(907, (1, 0.3))

    Pins of the layout stay at their targets. The layout follows a vertex as far as it stays planar.
    """

    def __new__(cls, layout: Layout, threads: int | None = None) -> Drag:
        return super().__new__(cls, layout._native, threads)

    def move(
        self, vertex: int, target: tuple[float, float], *, frames: int | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Moves a vertex towards a place. Returns the coordinates, shape (n, 2), and the verdict on them.

        Args:
            vertex: vertex of the layout.
            target: place to move it to.
            frames: most frames. With 1 a call takes a frame of an editor; call it again until :attr:`at_rest` is true.
                Default: until the layout is at rest, at most 200.
        """
        if frames is not None and frames < 1:
            raise OptionError("frames: pass a number of 1 or more")
        u, v = (float(number) for number in target)
        return self.advance(int(vertex), [u, v], frames)


def equations(vertices: Any, faces: Any = None, *, family: str = "mean-value", boundary: str = "free") -> Any:
    """Matrix of the vertex equations of a disk, as a complex ``scipy.sparse.csr_matrix`` of shape (n, n).

    Row v is the equation of vertex v: its weights, and minus their sum on the diagonal. With a free boundary the rows
    of boundary vertices are those of the natural boundary (paper, eq. 3), which are complex. With ``boundary="fixed"``
    all rows are those of eq. 2.

    Args:
        family: "conformal", "mean-value", "wachspress" or "power:P".
        boundary: "free" or "fixed".
    """
    try:
        from scipy import sparse
    except ImportError as error:
        raise OptionError("equations need scipy: pip install freebound[matrices]") from error
    if boundary not in ("free", "fixed"):
        raise OptionError("boundary: choose one of free, fixed")
    mesh = _arrays.mesh_of(vertices, faces)
    rows, columns, values = _freebound.equations(mesh, family, boundary == "free")
    count = len(mesh.vertices)
    return sparse.csr_matrix((values, (rows, columns)), shape=(count, count))
