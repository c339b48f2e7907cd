# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators of the UV editor."""

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


def _packing(context, margin):
    """Options of packing for the picture in the editor."""
    size = _picture(context)
    if size is None:
        return {"pack": freebound.Pack(size=1024, gap=margin)}
    return {"pack": freebound.Pack(size=size, gap=margin)}


def tell(context, text):
    """Shows a verdict in the panel."""
    context.window_manager.freebound_verdict = text


class _Run:
    """Operator that runs the solver: in the background if a person calls it, to the end if a script does."""

    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        if meshes.objects_of(context):
            return True
        cls.poll_message_set("Edit a mesh first")
        return False

    def _begin(self, context):
        """Starts the run. Returns the job."""
        raise NotImplementedError

    def _end(self, context, layout):
        """Puts the layout into the meshes. Returns a sentence on it."""
        raise NotImplementedError

    def _start(self, context):
        try:
            return self._begin(context)
        except (meshes.Nothing, freebound.Error) as error:
            self.report({"ERROR"}, _sentence(error))
            return None

    def _finish(self, context, job):
        try:
            layout = job.result()
        except freebound.NotProved as error:
            layout = error.layout
            if layout is None or not layout.verdict.planar:
                tell(context, _sentence(error))
                self.report({"ERROR"}, _sentence(error))
                return {"CANCELLED"}
            self.report({"WARNING"}, _sentence(error))
        except freebound.Cancelled:
            self.report({"INFO"}, "Cancelled")
            return {"CANCELLED"}
        except (freebound.Error, RuntimeError) as error:
            self.report({"ERROR"}, _sentence(error))
            return {"CANCELLED"}
        text = self._end(context, layout)
        tell(context, text)
        self.report({"INFO"}, text)
        return {"FINISHED"}

    def execute(self, context):
        job = self._start(context)
        return {"CANCELLED"} if job is None else self._finish(context, job)

    def invoke(self, context, event):
        if bpy.app.background or context.window is None:
            return self.execute(context)
        self._job = self._start(context)
        if self._job is None:
            return {"CANCELLED"}
        self._timer = context.window_manager.event_timer_add(_TICK, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC":
            self._job.cancel()
        if event.type != "TIMER" and event.type != "ESC":
            return {"PASS_THROUGH"} if not self._job.done else {"RUNNING_MODAL"}
        if not self._job.wait(0) and event.type != "ESC":
            state = self._job.progress
            words = state["stage"] or "working"
            context.workspace.status_text_set(f"Freebound: {words}, {state['seconds']:.1f} s. Esc cancels")
            return {"RUNNING_MODAL"}
        context.workspace.status_text_set(None)
        context.window_manager.event_timer_remove(self._timer)
        return self._finish(context, self._job)


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

    def _end(self, context, layout):
        seams = layout.cut_edges if self.adds_seams and self.marks_seams else None
        marked = meshes.write(context, self._selection, layout.corner_uv, seams)
        added = f", {marked} seams marked" if marked else ""
        charts = layout.chart.max() + 1
        return f"{charts} chart{'s' if charts != 1 else ''}, no overlaps: proved; energy {layout.energy:.3f}{added}"


class FREEBOUND_OT_relax(_Run, bpy.types.Operator):
    """Lower the distortion of the selected charts. Pinned coordinates stay, and charts stay in place"""

    bl_idname = "uv.freebound_relax"
    bl_label = "Freebound Relax"

    rounds: IntProperty(name="Rounds", description="Rounds of relaxing", default=20, min=1, max=500)
    soft_pins: StringProperty(name="Soft Pins", description="Vertex group whose pinned vertices may move", default="")

    def _begin(self, context):
        selection = self._selection = meshes.gather(context, self.soft_pins, needs_uv=True)
        return freebound.start(
            selection.vertices,
            selection.faces(),
            layout=selection.uv,
            charts="uv",
            repair="all",
            corner_pins=meshes.corner_pins(selection),
            new_vertices=False,
            relax=self.rounds,
            precision="f32",
        )

    def _end(self, context, layout):
        meshes.write(context, self._selection, layout.corner_uv)
        return f"relaxed, no overlaps: proved; energy {layout.energy:.3f}"


class FREEBOUND_OT_pack(_Run, bpy.types.Operator):
    """Pack the selected charts by their shapes into the unit square, at one density"""

    bl_idname = "uv.freebound_pack"
    bl_label = "Freebound Pack"

    margin: IntProperty(name="Margin", description="Least distance of charts, pixels", default=4, min=0, max=1024)
    rotates: BoolProperty(name="Rotate", description="Charts may be rotated", default=True)

    def _begin(self, context):
        selection = self._selection = meshes.gather(context, needs_uv=True)
        pack = _packing(context, self.margin)["pack"]
        rotations = "free" if self.rotates else "none"
        return freebound.start(
            selection.vertices,
            selection.faces(),
            layout=selection.uv,
            charts="uv",
            repair="all",
            new_vertices=False,
            relax=0,
            precision="f32",
            pack=freebound.Pack(size=pack.size, gap=pack.gap, rotations=rotations),
        )

    def _end(self, context, layout):
        meshes.write(context, self._selection, layout.corner_uv)
        packing = layout.report.get("packing") or {}
        covered = packing.get("coverage")
        covered = f", {100 * covered:.0f} % covered" if covered is not None else ""
        return f"packed, no overlaps: proved{covered}"


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
        faces = set()
        for finding in found["findings"]:
            if finding["severity"] != "note":
                faces.update(_faces_of(finding))
        if faces:
            meshes.select(context, selection, faces)
        errors = [finding["code"] for finding in found["findings"] if finding["severity"] == "error"]
        if found["planar"]:
            text = f"{found['charts']} charts, no overlaps: proved"
        else:
            text = f"Not one-to-one: {', '.join(sorted(set(errors)))}; {len(faces)} faces selected"
        tell(context, text)
        self.report({"INFO"} if found["planar"] else {"WARNING"}, text)
        return {"FINISHED"}


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


CLASSES = (FREEBOUND_OT_unwrap, FREEBOUND_OT_relax, FREEBOUND_OT_pack, FREEBOUND_OT_check)
