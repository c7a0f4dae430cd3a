# SPDX-License-Identifier: GPL-3.0-or-later
"""The land behind a harbour's bed: the quay goes on to both sides, and hills rise behind it."""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from ..core.numerics.interpolation import smoothstep
from ..core.waves.coast.beds import SIDE
from .ground import land
from .relief import noise

Array = NDArray[np.float64]

#: x in m of the quay's edge, its height, and by how much less it lies under the bed's own mesh
_EDGE, _QUAY, _UNDER = 459.0, 2.4, 0.1
#: m to both sides of the bed and behind it, and lines of the mesh along x and y
_FAR, _LINES = 3500.0, (160, 280)
#: height of hills, m, how far behind the bed they are whole, and length and share of their noise
_HIGH, _WHOLE = 110.0, 1500.0
_HILLS = ((900.0, 0.55), (330.0, 0.28), (120.0, 0.11), (45.0, 0.06))


def add_hinterland(name: str, collection: bpy.types.Collection, scale: float) -> bpy.types.Object:
    """A mesh of land, which is no bed: waves do not see it.

    scale : Blender units in a metre
    """
    # finer near the bed
    x = _EDGE + (_FAR * np.linspace(0.0, 1.0, _LINES[0]) ** 2.2)
    side = np.linspace(-1.0, 1.0, _LINES[1])
    y = 0.5 * SIDE + 0.8 * SIDE * side + (_FAR - 0.3 * SIDE) * side**3
    along, across = np.meshgrid(x, y)
    height = hinterland(along, across)
    places = np.stack((along, across, height), axis=-1)
    return land(name, places, np.ones_like(height), collection, scale)


def hinterland(x: Array, y: Array) -> Array:
    """m above still water, at places in m."""
    behind = np.maximum(x - SIDE, 0.0)
    hills = sum(
        share * noise(x / length + 7.3, y / length + 2.9, 41 + number)
        for number, (length, share) in enumerate(_HILLS)
    )
    is_bed = (y > 0.0) & (y < SIDE) & (x < SIDE)
    rise = _HIGH * smoothstep(behind / _WHOLE) * (0.35 + 1.1 * hills)
    result: Array = np.where(x <= _EDGE, -8.0, _QUAY + rise) - _UNDER * is_bed
    return result
