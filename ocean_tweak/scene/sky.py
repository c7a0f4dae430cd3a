# SPDX-License-Identifier: GPL-3.0-or-later
"""The light of a sky in numbers: its sun, its moon, its clouds, and the air at the horizon."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

Colour = tuple[float, float, float]

#: brings a sunlit white surface to about 1: the sky texture counts in units of its own
EXPOSURE = 0.055

#: what Blender's sky has, measured by rendering it: elevation in degrees, then linear red, green and blue.
#: The sun's irradiance on a surface that faces it, which a lamp gives in both engines, while the texture's
#: own disc is for Cycles alone; and the mean radiance just above the horizon, which haze takes
SUN = np.array(
    [
        (-1.0, 0.0, 0.0, 0.0), (0.0, 14.0, 2.0, 0.0), (2.0, 33.6, 10.5, 0.07), (5.0, 71.7, 36.5, 8.3),
        (10.0, 107.4, 71.7, 32.3), (15.0, 125.8, 93.0, 52.7), (20.0, 136.7, 106.4, 67.6),
        (30.0, 148.5, 121.7, 86.6), (45.0, 156.6, 132.7, 101.5), (60.0, 160.3, 137.9, 108.9),
        (90.0, 162.6, 141.0, 113.6),
    ]
)  # fmt: skip
_HORIZON = np.array(
    [
        (-12.0, 0.002, 0.007, 0.017), (-9.0, 0.006, 0.018, 0.043), (-6.0, 0.031, 0.05, 0.107),
        (-4.0, 0.126, 0.115, 0.198), (-2.0, 0.49, 0.30, 0.36), (-1.0, 1.13, 0.53, 0.47),
        (0.0, 2.7, 1.0, 0.58), (2.0, 7.6, 3.7, 1.25), (5.0, 12.6, 8.6, 4.0), (10.0, 15.3, 13.3, 9.0),
        (20.0, 14.5, 14.9, 13.0), (30.0, 13.9, 15.2, 14.4), (90.0, 14.1, 16.3, 16.7),
    ]
)  # fmt: skip

#: what a clear horizon's radiance is beside that mean, away from the sun and towards it, and how narrow that
#: is: measured at 25° and 60° to 75° from a sun 14° to 34° high
_AROUND_SUN = (0.65, 1.77, 6.0)

#: radiance of a closed cloud at the horizon, where it thins out, with the sun 16° high
CLOUD_HORIZON = (0.30, 0.335, 0.36)
_CLOUD_SUN = math.radians(16.0)
#: light beneath its edge towards the sun: colour, strength and how narrow it is
_GLOW = (1.0, 0.90, 0.76)
GLOWING, GLOW_POWER = 1.8, 24.0

#: the moon's light beside the sun's: eight stops below it, as night is lit in film. The true share is 2.5e-6,
#: by which a lantern on deck would outshine the moon a thousand times
_MOON = 0.004
#: moonlight as the eye takes it: bluer than it is
_NIGHT_TINT = (0.62, 0.84, 1.3)
#: of the sun below the horizon, at which the moon's light is whole
_NIGHT = math.radians(-8.0)
#: red, green and blue in brightness
_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


@dataclass(frozen=True)
class Sky:
    """A sky.

    sun_elevation, sun_azimuth : rad; the azimuth counter-clockwise from +x
    clouds : 0…1, of the blue sky that fair-weather clouds cover
    overcast : 0…1, from a sky with a sun to closed, torn cloud with light beneath its edge
    sunlight : 0…1, of the sun's light that comes through a break in closed cloud
    visibility : in the air, m
    exposure : of the picture, in stops
    moon_elevation, moon_azimuth : rad; it shines where the sun has set
    """

    sun_elevation: float
    sun_azimuth: float
    clouds: float = 0.35
    overcast: float = 0.0
    sunlight: float = 0.0
    visibility: float = 30e3
    exposure: float = 0.0
    moon_elevation: float = math.radians(30.0)
    moon_azimuth: float = math.radians(120.0)

    def turned(self, angle: float) -> Sky:
        """The same sky, turned counter-clockwise by an angle in rad."""
        return replace(self, sun_azimuth=self.sun_azimuth + angle, moon_azimuth=self.moon_azimuth + angle)

    @property
    def night(self) -> float:
        """0…1, how much of the moon's light is seen: none by day."""
        return min(max(self.sun_elevation / _NIGHT, 0.0), 1.0)

    @property
    def sun_irradiance(self) -> Colour:
        """Red, green and blue on a surface that faces the sun, W/m² of Blender's."""
        return at(SUN, self.sun_elevation, EXPOSURE * self._through_clouds)

    @property
    def moon_irradiance(self) -> Colour:
        """Red, green and blue on a surface that faces the moon, W/m² of Blender's."""
        return _times(at(SUN, self.moon_elevation, EXPOSURE * self._through_clouds), self.moonlight)

    @property
    def moonlight(self) -> Colour:
        """What the moon's light is beside that of a sun in its place, by colour."""
        return _times(_NIGHT_TINT, _MOON * self.night)

    @property
    def cloud_light(self) -> Colour:
        """What light closed cloud gets, beside that from a sun 16° high, by colour."""
        day, night = (
            _daylight(elevation) / _daylight(_CLOUD_SUN)
            for elevation in (self.sun_elevation, self.moon_elevation)
        )
        return tuple(day + night * part for part in self.moonlight)

    @property
    def glow(self) -> Colour:
        """Colour of the light beneath the edge of closed cloud."""
        now, usual = (np.array(at(SUN, elevation)) for elevation in (self.sun_elevation, _CLOUD_SUN))
        return _times(_GLOW, now / usual)

    @property
    def _through_clouds(self) -> float:
        return max((1.0 - self.overcast) ** 2, self.sunlight)

    def haze(self, azimuth: float) -> Colour:
        """Radiance of the air at the horizon, towards an azimuth in rad."""
        facing = max(math.cos(azimuth - self.sun_azimuth), 0.0)
        # a horizon without clouds: they take some of its light
        clear = np.array(_horizon(self.sun_elevation, azimuth - self.sun_azimuth))
        clear += np.array(self.moonlight) * _horizon(self.moon_elevation, azimuth - self.moon_azimuth)
        cloud = np.array(CLOUD_HORIZON) * self.cloud_light + GLOWING * facing**GLOW_POWER * np.array(
            self.glow
        )
        return tuple(float(part) for part in clear + self.overcast * (cloud - clear))


def at(table: NDArray[np.float64], elevation: float, factor: float = 1.0) -> Colour:
    """Red, green and blue of a table at an elevation in rad, times a factor."""
    degrees = math.degrees(elevation)
    return tuple(factor * float(np.interp(degrees, table[:, 0], part)) for part in table.T[1:])


def _horizon(elevation: float, aside: float) -> Colour:
    """Radiance of a clear horizon, at an angle in rad from what lights it."""
    away, towards, power = _AROUND_SUN
    return at(_HORIZON, elevation, EXPOSURE * (away + towards * max(math.cos(aside), 0.0) ** power))


def _daylight(elevation: float) -> float:
    """Brightness of a level surface in the open, with the sun at an elevation in rad, in units of the tables.

    The sky's part is that of one as bright as a third of its horizon.
    """
    sun = max(math.sin(elevation), 0.0) * np.array(at(SUN, elevation))
    return float(_LUMINANCE @ (sun + math.pi / 3.0 * np.array(at(_HORIZON, elevation))))


def _times(colour: Sequence[float], factor: float | Sequence[float]) -> Colour:
    return tuple(float(part) for part in np.array(colour) * factor)
