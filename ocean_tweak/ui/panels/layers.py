# SPDX-License-Identifier: GPL-3.0-or-later
"""Wave layers: their list, the active one in full, and the spectrum that they make."""

import bpy

from ...core import ParameterError
from ...core.parameters import WaveLayer
from .. import layer_operators
from ..previews import PREVIEWS
from .drawing import SubPanel, active_settings, split

_FRACTIONS = 12.0  # height of the picture in units of a button


class OCEAN_UL_layers(bpy.types.UIList):
    """A line a layer: what it is, and whether it takes part."""

    bl_idname = "OCEAN_UL_layers"

    def draw_item(  # Blender wants each argument by itself
        self, _context: bpy.types.Context, layout: bpy.types.UILayout, _data: object,
        layer: bpy.types.PropertyGroup, _icon: int, _active_data: object, _active_property: str,
    ) -> None:  # fmt: skip
        """Draw the layer's wind, or its waves."""
        if layer.definition == "WIND":
            text, icon = f"{layer.wind_speed:.3g} m/s, {layer.fetch_km:.3g} km", "FORCE_WIND"
        else:
            text, icon = f"{layer.significant_wave_height:.3g} m, {layer.peak_period:.3g} s", "MOD_WAVE"
        line = layout.row(align=True)
        line.active = not layer.muted
        line.label(text=text, icon=icon, translate=False)
        line.prop(layer, "muted", text="", icon="HIDE_ON" if layer.muted else "HIDE_OFF", emboss=False)


class OCEAN_PT_layers(SubPanel, bpy.types.Panel):
    """All layers, and the active one's settings."""

    bl_idname = "OCEAN_PT_layers"
    bl_label = "Layers"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the list with its buttons, and the active layer."""
        settings = active_settings(context)
        line = self.layout.row()
        line.template_list(
            OCEAN_UL_layers.bl_idname, "", settings, "layers", settings, "active_layer", rows=3
        )
        buttons = line.column(align=True)
        for operator, icon in layer_operators.BUTTONS:
            buttons.operator(operator.bl_idname, text="", icon=icon)
        if settings.active_layer < len(settings.layers):
            _draw_layer(split(self.layout, animated=True), settings.layers[settings.active_layer])


def _draw_layer(layout: bpy.types.UILayout, layer: bpy.types.PropertyGroup) -> None:
    layout.row().prop(layer, "definition", expand=True)
    column = layout.column(align=True)
    names = ("wind_speed", "wind_direction", "fetch", "wind_height", "limit_fetch")
    if layer.definition == "SEA_STATE":
        names = ("significant_wave_height", "peak_period", "wind_direction")
    _props(column, layer, *names)
    _props(layout, layer, "gain")


class OCEAN_PT_spectrum(SubPanel, bpy.types.Panel):
    """A picture of the spectrum, and the active layer's model."""

    bl_idname = "OCEAN_PT_spectrum"
    bl_label = "Spectrum"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw energy over period and over direction, then the models."""
        layout = split(self.layout)
        settings = active_settings(context)
        try:
            icon = PREVIEWS.spectrum(settings.to_parameters(context.scene))
        except ParameterError:
            icon = 0  # the panel above says what is wrong
        if icon:
            layout.template_icon(icon_value=icon, scale=_FRACTIONS)
        if settings.active_layer >= len(settings.layers):
            return
        layer = settings.layers[settings.active_layer]
        _props(layout, layer, "spectrum")
        if layer.spectrum in ("TMA", "JONSWAP"):
            _props(layout, layer, "peak_enhancement")
        if layer.spectrum == "TMA":
            _props(layout, layer, "depth_factor")
        if layer.spectrum == "GENERALIZED_AB":
            _props(layout, layer, "generalized_a", "generalized_b")
        _props(layout, layer, "short_wave_cutoff")


class OCEAN_PT_spreading(SubPanel, bpy.types.Panel):
    """Over which directions the active layer's energy goes."""

    bl_idname = "OCEAN_PT_spreading"
    bl_label = "Spreading"
    bl_parent_id = "OCEAN_PT_spectrum"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the model, and the one that is mixed in."""
        layout, settings = split(self.layout), active_settings(context)
        if settings.active_layer >= len(settings.layers):
            return
        layer = settings.layers[settings.active_layer]
        _props(layout, layer, "spreading", "swell", "spreading_mix")
        if layer.spreading_mix > 0.0:
            _props(layout, layer, "second_spreading")
        if "COSINE_2S" in (layer.spreading, layer.second_spreading):
            _props(layout, layer, "spreading_exponent")


class OCEAN_PT_band(SubPanel, bpy.types.Panel):
    """Which wavelengths of the active layer are kept."""

    bl_idname = "OCEAN_PT_band"
    bl_label = "Band and Seed"
    bl_parent_id = "OCEAN_PT_spectrum"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the band's ends and the seed."""
        layout, settings = split(self.layout), active_settings(context)
        if settings.active_layer >= len(settings.layers):
            return
        layer = settings.layers[settings.active_layer]
        _props(layout, layer, "shortest_wavelength", "longest_wavelength", "band_softness")
        _props(layout, layer, "band_inverted", "seed")


def _props(layout: bpy.types.UILayout, layer: bpy.types.PropertyGroup, *names: str) -> None:
    for name in names:
        assert name in WaveLayer.__dataclass_fields__, name
        layout.prop(layer, name)


CLASSES = (OCEAN_UL_layers, OCEAN_PT_layers, OCEAN_PT_spectrum, OCEAN_PT_spreading, OCEAN_PT_band)
