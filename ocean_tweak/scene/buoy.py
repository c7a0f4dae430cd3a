# SPDX-License-Identifier: GPL-3.0-or-later
"""A navigation buoy: a turned body with a mast and a lamp, with its waterline at the origin."""

from __future__ import annotations

import bpy

from .solids import Paint, lathe, new_object

#: radius and height in m from below to above, with the number of the paint of the band that follows
_PROFILE = (
    (0.0001, -1.20, 1), (0.34, -1.16, 1), (0.52, -0.62, 1), (1.02, -0.42, 1), (1.10, -0.30, 1),
    (1.10, 0.06, 0), (1.10, 0.42, 0), (1.02, 0.52, 0), (0.50, 0.58, 0), (0.36, 0.66, 0), (0.19, 2.15, 2),
    (0.19, 2.20, 2), (0.30, 2.22, 2), (0.30, 2.27, 1), (0.13, 2.29, 3), (0.15, 2.36, 3), (0.15, 2.52, 3),
    (0.10, 2.62, 1), (0.0001, 2.66, 1),
)  # fmt: skip
_SEGMENTS = 48

#: of the hull at the waterline, and of its keel below that, m
DIAMETER, DRAFT = 2.2, 1.2

_PAINTS = (
    Paint("Buoy Paint", (0.62, 0.045, 0.012), 0.38),
    Paint("Buoy Hull", (0.018, 0.020, 0.022), 0.55),
    Paint("Buoy Metal", (0.52, 0.52, 0.50), 0.42),
    Paint("Buoy Lamp", (1.0, 0.62, 0.20), 0.2, light=2.0),
)


def new_buoy(name: str, metres: float = 1.0) -> bpy.types.Object:
    """A buoy; in no collection yet.

    metres : in a Blender unit
    """
    body = lathe([point[:2] for point in _PROFILE], [point[2] for point in _PROFILE[:-1]], _SEGMENTS)
    return new_object(name, [body], _PAINTS, metres)
