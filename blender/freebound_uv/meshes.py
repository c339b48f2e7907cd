# SPDX-License-Identifier: GPL-3.0-or-later
"""Selected faces of all meshes in edit mode, as one mesh of arrays, and texture coordinates back into them."""

import hashlib
from contextlib import contextmanager
from dataclasses import dataclass

import bpy
import numpy as np


class Nothing(Exception):
    """There is nothing to work on. The message tells what to do."""


class Changed(Exception):
    """A mesh has changed since its faces were gathered."""


@dataclass
class Part:
    """Faces of one object."""

    object: object
    map_name: str
    """UV map, or an empty text if there is none yet."""
    faces: np.ndarray
    """Numbers of the faces in the mesh of the object."""
    loops: np.ndarray
    """Numbers of their corners."""
    loop_vertices: np.ndarray
    """Vertices of these corners in the mesh of the object."""
    edges: np.ndarray
    """Vertices of all edges of the mesh."""
    first_vertex: int
    """Number of the first vertex in the joined mesh."""
    digest: bytes = b""
    """Digest of the mesh and its UV map, for faces that are written."""


@dataclass
class Faces:
    """Faces of all objects, joined to one mesh."""

    parts: list[Part]
    corners: np.ndarray
    """Vertices of the corners, in the joined mesh."""
    starts: np.ndarray
    """First corner of each face, and the number of corners."""
    uv: np.ndarray
    """Coordinates of the corners."""
    pinned: np.ndarray
    """True for each corner that is pinned."""

    @property
    def face_count(self):
        """Number of faces."""
        return len(self.starts) - 1

    @property
    def face_of(self):
        """Face of each corner."""
        return np.repeat(np.arange(self.face_count), np.diff(self.starts))

    @property
    def places(self):
        """Vertex and coordinates of each corner, as a row of numbers."""
        return np.column_stack([self.corners, self.uv])

    def of_faces(self, is_wanted):
        """True for each face if ``is_wanted`` is true for one of its corners."""
        return np.logical_or.reduceat(is_wanted, self.starts[:-1])

    def without(self, is_left_out):
        """Copy without some faces. It has no parts."""
        kept = ~is_left_out
        of_corner = np.repeat(kept, np.diff(self.starts))
        starts = np.concatenate([[0], np.cumsum(np.diff(self.starts)[kept])]).astype(np.int64)
        return Faces([], self.corners[of_corner], starts, self.uv[of_corner], self.pinned[of_corner])


@dataclass
class Selection(Faces):
    """Selected faces of all objects."""

    vertices: np.ndarray
    """Positions of all vertices of all objects, in the world."""
    seams: np.ndarray
    """Marked seams by their vertices, shape (e, 2)."""
    weights: np.ndarray
    """Weight of each corner's vertex in the group of soft pins, or NaN."""
    is_attached: np.ndarray
    """True for each corner that shares its vertex and its coordinates with a face that is not in the selection."""
    others: Faces | None = None
    """Other faces that have a place in the map."""
    is_around: bool = False
    """True if the others are kept clear."""
    new_count: int = 0
    """Number of faces without a place, or with the coordinates of a new map. They are neither selected nor others."""

    def faces(self):
        """Faces for the package."""
        return self.corners, self.starts

    def meshes(self):
        """Mesh of each part with its corners in the selection: positions, faces for the package, range of corners."""
        ends = [part.first_vertex for part in self.parts[1:]] + [len(self.vertices)]
        first_face = first_corner = 0
        for part, end in zip(self.parts, ends):
            corners = slice(first_corner, first_corner + len(part.loops))
            starts = self.starts[first_face : first_face + len(part.faces) + 1] - first_corner
            yield self.vertices[part.first_vertex : end], (self.corners[corners] - part.first_vertex, starts), corners
            first_face, first_corner = first_face + len(part.faces), corners.stop


def corner_after(starts):
    """Next corner around its face, for each corner."""
    after = np.arange(starts[-1]) + 1
    after[starts[1:] - 1] = starts[:-1]
    return after


def boxes_of(uv, starts):
    """Least and largest coordinates of each face."""
    return np.minimum.reduceat(uv, starts[:-1]), np.maximum.reduceat(uv, starts[:-1])


