# SPDX-License-Identifier: GPL-3.0-or-later
"""Seas with the sky, the water and the place to look from that go with them."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..core import Foam, OceanParameters, Timing, WaveLayer
from .sky import Sky

#: where the camera looks, rad counter-clockwise from +x: along +y, as Blender's front view does
VIEW = 0.5 * math.pi


@dataclass(frozen=True)
class Mood:
    """A sea and how it is seen; lengths in m, angles in rad.

    wind_speed, fetch, domain_size, resolution : of the sea
    wind : direction of the waves, counter-clockwise from the view
    water : a key of `water_material.WATERS`
    sun, sun_elevation, clouds, overcast : as in `Sky`, the sun's azimuth from the view
    visibility : in the air
    eye : height of the camera above mean water, in significant wave heights above `least_eye`
    crest_distance : from the camera to the highest crest, in significant wave heights
    tilt : of the camera below the horizon
    rings : of copies around the ocean
    """

    label: str
    description: str
    wind_speed: float
    fetch: float
    domain_size: float
    resolution: int
    wind: float
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
    swell: float = 0.3
    seed: int = 3

    def sea(self, timing: Timing) -> OceanParameters:
        """The sea's parameters."""
        layer = WaveLayer(
            wind_speed=self.wind_speed, fetch=self.fetch, wind_direction=VIEW + self.wind, swell=self.swell
        )  # fmt: skip
        return OceanParameters(
            resolution=self.resolution, domain_size=self.domain_size, seed=self.seed, layers=(layer,),
            # foam is soft and looks back at a hundred surfaces: half the samples show it as well
            foam=Foam(resolution=self.resolution // 2), timing=timing,
        )  # fmt: skip

    def sky(self) -> Sky:
        """The sky."""
        return Sky(self.sun_elevation, VIEW + self.sun, self.clouds, self.overcast)


def _degrees(value: float) -> float:
    return math.radians(value)


MOODS = {
    "CALM": Mood(
        "Calm", "A light breeze of 3 m/s, low sun and clear water",
        wind_speed=3.0, fetch=15e3, domain_size=120.0, resolution=512, wind=_degrees(200.0), water="OCEANIC",
        sun=_degrees(33.0), sun_elevation=_degrees(11.0), clouds=0.5, overcast=0.0, visibility=30e3,
        eye=1.0, least_eye=2.2, crest_distance=30.0, tilt=_degrees(3.0), rings=9,
    ),
    "FRESH_BREEZE": Mood(
        "Fresh Breeze", "10 m/s: waves of two metres and a half with white horses",
        wind_speed=10.0, fetch=120e3, domain_size=400.0, resolution=512, wind=_degrees(215.0),
        water="OCEANIC", sun=_degrees(75.0), sun_elevation=_degrees(34.0), clouds=0.55, overcast=0.0,
        visibility=30e3, eye=1.0, least_eye=1.5, crest_distance=16.0, tilt=_degrees(3.0), rings=5,
    ),
    "STORM": Mood(
        "Storm", "25 m/s: waves of eleven metres, streaks of foam and torn cloud",
        wind_speed=25.0, fetch=500e3, domain_size=1200.0, resolution=1024, wind=_degrees(160.0),
        water="STORM", sun=_degrees(-40.0), sun_elevation=_degrees(20.0), clouds=0.6, overcast=0.78,
        visibility=12e3, eye=0.6, least_eye=1.0, crest_distance=9.0, tilt=_degrees(0.5), rings=3,
    ),
}  # fmt: skip
