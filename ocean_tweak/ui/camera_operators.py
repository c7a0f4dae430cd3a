# SPDX-License-Identifier: GPL-3.0-or-later
"""Adds and removes an ocean's camera surface."""

import bpy
from bpy.app.translations import pgettext_rpt as translated
from bpy.props import IntProperty

from ..core import ParameterError
from ..scene.camera_surface import add_camera_surface, remove_camera_surface
from ..scene.portability import neighbours_of
from ..scene.refinement import show
from ..scene.refresh import AROUND_CAMERA
from ..scene.settings import OceanObjectError
from .active_ocean import OfActiveOcean, refuse, shown_ocean


class OCEAN_OT_add_camera_surface(OfActiveOcean, bpy.types.Operator):
    """Show the ocean on a surface around the camera, up to the horizon."""

    bl_idname = "ocean.add_camera_surface"
    bl_description = (
        "Show the ocean on a surface that is dense near the camera and reaches the horizon. Its "
        "own mesh is left out of renders"
    )
    bl_label = "Camera Surface"
    bl_options = {"REGISTER", "UNDO"}

    budget: IntProperty(
        name="Vertices",
        description="Maximum number of vertices of the surface (1000 to 20000000)",
        default=200_000, min=1000, max=20_000_000, soft_max=2_000_000,
    )  # fmt: skip

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """An ocean of this file is active, and has none yet."""
        if not super().poll(context):
            return False
        if neighbours_of(shown_ocean(context)).has_surface:
            cls.poll_message_set("The ocean has a camera surface already")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Add it, and report which camera it follows."""
        try:
            add_camera_surface(shown_ocean(context), context.scene, budget=self.budget)
        except (OceanObjectError, ParameterError) as error:
            return refuse(self, error)
        if context.scene.camera is None:
            text = translated("The scene has no camera: the surface is dense at the ocean's own place")
            self.report({"WARNING"}, text)
        return {"FINISHED"}


class OCEAN_OT_remove_camera_surface(OfActiveOcean, bpy.types.Operator):
    """Show the ocean by its own mesh again."""

    bl_idname = "ocean.remove_camera_surface"
    bl_description = "Remove the surface around the camera, and show the ocean's own mesh again"
    bl_label = "Remove Camera Surface"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """An ocean of this file is active, and has one."""
        if not super().poll(context):
            return False
        if not neighbours_of(shown_ocean(context)).has_surface:
            cls.poll_message_set("The ocean has no camera surface")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Remove it."""
        ocean = shown_ocean(context)
        remove_camera_surface(ocean)
        show(ocean, context.scene, AROUND_CAMERA)  # a coast has a mesh again
        return {"FINISHED"}


def draw_camera_surface(layout: bpy.types.UILayout, item: bpy.types.Object) -> None:
    """Draw the button that adds or removes it."""
    kind = OCEAN_OT_remove_camera_surface if neighbours_of(item).has_surface else OCEAN_OT_add_camera_surface
    layout.operator(kind.bl_idname, icon="X" if kind is OCEAN_OT_remove_camera_surface else "CAMERA_DATA")


CLASSES = (OCEAN_OT_add_camera_surface, OCEAN_OT_remove_camera_surface)
