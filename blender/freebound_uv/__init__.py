# SPDX-License-Identifier: GPL-3.0-or-later
"""Freebound in the UV editor: unwrap, relax, pack, drag, check and copy layouts, with a proof."""

import bpy

from . import copying, dragging, operators, panel


def register():
    for cls in (*operators.CLASSES, *dragging.CLASSES, *copying.CLASSES, *panel.CLASSES):
        bpy.utils.register_class(cls)
    operators.add_properties()
    panel.add_menus()


def unregister():
    panel.remove_menus()
    operators.remove_properties()
    for cls in reversed((*operators.CLASSES, *dragging.CLASSES, *copying.CLASSES, *panel.CLASSES)):
        bpy.utils.unregister_class(cls)
