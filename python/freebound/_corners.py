"""Layouts of given meshes, by their corners."""

from __future__ import annotations

import os
from functools import cached_property
from typing import Any

import numpy as np

from ._errors import NotProved


class CornerLayout:
    """Texture coordinates of the corners of a mesh, with their proof. Arrays are read-only."""

    def __init__(self, native: Any) -> None:
        self._native = native

    @cached_property
    def corner_uv(self) -> np.ndarray:
        """Texture coordinates of the corners, in the order of the faces, shape (c, 2)."""
        return self._native.corner_uv

    @property
    def planar(self) -> bool:
        """True if the layout is one-to-one: no face is flipped, and no two faces overlap. Decided exactly."""
        return self._native.planar

    @cached_property
    def report(self) -> dict[str, Any]:
        """Report of the run, as the command of the program writes it."""
        return self._native.report

    def save(self, path: str | os.PathLike[str], *, precision: str | None = None) -> list[str]:
        """Writes the mesh with its coordinates (.obj, .ply, .glb).

        Raises:
            NotProved: the layout is planar, and rounding folds it. The file is written all the same.

        Args:
            path: file to write. Its extension names the format.
            precision: "f64" or "f32". Default: 64 bits for OBJ and 32 bits for PLY and GLB.

        Returns:
            The files written, ``path`` first.
        """
        files, planar = self._native.write(os.fspath(path), precision)
        if self.planar and not planar:
            raise NotProved(f"{os.fspath(path)}: the rounded coordinates are not planar")
        return [os.fspath(file) for file in files]
