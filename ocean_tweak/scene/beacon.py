# SPDX-License-Identifier: GPL-3.0-or-later
"""The lights on a harbour's moles: red to port of what enters, green to starboard (IALA, region A)."""

from __future__ import annotations

import bpy

from .solids import Paint, lathe, new_object

#: radius and height in m from below to above, with the number of the paint of the band that follows
_PROFILE = (
    (0.0001, -0.5, 1), (1.7, -0.5, 1), (1.7, 0.9, 1), (1.55, 1.0, 1), (0.95, 1.0, 0), (0.88, 2.6, 2),
    (0.8, 4.2, 0), (0.72, 5.7, 0), (1.15, 5.75, 0), (1.15, 5.95, 0), (0.46, 6.0, 3), (0.46, 7.0, 0),
    (0.62, 7.05, 0), (0.0001, 7.6, 0),
)  # fmt: skip
_SEGMENTS = 40

_RED, _GREEN = (0.50, 0.03, 0.016), (0.014, 0.17, 0.06)
_COMMON = (
    Paint("Beacon Concrete", (0.36, 0.35, 0.32), 0.85),
    Paint("Beacon White", (0.66, 0.65, 0.61), 0.45),
)


def new_beacon(is_port: bool, metres: float = 1.0) -> bpy.types.Object:
    """A beacon that stands on its origin; in no collection yet.

    is_port : for the side that what enters has to port
    metres : in a Blender unit
    """
    name, colour = ("Red", _RED) if is_port else ("Green", _GREEN)
    light = tuple(min(1.0, 2.0 * part + 0.05) for part in colour)
    paints = (
        Paint(f"Beacon {name}", colour, 0.45), *_COMMON, Paint(f"Beacon {name} Lamp", light, 0.2, light=2.0),
    )  # fmt: skip
    body = lathe([point[:2] for point in _PROFILE], [point[2] for point in _PROFILE[:-1]], _SEGMENTS)
    return new_object(f"{name} Beacon", [body], paints, metres)
