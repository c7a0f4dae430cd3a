# SPDX-License-Identifier: GPL-3.0-or-later
"""Foam on the water: where it covers, and how it shades.

The ocean's foam says how much; the lace of the detail image says where, so that a share F of foam covers a
share F of the water however near it is seen.
"""

from __future__ import annotations

from typing import NamedTuple

from .building import Socket
from .shading import Shading
from .water_pattern import Place, tile

_STREAK_LENGTH = 70.0  # m
_STREAK_NARROWER = 5.0
_SPREAD = 1.5


class Cover(NamedTuple):
    """Foam at a point.

    amount : 0…1, of the water that is covered
    thickness : 0…1
    """

    amount: Socket
    thickness: Socket


def foam_cover(shade: Shading, given: dict[str, Socket], at: Place, foam: Socket) -> Cover:
    """Foam with its pattern.

    foam : 0…1, the ocean's
    """
    size = given["Foam Size"]
    fine = tile(shade, at, shade.math("MULTIPLY", size, 0.37), 0.7).lace
    middle = tile(shade, at, size, 0.2).lace
    coarse = tile(shade, at, shade.math("MULTIPLY", size, 5.3), -0.4).lace
    lines = tile(shade, at, _STREAK_LENGTH, 0.0, stretch=_STREAK_NARROWER).lace
    old = shade.math("MULTIPLY", shade.smooth(lines, 0.40, 0.0), given["Foam Streaks"])
    amount = shade.math("ADD", foam, shade.math("MULTIPLY", old, 0.55))
    lace = shade.math("MULTIPLY_ADD", middle, 0.5, shade.math("MULTIPLY", fine, 0.22))
    lace = shade.math("MULTIPLY_ADD", coarse, 0.28, lace)
    # a sum of patterns gathers in the middle: spread out again, a share F covers about F of the water
    lace = shade.math("MULTIPLY_ADD", lace, _SPREAD, 0.5 - 0.5 * _SPREAD)
    above = shade.math("SUBTRACT", shade.math("MULTIPLY", amount, 1.08), lace)
    has_any = shade.smooth(amount, 0.0, 0.08)
    cover = shade.math("MULTIPLY", shade.smooth(above, -0.09, 0.10), has_any)
    return Cover(cover, shade.smooth(above, -0.05, 0.65))


def foam_shader(shade: Shading, given: dict[str, Socket], cover: Cover, normal: Socket) -> Socket:
    """Bubbles scatter all light that meets them; thin foam lets some of it through to the water."""
    colour = shade.scale(given["Foam Color"], shade.mix(cover.thickness, 0.72, 1.0))
    inputs = {
        "Base Color": colour, "Roughness": given["Foam Roughness"], "IOR": given["IOR"], "Normal": normal,
    }  # fmt: skip
    return shade.node("ShaderNodeBsdfPrincipled", inputs).outputs[0]
