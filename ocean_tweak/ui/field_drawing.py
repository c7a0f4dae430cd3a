# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws parameter fields in panels, with other units or switches."""

import bpy

from . import wording
from .parameter_properties import SWITCH


def draw_fields(layout: bpy.types.UILayout, group: bpy.types.PropertyGroup, *names: str) -> None:
    """Draw fields of parameters, one below another."""
    for name in names:
        scaled = wording.SCALED.get(name)
        if scaled is not None:
            _draw_scaled(layout, group, name, scaled)
        elif f"{SWITCH}{name}" in group.bl_rna.properties:
            draw_switched(layout, group, name)
        else:
            layout.prop(group, name)


def draw_switched(layout: bpy.types.UILayout, group: bpy.types.PropertyGroup, name: str) -> None:
    """Draw a switch, and beside it the number, or the meaning of "off"."""
    switch = f"{SWITCH}{name}"
    line = layout.row(heading=group.bl_rna.properties[switch].name)
    line.prop(group, switch, text="")
    if getattr(group, switch):
        line.prop(group, name, text="")
    else:
        absent = line.row()
        absent.active = False
        absent.label(text=wording.OFF[name])


def _draw_scaled(
    layout: bpy.types.UILayout, group: bpy.types.PropertyGroup, name: str, scaled: wording.Scaled
) -> None:
    """Draw a field in another unit, with the keyframe dot of the field itself."""
    line = layout.row(align=True)
    decorated = layout.use_property_decorate and group.bl_rna.properties[name].is_animatable
    line.use_property_decorate = False
    line.prop(group, scaled.name)
    if decorated:
        line.prop_decorator(group, name)
