# SPDX-License-Identifier: GPL-3.0-or-later
"""Seas with the sky, the water and the place to look from that go with them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from ..core import Foam, OceanParameters, Timing, WaveLayer
from ..core.parameters.presets import built_in
from .sky import Sky

#: where the camera looks, rad counter-clockwise from +x: along +y, as Blender's front view does
VIEW = 0.5 * math.pi


@dataclass(frozen=True)
class Mood:
    """A sea and how it is seen; lengths in m, angles in rad.

    waves : gives the sea's parameters
    water : a key of `water_material.WATERS`
    sun, sun_elevation, clouds, overcast : as in `Sky`, the sun's azimuth from the view
    visibility : in the air
    eye : height of the camera above mean water, in significant wave heights above `least_eye`
    crest_distance : from the camera to the highest crest, in significant wave heights
    tilt : of the camera below the horizon
    rings : of copies around the ocean; 0 for a surface around the camera in their place
    floats : before the camera, a key of `afloat.AFLOAT`
    """

    label: str
    description: str
    waves: Callable[[], OceanParameters]
    water: str
    sun: float
    sun_elevation: float
    clouds: float
    overcast: float
    visibility: float
    eye: float
    least_eye: float
    crest_distance: float
    tilt: float
    rings: int
    floats: str = "BUOY"

    def sea(self, timing: Timing) -> OceanParameters:
        """The sea's parameters."""
        return self.waves().replace(timing=timing)

    def sky(self) -> Sky:
        """The sky."""
        return Sky(self.sun_elevation, VIEW + self.sun, self.clouds, self.overcast)


def _wind_sea(
    wind_speed: float, fetch: float, domain_size: float, resolution: int, wind: float
) -> OceanParameters:
    """One wind's sea; `wind` is the waves' direction, counter-clockwise from the view."""
    layer = WaveLayer(wind_speed=wind_speed, fetch=fetch, wind_direction=VIEW + wind, swell=0.3)
    # foam is soft and looks back at a hundred surfaces: half the samples show it as well
    foam = Foam(resolution=resolution // 2)
    return OceanParameters(resolution=resolution, domain_size=domain_size, seed=3, layers=(layer,), foam=foam)


def _preset_sea(key: str) -> OceanParameters:
    return built_in()[key].parameters


def _degrees(value: float) -> float:
    return math.radians(value)


MOODS = {
    "CALM": Mood(
        "Calm", "A light breeze of 3 m/s, low sun and clear water",
        waves=partial(_wind_sea, 3.0, 15e3, 120.0, 512, _degrees(200.0)), water="OCEANIC",
        sun=_degrees(33.0), sun_elevation=_degrees(11.0), clouds=0.5, overcast=0.0, visibility=30e3,
        eye=1.0, least_eye=2.2, crest_distance=30.0, tilt=_degrees(3.0), rings=9,
    ),
    "FRESH_BREEZE": Mood(
        "Fresh Breeze", "10 m/s: waves of two metres and a half with white horses",
        waves=partial(_wind_sea, 10.0, 120e3, 400.0, 512, _degrees(215.0)), water="OCEANIC",
        sun=_degrees(75.0), sun_elevation=_degrees(34.0), clouds=0.55, overcast=0.0,
        visibility=30e3, eye=1.0, least_eye=1.5, crest_distance=16.0, tilt=_degrees(3.0), rings=5,
    ),
    "STORM": Mood(
        "Storm", "25 m/s: waves of eleven metres, streaks of foam and torn cloud",
        waves=partial(_wind_sea, 25.0, 500e3, 1200.0, 1024, _degrees(160.0)), water="STORM",
        sun=_degrees(-40.0), sun_elevation=_degrees(20.0), clouds=0.6, overcast=0.78,
        visibility=12e3, eye=0.6, least_eye=1.0, crest_distance=9.0, tilt=_degrees(0.5), rings=3,
        floats="BOAT",
    ),
    "HORIZON": Mood(
        "To the Horizon", "9 m/s and a swell, from ripples before the camera to the horizon",
        waves=partial(_preset_sea, "horizon"), water="OCEANIC",
        sun=_degrees(40.0), sun_elevation=_degrees(24.0), clouds=0.5, overcast=0.0, visibility=150e3,
        eye=0.0, least_eye=2.0, crest_distance=14.0, tilt=_degrees(4.0), rings=0,
    ),
}  # fmt: skip
