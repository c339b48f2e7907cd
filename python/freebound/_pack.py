"""New places for the charts of a given layout."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Any

import numpy as np

from . import _arrays, _freebound
from ._corners import CornerLayout
from ._errors import OptionError
from ._run import Pack


class Packed(CornerLayout):
    """Given layout whose charts have new places. Arrays are read-only. ``save`` also draws the layout (.svg)."""

    @cached_property
    def chart(self) -> np.ndarray:
        """Chart of each face, shape (m,); −1 for faces without a triangle."""
        return self._native.chart

    def __repr__(self) -> str:
        count = self.chart.max() + 1
        verdict = "planar" if self.planar else "not planar"
        return f"<freebound.Packed: {count} chart{'s' if count != 1 else ''}, {verdict}>"


def pack(
    vertices: Any,
    faces: Any = None,
    corner_uv: Any = None,
    *,
    pack: Pack | None = None,
    lock: Any = None,
    keep_sizes: bool = False,
    aspect: float | None = None,
    precision: str | None = None,
    threads: int | None = None,
    stop: Callable[[], bool] | None = None,
) -> Packed:
    """Packs the charts of a given layout, without flattening. Each chart keeps its shape.

    >>> packed = freebound.pack("model.obj", pack=freebound.Pack(size=2048, gap=8))

    Args:
        vertices: positions, shape (n, 3); or a :class:`Mesh`; or the path of a mesh file with texture coordinates.
        faces: shape (m, 3) or (m, 4), or (indices, offsets).
        corner_uv: texture coordinates of the corners, shape (c, 2), v up.
        pack: packing of the charts.
        lock: numbers of faces, or True for each face, shape (m,). Charts with one of these faces keep their coordinates
            to the last bit, unless "f32" rounds them, and the others are packed around them.
        keep_sizes: True to keep the sizes of the charts relative to each other. Default: one density for all charts.
        aspect: width over height of the picture of the given layout. Default: that of the new picture.
        precision: "f32" to round the coordinates to 32 bits, and to prove them so.
        threads: number of threads. Default: all cores.
        stop: function that is called about twenty times a second. The packing ends if it returns True.

    Raises:
        InputError: the mesh has no complete texture coordinates.
        OptionError: an option is wrong.
        Cancelled: ``stop`` returned True.
    """
    mesh = _arrays.mesh_with_uv(vertices, faces, corner_uv)
    options, _ = _arrays.request({"pack": pack, "precision": precision, "threads": threads})
    rules = {"locked": _locked(mesh, lock), "keeps_sizes": keep_sizes, "aspect": aspect}
    return Packed(_freebound.pack(mesh, options, rules, stop))


def _locked(mesh: Any, lock: Any) -> np.ndarray | None:
    if lock is None:
        return None
    faces = np.asarray(lock)
    if faces.dtype == bool:
        if faces.shape != (mesh.face_count,):
            raise OptionError(f"lock: pass an array of shape ({mesh.face_count},), True for each face to lock")
        faces = np.flatnonzero(faces)
    if faces.size == 0:
        return None
    if faces.ndim != 1 or not np.issubdtype(faces.dtype, np.integer):
        raise OptionError("lock: pass numbers of faces, or True for each face")
    return np.ascontiguousarray(faces, dtype=np.int64)
