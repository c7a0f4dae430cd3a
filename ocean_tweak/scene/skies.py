# SPDX-License-Identifier: GPL-3.0-or-later
"""Skies to choose from, for a camera that looks along +y."""

from __future__ import annotations

import math
from dataclasses import dataclass

from .sky import Sky

#: where these skies' camera looks, rad counter-clockwise from +x: along +y, as Blender's front view does
VIEW = 0.5 * math.pi


@dataclass(frozen=True)
class SkyPreset:
    """A sky with its name."""

    label: str
    description: str
    sky: Sky


def seen(sun_elevation: float, sun: float, moon: float = 40.0, **values: float) -> Sky:
    """A sky as its camera sees it.

    sun_elevation : degrees
    sun, moon : azimuths from the view, degrees counter-clockwise
    values : of other fields of `Sky`
    """
    azimuths = (VIEW + math.radians(degrees) for degrees in (sun, moon))
    return Sky(
        math.radians(sun_elevation),
        **dict(zip(("sun_azimuth", "moon_azimuth"), azimuths, strict=True)),
        **values,
    )


SKIES = {
    "NOON": SkyPreset(
        "Noon", "High sun and fair-weather clouds",
        seen(58.0, 70.0, clouds=0.45, visibility=40e3, exposure=-0.5)
    ),
    "GOLDEN_HOUR": SkyPreset(
        "Golden Hour", "Sun 6° above the horizon, to the left of the view: warm light on every crest",
        seen(6.0, 24.0, clouds=0.45, visibility=25e3, exposure=0.6),
    ),
    "DUSK": SkyPreset(
        "Dusk", "The sun has just set: light from a glowing horizon alone",
        seen(-1.5, 12.0, moon=-60.0, clouds=0.5, visibility=25e3, exposure=4.2),
    ),
    "OVERCAST": SkyPreset(
        "Overcast", "Closed grey cloud, soft light without shadows",
        seen(30.0, 60.0, overcast=1.0, visibility=15e3, exposure=-0.6),
    ),
    "STORM_LIGHT": SkyPreset(
        "Storm Light", "Low sun through a break in torn, dark cloud",
        seen(9.0, 55.0, clouds=0.6, overcast=0.96, sunlight=0.9, visibility=9e3, exposure=0.4),
    ),
    "MOONLIT_NIGHT": SkyPreset(
        "Moonlit Night", "The moon ahead, its light in a path on the water",
        seen(
            -20.0, 180.0, moon=8.0, moon_elevation=math.radians(17.0), clouds=0.4, visibility=25e3,
            exposure=4.0,
        ),
    ),
}  # fmt: skip
