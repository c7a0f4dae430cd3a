# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar tab: settings above, what they mean below. Nothing here computes a sea."""

import json
import textwrap
from typing import Any

import bpy

from ..scene import refinement
from ..scene.maps import MAPS
from ..scene.settings import is_ocean, settings_of
from . import operators

_CATEGORY = "Ocean Tweak"
_LABEL_SHARE = 0.4  # of the width, as Blender's own split layouts


class _SidebarPanel:
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = _CATEGORY


class _OceanPanel(_SidebarPanel):
    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Shown for an active ocean."""
        return is_ocean(context.active_object)


class OCEAN_PT_start(_SidebarPanel, bpy.types.Panel):
    """Where to begin when no ocean is active."""

    bl_idname = "OCEAN_PT_start"
    bl_label = "Ocean Tweak"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Shown when the active object is not an ocean."""
        return not is_ocean(context.active_object)

    def draw(self, context: bpy.types.Context) -> None:
        """Offer to add one."""
        self.layout.label(text="No ocean is active")
        self.layout.operator(operators.MESH_OT_ocean_tweak_add.bl_idname, text="Add Ocean", icon="MOD_OCEAN")


class OCEAN_PT_sea(_OceanPanel, bpy.types.Panel):
    """The few numbers that make a sea."""

    bl_idname = "OCEAN_PT_sea"
    bl_label = "Sea"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the settings, and above them what is wrong with them."""
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        settings = settings_of(context.active_object)
        if settings.error:
            _message(layout, context, settings.error, alert=True)
        wind = layout.column(align=True)
        for layer in settings.layers[:1]:
            wind.prop(layer, "wind_speed")
            wind.prop(layer, "wind_direction", text="Direction")
            wind.prop(layer, "fetch")
            layout.prop(layer, "swell", slider=True)
        if len(settings.layers) > 1:
            _message(layout, context, f"And {len(settings.layers) - 1} more wave layers from the JSON file")
        layout.prop(settings, "choppiness", slider=True)
        layout.prop(settings.water, "depth", text="Water Depth")
        layout.prop(settings, "seed")
        patch = layout.column(align=True)
        patch.prop(settings, "domain_size")
        samples = layout.column(align=True)
        samples.prop(settings, "viewport_resolution", text="Res. Viewport")
        samples.prop(settings, "resolution", text="Res. Render")


class OCEAN_PT_statistics(_OceanPanel, bpy.types.Panel):
    """What the settings mean right now."""

    bl_idname = "OCEAN_PT_statistics"
    bl_label = "Waves"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the statistics that the last change left, and warnings with their remedy."""
        settings = settings_of(context.active_object)
        if refinement.is_outstanding(context.active_object):
            self.layout.label(text="Refining…", icon="SORTTIME")
        if not settings.statistics:
            self.layout.label(text="Not known with these settings")
            return
        values: dict[str, Any] = json.loads(settings.statistics)
        column = self.layout.column(align=True)
        for label, text in _statistics_rows(context.scene, values):
            _row(column, label, text)
        for warning in [*values["warnings"], *_object_warnings(context)]:
            _message(self.layout, context, warning)


class OCEAN_PT_motion(_OceanPanel, bpy.types.Panel):
    """Where the movement comes from."""

    bl_idname = "OCEAN_PT_motion"
    bl_label = "Motion"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the source, the files and the method."""
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        settings = settings_of(context.active_object)
        layout.row().prop(settings, "source", expand=True)
        if settings.source == "SEQUENCE":
            _sequence(layout, context)
        else:
            layout.operator(operators.OCEAN_OT_use_sequence.bl_idname, icon="FILE_FOLDER")
        layout.prop(settings, "method")
        layout.prop(settings.timing, "start_frame")


class OCEAN_PT_foam(_OceanPanel, bpy.types.Panel):
    """How much foam there is and how it lives."""

    bl_idname = "OCEAN_PT_foam"
    bl_label = "Foam"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the settings of live foam; baked foam has its own already."""
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        settings = settings_of(context.active_object)
        layout.prop(settings, "use_foam")
        column = layout.column()
        column.active = settings.use_foam and settings.source == "LIVE"
        for name in ("coverage", "half_life", "drift"):
            column.prop(settings.foam, name)
        column.prop(settings.foam, "resolution", text="Foam Res.")


