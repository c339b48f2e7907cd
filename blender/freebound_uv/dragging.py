# SPDX-License-Identifier: GPL-3.0-or-later
"""Operator that drags a corner of a chart. The chart follows, and stays one-to-one at every frame."""

import bmesh
import bpy
import freebound
import numpy as np
from bpy.props import BoolProperty, FloatVectorProperty

from . import meshes, operators
from .solving import is_mirrored, sentence, told_of_chart

#: Largest distance of the mouse from the corner that it grabs, pixels.
_REACH = 24

#: Seconds between two frames of a drag.
_FRAME = 1 / 60

#: Events that move the view.
_NAVIGATION = {"MIDDLEMOUSE", "WHEELUPMOUSE", "WHEELDOWNMOUSE", "TRACKPADPAN", "TRACKPADZOOM", "HOME", "NUMPAD_PERIOD"}


class Grab:
    """Corner of a chart that is dragged. Pinned corners of the chart stay, and corners that faces beside the chart
    share."""

    def __init__(self, selection, corner, aspect=1.0):
        chart_of = freebound.charts(selection.vertices, selection.faces(), selection.uv)
        face_of = selection.face_of
        is_own = chart_of == chart_of[face_of[corner]]
        # A mirrored chart is dragged in the mirror.
        self._side = np.array((-1.0 if is_mirrored(selection, chart_of)[corner] else 1.0, 1.0))
        self.corners = np.flatnonzero(is_own[face_of])
        """Corners of the chart, by their numbers in the selection."""
        uv = selection.uv[self.corners]
        # A vertex for each place, so that the chart is cut along its seams.
        keys = np.column_stack([selection.corners[self.corners], uv])
        _, first, self._vertex_of = np.unique(keys, axis=0, return_index=True, return_inverse=True)
        self._vertex_of = self._vertex_of.ravel()
        vertices = selection.vertices[selection.corners[self.corners[first]]]
        faces = self._vertex_of, np.concatenate([[0], np.cumsum(np.diff(selection.starts)[is_own])])
        self._vertex = int(self._vertex_of[np.searchsorted(self.corners, corner)])
        self.grabbed = self.corners[self._vertex_of == self._vertex]
        """Corners at the place that is dragged."""
        is_attached = selection.is_attached[self.corners]
        if is_attached[self._vertex_of == self._vertex].any():
            raise meshes.Nothing("faces that are not shown hold this corner: show or select them")
        is_pinned = (selection.pinned[self.corners] | is_attached) & (self._vertex_of != self._vertex)
        pins = {int(self._vertex_of[at]): tuple(uv[at] * self._side) for at in np.flatnonzero(is_pinned)}
        options = {"relax": 0, "new_vertices": False, "precision": "f32", "aspect": aspect}
        layout = freebound.flatten(vertices, faces, layout=uv * self._side, pins=pins or None, **options)
        self.uv = uv.astype(np.float32)
        """Coordinates of the corners of the chart."""
        if ((layout.corner_uv * self._side).astype(np.float32) != self.uv).any():
            # The solver had to change it.
            raise freebound.NotProved("the chart is not one-to-one")
        self._drag = freebound.Drag(layout)

    def move(self, target, frames=None):
        """Drags towards a place, until nothing moves, or for some frames. Returns the corners that moved, by their
        position in ``corners``."""
        places, verdict = self._drag.move(self._vertex, tuple(self._side * target), frames=frames)
        if not (verdict["planar"] and verdict["f32"]):
            return np.zeros(0, dtype=np.int64)
        uv = (places * self._side)[self._vertex_of].astype(np.float32)
        moved = np.flatnonzero((uv != self.uv).any(axis=1))
        self.uv = uv
        return moved

    @property
    def is_at_rest(self):
        """True if the chart has reached its place."""
        return self._drag.at_rest

    @property
    def place(self):
        """Place of the dragged corner."""
        return self.uv[np.searchsorted(self.corners, self.grabbed[0])]


