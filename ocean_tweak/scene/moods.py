# SPDX-License-Identifier: GPL-3.0-or-later
"""Seas with the sky, the water and the place to look from that go with them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from ..core import Foam, OceanParameters, Spray, Timing, Water, WaveLayer
from ..core.parameters.presets import built_in
from ..core.sea.patch_plan import Wish, planned
from .skies import VIEW, seen
from .sky import Sky

#: one whose highest wave stands before the camera as high as such waves are
_STORM_SEED = 8


@dataclass(frozen=True)
class Shore:
    """A bed, and from where it is seen: x, y and z in m.

    bed : a key of `core.waves.coast.beds.BEDS`
    eye, target : of the camera
    boat : x and y in m, and the heading in rad, of a fishing boat; None for none
    beacons : x, y and z in m of a red and a green one; () for none
    sheds : x, y and z in m of the fronts of sheds on a quay; () for none
    """

    bed: str
    eye: tuple[float, float, float]
    target: tuple[float, float, float]
    boat: tuple[float, float, float] | None = None
    beacons: tuple[tuple[float, float, float], ...] = ()
    sheds: tuple[tuple[float, float, float], ...] = ()


@dataclass(frozen=True)
class Mood:
    """A sea and how it is seen; lengths in m, angles in rad.

    waves : gives the sea's parameters
    water : a key of `water_material.WATERS`
    sky : for a camera that looks along VIEW
    eye : height of the camera above the water at its place
    crest_distance : from the camera to the highest crest, in significant wave heights
    lens : focal length in mm
    tilt : of the camera below the horizon
    rings : of copies around the ocean; 0 for a surface around the camera in their place
    floats : before the camera, a key of `afloat.AFLOAT`
    vertices : of the surface around the camera, at most; a long lens sees few of them
    shore : of a coast, which takes the place of where the camera is and looks; None for the open sea
    """

    label: str
    description: str
    waves: Callable[[], OceanParameters]
    water: str
    sky: Sky
    eye: float
    crest_distance: float
    lens: float
    tilt: float
    rings: int
    floats: str = "BUOY"
    vertices: int = 200_000
    shore: Shore | None = None

    def sea(self, timing: Timing) -> OceanParameters:
        """The sea's parameters."""
        return self.waves().replace(timing=timing)


