# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene's sky: sun and moon, clouds, haze, exposure, or a panorama."""

import bpy

from ...scene import scene_sky
from .. import scene_operators, sky_operators
from .drawing import OceanPanel, message, split


class OCEAN_PT_sky(OceanPanel, bpy.types.Panel):
    """The sky of a scene with an ocean."""

    bl_idname = "OCEAN_PT_sky"
    bl_label = "Sky"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the presets, and the settings of a sky that is there."""
        scene = context.scene
        has_sky = scene_sky.has_sky(scene)
        text = "Change Sky" if has_sky else "Add Sky"
        buttons = self.layout.column(align=True)
        buttons.operator_menu_enum(
            sky_operators.OCEAN_OT_use_sky.bl_idname, "sky", text=text, icon="LIGHT_SUN"
        )
        buttons.operator_menu_enum(scene_operators.OCEAN_OT_change_mood.bl_idname, "mood", icon="SCENE_DATA")
        if not has_sky:
            if scene.world is not None:
                message(self.layout, context, f"The scene has a world of its own, {scene.world.name}")
            return
        settings = scene_sky.settings_of(scene)
        if settings.error:
            message(self.layout, context, settings.error, alert=True)
        layout = split(self.layout)
        if settings.hdri is None or settings.error:
            _draw_sky(layout, settings)
        layout.prop(settings, "visibility")
        _draw_exposure(layout, settings, scene)
        _draw_panorama(layout, settings)


def _draw_sky(layout: bpy.types.UILayout, settings: scene_sky.SkySettings) -> None:
    sun = layout.column(align=True)
    sun.prop(settings, "sun_elevation")
    sun.prop(settings, "sun_azimuth")
    if settings.sun_elevation < 0.0:
        moon = layout.column(align=True)
        moon.prop(settings, "moon_elevation")
        moon.prop(settings, "moon_azimuth")
    clouds = layout.column(align=True)
    clouds.prop(settings, "clouds")
    clouds.prop(settings, "overcast")
    if settings.overcast > 0.0:
        clouds.prop(settings, "sunlight")


def _draw_exposure(
    layout: bpy.types.UILayout, settings: scene_sky.SkySettings, scene: bpy.types.Scene
) -> None:
    layout.prop(settings, "use_exposure")
    if settings.use_exposure:
        layout.prop(settings, "exposure")
    else:
        layout.label(text=f"The scene's own: {scene.view_settings.exposure:.1f}")


def _draw_panorama(layout: bpy.types.UILayout, settings: scene_sky.SkySettings) -> None:
    line = layout.row(align=True)
    name = "Open HDRI" if settings.hdri is None else settings.hdri.name
    line.operator(sky_operators.OCEAN_OT_load_hdri.bl_idname, text=name, icon="WORLD")
    if settings.hdri is not None:
        line.operator(sky_operators.OCEAN_OT_remove_hdri.bl_idname, text="", icon="X")
        layout.prop(settings, "hdri_rotation")
        layout.prop(settings, "hdri_strength")


CLASSES = (OCEAN_PT_sky,)