class _EditedLoops:
    """Corners of a chart in meshes that are edited."""

    def __init__(self, selection, grab):
        self._meshes, self._loops = [], []
        begin = 0
        for part in selection.parts:
            end = begin + len(part.loops)
            own = grab.corners[(grab.corners >= begin) & (grab.corners < end)] - begin
            if len(own):
                mesh = part.object.data
                edited = bmesh.from_edit_mesh(mesh)
                edited.faces.ensure_lookup_table()
                loops = [loop for face in part.faces for loop in edited.faces[face].loops]
                layer = edited.loops.layers.uv[part.map_name]
                self._loops += [loops[at][layer] for at in own]
                self._meshes.append((mesh, edited))
            begin = end

    def write(self, at, uv):
        for corner in at:
            self._loops[corner].uv = uv[corner]
        self._update()

    def pin(self, at):
        for corner in at:
            self._loops[corner].pin_uv = True
        self._update()

    def _update(self):
        for mesh, _ in self._meshes:
            bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)


def _is_undo(event):
    """True for the keys of undo and redo."""
    return event.type == "Z" and (event.ctrl or event.oskey)


def _holds(region, event):
    """True if the mouse is over a region. A hidden region has a size of 1."""
    x, y = event.mouse_x - region.x, event.mouse_y - region.y
    return 0 <= x < region.width and 0 <= y < region.height


