# SPDX-License-Identifier: GPL-3.0-or-later
"""Registers the extension with Blender when it is enabled, and unregisters it when it is disabled."""

from __future__ import annotations

import atexit
import logging
from collections.abc import Iterator, Mapping

import bpy

from . import cli
from .export import logs
from .scene import asset_library, handlers
from .scene.baked_spray import bake_place
from .scene.cache_place import cache_folder, own_uid
from .scene.command_process import CommandProcess
from .scene.portability import needs_of
from .scene.settings import OceanObjectError, all_oceans, shown_oceans
from .scene.shots import needed_maps, scene_frames, shot_of, with_surroundings
from .scene.view_layers import is_in_view_layer
from .ui import (
    adding,
    bake_operators,
    camera_operators,
    coast_operators,
    float_operators,
    gizmos,
    layer_operators,
    mask_operators,
    material_operators,
    measured_operators,
    node_operators,
    object_menu,
    overlays,
    panels,
    parameter_operators,
    patch_operators,
    pinning,
    preferences,
    preset_operators,
    previews,
    properties,
    scene_operators,
    sea_operators,
    sequence_operators,
    sky_operators,
    sky_properties,
    usd_operators,
    wake_operators,
    wind_operators,
)

CLASSES = (
    *preferences.CLASSES,
    *properties.CLASSES,
    *sky_properties.CLASSES,
    *adding.CLASSES,
    *parameter_operators.CLASSES,
    *measured_operators.CLASSES,
    *sequence_operators.CLASSES,
    *bake_operators.CLASSES,
    *usd_operators.CLASSES,
    *layer_operators.CLASSES,
    *patch_operators.CLASSES,
    *mask_operators.CLASSES,
    *coast_operators.CLASSES,
    *wind_operators.CLASSES,
    *preset_operators.CLASSES,
    *sea_operators.CLASSES,
    *panels.CLASSES,
    *camera_operators.CLASSES,
    *float_operators.CLASSES,
    *wake_operators.CLASSES,
    *node_operators.CLASSES,
    *object_menu.CLASSES,
    *pinning.CLASSES,
    *scene_operators.CLASSES,
    *material_operators.CLASSES,
    *sky_operators.CLASSES,
    *gizmos.CLASSES,
)

_log = logging.getLogger(__name__)

_COMMAND = "ocean_tweak"
# handle of the registered command-line command, needed to unregister it
_commands: list[object] = []


class _SceneOceans(Mapping[str, cli.FileSea]):
    """The oceans of the open file by object name; each sea is created on access.

    Access raises ParameterError for invalid settings.
    """

    def __init__(self) -> None:
        shown = shown_oceans()
        self._oceans: dict[str, tuple[bpy.types.Object, bpy.types.Scene]] = {}
        for item in (item for item in all_oceans() if item in shown):
            # a linked object may have the same name
            name = item.name if item.name not in self._oceans else item.name_full
            self._oceans[name] = item, shown[item]

    def __getitem__(self, name: str) -> cli.FileSea:
        """The sea of an object, over the frames of its scene."""
        item, scene = self._oceans[name]
        frames = scene_frames(scene)
        shot = with_surroundings(shot_of(item, scene, frames), item, scene, frames)
        if not is_in_view_layer(item, scene):
            _log.warning("%s is in no view layer of %s that is rendered: no picture has it", name, scene.name)
        try:
            cache = cache_folder(item)
        except OceanObjectError as error:
            _log.warning("%s: %s", name, error)
            cache = None
        needs = tuple(need.text for need in needs_of(item))
        return cli.FileSea(
            shot, own_uid(item), frames, cache, needed_maps(item), needs, bake_place(item, scene)
        )

    def __iter__(self) -> Iterator[str]:
        """The names."""
        return iter(self._oceans)

    def __len__(self) -> int:
        """The number of oceans."""
        return len(self._oceans)


def scene_oceans() -> Mapping[str, cli.FileSea]:
    """The oceans of the open file by object name."""
    return _SceneOceans()


def run_command(argv: list[str]) -> int:
    """Run `blender --command ocean_tweak …`. Returns the exit code."""
    return cli.main(argv, scene_oceans=scene_oceans)


def register(package: str | None = None) -> None:
    """Enable the extension.

    package : Blender's name for the extension; a script that uses a checkout passes another one
    """
    if not str(package).startswith("bl_ext."):
        # Blender disables extensions when it quits, but not for a script, and bpy 4.5 hangs or crashes at the
        # end of a process in which Python classes are still registered
        atexit.register(unregister)
    preferences.OCEAN_AP_preferences.bl_idname = package or _COMMAND
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    preferences.apply()
    bpy.types.Object.ocean_tweak = bpy.props.PointerProperty(
        type=properties.OCEAN_PG_ocean, override={"LIBRARY_OVERRIDABLE"}
    )
    sky_properties.register()
    pinning.register()
    previews.register()
    material_operators.register()
    bpy.types.VIEW3D_MT_mesh_add.append(panels.draw_add_menu)
    bpy.types.VIEW3D_MT_object.append(float_operators.draw_object_menu)
    bpy.types.VIEW3D_MT_object.append(object_menu.draw_object_menu)
    bpy.types.NODE_MT_add.append(node_operators.draw_add_menu)
    bpy.types.VIEW3D_MT_mesh_add.append(scene_operators.draw_add_menu)
    bpy.types.TOPBAR_MT_file_export.append(usd_operators.draw_export_menu)
    bpy.types.TOPBAR_MT_file_import.append(usd_operators.draw_import_menu)
    bpy.types.TOPBAR_MT_file_import.append(measured_operators.draw_import_menu)
    CommandProcess.command_line = cli.command()
    handlers.register()
    overlays.register()
    _commands.append(bpy.utils.register_cli_command(_COMMAND, run_command))


def unregister() -> None:
    """Disable the extension; oceans in the file keep their settings."""
    atexit.unregister(unregister)
    while _commands:
        bpy.utils.unregister_cli_command(_commands.pop())
    overlays.unregister()
    handlers.unregister()
    asset_library.remove()
    bpy.types.TOPBAR_MT_file_import.remove(measured_operators.draw_import_menu)
    bpy.types.TOPBAR_MT_file_import.remove(usd_operators.draw_import_menu)
    bpy.types.TOPBAR_MT_file_export.remove(usd_operators.draw_export_menu)
    bpy.types.VIEW3D_MT_mesh_add.remove(scene_operators.draw_add_menu)
    bpy.types.NODE_MT_add.remove(node_operators.draw_add_menu)
    bpy.types.VIEW3D_MT_object.remove(object_menu.draw_object_menu)
    bpy.types.VIEW3D_MT_object.remove(float_operators.draw_object_menu)
    bpy.types.VIEW3D_MT_mesh_add.remove(panels.draw_add_menu)
    material_operators.unregister()
    previews.unregister()
    pinning.unregister()
    sky_properties.unregister()
    del bpy.types.Object.ocean_tweak
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
    logs.end()
