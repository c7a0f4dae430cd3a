# SPDX-License-Identifier: GPL-3.0-or-later
"""A whole scene at one press, where no ocean is active."""

import bpy

from ...scene.moods import MOODS
from .. import scene_operators
from .drawing import SidebarPanel


class OCEAN_PT_start_scene(SidebarPanel, bpy.types.Panel):
    """A whole scene, where no ocean is active."""

    bl_idname = "OCEAN_PT_start_scene"
    bl_label = "Scene"
    bl_parent_id = "OCEAN_PT_start"
    bl_options = {"HIDE_HEADER"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw one button a mood."""
        self.layout.label(text="With sky and camera:")
        column = self.layout.column(align=True)
        operator = scene_operators.OCEAN_OT_add_scene.bl_idname
        for key, mood in MOODS.items():
            column.operator(operator, text=mood.label, icon="SCENE_DATA").mood = key


CLASSES = (OCEAN_PT_start_scene,)
