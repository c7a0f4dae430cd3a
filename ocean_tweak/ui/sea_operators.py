# SPDX-License-Identifier: GPL-3.0-or-later
"""Creates a sea from a wave height and period, from a Beaufort number, or from Blender's Ocean modifier."""

import dataclasses

import bpy
from bpy.app.translations import pgettext_rpt as translated
from bpy.props import BoolProperty, EnumProperty, FloatProperty

from ..core import Ocean, OceanParameters, ParameterError, WaveLayer, layer_for_sea_state
from ..core.parameters.presets import built_in
from ..scene import conversion
from ..scene.settings import OceanObjectError, settings_of
from .active_ocean import OfActiveOcean, refuse, shown_ocean
from .resizing import tell_what_stays
from .stepped_operator import SteppedOperator

#: wavelengths of the peak that a domain should hold
_WAVELENGTHS = 4.5


def _beaufort_items() -> list[tuple[str, str, str]]:
    presets = {key: preset for key, preset in built_in().items() if key.startswith("beaufort_")}
    return [(key, preset.title, preset.description) for key, preset in presets.items()]


class OCEAN_OT_match_sea_state(OfActiveOcean, bpy.types.Operator):
    """Give the active ocean a wave height and a period, or a Beaufort number."""

    bl_idname = "ocean.match_sea_state"
    bl_description = "Find the wind and fetch that raise waves of a known height and period"
    bl_label = "Match Sea State"
    bl_options = {"REGISTER", "UNDO"}

    by: EnumProperty(
        name="By",
        items=[
            ("WAVES", "Waves", "Significant wave height and peak period, as a forecast or a buoy gives them"),
            ("BEAUFORT", "Beaufort", "A force of the Beaufort scale"),
        ],
    )
    height: FloatProperty(
        name="Wave Height (m)", default=2.0, min=0.0, max=100.0, precision=2,
        description="Significant wave height in metres: the mean of the highest third of the waves",
    )  # fmt: skip
    period: FloatProperty(
        name="Peak Period", default=8.0, min=0.1, max=60.0, precision=1, unit="TIME_ABSOLUTE",
        description="Period of the waves with the most energy",
    )  # fmt: skip
    beaufort: EnumProperty(name="Wind", items=_beaufort_items(), default="beaufort_05")
    fit_domain: BoolProperty(
        name="Fit Domain", default=True,
        description=("Resize the domain to fit these waves; of several patches, enlarge the first if it "
        "is smaller"),
    )  # fmt: skip

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        """Ask for the numbers."""
        return context.window_manager.invoke_props_dialog(self)

    def draw(self, _context: bpy.types.Context) -> None:
        """Draw what belongs to the choice."""
        layout = self.layout
        layout.use_property_split = True
        layout.row().prop(self, "by", expand=True)
        for name in ("height", "period") if self.by == "WAVES" else ("beaufort",):
            layout.prop(self, name)
        layout.prop(self, "fit_domain")

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Change the first layer; the others, if there are any, stay."""
        settings = settings_of(shown_ocean(context))
        try:
            before = settings.to_parameters(context.scene)
            matched, explanation = self._matched(before)
            settings.from_parameters(matched, context.scene, keep_places=True)
        except (ParameterError, OceanObjectError) as error:
            return refuse(self, error)
        self.report({"INFO"}, explanation)  # what cannot be stays as a warning in the panel
        tell_what_stays(self, settings)
        return {"FINISHED"}

    def _matched(self, before: OceanParameters) -> tuple[OceanParameters, str]:
        first = before.of(WaveLayer)[0]
        if self.by == "WAVES":
            match = layer_for_sea_state(round(self.height, 4), round(self.period, 4), before.water, first)
            layer, explanation = match.layer, match.explanation
        else:
            preset = built_in()[self.beaufort]
            wanted = preset.parameters.layers[0]
            layer = dataclasses.replace(
                first, definition="WIND", wind_speed=wanted.wind_speed, fetch=wanted.fetch
            )
            explanation = f"{preset.title}: {wanted.wind_speed:g} m/s over {wanted.fetch / 1e3:g} km"
        matched = before.replace(layers=tuple(layer if own is first else own for own in before.layers))
        if self.fit_domain:
            length = Ocean(matched.without_patches.at_resolution(16)).statistics().peak_wavelength
            if length > 0.0:
                matched = _fitted(matched, _round(length * _WAVELENGTHS))
        return matched, explanation


def _fitted(parameters: OceanParameters, size: float) -> OceanParameters:
    """The sea in a domain of this size; the first of several patches is made no smaller.

    That one was made as large as the area in which nothing is to repeat, for more than these waves.
    """
    if not parameters.patches:
        return parameters.replace(domain_size=size)
    first, *others = parameters.patches
    larger = dataclasses.replace(first, domain_size=max(size, first.domain_size))
    return parameters.replace(patches=(larger, *others))


def _round(size: float) -> float:
    """Two significant digits, like a typed number."""
    return float(f"{size:.2g}")


class OCEAN_OT_convert(SteppedOperator, bpy.types.Operator):
    """Make one of our oceans out of Blender's Ocean modifier."""

    bl_idname = "ocean.convert"
    bl_description = "Replace the active object's Ocean modifier by an ocean with its settings"
    bl_label = "Convert Ocean Modifier"
    bl_options = {"REGISTER", "UNDO"}

    keep_original: BoolProperty(
        name="Keep Original", default=True, description="Keep the object, hidden, instead of deleting it"
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """An object with an Ocean modifier is active."""
        item = context.active_object
        if conversion.ocean_modifier(item) is None:
            cls.poll_message_set("Select an object with Blender's Ocean modifier")
            return False
        if context.mode != "OBJECT":
            cls.poll_message_set("Switch to Object Mode to convert an ocean")
            return False
        return True

    doing = "Converting the Ocean modifier"

    def begin(self, context: bpy.types.Context) -> conversion.Converting:
        """Read the modifier, and change nothing."""
        original = context.active_object
        return conversion.Converting(original, conversion.ocean_modifier(original), context.scene)

    def conclude(self, context: bpy.types.Context, made: conversion.Made) -> set[str]:
        """Hide or delete the original, and say what did not carry over."""
        original, item, name = made.original, made.ocean, made.original.name
        context.view_layer.objects.active = item
        item.select_set(True)
        if self.keep_original:
            original.name = f"{name} Original"
            original.select_set(False)
            original.hide_render = True
            original.hide_set(True)
        else:
            bpy.data.objects.remove(original)
        item.name = name
        if made.lost:
            self.report({"WARNING"}, translated("Not carried over: {list}").format(list="; ".join(made.lost)))
        else:
            self.report(
                {"INFO"}, translated("Everything carried over; the waves now have the height of their wind")
            )
        return {"FINISHED"}


CLASSES = (OCEAN_OT_match_sea_state, OCEAN_OT_convert)
