# SPDX-License-Identifier: GPL-3.0-or-later
"""Selected faces of all meshes in edit mode, as one mesh of arrays, and texture coordinates back into them."""

from contextlib import contextmanager
from dataclasses import dataclass, field

import bpy
import numpy as np


class Nothing(Exception):
    """There is nothing to work on. The message tells what to do."""


class Changed(Exception):
    """A mesh has changed since its faces were gathered."""


@dataclass
class Part:
    """Selected faces of one object."""

    object: object
    map_name: str
    """UV map, or an empty text if there is none yet."""
    size: tuple
    """Numbers of vertices, edges, faces and corners of the mesh."""
    faces: np.ndarray
    """Numbers of the faces in the mesh of the object."""
    loops: np.ndarray
    """Numbers of their corners."""
    edges: np.ndarray
    """Vertices of all edges of the mesh."""
    first_vertex: int
    """Number of the first vertex in the joined mesh."""


@dataclass
class Selection:
    """Selected faces of all objects, joined to one mesh."""

    parts: list[Part] = field(default_factory=list)
    vertices: np.ndarray = None
    corners: np.ndarray = None
    starts: np.ndarray = None
    seams: np.ndarray = None
    """Marked seams by their vertices, shape (e, 2)."""
    uv: np.ndarray = None
    """Coordinates of the corners."""
    pinned: np.ndarray = None
    """True for each corner that is pinned."""
    weights: np.ndarray = None
    """Weight of each corner's vertex in the group of soft pins, or NaN."""

    def faces(self):
        """Faces for the package."""
        return self.corners, self.starts

    @property
    def face_count(self):
        """Number of faces."""
        return len(self.starts) - 1

    @property
    def face_of(self):
        """Face of each corner."""
        return np.repeat(np.arange(self.face_count), np.diff(self.starts))

    @property
    def is_hard(self):
        """True for each corner that is pinned, and whose vertex is not in the group of soft pins."""
        return self.pinned & np.isnan(self.weights)


@contextmanager
def object_mode(context):
    """Leaves edit mode for a while: the arrays of a mesh are those of the edited mesh only then."""
    if context.mode != "EDIT_MESH":
        yield
        return
    edited = list(context.objects_in_mode)
    active = context.view_layer.objects.active
    bpy.ops.object.mode_set(mode="OBJECT")
    try:
        yield
    finally:
        # The selected objects enter edit mode together, and no others.
        was_selected = {item: item.select_get() for item in context.view_layer.objects}
        for item in was_selected:
            item.select_set(item in edited)
        context.view_layer.objects.active = active
        bpy.ops.object.mode_set(mode="EDIT")
        for item, selected in was_selected.items():
            item.select_set(selected)


def objects_of(context):
    """Objects in edit mode, each mesh once. Outside edit mode: the active object."""
    if context.mode == "EDIT_MESH":
        return list(context.objects_in_mode_unique_data)
    active = context.active_object
    return [active] if active is not None and active.type == "MESH" else []


def _numbers(collection, name, dtype, width=1):
    values = np.empty(len(collection) * width, dtype=dtype)
    collection.foreach_get(name, values)
    return values.reshape(-1, width) if width > 1 else values


def gather(context, group="", needs_uv=False):
    """Selected faces with their seams, coordinates and pins. ``group`` is the vertex group of soft pins."""
    return gather_with_others(context, group, needs_uv, False)[0]


def gather_with_others(context, group="", needs_uv=False, is_around=True):
    """Selected faces, and the faces with coordinates that are not selected, or None. Outside edit mode all are selected."""
    is_edited = context.mode == "EDIT_MESH"
    objects = objects_of(context)
    with object_mode(context):
        selection = _arrays(objects, is_edited, group, needs_uv)
        others = None
        if is_edited and is_around:
            try:
                others = _arrays(objects, is_edited, needs_uv=True, is_other=True)
            except Nothing:
                pass
    return selection, others


