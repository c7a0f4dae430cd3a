# SPDX-License-Identifier: GPL-3.0-or-later
"""What a changed property does: the ocean is shown anew."""

from collections.abc import Callable

import bpy

from ..scene import bake_versions, stored_paths
from ..scene.refinement import show
from ..scene.refresh import Wanted
from ..scene.settings import scene_of


def changed(group: bpy.types.PropertyGroup, _context: bpy.types.Context) -> None:
    """Show the ocean whose settings hold this group."""
    item = group.id_data
    settings = item.ocean_tweak
    if settings.is_quiet or not settings.is_ocean:
        return
    bake_versions.settings_changed(item)
    if settings.preset:
        settings.preset = ""
    if item.users_scene:
        show(item, scene_of(item), Wanted.CHANGE)


def path_changed(name: str) -> Callable[[bpy.types.PropertyGroup, bpy.types.Context], None]:
    """What a changed path of this name does: it is kept relative to the file, where it can be.

    Whether the shown bake lies in the ocean's cache may be another matter then.
    """

    def update(group: bpy.types.PropertyGroup, _context: bpy.types.Context) -> None:
        path = getattr(group, name)
        kept = stored_paths.relative(path)
        if kept != path:
            setattr(group, name, kept)  # which updates
        elif group.id_data.users_scene:
            show(group.id_data, scene_of(group.id_data), Wanted.BAKE)

    return update