def as_values(rows):
    """Each row of numbers as one value."""
    # Adding 0 turns −0 into 0.
    rows = np.ascontiguousarray(rows, dtype=np.float64) + 0.0
    return rows.view([("", np.float64)] * rows.shape[1]).ravel()


def _is_attached(faces, others):
    """True for each corner that shares its vertex and its coordinates with other faces."""
    is_attached = np.zeros(len(faces.corners), dtype=bool)
    if others is not None:
        own, theirs = np.isin(faces.corners, others.corners), np.isin(others.corners, faces.corners)
        is_attached[own] = np.isin(as_values(faces.places[own]), as_values(others.places[theirs]))
    return is_attached


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
        locked = [item for item in edited if item.hide_select]
        for item in locked:
            item.hide_select = False
        for item in was_selected:
            item.select_set(item in edited)
        context.view_layer.objects.active = active
        bpy.ops.object.mode_set(mode="EDIT")
        for item, selected in was_selected.items():
            item.select_set(selected)
        for item in locked:
            item.hide_select = True


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


def gather(context, group="", needs_uv=False, is_around=False):
    """Selected faces with their seams, coordinates and pins, and all others. Outside edit mode all faces are selected.
    ``group`` is the vertex group of soft pins."""
    is_edited = context.mode == "EDIT_MESH"
    objects = objects_of(context)
    if group and not any(group in item.vertex_groups for item in objects):
        raise Nothing(f"there is no vertex group {group}: choose one for soft pins, or clear its name")
    uses_uv_selection = is_edited and _is_uv_editor(context) and not context.tool_settings.use_uv_select_sync

    def chosen(mesh):
        visible = ~_numbers(mesh.polygons, "hide", bool)
        if not is_edited:
            return np.ones(len(visible), dtype=bool)
        chosen = visible & _numbers(mesh.polygons, "select", bool)
        return chosen & _uv_selected(mesh) if uses_uv_selection else chosen

    missing = "select faces in the UV editor first" if uses_uv_selection else "select faces of a mesh first"
    options = {"group": group, "needs_uv": needs_uv, "needs_place": needs_uv, "is_around": is_around}
    return _gathered(context, chosen, missing, **options)


def gather_shown(context):
    """Faces that the UV editor shows, and all others."""
    shows_all = context.mode != "EDIT_MESH" or context.tool_settings.use_uv_select_sync

    def chosen(mesh):
        visible = ~_numbers(mesh.polygons, "hide", bool)
        return visible if shows_all else visible & _numbers(mesh.polygons, "select", bool)

    return _gathered(context, chosen, "the UV editor shows no faces", needs_place=True, is_around=True)


def gather_all(context):
    """All faces that have a UV map."""
    return _gathered(context, lambda mesh: np.ones(len(mesh.polygons), dtype=bool), "edit a mesh first")


def gather_objects(context, objects, missing, is_in_world, needs_uv=False):
    """All faces of some objects. ``missing`` is the message if there are none. Positions are those of the meshes, or those
    in the world."""
    options = {"needs_uv": needs_uv, "objects": objects, "is_in_world": is_in_world}
    return _gathered(context, lambda mesh: np.ones(len(mesh.polygons), dtype=bool), missing, **options)


def _gathered(
    context,
    chosen,
    missing,
    *,
    group="",
    needs_uv=True,
    needs_place=False,
    is_around=False,
    objects=None,
    is_in_world=True,
):
    """Faces of each mesh that ``chosen`` finds, and all others. ``missing`` tells what to do if it finds none."""
    is_selection = objects is None
    objects = objects_of(context) if is_selection else objects
    with object_mode(context):
        positions, firsts, count = [], {}, 0
        for item in objects:
            co = _numbers(item.data.vertices, "co", np.float32, 3).astype(np.float64)
            matrix = np.array(item.matrix_world, dtype=np.float64) if is_in_world else np.eye(4)
            positions.append(co @ matrix[:3, :3].T + matrix[:3, 3])
            firsts[item] = count
            count += len(co)
        chosen_of = {item: chosen(item.data) for item in objects}
        placed_of = {item: mask & _has_place(item.data) if needs_place else mask for item, mask in chosen_of.items()}
        own = _joined(firsts, placed_of, needs_uv)
        if own is None:
            has_faces = is_selection and any(mask.any() for mask in chosen_of.values())
            raise Nothing("the selected faces have no place in a UV map: unwrap them first" if has_faces else missing)
        vertices = np.concatenate(positions)
        for part in own.parts:
            part.digest = _digest(part.object.data, part.object.data.uv_layers.active)
            _refuse_collapsed(part, vertices)
        others = _joined(firsts, {item: ~mask for item, mask in placed_of.items()}, True)
        unmapped = sum(int((~placed_of[item]).sum()) for item in objects if item.data.uv_layers.active is None)
        seams = [_seams(part) for part in own.parts]
        weights = [_weights(part, group)[part.loop_vertices] for part in own.parts]
    selection = Selection(
        **vars(own),
        vertices=vertices,
        seams=np.concatenate(seams),
        weights=np.concatenate(weights),
        is_attached=_is_attached(own, others),
        is_around=is_around,
        new_count=unmapped,
    )
    if others is not None:
        has_no_place = _is_new(others) | _lies_nowhere(others.uv, others.starts)
        selection.new_count += int(has_no_place.sum())
        selection.others = others.without(has_no_place)
        if not selection.others.face_count:
            selection.others = None
    return selection