def _arrays(objects, is_edited, group="", needs_uv=False, is_other=False):
    selection = Selection()
    vertices, corners, sizes, seams, uvs, pins, weights = [], [], [], [], [], [], []
    count = 0
    for item in objects:
        mesh = item.data
        chosen = _numbers(mesh.polygons, "select", bool) & ~_numbers(mesh.polygons, "hide", bool)
        if not is_edited:
            chosen[:] = True
        faces = np.flatnonzero(~chosen if is_other else chosen)
        if not len(faces):
            continue
        layer = mesh.uv_layers.active
        if layer is None and needs_uv:
            continue
        matrix = np.array(item.matrix_world, dtype=np.float64)
        if np.linalg.matrix_rank(matrix[:3, :3]) < 3:
            raise Nothing(f"{item.name} is scaled to nothing: change its scale")
        starts = _numbers(mesh.polygons, "loop_start", np.int32)[faces]
        totals = _numbers(mesh.polygons, "loop_total", np.int32)[faces]
        firsts = np.cumsum(totals) - totals
        loops = np.arange(totals.sum()) + np.repeat(starts - firsts, totals)
        co = _numbers(mesh.vertices, "co", np.float32, 3).astype(np.float64)
        vertex = _numbers(mesh.loops, "vertex_index", np.int32)[loops].astype(np.int64)
        edges = _numbers(mesh.edges, "vertices", np.int32, 2).astype(np.int64)
        marked = _numbers(mesh.edges, "use_seam", bool) if len(mesh.edges) else np.zeros(0, dtype=bool)
        vertices.append(co @ matrix[:3, :3].T + matrix[:3, 3])
        corners.append(vertex + count)
        sizes.append(totals)
        seams.append(edges[marked] + count)
        if layer is None:
            uvs.append(np.zeros((len(loops), 2)))
            pins.append(np.zeros(len(loops), dtype=bool))
        else:
            uvs.append(_numbers(layer.uv, "vector", np.float32, 2)[loops].astype(np.float64))
            pins.append(_pins(layer, len(mesh.loops))[loops])
        weights.append(_weights(item, group)[vertex])
        selection.parts.append(Part(item, layer.name if layer else "", _size(mesh), faces, loops, edges, count))
        count += len(co)
    if not selection.parts:
        raise Nothing("select faces that have a UV map" if needs_uv else "select faces of a mesh first")
    selection.vertices = np.concatenate(vertices)
    selection.corners = np.concatenate(corners)
    selection.starts = np.concatenate([[0], np.cumsum(np.concatenate(sizes))]).astype(np.int64)
    selection.seams = np.concatenate(seams)
    selection.uv = np.concatenate(uvs)
    selection.pinned = np.concatenate(pins)
    selection.weights = np.concatenate(weights)
    return selection


def _size(mesh):
    return len(mesh.vertices), len(mesh.edges), len(mesh.polygons), len(mesh.loops)


def _pins(layer, count):
    values = np.zeros(count, dtype=bool)
    if len(layer.pin) == count:
        layer.pin.foreach_get("value", values)
    return values


def _weights(item, group):
    """Weight of each vertex in a group, NaN outside it."""
    weights = np.full(len(item.data.vertices), np.nan)
    index = item.vertex_groups.find(group) if group else -1
    if index >= 0:
        for vertex in item.data.vertices:
            for entry in vertex.groups:
                if entry.group == index and entry.weight > 0:
                    weights[vertex.index] = entry.weight
    return weights


def write(context, selection, corner_uv, cut_edges=None, pins=None):
    """Puts coordinates into the active UV maps, marks seams, and pins corners. Corners without coordinates stay. Returns
    the number of newly marked edges."""
    marked, begin = 0, 0
    with object_mode(context):
        if not all(_is_unchanged(part) for part in selection.parts):
            raise Changed("the meshes have changed while they were unwrapped: try again")
        for part in selection.parts:
            mesh = part.object.data
            end = begin + len(part.loops)
            own = corner_uv[begin:end]
            layer = mesh.uv_layers.get(part.map_name) if part.map_name else mesh.uv_layers.new()
            values = _numbers(layer.uv, "vector", np.float32, 2)
            is_known = np.isfinite(own).all(axis=1)
            values[part.loops[is_known]] = own[is_known].astype(np.float32)
            layer.uv.foreach_set("vector", values.ravel())
            if cut_edges is not None and len(cut_edges):
                marked += _mark(mesh, part, cut_edges)
            if pins is not None:
                _pin(layer, len(mesh.loops), part.loops[pins[(pins >= begin) & (pins < end)] - begin])
            mesh.update()
            begin = end
    return marked


def _pin(layer, count, loops):
    if len(loops):
        is_pinned = _pins(layer, count)
        is_pinned[loops] = True
        layer.pin_ensure()
        layer.pin.foreach_set("value", is_pinned)


def _is_unchanged(part):
    try:
        mesh = part.object.data
    except ReferenceError:
        return False
    return _size(mesh) == part.size and (not part.map_name or part.map_name in mesh.uv_layers)


def _mark(mesh, part, cut_edges):
    own = cut_edges - part.first_vertex
    count = len(mesh.vertices)
    own = own[((own >= 0) & (own < count)).all(axis=1)]
    keys = own.min(axis=1) * count + own.max(axis=1)
    edges = part.edges.min(axis=1) * count + part.edges.max(axis=1)
    seam = _numbers(mesh.edges, "use_seam", bool)
    new = np.isin(edges, keys) & ~seam
    mesh.edges.foreach_set("use_seam", seam | new)
    return int(new.sum())


def select(context, selection, faces):
    """Selects faces of the joined mesh, and nothing else."""
    begin = 0
    chosen = np.zeros(selection.face_count, dtype=bool)
    chosen[list(faces)] = True
    is_edited = context.mode == "EDIT_MESH"
    with object_mode(context):
        for part in selection.parts:
            mesh = part.object.data
            end = begin + len(part.faces)
            values = np.zeros(len(mesh.polygons), dtype=bool)
            values[part.faces] = chosen[begin:end]
            mesh.vertices.foreach_set("select", np.zeros(len(mesh.vertices), dtype=bool))
            mesh.edges.foreach_set("select", np.zeros(len(mesh.edges), dtype=bool))
            mesh.polygons.foreach_set("select", values)
            mesh.update()
            begin = end
        if is_edited:
            context.tool_settings.mesh_select_mode = (False, False, True)
