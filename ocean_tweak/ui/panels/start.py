# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel of a scene without an ocean: adds one, or a whole scene."""

import bpy

from ...scene.conversion import ocean_modifier
from ...scene.moods import COASTS, MOODS
from ...scene.settings import is_ocean, settings_of
from .. import adding, scene_operators, sea_operators
from ..active_ocean import shown_ocean
from .drawing import SidebarPanel, message


class OCEAN_PT_start(SidebarPanel, bpy.types.Panel):
    """Shown in a scene without an ocean."""

    bl_idname = "OCEAN_PT_start"
    bl_label = "Ocean Tweak"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Shown where the scene has no ocean, and for what was one or can become one."""
        return shown_ocean(context) is None or _was_or_can_be(context.active_object)

    def draw(self, context: bpy.types.Context) -> None:
        """Offer to add one."""
        layout = self.layout
        item = context.active_object
        if item is not None and item.type == "MESH" and settings_of(item).uid and not is_ocean(item):
            message(layout, context, "This mesh was an ocean: its modifier was applied or removed")
        elif shown_ocean(context) is None:
            layout.label(text="No ocean in this scene")
        if shown_ocean(context) is None:
            column = layout.column(align=True)
            column.scale_y = 1.2
            column.operator(adding.MESH_OT_ocean_tweak_add.bl_idname, text="Add Ocean", icon="MOD_OCEAN")
            column.operator(
                scene_operators.OCEAN_OT_add_scene.bl_idname, text="Add Ocean Scene", icon="SCENE_DATA"
            )
        if ocean_modifier(context.active_object) is not None:
            layout.operator(sea_operators.OCEAN_OT_convert.bl_idname, icon="MODIFIER")


class OCEAN_PT_start_scene(SidebarPanel, bpy.types.Panel):
    """A whole scene, where the scene has no ocean."""

    bl_idname = "OCEAN_PT_start_scene"
    bl_label = "Scene"
    bl_parent_id = "OCEAN_PT_start"
    bl_options = {"HIDE_HEADER"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Shown where the scene has no ocean."""
        return shown_ocean(context) is None

    def draw(self, context: bpy.types.Context) -> None:
        """Draw one button a mood."""
        self.layout.label(text="With sky and camera:")
        column = self.layout.column(align=True)
        operator = scene_operators.OCEAN_OT_add_scene.bl_idname
        for key, mood in (MOODS | COASTS).items():
            column.operator(operator, text=mood.label, icon="SCENE_DATA").mood = key


def draw_add_menu(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    """Draw the entry in Add > Mesh."""
    text = "Ocean Tweak" if shown_ocean(context) is None else "Ocean Tweak (Another Ocean)"
    self.layout.operator(adding.MESH_OT_ocean_tweak_add.bl_idname, text=text, icon="MOD_OCEAN")


def _was_or_can_be(item: bpy.types.Object | None) -> bool:
    """Whether an object was an ocean, or has Blender's Ocean modifier."""
    if item is None or item.type != "MESH" or is_ocean(item):
        return False
    return bool(settings_of(item).uid) or ocean_modifier(item) is not None


CLASSES = (OCEAN_PT_start, OCEAN_PT_start_scene)
