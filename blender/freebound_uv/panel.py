# SPDX-License-Identifier: GPL-3.0-or-later
"""Panel of the UV editor, and entries of the UV menus."""

import bpy

from . import operators


class FREEBOUND_PT_panel(bpy.types.Panel):
    bl_label = "Freebound"
    bl_idname = "FREEBOUND_PT_panel"
    bl_space_type = "IMAGE_EDITOR"
    bl_region_type = "UI"
    bl_category = "Freebound"

    @classmethod
    def poll(cls, context):
        return context.space_data.show_uvedit or context.mode == "EDIT_MESH"

    def draw(self, context):
        layout = self.layout
        column = layout.column(align=True)
        for operator in operators.CLASSES:
            column.operator(operator.bl_idname, text=operator.bl_label.removeprefix("Freebound "))
        verdict = context.window_manager.freebound_verdict
        box = layout.box()
        if verdict:
            # A label does not wrap.
            words, line = verdict.split(" "), ""
            for word in words:
                if len(line) + len(word) > 32:
                    box.label(text=line)
                    line = ""
                line = f"{line} {word}".strip()
            box.label(text=line)
        else:
            box.label(text="Select faces, then unwrap.")
            box.label(text="P pins coordinates.")


def draw_menu(self, context):
    self.layout.separator()
    for operator in operators.CLASSES:
        self.layout.operator(operator.bl_idname)


MENUS = ("IMAGE_MT_uvs", "VIEW3D_MT_uv_map")


def add_menus():
    for name in MENUS:
        getattr(bpy.types, name).append(draw_menu)


def remove_menus():
    for name in MENUS:
        getattr(bpy.types, name).remove(draw_menu)


CLASSES = (FREEBOUND_PT_panel,)
