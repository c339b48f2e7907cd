"""Check of given texture coordinates."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

import numpy as np

from . import _arrays, _freebound


def charts(vertices: Any, faces: Any = None, corner_uv: Any = None) -> np.ndarray:
    """Chart of each face of given texture coordinates, shape (m,); −1 for faces without a triangle.

    A chart is a set of faces that share edges with both of their coordinates. Charts are numbered in the order of their
    first faces.

    Args:
        vertices: positions, shape (n, 3); or a :class:`Mesh`; or the path of a mesh file with texture coordinates.
        faces: shape (m, 3) or (m, 4), or (indices, offsets).
        corner_uv: texture coordinates of the corners, shape (c, 2), v up.

    Raises:
        InputError: the mesh has no complete texture coordinates.
    """
    return _freebound.charts(_arrays.mesh_with_uv(vertices, faces, corner_uv))


def check(
    vertices: Any,
    faces: Any = None,
    corner_uv: Any = None,
    *,
    stacked: bool = False,
    gap: float | None = None,
    size: int | tuple[int, int] | None = None,
    scale_ratio: float | None = None,
    listed: int | None = None,
    stop: Callable[[], bool] | None = None,
) -> dict[str, Any]:
    """Decides exactly if a layout is one-to-one, and lists its defects.

    >>> freebound.check("model.obj")["planar"]
    True

    Args:
        vertices: positions, shape (n, 3); or a :class:`Mesh`; or the path of a mesh file with texture coordinates.
        faces: shape (m, 3) or (m, 4), or (indices, offsets).
        corner_uv: texture coordinates of the corners, shape (c, 2), v up. NaN where there are none.
        stacked: True if faces may share exactly one place.
        gap: smallest distance of two charts in pixels. Default: not tested.
        size: width and height of the picture in pixels, or one number for both. Default: 1024.
        scale_ratio: largest ratio of a chart's scale to the usual scale. Default: 2.
        listed: largest number of faces or pairs that a finding lists. Default: 1000.
        stop: function that is called about twenty times a second. The check ends if it returns True.

    Raises:
        InputError: the mesh has no texture coordinates.
        Cancelled: ``stop`` returned True.

    Returns:
        A dictionary with ``planar``, ``f32`` (planar in 32 bits), ``passes``, ``charts``, ``triangles`` and
        ``findings``. Each finding has a ``code``, a ``severity`` and the faces or vertices at fault.
    """
    mesh = _arrays.mesh_with_uv(vertices, faces, corner_uv)
    picture = None if size is None else ([size, size] if isinstance(size, int) else list(size))
    options = {"stacked": stacked, "gap": gap, "size": picture, "scale_ratio": scale_ratio, "listed": listed}
    return _freebound.check(mesh, json.dumps(options), stop)
