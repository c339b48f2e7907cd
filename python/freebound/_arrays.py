"""Arguments of the package as the native module takes them."""

from __future__ import annotations

import dataclasses
import json
import math
import os
from typing import Any, Iterable, Mapping

import numpy as np

from . import _freebound
from ._errors import OptionError

_NAN = math.nan


def mesh_of(vertices: Any, faces: Any = None, corner_uv: Any = None) -> _freebound.Mesh:
    """Native mesh of a :class:`freebound.Mesh`, a path, or arrays."""
    from ._mesh import Mesh

    if isinstance(vertices, (str, os.PathLike)):
        vertices = Mesh.read(vertices)
    if isinstance(vertices, Mesh):
        if faces is not None:
            raise OptionError("a mesh has faces of its own: pass the mesh alone")
        native = vertices._native
        return native if corner_uv is None else native.with_uv(_uv_of(corner_uv))
    if faces is None:
        raise OptionError("faces: pass them with the vertices, or pass a freebound.Mesh or a path")
    points = np.ascontiguousarray(vertices, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != 3:
        raise OptionError(f"vertices: pass an array of shape (n, 3), not {points.shape}")
    corners, starts = corners_of(faces)
    return _freebound.Mesh(points, corners, starts, None if corner_uv is None else _uv_of(corner_uv))


def mesh_with_uv(vertices: Any, faces: Any, corner_uv: Any) -> _freebound.Mesh:
    """Native mesh that has texture coordinates."""
    mesh = mesh_of(vertices, faces, corner_uv)
    if not mesh.has_uv:
        raise OptionError("corner_uv: the mesh has no texture coordinates: pass them")
    return mesh


def _uv_of(corner_uv: Any) -> np.ndarray:
    return np.ascontiguousarray(corner_uv, dtype=np.float64).reshape(-1, 2)


def corners_of(faces: Any) -> tuple[np.ndarray, np.ndarray | None]:
    """Vertex of each corner, and the starts of the faces; None for triangles."""
    if isinstance(faces, tuple) and len(faces) == 2:
        return _integers("faces", faces[0]).reshape(-1), _integers("faces", faces[1]).reshape(-1)
    try:
        table = _integers("faces", faces)
    except ValueError:
        # Lists of different lengths.
        rows = [_integers("faces", row) for row in faces]
        ends = np.cumsum([len(row) for row in rows])
        return np.concatenate(rows), np.concatenate([[0], ends]).astype(np.int64)
    if table.ndim != 2 or table.shape[1] < 3:
        raise OptionError(f"faces: pass an array of shape (n, 3) or (n, 4), or (indices, offsets), not {table.shape}")
    count, size = table.shape
    starts = None if size == 3 else np.arange(0, (count + 1) * size, size, dtype=np.int64)
    return table.reshape(-1), starts


def _integers(name: str, values: Any) -> np.ndarray:
    array = np.asarray(values)
    if array.dtype.kind not in "iu" and array.size:
        raise OptionError(f"{name}: pass integers, not {array.dtype}")
    if array.dtype == np.uint64 and array.size and array.max() > np.iinfo(np.int64).max:
        raise OptionError(f"{name}: a number is too large")
    return np.ascontiguousarray(array, dtype=np.int64)


def pins_of(name: str, pins: Any) -> np.ndarray | None:
    """Rows of element, u, v and weight. A weight of NaN makes the pin hard."""
    if pins is None:
        return None
    if isinstance(pins, Mapping):
        rows = [_pin(name, element, place) for element, place in pins.items()]
        return np.array(rows, dtype=np.float64).reshape(-1, 4) if rows else None
    if isinstance(pins, tuple) and len(pins) in (2, 3):
        elements, places, *weights = pins
        elements = _integers(name, elements).reshape(-1)
        places = np.asarray(places, dtype=np.float64).reshape(-1, 2)
        given = np.asarray(weights[0], dtype=np.float64).reshape(-1) if weights else np.full(len(elements), _NAN)
        if not len(elements) == len(places) == len(given):
            raise OptionError(f"{name}: pass as many places as elements")
        return np.ascontiguousarray(np.column_stack([elements, places, given])) if len(elements) else None
    raise OptionError(f"{name}: pass a dictionary {{element: (u, v)}}, or arrays (elements, places)")


def _pin(name: str, element: Any, place: Any) -> tuple[float, float, float, float]:
    numbers = tuple(float(number) for number in place)
    if len(numbers) == 2:
        return (float(element), *numbers, _NAN)
    if len(numbers) == 3:
        return (float(element), *numbers)
    raise OptionError(f"{name}: {element}: pass (u, v), or (u, v, weight) for a soft pin")


def edges_of(name: str, edges: Any, columns: int) -> np.ndarray | None:
    """Rows of an edge, or of an edge and its cost."""
    if edges is None:
        return None
    if isinstance(edges, Mapping):
        edges = [(*edge, cost) for edge, cost in edges.items()]
    table = np.asarray(edges, dtype=np.float64)
    if table.size == 0:
        return None
    if table.ndim != 2 or table.shape[1] != columns:
        raise OptionError(f"{name}: pass rows of {columns} numbers")
    return np.ascontiguousarray(table)


def request(options: dict[str, Any]) -> tuple[str, dict[str, Any]]:
    """Options as JSON, and their lists of numbers as arrays."""
    options = {name: value for name, value in options.items() if value is not None}
    seams = options.pop("seams", None)
    kinds, edges = _seams(seams)
    lists = {
        "pins": pins_of("pins", options.pop("pins", None)),
        "corner_pins": pins_of("corner_pins", options.pop("corner_pins", None)),
        "seams": edges_of("seams", edges, 2),
        "costs": edges_of("cut_weights", options.pop("cut_weights", None), 3),
    }
    if kinds:
        options["seam_kinds"] = kinds
    pack = options.get("pack")
    if pack is not None:
        if not dataclasses.is_dataclass(pack) or isinstance(pack, type):
            raise OptionError("pack: pass a freebound.Pack")
        fields = {name: value for name, value in dataclasses.asdict(pack).items() if value is not None}
        if isinstance(fields.get("size"), (int, np.integer)):
            fields["size"] = [int(fields["size"])] * 2
        options["pack"] = fields
    parts = options.get("parts")
    if parts is not None and not isinstance(parts, str):
        options["parts"] = ",".join(str(part) for part in np.atleast_1d(parts))
    sizes = options.get("chart_size")
    if sizes is not None:
        options["chart_size"] = {int(chart): float(size) for chart, size in sizes.items()}
    repair = options.get("repair")
    if repair is not None and not isinstance(repair, str):
        options["repair"] = ",".join(repair)
    return json.dumps(options, default=_plain), lists


def _seams(seams: Any) -> tuple[list[str], Any]:
    if seams is None:
        return [], None
    if isinstance(seams, str):
        return [seams], None
    if isinstance(seams, Iterable) and not isinstance(seams, np.ndarray):
        seams = list(seams)
        kinds = [seam for seam in seams if isinstance(seam, str)]
        return kinds, [seam for seam in seams if not isinstance(seam, str)]
    return [], seams


def _plain(value: Any) -> Any:
    """Numbers and arrays of numpy for JSON."""
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, np.ndarray):
        return value.tolist()
    raise OptionError(f"an option has a value of type {type(value).__name__}")


def faces_of(corners: np.ndarray, starts: np.ndarray | None) -> np.ndarray | tuple[np.ndarray, np.ndarray]:
    """Faces of shape (n, 3) or (n, 4); (indices, offsets) if their sizes differ."""
    if starts is None:
        return corners.reshape(-1, 3)
    sizes = np.diff(starts)
    if len(sizes) and (sizes == sizes[0]).all():
        return corners.reshape(-1, int(sizes[0]))
    return corners, starts
