# SPDX-License-Identifier: GPL-3.0-or-later
"""Further settings: water, shape, time, foam, and the mesh."""

import bpy

from ...core.sea.spray_outlook import why_none
from ...scene.refresh import sea_of_settings
from ...scene.spray import too_few_bounces
from .. import camera_operators, material_operators, parameter_operators
from ..active_ocean import shown_ocean
from ..field_drawing import draw_fields, draw_switched
from .drawing import SubPanel, active_settings, draw_equaliser, message, split


class OCEAN_PT_water(SubPanel, bpy.types.Panel):
    """Properties of the liquid, and dispersion."""

    bl_idname = "OCEAN_PT_water"
    bl_label = "Water"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the dispersion and the liquid's numbers."""
        layout, settings = split(self.layout), active_settings(context)
        layout.prop(settings, "dispersion")
        column = layout.column(align=True)
        draw_fields(column, settings.water, "depth", "gravity", "density", "surface_tension")
        layout.operator(material_operators.OCEAN_OT_use_water_material.bl_idname, icon="MATERIAL")


class OCEAN_PT_current(SubPanel, bpy.types.Panel):
    """How the water moves as a whole."""

    bl_idname = "OCEAN_PT_current"
    bl_label = "Current"

    def draw_header(self, context: bpy.types.Context) -> None:
        """Draw its switch."""
        self.layout.prop(active_settings(context), "use_current", text="")

    def draw(self, context: bpy.types.Context) -> None:
        """Draw speed and direction, which can be keyed."""
        layout, settings = split(self.layout, animated=True), active_settings(context)
        column = layout.column(align=True)
        column.active = settings.use_current
        draw_fields(column, settings.current, "speed", "direction")


class OCEAN_PT_equaliser(SubPanel, bpy.types.Panel):
    """Heights of all waves by octave of their length."""

    bl_idname = "OCEAN_PT_equaliser"
    bl_label = "Equaliser"

    def draw_header(self, context: bpy.types.Context) -> None:
        """Draw its switch."""
        self.layout.prop(active_settings(context), "use_equaliser", text="")

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the bands of the whole sea; layers have their own."""
        layout, settings = split(self.layout, animated=True), active_settings(context)
        column = layout.column()
        column.active = settings.use_equaliser
        draw_equaliser(column, settings.equaliser)


class OCEAN_PT_shape(SubPanel, bpy.types.Panel):
    """Changes to the shape of waves."""

    bl_idname = "OCEAN_PT_shape"
    bl_label = "Shape"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw orbits, damping and amplitudes."""
        layout, settings = split(self.layout), active_settings(context)
        for name in ("trough_damping", "orbital_motion", "amplitudes", "match_height"):
            layout.prop(settings, name)


class OCEAN_PT_time(SubPanel, bpy.types.Panel):
    """The relation of frames to ocean time."""

    bl_idname = "OCEAN_PT_time"
    bl_label = "Time"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw where time begins, whether it repeats, and a clock of its own."""
        layout, settings = split(self.layout, animated=True), active_settings(context)
        layout.prop(settings.timing, "start_frame")
        loop = layout.row(heading="Loop")
        loop.prop(settings, "use_loop", text="")
        part = loop.row()
        part.active = settings.use_loop
        part.prop(settings, "loop_frames", text="Frames")
        scale = layout.row()
        scale.active = not settings.use_ocean_time
        scale.prop(settings, "time_scale", slider=True)
        own = layout.row(heading="Keyed Time")
        own.prop(settings, "use_ocean_time", text="")
        part = own.row()
        part.active = settings.use_ocean_time
        part.prop(settings, "ocean_time", text="")


class OCEAN_PT_foam(SubPanel, bpy.types.Panel):
    """Amount, half-life and drift of foam."""

    bl_idname = "OCEAN_PT_foam"
    bl_label = "Foam"

    def draw_header(self, context: bpy.types.Context) -> None:
        """Draw its switch."""
        self.layout.prop(active_settings(context), "use_foam", text="")

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the settings of live foam; baked foam has its own already."""
        layout, settings = split(self.layout), active_settings(context)
        column = layout.column()
        column.active = settings.use_foam and settings.source == "LIVE"
        draw_fields(column, settings.foam, "law", "coverage", "half_life", "drift", "resolution")


class OCEAN_PT_spray(SubPanel, bpy.types.Panel):
    """Spray from breaking crests."""

    bl_idname = "OCEAN_PT_spray"
    bl_label = "Spray"

    def draw_header(self, context: bpy.types.Context) -> None:
        """Draw its switch."""
        self.layout.prop(active_settings(context), "use_spray", text="")

    def draw(self, context: bpy.types.Context) -> None:
        """Draw how it is seen and carried, and why there is none."""
        layout, settings = split(self.layout), active_settings(context)
        column = layout.column()
        column.active = settings.use_spray
        draw_fields(column, settings.spray, "amount", "size", "wind", "life")
        sea = sea_of_settings(shown_ocean(context), context.scene)
        if settings.use_spray and sea is not None and (why := why_none(sea)) is not None:
            message(layout, context, f"{why[0].upper()}{why[1:]}")
        if text := too_few_bounces(shown_ocean(context), context.scene):
            message(layout, context, f"{text[0].upper()}{text[1:]}")


class OCEAN_PT_mesh(SubPanel, bpy.types.Panel):
    """The mesh and its attributes."""

    bl_idname = "OCEAN_PT_mesh"
    bl_label = "Mesh"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw its size and its attributes."""
        layout, settings = split(self.layout), active_settings(context)
        layout.prop(settings, "method")
        repeats = layout.column(align=True)
        repeats.prop(settings, "repeats_x")
        repeats.prop(settings, "repeats_y", text="Y")
        draw_switched(layout, settings, "mesh_resolution")
        attributes = layout.column(heading="Attributes")
        attributes.prop(settings, "use_normals")
        attributes.prop(settings, "use_velocity")
        camera_operators.draw_camera_surface(layout, shown_ocean(context))


class OCEAN_PT_parameters(SubPanel, bpy.types.Panel):
    """Parameters as files, node groups as assets."""

    bl_idname = "OCEAN_PT_parameters"
    bl_label = "Files and Assets"

    def draw(self, _context: bpy.types.Context) -> None:
        """Draw the buttons."""
        buttons = self.layout.row(align=True)
        buttons.operator(
            parameter_operators.OCEAN_OT_import_parameters.bl_idname, text="Import", icon="IMPORT"
        )
        buttons.operator(
            parameter_operators.OCEAN_OT_export_parameters.bl_idname, text="Export", icon="EXPORT"
        )
        self.layout.operator(material_operators.OCEAN_OT_install_assets.bl_idname, icon="ASSET_MANAGER")


CLASSES = (
    OCEAN_PT_water,
    OCEAN_PT_current,
    OCEAN_PT_equaliser,
    OCEAN_PT_shape,
    OCEAN_PT_time,
    OCEAN_PT_foam,
    OCEAN_PT_spray,
    OCEAN_PT_mesh,
    OCEAN_PT_parameters,
)
