# SPDX-License-Identifier: GPL-3.0-or-later
"""Cleans up after a deleted ocean: helper objects are removed, and floating objects stand still.

An ocean that others read is in no collection when it was deleted, but stays in the file until it is saved.
"""

from __future__ import annotations

import bpy

from ..nodes.camera_surface import CAMERA_SURFACE
from ..nodes.horizon import HORIZON
from ..nodes.versioned import is_of_kind
from . import (
    bed_points,
    coast_surface,
    contact,
    float_carrier,
    floating,
    hull_cut,
    mask_place,
    patch_objects,
    spray,
)
from .settings import was_ocean

#: what a child is that does not read its ocean
_READS_NO_OCEAN = (spray.is_ours, coast_surface.is_ours, bed_points.is_ours, mask_place.is_unread)


def clear() -> bool:
    """Remove horizons, surfaces, coasts, patches, spray and masks' places of deleted oceans, and let nothing
    float on or touch them.

    Returns whether there are any.
    """
    deleted = {item for item in bpy.data.objects if was_ocean(item) and not item.users_collection}
    # an ocean is not referenced because of these: it is freed, and its child loses its parent
    parted = [each for each in bpy.data.objects if each.parent is None and each.library is None]
    own = [each for each in parted if any(is_own(each) for is_own in _READS_NO_OCEAN)]
    alone = [item for item in own if item.users_collection]
    for item in alone:
        _take_away(item)
    if not deleted:
        return bool(alone)
    for item in [item for item in bpy.data.objects if item.library is None and item.users_collection]:
        if item.parent in deleted and (is_made_for_oceans(item) or mask_place.is_unread(item)):
            _take_away(item)
            continue
        carrier = float_carrier.carrier_of(item)
        if carrier is not None and floating.ride_of(carrier)[0] in deleted:
            floating.sink(item)
        elif contact.ocean_of(item) in deleted:
            contact.part(item)
        if hull_cut.ocean_of(item) in deleted:
            hull_cut.let_in(item)
    return True


def _take_away(item: bpy.types.Object) -> None:
    """Take an object out of the file that is saved, as Blender's own Delete does with what is still read.

    This is done amid an evaluation, in which Blender cannot bear that an object with a geometry is freed.
    """
    item.modifiers.clear()  # they would keep the ocean
    for collection in item.users_collection:
        collection.objects.unlink(item)


def is_made_for_oceans(item: bpy.types.Object) -> bool:
    """Whether the extension gave an ocean this child: its horizon, a surface, a coast,
    a patch or its spray."""
    kinds = (HORIZON, CAMERA_SURFACE)
    groups = [modifier.node_group for modifier in item.modifiers if modifier.type == "NODES"]
    parts = (patch_objects, spray, coast_surface, bed_points)
    return any(part.is_ours(item) for part in parts) or any(
        is_of_kind(group, kind) for group in groups for kind in kinds
    )
