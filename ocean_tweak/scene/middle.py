# SPDX-License-Identifier: GPL-3.0-or-later
"""Where an ocean stands: its origin is sample 0, from which files, masks and winds count; what stays when its
domain becomes larger or smaller is the middle.
"""

from __future__ import annotations

import math

import bpy
from mathutils import Matrix, Vector

from .animated import curves_of
from .grid_mesh import shown_size
from .left_behind import is_made_for_oceans
from .settings import OceanSettings, settings_of

#: message for an ocean that could not be moved
STAYS_BEHIND = "Its location is keyed, driven or locked: the domain grows and shrinks from its corner"


def put(item: bpy.types.Object, place: Vector, point: tuple[float, float] | None = None) -> None:
    """Stand an unturned ocean so that a point of its domain is at a place in the world.

    point : x and y in Blender units, the middle by default
    """
    half = 0.5 * settings_of(item).domain_size
    item.location = Vector(place) - Vector((*(point or (half, half)), 0.0))


def keep(item: bpy.types.Object) -> Vector:
    """Move an ocean whose domain has another size now, so that its middle stays where it is in the world.

    What others parented to it stays as well. Returns how far it was moved along its own axes, in Blender
    units: 0 where its location is not to be touched, of which `stays_behind` tells.
    """
    settings = settings_of(item)
    size = settings.domain_size
    if not (math.isfinite(size) and size > 0.0):
        return Vector()
    before = settings.placed_size or shown_size(item.data) or size
    settings.placed_size = size
    half = 0.5 * (before - size)
    by = Vector((half * settings.repeats_x, half * settings.repeats_y, 0.0))
    settings.stays_behind = bool(by.length) and _is_held(item)
    if settings.stays_behind:
        return Vector()
    item.location += item.matrix_basis.to_3x3() @ by
    back = Matrix.Translation(-by)
    for child in item.children:
        if child.parent_type == "OBJECT" and child.is_editable and not is_made_for_oceans(child):
            child.matrix_parent_inverse = back @ child.matrix_parent_inverse
    return by


def settle(settings: OceanSettings) -> None:
    """The ocean stands right for the size of its domain."""
    settings.placed_size, settings.stays_behind = settings.domain_size, False


def _is_held(item: bpy.types.Object) -> bool:
    data = item.animation_data
    drivers = () if data is None else data.drivers
    return any(item.lock_location[:2]) or any(
        curve.data_path == "location" for curve in (*curves_of(item), *drivers)
    )
