# SPDX-License-Identifier: GPL-3.0-or-later
"""Panel of the UV editor, and entries of the UV menus."""

import bpy

from . import copying, dragging, operators

#: Entries of the panel and the menus: operator, icon, and True if it needs the UV editor.
_ENTRIES = (
    (operators.FREEBOUND_OT_unwrap, "UV", False),
    (operators.FREEBOUND_OT_relax, "MOD_SMOOTH", False),
    (operators.FREEBOUND_OT_pack, "PACKAGE", False),
    (dragging.FREEBOUND_OT_drag_pin, "PINNED", True),
    (operators.FREEBOUND_OT_check, "VIEWZOOM", False),
)

#: Average width of a letter, and width of the borders of a box, in pixels at a scale of 1.
_LETTER, _BORDER = 7, 40


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
        row = layout.row()
        row.scale_y = 1.4
        first, *others = _ENTRIES
        _button(row, *first[:2])
        column = layout.column(align=True)
        for operator, icon, _ in others:
            _button(column, operator, icon)
        manager = context.window_manager
        box = layout.box().column(align=True)
        if not manager.freebound_verdict:
            lines, icon = ["Select faces, then unwrap.", "P pins the selected coordinates."], "INFO"
        else:
            scale = context.preferences.system.ui_scale
            letters = int((context.region.width / scale - _BORDER) / _LETTER)
            lines = _wrapped(manager.freebound_verdict, max(letters, 12))
            icon = "CHECKMARK" if manager.freebound_is_fine else "ERROR"
        for number, line in enumerate(lines):
            box.label(text=line, icon=icon if number == 0 else "BLANK1")


def _button(layout, operator, icon):
    layout.operator(operator.bl_idname, text=operator.bl_label.removeprefix("Freebound "), icon=icon)


def _wrapped(text, letters):
    """Lines of a text, because a label does not wrap."""
    lines = [""]
    for word in text.split():
        longer = f"{lines[-1]} {word}".strip()
        if len(longer) > letters and lines[-1]:
            lines.append(word)
        else:
            lines[-1] = longer
    return lines


def draw_menu(self, context):
    self.layout.separator()
    is_uv_editor = context.area is not None and context.area.type == "IMAGE_EDITOR"
    for operator, icon, needs_editor in _ENTRIES:
        if is_uv_editor or not needs_editor:
            self.layout.operator(operator.bl_idname, icon=icon)


def draw_object_menu(self, context):
    self.layout.separator()
    self.layout.operator(copying.FREEBOUND_OT_copy_layout.bl_idname, icon="UV_DATA")


#: Functions that draw entries, by the name of the menu.
MENUS = {
    "IMAGE_MT_uvs": draw_menu,
    "VIEW3D_MT_uv_map": draw_menu,
    "VIEW3D_MT_make_links": draw_object_menu,
}


def add_menus():
    for name, draw in MENUS.items():
        getattr(bpy.types, name).append(draw)


def remove_menus():
    for name, draw in MENUS.items():
        getattr(bpy.types, name).remove(draw)


CLASSES = (FREEBOUND_PT_panel,)
