# SPDX-License-Identifier: GPL-3.0-or-later
"""Layers of all kinds: their list, and the active one in full."""

import math
from typing import Any

import bpy
from bpy.app.translations import pgettext_iface as translated

from ...core import HeroWave, WakeLayer
from ...core.waves.contribution import Contribution
from ...scene import source_images
from ...scene.refresh import sea_of_settings
from ...scene.units import metres_per_unit
from .. import layer_operators, parameter_properties, wind_operators
from ..active_ocean import active_layer, nearest, shown_ocean
from ..field_drawing import draw_fields
from ..layer_properties import kind_of
from ..measured_operators import OCEAN_OT_import_measured
from .drawing import SubPanel, active_settings, draw_equaliser, length_text, message, row, speed_text, split
from .masks import draw_image, draw_mask


class OCEAN_UL_layers(bpy.types.UIList):
    """A line a layer: what it is, and whether it takes part."""

    bl_idname = "OCEAN_UL_layers"

    def draw_item(  # Blender wants each argument by itself
        self, context: bpy.types.Context, layout: bpy.types.UILayout, _data: object,
        layer: bpy.types.PropertyGroup, _icon: int, _active_data: object, _active_property: str,
    ) -> None:  # fmt: skip
        """Draw the layer's wind, its waves or its image."""
        group, kind = layer.group, kind_of(layer)
        line = layout.row(align=True)
        line.active = not group.muted
        title = _TITLES.get(kind.kind)
        text = kind.names.label if title is None else title(group, context.scene)
        line.label(text=text, icon=kind.names.icon, translate=False)
        line.prop(group, "muted", text="", icon="HIDE_ON" if group.muted else "HIDE_OFF", emboss=False)


def _waves_title(layer: bpy.types.PropertyGroup, scene: bpy.types.Scene) -> str:
    metres = float(metres_per_unit(scene))
    if layer.definition == "WIND":
        return f"{speed_text(scene, layer.wind_speed * metres)}, {layer.fetch_km:.3g} km"
    if layer.definition == "MEASURED":
        return "Measured"
    return f"{length_text(scene, layer.significant_wave_height * metres)}, {layer.peak_period:.3g} s"


def _wind_title(group: bpy.types.PropertyGroup, scene: bpy.types.Scene) -> str:
    if group.source == "UNIFORM":
        return f"Wind field, {speed_text(scene, group.wind_speed * float(metres_per_unit(scene)))}"
    if group.source == "IMAGE" and group.image is not None:
        return f"Wind field, {group.image.name}"
    return "Wind field, recorded" if group.source == "RECORDING" else "Wind field"


def _image_title(group: bpy.types.PropertyGroup, _scene: bpy.types.Scene) -> str:
    return "White noise" if group.image is None else f"Image, {group.image.name}"


def _hero_title(group: bpy.types.PropertyGroup, scene: bpy.types.Scene) -> str:
    height = length_text(scene, group.crest_height * float(metres_per_unit(scene)))
    return f"Hero wave, {height}, {group.time:.4g} s"


def _wake_title(group: bpy.types.PropertyGroup, scene: bpy.types.Scene) -> str:
    return f"Wake, {length_text(scene, group.length * float(metres_per_unit(scene)))}"


_TITLES = {
    "WAVES": _waves_title,
    "WIND_FIELD": _wind_title,
    "IMAGE": _image_title,
    "HERO_WAVE": _hero_title,
    "WAKE": _wake_title,
}


