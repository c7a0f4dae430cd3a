# SPDX-License-Identifier: GPL-3.0-or-later
"""Baking, and which of live and baked is shown."""

import bpy
from bpy.app.translations import pgettext_iface as translated

from ...core.frames import format_frames
from ...scene import bake_process, cache_place, stored_paths
from ...scene.image_sequence import baked_frames
from ...scene.maps import MAPS
from ...scene.shots import scene_frames
from .. import bake_operators, sequence_operators
from .drawing import OceanPanel, active_settings, message, progress_bar, row, split


class OCEAN_PT_bake(OceanPanel, bpy.types.Panel):
    """Frames on disk: made, chosen, taken along."""

    bl_idname = "OCEAN_PT_bake"
    bl_label = "Bake"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the cache, the button or the progress, and what is shown."""
        layout, settings = split(self.layout), active_settings(context)
        bake = bake_process.running(context.active_object)
        if bake is not None:
            progress_bar(layout, bake, bake_operators.OCEAN_OT_stop_bake.bl_idname)
        else:
            layout.prop(settings, "cache_folder")
            layout.operator(
                bake_operators.OCEAN_OT_bake.bl_idname, text=_bake_label(context), icon="RENDER_ANIMATION"
            )
        shown = (
            "Baked files move the ocean" if settings.source == "SEQUENCE" else "The ocean is computed live"
        )
        layout.label(text=shown, icon="FILE_CACHE" if settings.source == "SEQUENCE" else "PLAY")
        if settings.source == "SEQUENCE":
            _sequence(layout, context)
        choose = "Choose Another" if settings.sequence_maps.disp else "Use Baked Sequence"
        layout.operator(sequence_operators.OCEAN_OT_use_sequence.bl_idname, text=choose, icon="FILE_FOLDER")


def _bake_label(context: bpy.types.Context) -> str:
    settings, count = active_settings(context), len(scene_frames(context.scene))
    if 0 < settings.bake_done < settings.bake_total:
        return translated("Resume Bake ({} of {} Frames)").format(settings.bake_done, settings.bake_total)
    return translated("Bake {} Frames").format(count)


def _sequence(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the files, what is missing of them, and the way back."""
    settings = active_settings(context)
    image = settings.sequence_maps.disp
    column = layout.column(align=True)
    folder = cache_place.shown_bake(context.active_object)
    if folder is not None:
        row(column, "Version", folder.name)
    row(column, "Files", stored_paths.image_file(image).name if image else "none chosen")
    if image:
        row(column, "Frames", format_frames(baked_frames(settings)))
        row(column, "Maps", ", ".join(name for name in MAPS if getattr(settings.sequence_maps, name)))
    if settings.missing_file:
        file = bpy.path.basename(settings.missing_file)
        message(layout, context, f"{file} is missing: bake it again or choose other files", alert=True)
    if cache_place.is_left_behind(context.active_object):
        layout.operator(bake_operators.OCEAN_OT_take_cache_along.bl_idname, icon="DUPLICATE")
    layout.prop(settings, "out_of_range")
    if settings.error:
        layout.operator(sequence_operators.OCEAN_OT_use_live.bl_idname, icon="PLAY")


CLASSES = (OCEAN_PT_bake,)
