# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators of the UV editor that run the solver, and the check."""

import bpy
import freebound
import numpy as np
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty

from . import meshes, solving
from .solving import Sheet, counted, sentence
from .tasks import Task

#: Seconds between two looks at a run.
_TICK = 0.1


def picture_size(context):
    """Width and height of the picture in the UV editor, or None."""
    image = getattr(context.space_data, "image", None)
    return tuple(image.size) if image is not None and min(image.size) > 0 else None


def is_running():
    """True while a run is under way."""
    return Run.running is not None


def tell(context, text, is_fine):
    """Shows a verdict in the panel."""
    context.window_manager.freebound_verdict = text
    context.window_manager.freebound_is_fine = is_fine


class Run:
    """Operator that runs the solver: in the background if a person calls it, to the end if a script does."""

    bl_options = {"REGISTER", "UNDO"}

    #: Task that runs for a person. There is one at a time.
    running = None

    #: What to do if there is no object to work on.
    missing = "Edit a mesh first"

    margin: IntProperty(
        name="Margin", description="Least distance of charts, pixels", default=4, min=0, soft_max=64, max=256
    )
    is_around: BoolProperty(
        name="Around Others",
        description="Keep faces that are not selected in place, and lay no chart over them",
        default=True,
    )

    @classmethod
    def poll(cls, context):
        if is_running():
            cls.poll_message_set("A run of Freebound is under way")
            return False
        if cls._objects(context):
            return True
        cls.poll_message_set(cls.missing)
        return False

    @staticmethod
    def _objects(context):
        """Objects to work on."""
        return meshes.objects_of(context)

    def _gather(self, context):
        """Selected faces with coordinates, and the others."""
        return meshes.gather(context, needs_uv=True, is_around=self.is_around)

    def _work_of(self):
        """Function that solves, in a thread of its own: of the task, the faces and the picture."""
        raise NotImplementedError

    def _start(self, context):
        try:
            self._selection = self._gather(context)
        except meshes.Nothing as error:
            self._refuse(context, error)
            return None
        selection, sheet = self._selection, Sheet(picture_size(context), self.margin)
        # The thread must not reach the operator, which Blender may end before.
        work = self._work_of()
        return Task(lambda task: work(task, selection, sheet))

    def _refuse(self, context, error):
        tell(context, sentence(error), False)
        self.report({"ERROR"}, sentence(error))

    def _finish(self, context, task):
        try:
            done = task.result()
            marked = meshes.write(context, self._selection, done.corner_uv, done.seams)
        except freebound.Cancelled:
            self.report({"INFO"}, "Cancelled")
            return {"CANCELLED"}
        except Exception as error:
            # Whatever went wrong, the meshes are as before, and the person reads why.
            self._refuse(context, error)
            return {"CANCELLED"}
        text = f"{done.text}; {marked} seams marked" if marked else done.text
        text = f"{text}. {done.warning}" if done.warning else text
        tell(context, text, not done.warning)
        self.report({"WARNING"} if done.warning else {"INFO"}, text)
        return {"FINISHED"}

    def execute(self, context):
        task = self._start(context)
        return {"CANCELLED"} if task is None else self._finish(context, task)

    def invoke(self, context, event):
        if bpy.app.background or context.window is None:
            return self.execute(context)
        self._task = Run.running = self._start(context)
        if self._task is None:
            return {"CANCELLED"}
        self._workspace = context.workspace
        self._timer = context.window_manager.event_timer_add(_TICK, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "TIMER":
            if self._task.wait(0):
                self._leave(context)
                return self._finish(context, self._task)
            self._workspace.status_text_set(f"Freebound: {self._task.progress}. Esc cancels")
            # Other timers have handlers of their own.
            return {"PASS_THROUGH"}
        if event.type == "ESC" and event.value == "PRESS":
            self._task.cancel()
        # The meshes must stay as they are until the layout is put into them.
        return {"RUNNING_MODAL"}

    def cancel(self, context):
        """Blender ends the operator, for example because another file is opened."""
        self._task.cancel()
        self._leave(context)

    def _leave(self, context):
        Run.running = None
        self._workspace.status_text_set(None)
        context.window_manager.event_timer_remove(self._timer)


class FREEBOUND_OT_unwrap(Run, bpy.types.Operator):
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
    soft_pins: StringProperty(
        name="Soft Pins",
        description="Vertex group whose pinned vertices may move; its weights pull",
        default="",
    )

    def _gather(self, context):
        return meshes.gather(context, self.soft_pins, is_around=self.is_around)

    def _work_of(self):
        cut = {"cut": "auto", "distortion": self.distortion} if self.adds_seams else {"cut": "shortest"}
        options = {"holes": self.holes, **cut}
        marks = self.adds_seams and self.marks_seams
        return lambda *given: solving.unwrap(*given, options, marks)


class FREEBOUND_OT_relax(Run, bpy.types.Operator):
    """Lower the distortion of the selected charts. Pinned coordinates stay. Charts move only if they come to overlap"""

    bl_idname = "uv.freebound_relax"
    bl_label = "Freebound Relax"

    rounds: IntProperty(
        name="Rounds",
        description="Most rounds of relaxing",
        default=40,
        min=1,
        max=1000,
    )

    def _work_of(self):
        rounds = self.rounds
        return lambda *given: solving.relax(*given, rounds)


class FREEBOUND_OT_pack(Run, bpy.types.Operator):
    """Pack the charts of the selected faces. Charts with pins stay, and charts that are partly selected"""

    bl_idname = "uv.freebound_pack"
    bl_label = "Freebound Pack"

    keeps_sizes: BoolProperty(
        name="Keep Sizes",
        description="Keep the sizes of the charts relative to each other. Otherwise all get one texel density",
        default=False,
    )

    def _work_of(self):
        keeps_sizes = self.keeps_sizes
        return lambda *given: solving.pack(*given, keeps_sizes)


class FREEBOUND_OT_check(bpy.types.Operator):
    """Check all faces of the edited meshes, and select those that are flipped, overlap, or have other defects"""

    bl_idname = "uv.freebound_check"
    bl_label = "Freebound Check"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        if is_running():
            cls.poll_message_set("A run of Freebound is under way")
            return False
        return bool(meshes.objects_of(context))

    def execute(self, context):
        try:
            selection = meshes.gather_all(context)
            found = freebound.check(selection.vertices, selection.faces(), selection.uv, listed=solving.LISTED)
        except (meshes.Nothing, freebound.Error) as error:
            tell(context, sentence(error), False)
            self.report({"ERROR"}, sentence(error))
            return {"CANCELLED"}
        is_wrong, codes = np.zeros(selection.face_count, dtype=bool), set()
        for finding in found["findings"]:
            if finding["severity"] != "note" or finding["code"] == "mirrored":
                pairs = np.array(finding.get("pairs", []), dtype=np.int64).ravel()
                own = np.concatenate([np.array(finding.get("faces", []), dtype=np.int64), pairs])
                if finding["code"] == "stacked":
                    own = solving.with_stacked(selection.uv, selection.starts, own)
                if finding["code"] in _OF_CHARTS:
                    own = _with_charts(selection, own)
                is_wrong[own] = True
                codes.update([finding["code"]] if len(own) else [])
        bare = selection.of_faces(np.isnan(selection.uv).any(axis=1))
        if bare.any():
            is_wrong |= bare
            codes.add("not-a-number")
        hidden = meshes.select(context, selection, np.flatnonzero(is_wrong)) if is_wrong.any() else 0
        is_fine = found["planar"] and not bare.any()
        text = f"{counted(found['charts'])}, no overlaps: proved" if is_fine else "Not one-to-one"
        if codes:
            text += f"; {is_wrong.sum() - hidden} faces selected: {', '.join(sorted(codes))}"
        if hidden:
            text += f"; {hidden} more are hidden"
        tell(context, text, is_fine)
        self.report({"INFO"} if is_fine else {"WARNING"}, text)
        return {"FINISHED"}


#: Findings that name charts by their first faces.
_OF_CHARTS = {"mirrored", "outside", "scale", "tiles"}


def _with_charts(selection, faces):
    """All faces of the charts of some faces."""
    usable = ~selection.of_faces(~np.isfinite(selection.uv).all(axis=1))
    number_of = np.flatnonzero(usable)
    some = selection.without(~usable)
    charts = np.full(selection.face_count, -1)
    charts[number_of] = freebound.charts(selection.vertices, (some.corners, some.starts), some.uv)
    return np.flatnonzero(np.isin(charts, charts[faces]) & (charts >= 0))


@bpy.app.handlers.persistent
def forget_verdict(*_):
    """Empties the panel: the meshes are those of another time or file."""
    for manager in bpy.data.window_managers:
        manager.freebound_verdict, manager.freebound_is_fine = "", False


def _handlers():
    handlers = bpy.app.handlers
    return handlers.undo_post, handlers.redo_post, handlers.load_post


def add_properties():
    bpy.types.WindowManager.freebound_verdict = StringProperty(name="Verdict", default="")
    bpy.types.WindowManager.freebound_is_fine = BoolProperty(name="Proved", default=False)
    for handlers in _handlers():
        handlers.append(forget_verdict)


def remove_properties():
    for handlers in _handlers():
        handlers.remove(forget_verdict)
    del bpy.types.WindowManager.freebound_verdict
    del bpy.types.WindowManager.freebound_is_fine


CLASSES = (FREEBOUND_OT_unwrap, FREEBOUND_OT_relax, FREEBOUND_OT_pack, FREEBOUND_OT_check)