def _refuse_collapsed(part, vertices):
    """Rejects an object whose scale takes the area of faces away."""
    matrix = np.array(part.object.matrix_world, dtype=np.float64)[:3, :3]
    if np.linalg.matrix_rank(matrix) == 3:
        return
    mesh = part.object.data
    sizes = _numbers(mesh.polygons, "loop_total", np.int32)[part.faces]
    starts = np.concatenate([[0], np.cumsum(sizes)])
    local = _numbers(mesh.vertices, "co", np.float32, 3).astype(np.float64)

    def areas(positions):
        corners = positions[part.loop_vertices]
        crossed = np.cross(corners, corners[corner_after(starts)])
        return np.linalg.norm(np.add.reduceat(crossed, starts[:-1]), axis=1)

    in_world = vertices[part.first_vertex : part.first_vertex + len(local)]
    if ((areas(local) > 0) & (areas(in_world - in_world.mean(axis=0)) <= 1e-12 * areas(local))).any():
        raise Nothing(f"{part.object.name} is scaled to nothing: change its scale")


def _has_place(mesh):
    """True for each face that has a place in the active UV map."""
    layer = mesh.uv_layers.active
    if layer is None or not len(mesh.polygons):
        return np.zeros(len(mesh.polygons), dtype=bool)
    starts = np.append(_numbers(mesh.polygons, "loop_start", np.int32), len(mesh.loops))
    uv = _numbers(layer.uv, "vector", np.float32, 2)
    return ~_lies_nowhere(uv, starts)


def _joined(firsts, chosen_of, needs_uv):
    """Chosen faces of all objects, or None. ``firsts`` has the number of each object's first vertex."""
    parts, corners, sizes, uvs, pins = [], [], [], [], []
    for item, first in firsts.items():
        mesh, faces = item.data, np.flatnonzero(chosen_of[item])
        layer = mesh.uv_layers.active
        if not len(faces) or (layer is None and needs_uv):
            continue
        starts = _numbers(mesh.polygons, "loop_start", np.int32)[faces]
        totals = _numbers(mesh.polygons, "loop_total", np.int32)[faces]
        loops = np.arange(totals.sum()) + np.repeat(starts - (np.cumsum(totals) - totals), totals)
        vertices = _numbers(mesh.loops, "vertex_index", np.int32)[loops].astype(np.int64)
        edges = _numbers(mesh.edges, "vertices", np.int32, 2).astype(np.int64)
        name = layer.name if layer else ""
        parts.append(Part(item, name, faces, loops, vertices, edges, first))
        corners.append(vertices + first)
        sizes.append(totals)
        if layer is None:
            uvs.append(np.zeros((len(loops), 2)))
            pins.append(np.zeros(len(loops), dtype=bool))
        else:
            uvs.append(_numbers(layer.uv, "vector", np.float32, 2)[loops].astype(np.float64))
            pins.append(_pins(layer, len(mesh.loops))[loops])
    if not parts:
        return None
    starts = np.concatenate([[0], np.cumsum(np.concatenate(sizes))]).astype(np.int64)
    return Faces(parts, np.concatenate(corners), starts, np.concatenate(uvs), np.concatenate(pins))


def _is_uv_editor(context):
    return context.area is not None and context.area.type == "IMAGE_EDITOR"