class OCEAN_PT_mesh(_OceanPanel, bpy.types.Panel):
    """The mesh that is moved, and what it carries besides."""

    bl_idname = "OCEAN_PT_mesh"
    bl_label = "Mesh"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw its size and its attributes."""
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        settings = settings_of(context.active_object)
        repeats = layout.column(align=True)
        repeats.prop(settings, "repeats_x")
        repeats.prop(settings, "repeats_y", text="Y")
        layout.prop(settings, "mesh_resolution", text="Mesh Quads")
        attributes = layout.column(heading="Attributes")
        attributes.prop(settings, "use_normals")
        attributes.prop(settings, "use_velocity")


class OCEAN_PT_parameters(_OceanPanel, bpy.types.Panel):
    """Parameters as files."""

    bl_idname = "OCEAN_PT_parameters"
    bl_label = "Parameters"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the two buttons."""
        row = self.layout.row(align=True)
        row.operator(operators.OCEAN_OT_import_parameters.bl_idname, text="Import", icon="IMPORT")
        row.operator(operators.OCEAN_OT_export_parameters.bl_idname, text="Export", icon="EXPORT")


def draw_add_menu(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
    """Draw the entry in Add > Mesh."""
    self.layout.operator(operators.MESH_OT_ocean_tweak_add.bl_idname, icon="MOD_OCEAN")


def _statistics_rows(scene: bpy.types.Scene, values: dict[str, Any]) -> list[tuple[str, str]]:
    """Label and text of each number, in the scene's system of units."""

    def length(metres: float) -> str:
        system = "IMPERIAL" if scene.unit_settings.system == "IMPERIAL" else "METRIC"
        return bpy.utils.units.to_string(system, "LENGTH", metres, precision=3)

    expected = values["spectrum"]
    rows = [
        ("Wave Height", length(expected["significant_wave_height"])),
        ("This Seed", length(values["seed"]["significant_wave_height"])),
    ]
    if expected["peak_period"] is not None:  # a flat sea has none
        rows += [
            ("Period", f"{expected['peak_period']:.1f} s"),
            ("Wavelength", length(expected["peak_wavelength"])),
            ("Domain", f"{values['wavelengths_per_domain']:.1f} wavelengths"),
        ]
    return [*rows, ("Sample", length(values["sample_spacing"]))]


def _object_warnings(context: bpy.types.Context) -> list[str]:
    item, frame = context.active_object, context.scene.frame_current
    settings = settings_of(item)
    warnings = []
    if any(abs(factor - 1.0) > 1e-5 for factor in item.matrix_world.to_scale()):
        warnings.append(
            "The object is scaled, so its waves are too. Set its scale to 1 and change the domain size"
        )
    first, last = settings.sequence_first, settings.sequence_last
    is_outside = settings.source == "SEQUENCE" and not first <= frame <= last
    if is_outside and settings.out_of_range == "WARN":
        flat = frame < first == last and settings.method == "DISPLACE"
        shown = "the sea is flat" if flat else "the nearest one is held"
        warnings.append(f"Frame {frame} has no file: {shown}")
    return warnings


def _sequence(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the files, what is missing of them, and the way to others."""
    settings = settings_of(context.active_object)
    image = settings.sequence_maps.disp
    _row(layout, "Files", bpy.path.basename(image.filepath) if image else "none chosen")
    if image:
        _row(layout, "Frames", f"{settings.sequence_first} to {settings.sequence_last}")
        present = [name for name in MAPS if getattr(settings.sequence_maps, name)]
        _row(layout, "Maps", ", ".join(present))
    if settings.missing_file:
        file = bpy.path.basename(settings.missing_file)
        _message(layout, context, f"{file} is missing: bake it again or choose other files", alert=True)
    layout.prop(settings, "out_of_range")
    choose = "Choose Another" if image else "Choose Sequence"
    layout.operator(operators.OCEAN_OT_use_sequence.bl_idname, text=choose, icon="FILE_FOLDER")
    if settings.error:
        layout.operator(operators.OCEAN_OT_use_live.bl_idname, icon="PLAY")


def _row(layout: bpy.types.UILayout, label: str, text: str) -> None:
    """Draw a label and its text in line with Blender's split properties."""
    split = layout.split(factor=_LABEL_SHARE)
    left = split.row()
    left.alignment = "RIGHT"
    left.label(text=label)
    split.label(text=text)


def _message(layout: bpy.types.UILayout, context: bpy.types.Context, text: str, alert: bool = False) -> None:
    """Draw a text in a box, wrapped to the region: Blender's labels do not wrap."""
    width = context.region.width / context.preferences.system.ui_scale
    box = layout.box().column(align=True)
    box.alert = alert
    box.scale_y = 0.8
    for index, line in enumerate(textwrap.wrap(text, max(int(width / 7.0) - 9, 16))):
        icon = ("ERROR" if alert else "INFO") if index == 0 else "BLANK1"
        box.label(text=line, icon=icon)


CLASSES = (
    OCEAN_PT_start,
    OCEAN_PT_sea,
    OCEAN_PT_statistics,
    OCEAN_PT_foam,
    OCEAN_PT_mesh,
    OCEAN_PT_motion,
    OCEAN_PT_parameters,
)
