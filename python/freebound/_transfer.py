"""Layouts and pictures of one mesh on another mesh of the surface."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from functools import cached_property
from typing import Any

import numpy as np

from . import _arrays, _freebound
from ._corners import CornerLayout
from ._errors import OptionError


class Transferred(CornerLayout):
    """Layout of one mesh on another mesh. Arrays are read-only."""

    @property
    def apart(self) -> bool:
        """True if the two surfaces lie apart, in other places or sizes: the copy is of little use. See ``fit``."""
        return self._native.apart

    def __repr__(self) -> str:
        return f"<freebound.Transferred: {'planar' if self.planar else 'not planar'}>"


def transfer(
    layout: Any,
    mesh: Any,
    *,
    fit: bool = False,
    threads: int | None = None,
    stop: Callable[[], bool] | None = None,
) -> Transferred:
    """Copies the layout of one mesh to another mesh of the surface, such as another level of detail.

    If the meshes have equal faces, coordinates are copied corner by corner. Otherwise nearest points are used.

    >>> copied = freebound.transfer("model-unwrapped.obj", "model-coarse.obj")

    Args:
        layout: mesh with texture coordinates: a :class:`Mesh`, the path of a file, or (vertices, faces, corner_uv).
        mesh: mesh that gets the layout: a :class:`Mesh`, the path of a file, or (vertices, faces).
        fit: True to move and scale the first mesh into the box of the second before nearest points are sought.
        threads: number of threads. Default: all cores.
        stop: function that is called about twenty times a second. The copy ends if it returns True.

    Raises:
        InputError: the first mesh has no usable texture coordinates, or the second has no faces.
        Cancelled: ``stop`` returned True.
    """
    options = json.dumps({"fit": fit, "threads": threads}, default=_arrays._plain)
    return Transferred(_freebound.transfer(_mesh(layout, True), _mesh(mesh, False), options, stop))


class Baked:
    """Picture of one layout, drawn for another layout."""

    def __init__(self, native: Any) -> None:
        self._native = native

    @cached_property
    def pixels(self) -> np.ndarray:
        """Red, green, blue and opacity from 0 to 255, row by row from the top, shape (height, width, 4). Pixels outside
        the charts and their margin are transparent."""
        return self._native.pixels

    @cached_property
    def report(self) -> dict[str, Any]:
        """``covered``, the share of covered pixels; ``outside``, the number of triangles outside the picture;
        ``largest_distance`` of the surfaces and ``diagonal`` of their box, in units of the mesh."""
        return self._native.report

    def save(self, path: str | os.PathLike[str]) -> str:
        """Writes the picture as PNG, and returns its path."""
        self._native.write(os.fspath(path))
        return os.fspath(path)

    def __repr__(self) -> str:
        height, width, _ = self.pixels.shape
        return f"<freebound.Baked: {width} × {height} pixels>"


def bake(
    old: Any,
    new: Any,
    picture: Any = None,
    *,
    size: int | tuple[int, int] | None = None,
    margin: int = 8,
    fit: bool = False,
    threads: int | None = None,
    stop: Callable[[], bool] | None = None,
) -> Baked:
    """Draws the picture of an old layout for a new layout of the surface, by nearest points.

    >>> freebound.bake("model.glb", "model-unwrapped.obj").save("new.png")
    'new.png'

    Args:
        old: mesh with the layout that the picture belongs to: a :class:`Mesh`, the path of a file, or (vertices, faces,
            corner_uv).
        new: mesh with the new layout, as ``old``.
        picture: path of a picture, or an array of shape (height, width, 3) or (height, width, 4) of numbers from 0 to
            255. Default: the picture that the materials of ``old`` show on most faces.
        size: width and height of the new picture in pixels, or one number for both. Default: that of the old picture.
        margin: margin that continues the colours around the charts, in pixels, up to 1024.
        fit: True to move and scale the old mesh into the box of the new one before nearest points are sought.
        threads: number of threads. Default: all cores.
        stop: function that is called about twenty times a second. The drawing ends if it returns True.

    Raises:
        InputError: a mesh has no usable texture coordinates, or the picture cannot be read.
        OptionError: there is no picture, or an option is wrong.
        Cancelled: ``stop`` returned True.
    """
    old = _mesh(old, True)
    shape = None if size is None else ([size, size] if isinstance(size, (int, np.integer)) else list(size))
    options = {"size": shape, "margin": margin, "fit": fit, "threads": threads}
    options = json.dumps(options, default=_arrays._plain)
    return Baked(_freebound.bake(old, _mesh(new, True), _pixels(old, picture), options, stop))


def _mesh(mesh: Any, with_uv: bool) -> Any:
    parts = mesh if isinstance(mesh, tuple) else (mesh,)
    if len(parts) > 3:
        raise OptionError("pass a freebound.Mesh, a path, or (vertices, faces, corner_uv)")
    return _arrays.mesh_with_uv(*parts, *[None] * (3 - len(parts))) if with_uv else _arrays.mesh_of(*parts)


def _pixels(old: Any, picture: Any) -> np.ndarray:
    if picture is None:
        pixels = _freebound.picture_of(old)
        if pixels is None:
            raise OptionError("picture: the materials of the old mesh name none: pass one")
        return pixels
    if isinstance(picture, (str, os.PathLike)):
        return _freebound.read_picture(os.fspath(picture))
    pixels = np.asarray(picture)
    if pixels.dtype != np.uint8 or pixels.ndim != 3 or pixels.shape[2] not in (3, 4):
        raise OptionError("picture: pass a path, or an array of uint8 of shape (height, width, 3) or (height, width, 4)")
    if pixels.shape[2] == 3:
        opaque = np.full((*pixels.shape[:2], 1), 255, dtype=np.uint8)
        pixels = np.concatenate([pixels, opaque], axis=2)
    return np.ascontiguousarray(pixels)