def _uv_selected(mesh):
    """True for each face that is selected in the UV editor."""
    attribute = mesh.attributes.get(".uv_select_face")
    if attribute is None:
        return np.zeros(len(mesh.polygons), dtype=bool)
    return _numbers(attribute.data, "value", bool)


def _seams(part):
    edges = part.object.data.edges
    marked = _numbers(edges, "use_seam", bool) if len(edges) else np.zeros(0, dtype=bool)
    return part.edges[marked] + part.first_vertex


def _lies_nowhere(uv, starts):
    """True for each face whose corners lie at one point, or have coordinates that are not finite."""
    low, high = boxes_of(uv, starts)
    return ~(np.isfinite(low) & np.isfinite(high)).all(axis=1) | (low == high).all(axis=1)


def _is_new(faces):
    """True for each face with the coordinates that Blender gives the faces of a new map. A mesh of a single face may
    have them for good."""
    sizes = np.diff(faces.starts)
    size = np.repeat(sizes, sizes)
    at = np.arange(len(size)) - np.repeat(faces.starts[:-1], sizes)
    angle = 2 * np.pi * at / size
    on_circle = 0.5 + 0.5 * np.column_stack([np.sin(angle), np.cos(angle)])
    on_square = np.column_stack([(at == 1) | (at == 2), at >= 2]).astype(np.float64)
    expected = np.where((size <= 4)[:, None], on_square, on_circle)
    is_new = ~faces.of_faces((abs(faces.uv - expected) > 1e-6).any(axis=1))
    is_one_of_many = [np.full(len(part.faces), len(part.object.data.polygons) > 1) for part in faces.parts]
    return is_new & np.concatenate(is_one_of_many)


def _digest(mesh, layer):
    digest = hashlib.blake2b()
    for array in (
        _numbers(mesh.vertices, "co", np.float32, 3),
        _numbers(mesh.edges, "vertices", np.int32, 2),
        _numbers(mesh.polygons, "loop_start", np.int32),
        _numbers(mesh.loops, "vertex_index", np.int32),
    ):
        digest.update(array.tobytes())
    if layer is not None:
        digest.update(_numbers(layer.uv, "vector", np.float32, 2).tobytes())
        digest.update(_pins(layer, len(mesh.loops)).tobytes())
    return digest.digest()


def _pins(layer, count):
    values = np.zeros(count, dtype=bool)
    if len(layer.pin) == count:
        layer.pin.foreach_get("value", values)
    return values


def _weights(part, group):
    """Weight of each vertex in a group, NaN outside it."""
    vertices = part.object.data.vertices
    weights = np.full(len(vertices), np.nan)
    index = part.object.vertex_groups.find(group) if group else -1
    if index >= 0:
        for vertex in vertices:
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
            raise Changed("the meshes have changed in the meantime, and nothing was written: try again")
        for part in selection.parts:
            mesh = part.object.data
            end = begin + len(part.loops)
            own = corner_uv[begin:end]
            # Faces that are not selected have no place in a new map.
            layer = mesh.uv_layers.get(part.map_name) if part.map_name else mesh.uv_layers.new(do_init=False)
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
    if not part.map_name:
        return not mesh.uv_layers and _digest(mesh, None) == part.digest
    layer = mesh.uv_layers.get(part.map_name)
    return layer is not None and _digest(mesh, layer) == part.digest


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
    """Selects faces of the joined mesh, and nothing else. Returns how many of them are hidden."""
    begin = hidden = 0
    chosen = np.zeros(selection.face_count, dtype=bool)
    chosen[list(faces)] = True
    is_edited = context.mode == "EDIT_MESH"
    with object_mode(context):
        for part in selection.parts:
            mesh = part.object.data
            end = begin + len(part.faces)
            values = np.zeros(len(mesh.polygons), dtype=bool)
            values[part.faces] = chosen[begin:end]
            is_hidden = _numbers(mesh.polygons, "hide", bool)
            hidden += int((values & is_hidden).sum())
            values &= ~is_hidden
            mesh.vertices.foreach_set("select", np.zeros(len(mesh.vertices), dtype=bool))
            mesh.edges.foreach_set("select", np.zeros(len(mesh.edges), dtype=bool))
            mesh.polygons.foreach_set("select", values)
            mesh.update()
            begin = end
        if is_edited:
            context.tool_settings.mesh_select_mode = (False, False, True)
    return hidden
