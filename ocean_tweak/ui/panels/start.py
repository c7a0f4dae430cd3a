# SPDX-License-Identifier: GPL-3.0-or-later
"""Where to begin when no ocean is active: with one, or with a whole scene at one press."""

import bpy

from ...scene.conversion import ocean_modifier
from ...scene.moods import MOODS
from ...scene.settings import is_ocean, settings_of
from .. import adding, scene_operators, sea_operators
from .drawing import SidebarPanel, message


class OCEAN_PT_start(SidebarPanel, bpy.types.Panel):
    """Where to begin when no ocean is active."""

    bl_idname = "OCEAN_PT_start"
    bl_label = "Ocean Tweak"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Shown when the active object is not an ocean."""
        return not is_ocean(context.active_object)

    def draw(self, context: bpy.types.Context) -> None:
        """Offer to add one."""
        layout = self.layout
        item = context.active_object
        if item is not None and item.type == "MESH" and settings_of(item).uid:
            message(layout, context, "This mesh was an ocean: its modifier was applied or removed")
        else:
            layout.label(text="No ocean is active")
        column = layout.column(align=True)
        column.scale_y = 1.2
        column.operator(adding.MESH_OT_ocean_tweak_add.bl_idname, text="Add Ocean", icon="MOD_OCEAN")
        column.operator(
            scene_operators.OCEAN_OT_add_scene.bl_idname, text="Add Ocean Scene", icon="SCENE_DATA"
        )
        if ocean_modifier(context.active_object) is not None:
            layout.operator(sea_operators.OCEAN_OT_convert.bl_idname, icon="MODIFIER")


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


def draw_add_menu(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
    """Draw the entry in Add > Mesh."""
    self.layout.operator(adding.MESH_OT_ocean_tweak_add.bl_idname, icon="MOD_OCEAN")


CLASSES = (OCEAN_PT_start, OCEAN_PT_start_scene)
