# SPDX-License-Identifier: GPL-3.0-or-later
"""The colour of deep water, by what absorbs light in it and what turns light back; and the way back.

As the water shader has it (`nodes.water_light`): R = 0.33 b/(a + b) below the surface (Morel & Prieur 1977),
of which (1 - r) R/(1 - r R) comes out, r = 0.47 (Saunderson 1942).
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from ..nodes.water_light import SURFACE_FACTOR, THROWN_BACK

#: of light that comes out of water: what is darker or brighter is no water's
DARKEST, BRIGHTEST = 1e-4, 0.195


def water_colour(absorption: Sequence[float], backscatter: Sequence[float]) -> tuple[float, ...]:
    """Share of the light from above that comes back out of deep water, linear red, green and blue.

    absorption, backscatter : of a metre, in red, green and blue
    """
    return tuple(_out_of(*pair) for pair in zip(absorption, backscatter, strict=True))


def coefficients_of(
    colour: Sequence[float], absorption: Sequence[float], backscatter: Sequence[float]
) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Absorption and backscatter of water that has a colour, and lets light through as far as other water.

    The ratio of both makes the colour; the product of each pair stays as it is in the other water.
    """
    pairs = [_wanted(*each) for each in zip(colour, absorption, backscatter, strict=True)]
    return tuple(a for a, _ in pairs), tuple(b for _, b in pairs)


def _out_of(absorption: float, backscatter: float) -> float:
    lost = max(absorption + backscatter, 1e-9)
    below = SURFACE_FACTOR * backscatter / lost
    return (1.0 - THROWN_BACK) * below / (1.0 - THROWN_BACK * below)


def _wanted(colour: float, absorption: float, backscatter: float) -> tuple[float, float]:
    out = min(max(colour, DARKEST), BRIGHTEST)
    below = out / (1.0 - THROWN_BACK + THROWN_BACK * out)
    ratio = below / (SURFACE_FACTOR - below)
    size = math.sqrt(max(absorption, 1e-6) * max(backscatter, 1e-6))
    return size / math.sqrt(ratio), size * math.sqrt(ratio)
