# SPDX-License-Identifier: GPL-3.0-or-later
"""The main panel: the most important settings of a sea, and their results."""

from typing import Any

import bpy
from bpy.app.translations import pgettext_iface as translated

from ...core import WaveLayer
from ...core.sea.memory import beyond_budget
from ...core.spectral.spectra import wind_at_10_m
from ...core.statistics import sea_scales
from ...scene import failures, refinement
from ...scene.image_sequence import shown_frame, unbaked_frames
from ...scene.middle import STAYS_BEHIND
from ...scene.portability import sharp_under_blur
from ...scene.refresh import sea_of_settings
from ...scene.settings import OceanSettings
from ...scene.units import metres_per_unit
from .. import (
    bake_operators,
    parameter_properties,
    preset_operators,
    sea_operators,
    sequence_operators,
    wording,
)
from ..active_ocean import shown_ocean
from ..field_drawing import draw_fields
from ..layer_properties import first_waves
from ..pinning import draw_shown
from .drawing import (
    OceanPanel,
    active_settings,
    length_text,
    message,
    parsed,
    row,
    speed_text,
    split,
)

#: that are named in the panel
_MOST_DIFFERENCES = 4


class OCEAN_PT_sea(OceanPanel, bpy.types.Panel):
    """The most important settings of a sea, and their results."""

    bl_idname = "OCEAN_PT_sea"
    bl_label = "Sea"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the preset, the settings, problems, and the resulting waves."""
        layout = split(self.layout, animated=True)
        settings = active_settings(context)
        draw_shown(layout, context)
        if settings.error:
            message(layout, context, wording.readable(settings.error), alert=True)
        if settings.source == "SEQUENCE":
            _bake(layout, context)
        _presets(layout, context)
        waves = first_waves(settings.layers)
        if waves is not None:
            _wind(layout, waves)
        if len(settings.layers) > 1:
            more = len(settings.layers) - 1
            text = "And one more layer" if more == 1 else translated("And {} more layers").format(more)
            layout.label(text=text, icon="RENDERLAYERS")
        layout.prop(settings, "choppiness", slider=True)
        layout.prop(settings.water, "depth", text="Depth")
        layout.prop(settings, "seed")
        _size(layout, settings)
        layout.row().prop(settings, "source", expand=True)
        _waves(layout, context)


def _bake(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw problems of the bake that is shown, and remedies."""
    settings = active_settings(context)
    if settings.missing_file:
        message(layout, context, failures.missing_text(settings), alert=True)
    if settings.bake_differs:
        found = parsed(settings.bake_differs)
        shown = "; ".join(_difference(*entry) for entry in found[:_MOST_DIFFERENCES])
        more = len(found) - _MOST_DIFFERENCES
        text = f"Settings differ from the bake, which is shown: {shown}" + (
            f"; {more} more" if more > 0 else ""
        )
        message(layout, context, text, alert=True)
        buttons = layout.column(align=True)
        buttons.operator(bake_operators.OCEAN_OT_bake.bl_idname, text="Bake Again", icon="RENDER_ANIMATION")
        buttons.operator(sequence_operators.OCEAN_OT_settings_from_bake.bl_idname, icon="LOOP_BACK")


def _difference(path: str, baked: object, own: object) -> str:
    """`Layer 2, Wind Speed 8, baked 12`."""
    return f"{wording.place(path)} {_number(own)}, baked {_number(baked)}"


