# SPDX-License-Identifier: GPL-3.0-or-later
"""Keeps the middle of the domain, and manually placed things, in place when the domain size changes."""

from __future__ import annotations

import bpy

from ..scene import mask_lines, middle
from ..scene.settings import OceanSettings
from .layer_properties import masks


def keep_middle(settings: bpy.types.PropertyGroup, keep_places: bool = True) -> None:
    """Move an ocean whose domain has another size now, within `settings.quiet()`.

    keep_places : whether hero waves, places and lines of masks stay in the world as well; they count from the
        corner
    """
    by = middle.keep(settings.id_data)
    if not (keep_places and by.length):
        return
    waves = [layer.group for layer in settings.layers if layer.kind == "HERO_WAVE"]
    all_masks = (settings.mask, *masks(settings.layers), *(patch.mask for patch in settings.patches))
    # of an object, place and lines follow it
    places = [mask for mask in all_masks if mask.source == "DISTANCE" and mask.object is None]
    for group in (*waves, *places):
        group.x, group.y = group.x - by.x, group.y - by.y
    for mask in places:
        mask.lines = mask_lines.shifted(mask.lines, -by.x, -by.y)


def tell_what_stays(operator: bpy.types.Operator, settings: OceanSettings) -> None:
    """Report where an ocean could not keep its middle."""
    if settings.stays_behind:
        operator.report({"WARNING"}, middle.STAYS_BEHIND)
