# SPDX-License-Identifier: GPL-3.0-or-later
"""The spectrum of all wave layers, and how the active one shares its energy."""

import bpy

from ...scene.refresh import sea_of_settings
from ..active_ocean import shown_ocean
from ..field_drawing import draw_fields
from ..previews import PREVIEWS
from .drawing import SubPanel, active_settings, active_waves, split

_FRACTIONS = 12.0  # height of the picture in units of a button


class _OfWaves(SubPanel):
    """Inside the spectrum's panel, shown where the active layer is a wave system."""

    bl_parent_id = "OCEAN_PT_spectrum"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """An ocean is active, and a wave layer in it."""
        return super().poll(context) and active_waves(active_settings(context)) is not None


class OCEAN_PT_spectrum(SubPanel, bpy.types.Panel):
    """A picture of the spectrum, and the active layer's model."""

    bl_idname = "OCEAN_PT_spectrum"
    bl_label = "Spectrum"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw energy over period and over direction, then the models."""
        layout = split(self.layout)
        settings = active_settings(context)
        sea = sea_of_settings(shown_ocean(context), context.scene)
        icon = 0 if sea is None else PREVIEWS.spectrum(sea)  # without a sea the panel above says why
        if icon:
            layout.template_icon(icon_value=icon, scale=_FRACTIONS)
        layer = active_waves(settings)
        if layer is None or layer.definition == "MEASURED":
            return
        draw_fields(layout, layer, "spectrum")
        if layer.spectrum in ("TMA", "JONSWAP"):
            draw_fields(layout, layer, "peak_enhancement")
        if layer.spectrum == "TMA":
            draw_fields(layout, layer, "depth_factor")
        if layer.spectrum == "GENERALIZED_AB":
            draw_fields(layout, layer, "generalized_a", "generalized_b")
        draw_fields(layout, layer, "short_wave_cutoff")


class OCEAN_PT_spreading(_OfWaves, bpy.types.Panel):
    """Over which directions the active layer's energy goes."""

    bl_idname = "OCEAN_PT_spreading"
    bl_label = "Spreading"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the model, and the one that is mixed in."""
        layout, layer = split(self.layout), active_waves(active_settings(context))
        draw_fields(layout, layer, "spreading", "swell", "spreading_mix")
        if layer.spreading_mix > 0.0:
            draw_fields(layout, layer, "second_spreading")
        if "COSINE_2S" in (layer.spreading, layer.second_spreading):
            draw_fields(layout, layer, "spreading_exponent")


class OCEAN_PT_band(_OfWaves, bpy.types.Panel):
    """Which wavelengths of the active layer are kept."""

    bl_idname = "OCEAN_PT_band"
    bl_label = "Band and Seed"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the band's ends and the seed."""
        layout, layer = split(self.layout), active_waves(active_settings(context))
        draw_fields(layout, layer, "shortest_wavelength", "longest_wavelength", "band_softness")
        draw_fields(layout, layer, "band_inverted", "seed")


CLASSES = (OCEAN_PT_spectrum, OCEAN_PT_spreading, OCEAN_PT_band)
