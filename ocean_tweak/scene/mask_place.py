# SPDX-License-Identifier: GPL-3.0-or-later
"""Empties over an ocean from which its masks measure: an imported shot keys them where a mask moves."""

from __future__ import annotations

import bpy

from .settings import all_oceans, link_beside, settings_of

_MARK = "ocean_tweak_mask_place"


def new_over(ocean: bpy.types.Object) -> bpy.types.Object:
    """An empty in an ocean's axes."""
    item = bpy.data.objects.new(f"{ocean.name} mask", None)
    item.parent = ocean
    item[_MARK] = True
    link_beside(item, ocean)
    return item


def is_unread(item: bpy.types.Object) -> bool:
    """Whether an object is such an empty, and no mask measures from it any more."""
    return _MARK in item and not any(
        item in settings_of(ocean).mask_objects() for ocean in all_oceans() if ocean.users_collection
    )


def remove_unread(ocean: bpy.types.Object) -> None:
    """Remove those over an ocean from which no mask measures any more."""
    for item in [child for child in ocean.children if child.library is None and is_unread(child)]:
        bpy.data.objects.remove(item)
