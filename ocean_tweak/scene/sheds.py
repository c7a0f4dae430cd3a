# SPDX-License-Identifier: GPL-3.0-or-later
"""The sheds on a harbour's quay: gables towards the water, a door in each."""

from __future__ import annotations

from collections.abc import Sequence

import bpy
import numpy as np

from .solids import Paint, Solid, house, new_object

#: depth, half of the breadth, and heights of eaves and ridge, m; of one kind after another
_KINDS = ((17.0, 6.5, 5.2, 9.0), (14.0, 5.0, 4.2, 7.2), (20.0, 8.5, 5.6, 10.0))
_BRICK, _PLASTER, _BOARDS, _SLATE, _DOOR = range(5)
_PAINTS = (
    Paint("Shed Brick", (0.21, 0.085, 0.052), 0.9), Paint("Shed Plaster", (0.52, 0.47, 0.39), 0.9),
    Paint("Shed Boards", (0.075, 0.115, 0.125), 0.85), Paint("Shed Slate", (0.06, 0.062, 0.068), 0.7),
    Paint("Shed Door", (0.022, 0.028, 0.03), 0.6),
)  # fmt: skip
_WALLS = (_BRICK, _PLASTER, _BOARDS, _PLASTER, _BRICK)
_EAVES = 0.5  # how far a roof stands out, m


def new_sheds(places: Sequence[tuple[float, float, float]], metres: float = 1.0) -> bpy.types.Object:
    """Sheds whose gables face -x; in no collection yet.

    places : x, y and z in m of the middle of each one's front, on the ground
    metres : in a Blender unit
    """
    solids: list[Solid] = []
    for number, place in enumerate(places):
        depth, half, eaves, ridge = _KINDS[number % len(_KINDS)]
        out = half + _EAVES * half / (ridge - eaves)
        walls = [(0.0, 0.0, depth, half), (eaves, 0.0, depth, half), (ridge - 0.1, 0.0, depth, 0.1)]
        heights = ((eaves - _EAVES, out), (eaves - 0.2, out), (ridge + 0.2, 0.12))
        roof = [(height, -_EAVES, depth + _EAVES, half_there) for height, half_there in heights]
        door = [(height, -0.12, 0.3, 0.32 * half) for height in (0.0, 0.75 * eaves)]
        parts = (
            house(walls, _WALLS[number % len(_WALLS)]), house(roof, _SLATE, bevel=0.02), house(door, _DOOR),
        )  # fmt: skip
        solids += [Solid(part.vertices + np.array(place), part.faces, part.paints) for part in parts]
    return new_object("Sheds", solids, _PAINTS, metres)