class FREEBOUND_OT_drag_pin(bpy.types.Operator):
    """Drag corners of charts. The chart follows as far as no face flips or overlaps. Pinned coordinates stay"""

    bl_idname = "uv.freebound_drag_pin"
    bl_label = "Freebound Drag Pin"
    # Without "REGISTER": a drag with other places makes no sense to repeat or to adjust.
    bl_options = {"UNDO"}

    start: FloatVectorProperty(name="From", description="Coordinates near the corner to drag", size=2)
    target: FloatVectorProperty(name="To", description="Coordinates to drag the corner to", size=2)
    pins: BoolProperty(name="Pin", description="Pin the corner at its new place", default=True)

    @classmethod
    def poll(cls, context):
        if operators.is_running():
            cls.poll_message_set("A run of Freebound is under way")
            return False
        if context.mode == "EDIT_MESH" and meshes.objects_of(context):
            return True
        cls.poll_message_set("Edit a mesh first")
        return False

    def execute(self, context):
        """Drags one corner, for scripts."""

        def nearest(uv):
            return int(np.argmin(((uv - np.array(self.start)) ** 2).sum(axis=1)))

        if not self._grabbed(context, nearest):
            return {"CANCELLED"}
        self._grab.move(np.array(self.target))
        uv = np.full(self._selection.uv.shape, np.nan)
        uv[self._grab.corners] = self._grab.uv
        try:
            meshes.write(context, self._selection, uv, pins=self._grab.grabbed if self.pins else None)
        except meshes.Changed as error:
            self.report({"ERROR"}, sentence(error))
            return {"CANCELLED"}
        self._tell(context)
        return {"FINISHED"}

    def invoke(self, context, event):
        """Waits for a person to press on a corner, again and again."""
        if context.area is None or context.area.type != "IMAGE_EDITOR":
            self.report({"ERROR"}, "Corners are dragged in the UV editor")
            return {"CANCELLED"}
        self._area = context.area
        self._region = next(region for region in self._area.regions if region.type == "WINDOW")
        self._workspace = context.workspace
        self._grab = None
        context.window_manager.modal_handler_add(self)
        self._timer = context.window_manager.event_timer_add(_FRAME, window=context.window)
        self._say("press on a corner and drag it. Enter or right click ends")
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        try:
            return self._handled(context, event)
        except Exception:
            # Blender removes the operator, so nothing of it may stay.
            context.window.cursor_set("DEFAULT")
            self._ended(context)
            raise

    def _handled(self, context, event):
        if event.type == "TIMER":
            if self._grab is not None:
                self._take_frame()
            # Other timers have handlers of their own.
            return {"PASS_THROUGH"}
        if self._grab is not None:
            return self._dragging(context, event)
        if event.type == "LEFTMOUSE" and event.value == "PRESS":
            if not _holds(self._region, event):
                return self._ended(context) | {"PASS_THROUGH"}
            context.window.cursor_set("WAIT")
            is_grabbed = self._grabbed(context, lambda uv: self._nearest(uv, event))
            context.window.cursor_set("DEFAULT")
            if is_grabbed:
                self._first, self._target = self._grab.uv.copy(), None
                self._loops = _EditedLoops(self._selection, self._grab)
                self._say("drag the corner. Esc puts it back")
            elif self._is_over_panel(event):
                return self._ended(context) | {"PASS_THROUGH"}
        elif event.type in {"RET", "NUMPAD_ENTER", "RIGHTMOUSE", "ESC"} and event.value == "PRESS":
            return self._ended(context)
        elif event.type in _NAVIGATION or _is_undo(event):
            return {"PASS_THROUGH"}
        return {"RUNNING_MODAL"}

    def cancel(self, context):
        """Blender ends the operator, for example because another file is opened."""
        self._ended(context)

    def _dragging(self, context, event):
        """Event while a corner is dragged."""
        if event.type == "MOUSEMOVE":
            at = event.mouse_x - self._region.x, event.mouse_y - self._region.y
            self._target = np.array(self._region.view2d.region_to_view(*at))
        elif event.type in {"ESC", "RIGHTMOUSE"} and event.value == "PRESS":
            self._put_back("Put back")
        elif event.type == "LEFTMOUSE" and event.value == "RELEASE":
            self._take_frame(None)
            if self._grab is None:
                return {"RUNNING_MODAL"}
            if self.pins:
                self._loops.pin(np.searchsorted(self._grab.corners, self._grab.grabbed))
            self._tell(context)
            bpy.ops.ed.undo_push(message=self.bl_label)
            self._wait()
        return {"RUNNING_MODAL"}

    def _take_frame(self, frames=1):
        """Takes a frame towards the mouse, or all frames that are left."""
        if self._target is None:
            return
        try:
            moved = self._grab.move(self._target, frames)
        except freebound.Error as error:
            self._put_back(sentence(error))
            return
        self._loops.write(moved, self._grab.uv)
        if self._grab.is_at_rest:
            self._target = None

    def _grabbed(self, context, nearest):
        """Takes the corner that ``nearest`` finds. Returns True if there is one."""
        self._grab = None
        try:
            self._selection = meshes.gather_shown(context)
            corner = nearest(self._selection.uv)
            if corner is None:
                self.report({"INFO"}, "Press on a corner of a chart")
                return False
            size = operators.picture_size(context)
            grab = Grab(self._selection, corner, size[0] / size[1] if size else 1.0)
            # The first frame takes longest.
            grab.move(grab.place.astype(np.float64))
            self._grab = grab
            return True
        except freebound.NotProved:
            self.report({"ERROR"}, "The chart has flipped, overlapping or concave faces: unwrap or relax it first")
        except (meshes.Nothing, freebound.Error) as error:
            self.report({"ERROR"}, sentence(error))
        return False

    def _nearest(self, uv, event):
        """Corner under the mouse, or None."""
        view = self._region.view2d
        origin = np.array(view.view_to_region(0, 0, clip=False), dtype=np.float64)
        scale = (np.array(view.view_to_region(1000, 1000, clip=False)) - origin) / 1000
        mouse = event.mouse_x - self._region.x, event.mouse_y - self._region.y
        far = ((uv * scale + origin - mouse) ** 2).sum(axis=1)
        corner = int(np.argmin(far))
        return corner if far[corner] <= _REACH**2 else None

    def _is_over_panel(self, event):
        """True if the mouse is over a region that lies on the charts. Most of such a region is empty and shows them."""
        return any(_holds(region, event) for region in self._area.regions if region.type != "WINDOW")

    def _put_back(self, text):
        self._loops.write(range(len(self._first)), self._first)
        self.report({"INFO"}, text)
        self._wait()

    def _wait(self):
        self._grab = None
        self._say("press on a corner and drag it. Enter or right click ends")

    def _say(self, text):
        self._workspace.status_text_set(f"Freebound: {text}")

    def _ended(self, context):
        context.window_manager.event_timer_remove(self._timer)
        self._workspace.status_text_set(None)
        # Each drag was a step of undo by itself.
        return {"CANCELLED"}

    def _tell(self, context):
        u, v = self._grab.place
        uv = self._selection.uv.copy()
        uv[self._grab.corners] = self._grab.uv
        text, warning = told_of_chart(self._selection, uv, self._grab.corners)
        text = f"Dragged to ({u:.3f}, {v:.3f}), {text}" + (f". {warning}" if warning else "")
        operators.tell(context, text, not warning)
        self.report({"WARNING"} if warning else {"INFO"}, text)


CLASSES = (FREEBOUND_OT_drag_pin,)
