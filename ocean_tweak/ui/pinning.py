# SPDX-License-Identifier: GPL-3.0-or-later
"""Pins one of a scene's oceans in the sidebar, whatever is selected."""

import bpy
from bpy.props import StringProperty

from ..scene.portability import known_oceans
from .active_ocean import PINNED, shown_ocean


class OCEAN_OT_pin(bpy.types.Operator):
    """Show one ocean, whatever is selected, or what is selected again."""

    bl_idname = "ocean.pin"
    bl_description = (
        "Show this ocean in the sidebar, whatever is selected. Without a pin the sidebar shows "
        "the active ocean, or else the one that the active object floats on, or the first by name"
    )
    bl_label = "Pin Ocean"
    bl_options = {"REGISTER", "UNDO"}

    ocean: StringProperty(name="Ocean", description="Name of the ocean; empty removes the pin")

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """The scene has an ocean."""
        cls.poll_message_set("There is no ocean in this scene: add one first")
        return shown_ocean(context) is not None

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Pin it."""
        if self.ocean and self.ocean not in (item.name for item in known_oceans(context.scene)):
            self.report({"ERROR"}, f"{self.ocean!r} is not an ocean of this scene")
            return {"CANCELLED"}
        setattr(context.scene, PINNED, self.ocean)
        return {"FINISHED"}


class OCEAN_MT_oceans(bpy.types.Menu):
    """The scene's oceans."""

    bl_idname = "OCEAN_MT_oceans"
    bl_label = "Oceans"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw an entry for each."""
        for item in known_oceans(context.scene):
            self.layout.operator(OCEAN_OT_pin.bl_idname, text=item.name, icon="MOD_OCEAN").ocean = item.name


def draw_shown(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw which ocean is shown, with a list and a pin where there are several."""
    item = shown_ocean(context)
    if len(known_oceans(context.scene)) < 2:
        layout.label(text=item.name, icon="MOD_OCEAN", translate=False)
        return
    is_pinned = getattr(context.scene, PINNED) == item.name
    line = layout.row(align=True)
    line.menu(OCEAN_MT_oceans.bl_idname, text=item.name, icon="MOD_OCEAN")
    icon = "PINNED" if is_pinned else "UNPINNED"
    line.operator(OCEAN_OT_pin.bl_idname, text="", icon=icon, depress=is_pinned).ocean = (
        "" if is_pinned else item.name
    )


def register() -> None:
    """Let scenes remember the pinned ocean."""
    setattr(bpy.types.Scene, PINNED, StringProperty(options={"HIDDEN"}))


def unregister() -> None:
    """Take that back."""
    delattr(bpy.types.Scene, PINNED)


CLASSES = (OCEAN_OT_pin, OCEAN_MT_oceans)
