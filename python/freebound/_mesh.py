"""Meshes."""

from __future__ import annotations

import os
from functools import cached_property
from typing import Any

import numpy as np

from . import _arrays, _freebound


class Mesh:
    """Mesh from arrays or from a file.

    Args:
        vertices: positions, shape (n, 3).
        faces: vertices of the faces, shape (m, 3) or (m, 4), or a pair (indices, offsets) for other polygons; any type
            of integers. Counter-clockwise seen from outside.
        corner_uv: texture coordinates, a row (u, v) for each corner in the order of the faces, v up. NaN where there
            are none.

    Raises:
        InputError: a face names a vertex that is not there, or a position is not finite.
        OptionError: an array has another shape.
    """

    def __init__(self, vertices: Any, faces: Any, corner_uv: Any = None) -> None:
        self._native = _arrays.mesh_of(vertices, faces, corner_uv)

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> Mesh:
        """Reads an OBJ, PLY, STL, OFF, GLB or glTF file.

        Raises:
            InputError: the file cannot be read as a mesh.
        """
        mesh = cls.__new__(cls)
        mesh._native = _freebound.Mesh.read(os.fspath(path))
        return mesh

    @property
    def path(self) -> str | None:
        """Path of the file, or None."""
        path = self._native.path
        return None if path is None else os.fspath(path)

    @cached_property
    def vertices(self) -> np.ndarray:
        """Positions, shape (n, 3)."""
        return self._native.vertices

    @cached_property
    def faces(self) -> np.ndarray | tuple[np.ndarray, np.ndarray]:
        """Vertices of the faces: shape (m, 3) or (m, 4), or (indices, offsets) if their sizes differ."""
        return _arrays.faces_of(self._native.corners, self._native.starts)

    @cached_property
    def corner_uv(self) -> np.ndarray | None:
        """Texture coordinates of the corners, shape (c, 2), NaN at corners without; None if the mesh has none."""
        return self._native.corner_uv

    @property
    def warnings(self) -> list[str]:
        """Remarks of the reader of the file."""
        return self._native.warnings

    def __repr__(self) -> str:
        return f"<freebound.Mesh: {len(self.vertices)} vertices, {self._native.face_count} faces>"


def read(path: str | os.PathLike[str]) -> Mesh:
    """Reads a mesh file. See :meth:`Mesh.read`."""
    return Mesh.read(path)
