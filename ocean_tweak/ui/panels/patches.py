# SPDX-License-Identifier: GPL-3.0-or-later
"""Patches: the planner, the list, and the active one's settings."""

from typing import Any

import bpy
from bpy.app.translations import pgettext_iface as translated

from ...core.waves.contribution import NO_LONGEST
from ...scene.settings import OceanSettings
from ...scene.units import metres_per_unit
from .. import patch_operators
from ..active_ocean import nearest
from ..field_drawing import draw_fields
from .drawing import SubPanel, active_settings, length_text, message, parsed, row, split
from .masks import draw_mask


class OCEAN_UL_patches(bpy.types.UIList):
    """A line a patch: its size, its shortest waves and their share of the energy."""

    bl_idname = "OCEAN_UL_patches"

    def draw_item(  # Blender wants each argument by itself
        self, context: bpy.types.Context, layout: bpy.types.UILayout, settings: OceanSettings,
        patch: bpy.types.PropertyGroup, _icon: int, _active_data: object, _active_property: str,
        index: int = 0,
    ) -> None:  # fmt: skip
        """Draw the patch's numbers, and a sign where something is wrong with it."""
        scene, found = context.scene, of_patch(settings, index)
        line = layout.split(factor=0.3)
        line.label(text=_length(scene, patch.domain_size), translate=False)
        line = line.split(factor=0.6)
        # a sign takes the room of three digits, and finds it only here
        icon = "ERROR" if _warnings(settings, index) else "NONE"
        line.label(text=_band(scene, patch), icon=icon, translate=False)
        share = line.row()
        share.alignment = "RIGHT"
        share.label(text=_share(found["share"]) if found else "", translate=False)


class OCEAN_PT_patches(SubPanel, bpy.types.Panel):
    """The planner, the patches, and the active one's numbers."""

    bl_idname = "OCEAN_PT_patches"
    bl_label = "Patches"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw what to plan for, and what there is."""
        layout, settings = split(self.layout), active_settings(context)
        plan = layout.column(align=True)
        plan.prop(settings, "plan_finest")
        plan.prop(settings, "plan_area")
        plan.prop(settings, "plan_memory")
        layout.operator(patch_operators.OCEAN_OT_plan_patches.bl_idname, icon="MESH_GRID")
        if not settings.patches:
            layout.operator(patch_operators.OCEAN_OT_patch_add.bl_idname, icon="ADD")
            return
        line = layout.row()
        line.template_list(
            OCEAN_UL_patches.bl_idname, "", settings, "patches", settings, "active_patch", rows=4
        )
        buttons = line.column(align=True)
        buttons.operator(patch_operators.OCEAN_OT_patch_add.bl_idname, text="", icon="ADD")
        buttons.operator(patch_operators.OCEAN_OT_patch_remove.bl_idname, text="", icon="REMOVE")
        buttons.separator()
        buttons.operator(patch_operators.OCEAN_OT_one_patch.bl_idname, text="", icon="X")
        _draw_patch(layout, context, nearest(settings.active_patch, settings.patches))


def _draw_patch(layout: bpy.types.UILayout, context: bpy.types.Context, index: int) -> None:
    """Draw a patch's numbers, what they come to, and what is wrong with them."""
    settings = active_settings(context)
    patch = settings.patches[index]
    numbers = layout.column(align=True)
    numbers.prop(patch, "domain_size")
    numbers.prop(patch, "resolution", text="Samples")
    layout.prop(patch, "rotation")
    band = layout.column(align=True)
    draw_fields(band, patch, "longest_wavelength", "shortest_wavelength")
    draw_mask(layout, context, patch.mask, index)
    facts = layout.box().column(align=True)
    if patch.shortest_wavelength > 0.0 and patch.domain_size > 0.0:
        samples = patch.shortest_wavelength * patch.resolution / patch.domain_size
        row(facts, "Shortest Has", translated("{:.3g} samples").format(samples))
    if not _has_all_long_waves(context.scene, patch):
        times = patch.domain_size / patch.longest_wavelength
        row(facts, "Longest Fits", translated("{:.3g} times").format(times))
    found = of_patch(settings, index)
    if found is None:
        return
    height = found["resolved"]["significant_wave_height"]
    row(facts, "Wave Height", length_text(context.scene, height))
    row(facts, "Energy", f"{100.0 * found['share']:.3g} %")
    for warning in _warnings(settings, index):
        message(layout, context, warning)


def of_patch(settings: OceanSettings, index: int) -> dict[str, Any] | None:
    """What the last change left of one patch's statistics; None where they are not known."""
    if not settings.statistics:
        return None
    patches: list[dict[str, Any]] = parsed(settings.statistics).get("patches", [])
    return patches[index] if len(patches) == len(settings.patches) else None


def _warnings(settings: OceanSettings, index: int) -> list[str]:
    """What the core warns of in one patch."""
    warnings: list[str] = parsed(settings.statistics)["warnings"] if settings.statistics else []
    return [warning for warning in warnings if warning.startswith(f"Patch {index + 1}:")]


def _share(share: float) -> str:
    """A share of the energy in little room."""
    return f"{100.0 * share:.3g} %" if share >= 0.001 else "<0.1 %"


def _band(scene: bpy.types.Scene, patch: bpy.types.PropertyGroup) -> str:
    """Where the band ends; it begins where that of the line above ends, and both find no room."""
    if patch.shortest_wavelength > 0.0:
        return f"> {_length(scene, patch.shortest_wavelength)}"
    if _has_all_long_waves(scene, patch):
        return translated("all waves")
    return f"< {_length(scene, patch.longest_wavelength)}"


def _has_all_long_waves(scene: bpy.types.Scene, patch: bpy.types.PropertyGroup) -> bool:
    return patch.longest_wavelength * float(metres_per_unit(scene)) > 0.999 * NO_LONGEST


def _length(scene: bpy.types.Scene, length: float) -> str:
    """A length in Blender units as a short text in the scene's system of units."""
    return length_text(scene, length * float(metres_per_unit(scene)))


CLASSES = (OCEAN_UL_patches, OCEAN_PT_patches)
