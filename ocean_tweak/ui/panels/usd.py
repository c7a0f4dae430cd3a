# SPDX-License-Identifier: GPL-3.0-or-later
"""Layers for other programs: written, checked and read."""

import bpy
from bpy.app.translations import pgettext_iface as translated

from ...export.usd import library
from ...scene import usd_process
from ...scene.shots import scene_frames
from .. import usd_operators
from ..usd_properties import draw_choices
from .drawing import OceanPanel, active_settings, message, progress_bar, split


class OCEAN_PT_usd(OceanPanel, bpy.types.Panel):
    """The sea as USD."""

    bl_idname = "OCEAN_PT_usd"
    bl_label = "USD"
    bl_parent_id = "OCEAN_PT_bake"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw where the layers go, what they hold, and the buttons or the progress."""
        layout, item = split(self.layout), context.active_object
        settings, process = active_settings(context).usd, usd_process.running(item)
        if not library.is_installed():
            message(layout, context, library.MISSING_IN_BLENDER, alert=True)
        layout.prop(settings, "file", placeholder=usd_process.default_file(item))
        draw_choices(layout, settings, usd_process.has_bake(item))
        if process is not None:
            progress_bar(layout, process, usd_operators.OCEAN_OT_stop_usd.bl_idname)
        else:
            text = translated("Export {} Frames").format(len(scene_frames(context.scene)))
            layout.operator(usd_operators.OCEAN_OT_export_usd.bl_idname, text=text, icon="EXPORT")
        layout.operator(usd_operators.OCEAN_OT_verify_usd.bl_idname, icon="CHECKMARK")
        layout.operator(usd_operators.OCEAN_OT_import_usd.bl_idname, icon="IMPORT")


CLASSES = (OCEAN_PT_usd,)
