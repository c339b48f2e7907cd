# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators of the UV editor."""

import math

import bpy
import freebound
import numpy as np
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty

from . import meshes

#: Seconds between two looks at a run.
_TICK = 0.1


def _picture(context):
    """Width and height of the picture in the UV editor, or None."""
    image = getattr(context.space_data, "image", None)
    return tuple(image.size) if image is not None and min(image.size) > 0 else None


#: Longer side of the picture for which charts are packed if an aspect ratio is given, pixels.
_SIDE = 1024


def _packing(context, margin):
    """Options of packing for the picture in the editor."""
    size = _picture(context)
    if size is None:
        return {"pack": freebound.Pack(size=_SIDE, gap=margin)}
    if size[0] == size[1]:
        return {"pack": freebound.Pack(size=size, gap=margin)}
    # The coordinates are stretched with the picture, whose size is given by its aspect.
    return {"aspect": size[0] / size[1], "pack": freebound.Pack(gap=math.ceil(margin * _SIDE / max(size)))}


def tell(context, text):
    """Shows a verdict in the panel."""
    context.window_manager.freebound_verdict = text


class _Run:
    """Operator that runs the solver: in the background if a person calls it, to the end if a script does."""

    bl_options = {"REGISTER", "UNDO"}

    #: Job that runs for a person. There is one at a time.
    running = None

    @classmethod
    def poll(cls, context):
        if _Run.running is not None:
            cls.poll_message_set("A run of Freebound is under way")
            return False
        if meshes.objects_of(context):
            return True
        cls.poll_message_set("Edit a mesh first")
        return False

    def _begin(self, context):
        """Starts the run. Returns the job."""
        raise NotImplementedError

    def _words(self, layout):
        """Sentence on a layout."""
        raise NotImplementedError

    def _put(self, context, layout):
        """Puts the layout into the meshes. Returns a sentence on what was done beside it."""
        raise NotImplementedError

    def _start(self, context):
        try:
            return self._begin(context)
        except (meshes.Nothing, freebound.Error) as error:
            self.report({"ERROR"}, _sentence(error))
            return None

    def _finish(self, context, job):
        warning = ""
        try:
            layout = job.result()
        except freebound.NotProved as error:
            layout = error.layout
            if layout is None or not layout.verdict.planar_in_f32:
                tell(context, _sentence(error))
                self.report({"ERROR"}, _sentence(error))
                return {"CANCELLED"}
            warning = _sentence(error)
        except freebound.Cancelled:
            self.report({"INFO"}, "Cancelled")
            return {"CANCELLED"}
        except (freebound.Error, RuntimeError) as error:
            self.report({"ERROR"}, _sentence(error))
            return {"CANCELLED"}
        try:
            text = self._words(layout)
            text += self._put(context, layout)
        except meshes.Changed as error:
            self.report({"ERROR"}, _sentence(error))
            return {"CANCELLED"}
        tell(context, f"{text}. {warning}" if warning else text)
        self.report({"WARNING"} if warning else {"INFO"}, f"{text}. {warning}" if warning else text)
        return {"FINISHED"}

    def execute(self, context):
        job = self._start(context)
        return {"CANCELLED"} if job is None else self._finish(context, job)

    def invoke(self, context, event):
        if bpy.app.background or context.window is None:
            return self.execute(context)
        self._job = _Run.running = self._start(context)
        if self._job is None:
            return {"CANCELLED"}
        self._workspace = context.workspace
        self._timer = context.window_manager.event_timer_add(_TICK, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "TIMER":
            if self._job.wait(0):
                self._leave(context)
                return self._finish(context, self._job)
            state = self._job.progress
            words = state["stage"] or "working"
            self._workspace.status_text_set(f"Freebound: {words}, {state['seconds']:.1f} s. Esc cancels")
            # Other timers have handlers of their own.
            return {"PASS_THROUGH"}
        if event.type == "ESC" and event.value == "PRESS":
            self._job.cancel()
        # The meshes must stay as they are until the layout is put into them.
        return {"RUNNING_MODAL"}

    def cancel(self, context):
        """Blender ends the operator, for example because another file is opened."""
        self._job.cancel()
        self._leave(context)

    def _leave(self, context):
        _Run.running = None
        self._workspace.status_text_set(None)
        context.window_manager.event_timer_remove(self._timer)


def _sentence(error):
    text = str(error).strip().splitlines()[0] if str(error).strip() else type(error).__name__
    return text[:1].upper() + text[1:]


class FREEBOUND_OT_unwrap(_Run, bpy.types.Operator):
    """Unwrap the selected faces along seams. Pinned coordinates stay, and no face overlaps another"""

    bl_idname = "uv.freebound_unwrap"
    bl_label = "Freebound Unwrap"

    adds_seams: BoolProperty(
        name="Add Seams",
        description="Cut along further short seams until the distortion is small",
        default=True,
    )
    marks_seams: BoolProperty(
        name="Mark Seams",
        description="Mark the added seams on the mesh",
        default=True,
    )
    distortion: FloatProperty(
        name="Distortion",
        description="Largest mean energy of a part; 4 is without distortion",
        default=4.1,
        min=4.001,
        soft_max=6.0,
    )
    holes: EnumProperty(
        name="Holes",
        items=[
            ("fill", "Fill", "Keep holes inside the charts"),
            ("cut", "Cut", "Cut holes open"),
        ],
        default="fill",
    )
    margin: IntProperty(name="Margin", description="Least distance of charts, pixels", default=4, min=0, max=1024)
    soft_pins: StringProperty(
        name="Soft Pins",
        description="Vertex group whose pinned vertices may move; its weights pull",
        default="",
    )

    def _begin(self, context):
        self._selection = meshes.gather(context, self.soft_pins)
        pins = meshes.corner_pins(self._selection)
        options = {
            "seams": self._selection.seams if len(self._selection.seams) else None,
            "corner_pins": pins,
            "new_vertices": False,
            "holes": self.holes,
            "precision": "f32",
            **_packing(context, self.margin),
        }
        if self.adds_seams:
            options.update(cut="auto", distortion=self.distortion)
        else:
            options.update(cut="shortest")
        selection = self._selection
        return freebound.start(selection.vertices, selection.faces(), unwrap=True, **options)

    def _words(self, layout):
        charts = layout.chart.max() + 1
        return f"{charts} chart{'s' if charts != 1 else ''}, no overlaps: proved; energy {layout.energy:.3f}"

    def _put(self, context, layout):
        seams = layout.cut_edges if self.adds_seams and self.marks_seams else None
        marked = meshes.write(context, self._selection, layout.corner_uv, seams)
        return f"; {marked} seams marked" if marked else ""


class FREEBOUND_OT_check(bpy.types.Operator):
    """Select all faces that are flipped, overlap others, or have other defects in the active UV map"""

    bl_idname = "uv.freebound_check"
    bl_label = "Freebound Check"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return bool(meshes.objects_of(context))

    def execute(self, context):
        try:
            selection = meshes.gather(context, needs_uv=True)
            found = freebound.check(selection.vertices, selection.faces(), selection.uv)
        except (meshes.Nothing, freebound.Error) as error:
            self.report({"ERROR"}, _sentence(error))
            return {"CANCELLED"}
        faces, codes = set(), set()
        for finding in found["findings"]:
            if finding["severity"] != "note" or finding["code"] in _SELECTED_NOTES:
                own = _faces_of(finding)
                faces.update(own)
                if own:
                    codes.add(finding["code"])
        bare = np.isnan(selection.uv).any(axis=1)
        if bare.any():
            faces.update((np.searchsorted(selection.starts, np.flatnonzero(bare), side="right") - 1).tolist())
            codes.add("not-a-number")
        if faces:
            meshes.select(context, selection, faces)
        is_fine = found["planar"] and not bare.any()
        charts = found["charts"]
        text = f"{charts} chart{'s' if charts != 1 else ''}, no overlaps: proved" if is_fine else "Not one-to-one"
        if codes:
            text += f"; {len(faces)} faces selected: {', '.join(sorted(codes))}"
        tell(context, text)
        self.report({"INFO"} if is_fine else {"WARNING"}, text)
        return {"FINISHED"}


#: Findings whose faces are selected although they harm no proof.
_SELECTED_NOTES = {"mirrored"}


def _faces_of(finding):
    """Faces of a finding, however it lists them."""
    faces = set()
    for name, value in finding.items():
        if name in ("faces", "pairs", "face_pairs") and isinstance(value, list):
            faces.update(np.array(value, dtype=np.int64).ravel().tolist())
    return faces


def add_properties():
    bpy.types.WindowManager.freebound_verdict = StringProperty(name="Verdict", default="")


def remove_properties():
    del bpy.types.WindowManager.freebound_verdict


CLASSES = (FREEBOUND_OT_unwrap, FREEBOUND_OT_check)
