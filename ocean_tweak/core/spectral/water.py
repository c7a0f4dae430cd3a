# SPDX-License-Identifier: GPL-3.0-or-later
"""The body of water shared by all waves."""

from __future__ import annotations

from dataclasses import dataclass

from ..data.validation import Validated, number
from . import constants


@dataclass(frozen=True)
class Water(Validated):
    """Depth, gravity, density and surface tension, the same for every wave layer.

    Examples
    --------
    >>> Water(depth=15.0).gravity
    9.81
    """

    depth: float = number(
        200.0, 0.1, 11e3, "m", "Depth of the water. Long waves lose height in shallow water",
        "from a puddle to the deepest trench",
    )  # fmt: skip
    gravity: float = number(
        constants.GRAVITY,
        0.1,
        100.0,
        "m/s²",
        "Gravitational acceleration",
        "from a small moon to a gas giant",
    )
    density: float = number(
        constants.WATER_DENSITY, 100.0, 20e3, "kg/m³", "Density of the liquid", "liquids up to mercury"
    )
    surface_tension: float = number(
        constants.SURFACE_TENSION, 0.0, 1.0, "N/m", "Surface tension, felt by waves of a few centimetres",
        "liquids up to mercury",
    )  # fmt: skip