def _wind_sea(
    wind_speed: float, fetch: float, domain_size: float, resolution: int, wind: float
) -> OceanParameters:
    """One wind's sea; `wind` is the waves' direction, counter-clockwise from the view."""
    layer = WaveLayer(wind_speed=wind_speed, fetch=fetch, wind_direction=VIEW + wind, swell=0.3)
    # foam is soft and looks back at dozens of surfaces: half the samples show it as well
    foam = Foam(resolution=resolution // 2)
    return OceanParameters(resolution=resolution, domain_size=domain_size, seed=3, layers=(layer,), foam=foam)


def _coast(wind_speed: float, fetch: float, direction: float, depth: float, foam: Foam) -> OceanParameters:
    """A sea that runs towards +x, for a bed of 512 m."""
    layer = WaveLayer(wind_speed=wind_speed, fetch=fetch, wind_direction=direction, swell=0.6)
    return OceanParameters(
        resolution=384, domain_size=512.0, seed=3, layers=(layer,), foam=foam, water=Water(depth=depth)
    )


def _storm() -> OceanParameters:
    """A wind of 25 m/s over 800 km, as in figure 6 of Horvath (2015), down to waves of half a metre."""
    layer = WaveLayer(wind_speed=25.0, fetch=800e3, wind_direction=VIEW + _degrees(160.0), swell=0.2)
    # crests just fold, and foam lives as long as the bubbles of such seas let it
    foam = Foam(coverage=3.0, half_life=6.0)
    sea = OceanParameters(seed=_STORM_SEED, layers=(layer,), choppiness=1.25, foam=foam, spray=Spray())
    return planned(sea, Wish(finest=0.5, area=2000.0))


def _preset_sea(key: str) -> OceanParameters:
    return built_in()[key].parameters


def _degrees(value: float) -> float:
    return math.radians(value)


MOODS = {
    "CALM": Mood(
        "Calm", "A light breeze of 3 m/s, low sun and clear water",
        waves=partial(_wind_sea, 3.0, 15e3, 120.0, 512, _degrees(200.0)), water="OCEANIC",
        sky=seen(11.0, 33.0, clouds=0.5),
        eye=2.4, crest_distance=30.0, lens=35.0, tilt=_degrees(3.0), rings=9,
    ),
    "FRESH_BREEZE": Mood(
        "Fresh Breeze", "10 m/s: waves of 2.5 m with whitecaps",
        waves=partial(_wind_sea, 10.0, 120e3, 400.0, 512, _degrees(215.0)), water="OCEANIC",
        sky=seen(34.0, 75.0, clouds=0.55),
        eye=3.0, crest_distance=14.0, lens=40.0, tilt=_degrees(2.0), rings=5,
    ),
    "STORM": Mood(
        "Storm", "25 m/s over 800 km: waves of 15 m, breaking crests, streaks of foam and spray",
        waves=_storm, water="STORM",
        sky=seen(16.0, -85.0, clouds=0.6, overcast=0.95, sunlight=1.0, visibility=6e3, exposure=-0.4),
        eye=3.0, crest_distance=8.0, lens=62.0, tilt=_degrees(-5.2), rings=0,
        floats="BOAT", vertices=2_000_000,
    ),
    "HORIZON": Mood(
        "To the Horizon", "9 m/s and a swell, from ripples at the camera to the horizon",
        waves=partial(_preset_sea, "horizon"), water="OCEANIC",
        sky=seen(24.0, 40.0, clouds=0.5, visibility=150e3),
        eye=2.0, crest_distance=14.0, lens=35.0, tilt=_degrees(4.0), rings=0,
    ),
}  # fmt: skip

#: unevenly along the harbour's quay
_SHEDS = tuple(
    (474.0 + shift, y, 2.4)
    for y, shift in (
        (40.0, 0.0),
        (56.0, 6.0),
        (71.0, 3.0),
        (108.0, 9.0),
        (126.0, -2.0),
        (168.0, 2.0),
        (182.0, 7.0),
        (205.0, -1.0),
        (219.0, 1.0),
        (240.0, 8.0),
        (281.0, 1.5),
        (294.0, 4.0),
        (309.0, -3.0),
        (348.0, 0.0),
        (383.0, 5.0),
        (398.0, 0.0),
        (414.0, 2.0),
        (452.0, 6.0),
        (470.0, 1.0),
    )
)

#: seas with a coast
COASTS = {
    "BEACH": Mood(
        "Beach", "Swell that turns into a bay, rises, and breaks in lines on a bar and on the sand",
        waves=partial(_coast, 11.0, 150e3, _degrees(12.0), 20.0, Foam(half_life=4.0)), water="COASTAL",
        sky=seen(8.0, 50.0, clouds=0.55, exposure=0.2),
        eye=0.0, crest_distance=0.0, lens=35.0, tilt=0.0, rings=0, floats="",
        shore=Shore("BEACH", (391.0, 167.0, 9.0), (330.0, 301.0, 0.0)),
    ),
    "HARBOUR": Mood(
        "Harbour", "Waves that pass the gap between two moles and spread in a fan behind it",
        waves=partial(_coast, 12.0, 120e3, 0.0, 14.0, Foam()), water="COASTAL",
        sky=seen(14.0, -35.0, clouds=0.5, exposure=-0.25),
        eye=0.0, crest_distance=0.0, lens=42.0, tilt=0.0, rings=0, floats="",
        shore=Shore(
            "HARBOUR", (10.0, 190.0, 48.0), (262.0, 254.0, 16.0),
            boat=(182.0, 259.0, _degrees(-6.0)), beacons=((210.0, 298.0, 2.5), (210.0, 214.0, 2.5)),
            sheds=_SHEDS,
        ),
    ),
    "ISLET": Mood(
        "Islet", "A rock in a swell that bends around it and breaks on it",
        waves=partial(_coast, 12.0, 200e3, 0.0, 16.0, Foam(half_life=5.0)), water="COASTAL",
        sky=seen(10.0, 62.0, clouds=0.5),
        eye=0.0, crest_distance=0.0, lens=48.0, tilt=0.0, rings=0, floats="",
        shore=Shore("ISLET", (118.0, 126.0, 12.0), (250.0, 259.0, 1.5)),
    ),
}  # fmt: skip