class OCEAN_PT_layers(SubPanel, bpy.types.Panel):
    """All layers, and the active one's settings."""

    bl_idname = "OCEAN_PT_layers"
    bl_label = "Layers"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the list with its buttons, and the active layer."""
        settings = active_settings(context)
        line = self.layout.row()
        line.template_list(
            OCEAN_UL_layers.bl_idname, "", settings, "layers", settings, "active_layer", rows=5
        )
        buttons = line.column(align=True)
        buttons.menu(layer_operators.OCEAN_MT_layer_add.bl_idname, text="", icon="ADD")
        for operator, icon in layer_operators.BUTTONS:
            buttons.operator(operator.bl_idname, text="", icon=icon)
        buttons.separator()
        for direction in ("UP", "DOWN"):
            move = layer_operators.OCEAN_OT_layer_move.bl_idname
            buttons.operator(move, text="", icon=f"TRIA_{direction}").direction = direction
        layer = active_layer(settings)
        if layer is not None:
            layout = split(self.layout, animated=True)
            kind = kind_of(layer)
            if kind.kind in _DRAWERS:
                _DRAWERS[kind.kind](layout, layer.group, context)
            else:
                draw_fields(layout, layer.group, *parameter_properties.names_of(kind))
            if kind.kind == "WAVES":
                layout.prop(layer.group, "use_equaliser")
                if layer.group.use_equaliser:
                    draw_equaliser(layout, layer.group.equaliser)
            if hasattr(layer.group, "mask"):
                draw_mask(layout, context, layer.group.mask)


def _draw_waves(
    layout: bpy.types.UILayout, layer: bpy.types.PropertyGroup, _context: bpy.types.Context
) -> None:
    layout.row().prop(layer, "definition", expand=True)
    if layer.definition == "MEASURED":
        _draw_measured(layout, layer)
        return
    names = ("wind_speed", "wind_direction", "fetch", "wind_height", "limit_fetch")
    if layer.definition == "SEA_STATE":
        names = ("significant_wave_height", "peak_period", "wind_direction")
    draw_fields(layout.column(align=True), layer, *names)
    draw_fields(layout, layer, "amplitude_scale")


def _draw_measured(layout: bpy.types.UILayout, layer: bpy.types.PropertyGroup) -> None:
    again = layout.operator(OCEAN_OT_import_measured.bl_idname, text="Import as Another Layer", icon="IMPORT")
    again.target = "LAYER"
    column = layout.column(align=True)
    column.prop(layer, "measured_time")
    column.prop(layer, "wind_direction", text="Turn")
    column.prop(layer, "wind_speed", text="Wind for Foam")
    draw_fields(layout, layer, "amplitude_scale")


def _draw_wind_field(
    layout: bpy.types.UILayout, group: bpy.types.PropertyGroup, context: bpy.types.Context
) -> None:
    sources = layout.row()
    sources.use_property_split = False  # beside a label there is no room for the three names
    sources.prop(group, "source", expand=True)
    if group.source == "UNIFORM":
        draw_fields(layout.column(align=True), group, "wind_speed", "wind_direction")
    elif group.source == "IMAGE":
        draw_image(layout, group)
        if group.image is not None:
            _image_notes(layout, context, group.image)
        draw_fields(layout, group, "image_values", "image_speed")
    else:
        draw_fields(layout, group, "objects")
        text = "Record Again" if group.recording_hash else "Record Wind"
        layout.operator(wind_operators.OCEAN_OT_record_wind.bl_idname, text=text, icon="REC")
    draw_fields(layout, group, "wind_scale", "show_vectors")
    places = layout.column(align=True)
    draw_fields(places, group, "columns", "rows", "origins")
    draw_fields(layout, group, "jitter", "phase_jitter", "start_time", "minimum_wind_speed")
    draw_fields(
        layout,
        group,
        "height",
        "steepness" if group.height == "STEEPNESS" else "height_per_speed",
        "amplitude_scale",
    )
    draw_fields(layout, group, "life", "crest", "particles")
    if group.crest == "ARC":
        draw_fields(layout, group, "split_angle", "splitting")
    draw_fields(layout, group, "seed")


def _draw_image(
    layout: bpy.types.UILayout, group: bpy.types.PropertyGroup, context: bpy.types.Context
) -> None:
    draw_image(layout, group)
    if group.image is not None:
        _image_notes(layout, context, group.image)
    else:
        draw_fields(layout, group, "noise_resolution")
        draw_fields(layout, group, "seed")
    draw_fields(layout, group, "filter")
    physical = False
    if group.filter == "MODIFIED_PIERSON_MOSKOWITZ":
        draw_fields(layout, group, "filter_gain", "wind_speed")
        physical = group.filter_gain == "PHYSICAL"
    else:
        draw_fields(layout, group, "fractal_dimension")
    if group.filter == "WATER_TEXTURE":
        draw_fields(layout, group, "texture_wavelength")
    if not physical:
        draw_fields(layout, group, "significant_wave_height")
    draw_fields(layout, group, "amplitude_scale", "wind_direction", "animation")
    draw_fields(layout, group, *_ANIMATION.get(group.animation, ()))


def _draw_hero_wave(
    layout: bpy.types.UILayout, group: bpy.types.PropertyGroup, context: bpy.types.Context
) -> None:
    draw_fields(layout.column(align=True), group, "x", "y", "time")
    draw_fields(layout, group, "direction", "wavelength", "crest_height")
    draw_fields(layout.column(align=True), group, "group_length", "group_width")
    draw_fields(layout, group, "phase")
    wave, scene = _told(context, group, HeroWave), context.scene
    if wave is None:
        return
    column = layout.column(align=True)
    row(column, "Focus", f"{translated('Frame')} {wave.frame:.6g}")
    row(column, "Crests Run", f"{length_text(scene, wave.phase_speed)}/s")
    row(column, "Group Runs", f"{length_text(scene, wave.group_speed)}/s")
    for warning in wave.warnings:
        message(layout, context, warning)


def _draw_wake(
    layout: bpy.types.UILayout, group: bpy.types.PropertyGroup, context: bpy.types.Context
) -> None:
    draw_fields(layout, group, "object", "headings")
    draw_fields(layout.column(align=True), group, "length", "beam", "draught")
    draw_fields(layout, group, "amplitude_scale", "decay", "foam", "foam_half_life")
    area = layout.column(align=True)
    draw_fields(area, group, "area_size", "area_resolution", "area_follows")
    if not group.area_follows:
        draw_fields(area, group, "area_x", "area_y")
    wake, scene = _told(context, group, WakeLayer), context.scene
    if wake is None:
        return
    column = layout.column(align=True)
    row(column, "Fastest", f"{length_text(scene, wake.speed)}/s")
    row(column, "Froude Number", f"{wake.froude:.2f}")
    row(column, "Highest Waves", f"{math.degrees(wake.angle):.1f}°")
    wavelength = length_text(scene, wake.wavelength) if math.isfinite(wake.wavelength) else "–"
    row(column, "Transverse Waves", wavelength)
    for warning in wake.warnings:
        message(layout, context, warning)


def _told(context: bpy.types.Context, group: bpy.types.PropertyGroup, kind: type[Contribution]) -> Any:
    """What the outlook of a kind tells of the active layer; None where it tells nothing."""
    settings = active_settings(context)
    if group.muted or settings.error:
        return None
    before = settings.layers[: nearest(settings.active_layer, settings.layers)]
    number = [layer.kind for layer in before].count(kind.kind)
    sea = sea_of_settings(shown_ocean(context), context.scene)
    outlook: Any = None if sea is None else kind.outlook(sea)
    return next((found for found in (outlook[0] if outlook else ()) if found.number == number), None)


_DRAWERS = {
    "WAVES": _draw_waves,
    "WIND_FIELD": _draw_wind_field,
    "IMAGE": _draw_image,
    "HERO_WAVE": _draw_hero_wave,
    "WAKE": _draw_wake,
}
_ANIMATION = {
    "DISPERSION": (),
    "DOMINANT_BAND": ("dominant_rate", "surrounding_rate"),
    "TRANSLATION": ("translation_speed",),
}


def _image_notes(layout: bpy.types.UILayout, context: bpy.types.Context, image: bpy.types.Image) -> None:
    layout.operator(wind_operators.OCEAN_OT_reload_image.bl_idname, icon="FILE_REFRESH")
    of_blender = not source_images.has_named_channels(image)
    if of_blender and image.is_float and not image.colorspace_settings.is_data:
        message(
            layout, context,
            f"{image.name} is in the colour space {image.colorspace_settings.name}: choose Non-Color for the "
            "numbers of its file",
        )  # fmt: skip


CLASSES = (OCEAN_UL_layers, OCEAN_PT_layers)
