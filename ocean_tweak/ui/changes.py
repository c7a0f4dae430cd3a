# SPDX-License-Identifier: GPL-3.0-or-later
"""What a changed property does: the ocean is shown anew."""

import bpy

from ..scene.refinement import show


def changed(group: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    """Show the ocean whose settings hold this group."""
    item = group.id_data
    settings = item.ocean_tweak
    if settings.is_quiet or not settings.is_ocean:
        return
    if settings.preset:
        settings.preset = ""
    scenes = item.users_scene
    if scenes:
        show(item, context.scene if context.scene in scenes else scenes[0], dragged=True)
