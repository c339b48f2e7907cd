# SPDX-License-Identifier: GPL-3.0-or-later
"""Copy of the layout of one object to other objects of the same surface, such as other levels of detail."""

import bpy
from bpy.props import BoolProperty

from . import meshes, solving
from .operators import Run


class FREEBOUND_OT_copy_layout(Run, bpy.types.Operator):
    """Copy the UV map of the active object to the other selected objects, and prove it there. Their meshes may differ"""

    bl_idname = "object.freebound_copy_layout"
    bl_label = "Freebound Copy Layout"

    is_in_world: BoolProperty(
        name="World Positions",
        description="Compare the objects where they stand in the scene. Otherwise their own coordinates are compared",
        default=False,
    )
    fit: BoolProperty(
        name="Fit",
        description="Move and scale the box around the active object to the box around each other object first",
        default=False,
    )
    marks_seams: BoolProperty(
        name="Mark Seams",
        description="Mark the seams of the copied layout on the meshes",
        default=True,
    )

    missing = "In object mode, select other meshes of this file, and last the object with the layout"

    @staticmethod
    def _objects(context):
        """Objects that get the layout, each mesh once."""
        active = context.active_object
        if context.mode != "OBJECT" or active is None or active.type != "MESH":
            return []
        # Changes of meshes from a library would not be saved.
        chosen = [item for item in context.selected_objects if item.type == "MESH" and item.data.library is None]
        others = {item.data: item for item in chosen}
        others.pop(active.data, None)
        return list(others.values())

    def draw(self, context):
        for name in ("is_in_world", "fit", "marks_seams"):
            self.layout.prop(self, name)

    def _gather(self, context):
        active = context.active_object
        missing = f"there is no UV map on {active.name}: unwrap it first"
        self._source = meshes.gather_objects(context, [active], missing, self.is_in_world, True)
        missing = "the selected objects have no faces"
        return meshes.gather_objects(context, self._objects(context), missing, self.is_in_world)

    def _work_of(self):
        source, fit, marks = self._source, self.fit, self.marks_seams
        names = [part.object.name for part in self._selection.parts]
        return lambda task, selection, _: solving.copy_layout(task, source, selection, names, fit, marks)


CLASSES = (FREEBOUND_OT_copy_layout,)