def _number(value: object) -> str:
    if isinstance(value, (dict, list)):
        return "other"
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def _presets(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    buttons = layout.row(align=True)
    if context.window_manager is not None and hasattr(context.window_manager, "ocean_tweak_preset"):
        buttons.template_icon_view(
            context.window_manager, "ocean_tweak_preset", show_labels=True, scale=4.0, scale_popup=7.0
        )
        buttons = buttons.column(align=True)
    title = active_settings(context).preset or "Presets"
    buttons.menu(preset_operators.OCEAN_MT_presets.bl_idname, text=title, icon="PRESET")
    buttons.operator(sea_operators.OCEAN_OT_match_sea_state.bl_idname, text="Match", icon="VIEWZOOM")


def _wind(layout: bpy.types.UILayout, layer: bpy.types.PropertyGroup) -> None:
    column = layout.column(align=True)
    if layer.definition == "WIND":
        draw_fields(column, layer, "wind_speed", "wind_direction", "fetch")
    elif layer.definition == "MEASURED":
        column.label(text="Measured", icon="IMPORT")
        column.prop(layer, "measured_time")
        column.prop(layer, "wind_direction", text="Turn")
        return
    else:
        draw_fields(column, layer, "significant_wave_height", "peak_period", "wind_direction")
    layout.prop(layer, "swell", slider=True)


def _size(layout: bpy.types.UILayout, settings: OceanSettings) -> None:
    """Draw the domain size, for several patches that of the first, and the resolutions of the mesh."""
    first = settings.patches[0] if settings.patches else settings
    column = layout.column(align=True)
    column.prop(first, "domain_size")
    column.prop(settings, "viewport_resolution", text="Viewport")
    column.prop(settings, "resolution", text="Render")
    if len(settings.patches) > 1:
        more = len(settings.patches) - 1
        text = "And one more patch" if more == 1 else translated("And {} more patches").format(more)
        layout.label(text=text, icon="MESH_GRID")


def _waves(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the latest statistics of the sea, and warnings."""
    settings, item = active_settings(context), shown_ocean(context)
    column = layout.box().column(align=True)
    is_baked = settings.source == "SEQUENCE" and bool(settings.baked_sea)
    baked: dict[str, Any] = parsed(settings.baked_sea) if is_baked else {}
    _waves_title(column.row(), item, is_baked, bool(settings.statistics))
    if baked:
        for label, text in _baked_rows(context.scene, baked):
            row(column, label, text)
    if not settings.statistics:
        return
    values: dict[str, Any] = parsed(settings.statistics)
    winds = _baked_winds(baked) if baked else _winds(settings, context.scene)
    for label, text in [*_beaufort(winds), *_rows(context.scene, values)]:
        row(column, label, text)
    for warning in [*values["warnings"], *_object_warnings(context)]:
        message(layout, context, warning)


def _waves_title(layout: bpy.types.UILayout, item: bpy.types.Object, is_baked: bool, is_known: bool) -> None:
    """Always draw exactly one row, so that rows below do not move when a refinement begins or ends."""
    progress = refinement.progress_of(item)
    if progress is not None:
        layout.progress(factor=progress.share, text=progress.doing)
    elif refinement.is_outstanding(item):
        layout.label(text="Refining…", icon="SORTTIME")
    elif is_baked:
        layout.label(text="The bake", icon="FILE_CACHE")
    elif is_known:
        layout.label(text="These waves", icon="MOD_OCEAN")
    else:
        layout.label(text="Not known with these settings", icon="QUESTION")


def _baked_rows(scene: bpy.types.Scene, baked: dict[str, Any]) -> list[tuple[str, str]]:
    """Label and text of the numbers that the first part of the panel has for the settings."""
    layer = _baked_waves(baked)[0]
    if layer["definition"] == "WIND":
        first = [
            ("Wind Speed", speed_text(scene, layer["wind_speed"])),
            ("Fetch", length_text(scene, layer["fetch"])),
        ]
    elif layer["definition"] == "MEASURED":
        first = [("Waves", translated("Measured"))]
    else:
        height = length_text(scene, layer["significant_wave_height"])
        first = [("Wave Height", height), ("Peak Period", f"{layer['peak_period']:.3g} s")]
    return [
        *first,
        ("Choppiness", f"{baked['choppiness']:.3g}"),
        ("Depth", length_text(scene, baked["water"]["depth"])),
        ("Seed", str(baked["seed"])),
        ("Domain Size", f"{length_text(scene, baked['domain_size'])}, {baked['resolution']}²"),
    ]


def _winds(settings: Any, scene: bpy.types.Scene) -> list[float]:
    """Winds of the layers at 10 m, m/s."""
    metres = float(metres_per_unit(scene))
    return [
        wind_at_10_m(layer.wind_speed * metres, layer.wind_height)
        for layer in settings.layers
        if layer.kind == "WAVES" and layer.definition == "WIND" and not layer.muted
    ]


def _baked_waves(baked: dict[str, Any]) -> list[dict[str, Any]]:
    """The layers of waves by a spectrum, of which JSON does not say the kind."""
    return [layer for layer in baked["layers"] if layer.get("kind", WaveLayer.kind) == WaveLayer.kind]


def _baked_winds(baked: dict[str, Any]) -> list[float]:
    return [
        wind_at_10_m(layer["wind_speed"], layer["wind_height"])
        for layer in _baked_waves(baked)
        if layer["definition"] == "WIND" and not layer["muted"]
    ]


def _beaufort(winds: list[float]) -> list[tuple[str, str]]:
    if not winds:
        return []
    number = sea_scales.beaufort_number(max(winds))
    return [("Beaufort", f"{number}, {translated(sea_scales.BEAUFORT_NAMES[number])}")]


def _rows(scene: bpy.types.Scene, values: dict[str, Any]) -> list[tuple[str, str]]:
    """Label and text of each number, in the scene's system of units."""
    expected, seed = values["spectrum"], values["seed"]
    rows = [
        ("Wave Height", length_text(scene, expected["significant_wave_height"])),
        ("This Seed", length_text(scene, seed["significant_wave_height"])),
    ]
    if expected["peak_period"] is not None:  # a flat sea has none
        rows += [
            ("Peak Period", f"{expected['peak_period']:.1f} s"),
            ("Wavelength", length_text(scene, expected["peak_wavelength"])),
            ("Domain Holds", translated("{:.1f} wavelengths").format(values["wavelengths_per_domain"])),
        ]
    return [*rows, ("Grid Spacing", length_text(scene, values["sample_spacing"]))]


def _object_warnings(context: bpy.types.Context) -> list[str]:
    item, scene = shown_ocean(context), context.scene
    frame = scene.frame_current
    settings = active_settings(context)
    warnings = []
    if any(abs(factor - 1.0) > 1e-5 for factor in item.matrix_world.to_scale()):
        warnings.append(
            "The object is scaled, so its waves are too. Set its scale to 1 and change the domain size"
        )
    if settings.stays_behind:
        warnings.append(STAYS_BEHIND)
    if settings.out_of_range == "WARN" and unbaked_frames(settings, scene, (frame,)):
        warnings.append(f"Frame {frame} has no file: frame {shown_frame(settings, scene, frame)} is held")
    metres = metres_per_unit(scene)
    for index, layer in enumerate(settings.layers):
        for name, length in parameter_properties.beyond(layer, WaveLayer, metres):
            shown = (speed_text if name == "wind_speed" else length_text)(scene, length)
            where = wording.place(f"layers.{index}.{name}")
            warnings.append(f"{where} is out of range and counts as {shown}")
    sea = sea_of_settings(item, scene) if settings.source == "LIVE" else None
    over = None if sea is None else beyond_budget(sea)
    if over is not None:
        warnings.append(over)
    if text := sharp_under_blur(item, scene):
        warnings.append(text)
    if settings.bake_is_elsewhere:
        warnings.append(
            "The baked files are beside another .blend file: Copy Bake Here in Bake brings them along"
        )
    return warnings


CLASSES = (OCEAN_PT_sea,)
