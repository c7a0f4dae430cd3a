# SPDX-License-Identifier: GPL-3.0-or-later
"""The life of a wave: straight travel, growth and decay, division of its particles into three.

Everything is a function of the age. Positions are not wrapped to the patch.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .emission import Births
from .relations import period, phase_speed, wavelength
from .shape import RadiusClasses

if TYPE_CHECKING:
    from .parameters import WindFieldLayer

Array = NDArray[np.float64]

#: distance of neighbours, in radii, beyond which particles divide; also their distance in a parallel crest
SPACING = 0.5


class Particles(NamedTuple):
    """Particles at one time, (n,) each.

    x, y : m
    velocity_x, velocity_y : m/s
    amplitude, amplitude_rate : m and m/s
    shape : index of the particle's radius class
    """

    x: Array
    y: Array
    velocity_x: Array
    velocity_y: Array
    amplitude: Array
    amplitude_rate: Array
    shape: NDArray[np.intp]


def particles_of(
    births: Births,
    layer: WindFieldLayer,
    classes: RadiusClasses,
    gravity: float,
    shortest: float,
    current: tuple[float, float] = (0.0, 0.0),
) -> Particles:
    """The particles of some waves, least divided first.

    shortest : wavelength in m below which a wave has none
    current : x and y in m/s, which carries them
    """
    speed = np.hypot(births.wind[:, 0], births.wind[:, 1])
    kept = wavelength(speed, gravity) >= shortest
    speed, age, wind = speed[kept], births.age[kept], births.wind[kept]
    x, y = births.x[kept], births.y[kept]
    shape = classes.nearest(0.5 * wavelength(speed, gravity))
    radius = classes.radii[shape]
    travelled = phase_speed(speed) * age
    divided = divisions(travelled, radius, layer)
    phase = np.pi * age / (layer.life * period(speed, gravity))
    height = amplitude(speed, layer, gravity)
    towards = np.arctan2(wind[:, 1], wind[:, 0])
    parts: list[Particles] = []
    for times in np.unique(divided):
        # one row per wave, one column per particle
        these = np.nonzero(divided == times)[0][:, np.newaxis]
        turn, aside = _fan(layer, int(times))
        angle = towards[these] + turn
        cosine, sine = np.cos(angle), np.sin(angle)
        lateral = aside * radius[these]
        share = height[these] / 3.0**times
        rise = np.sin(phase[these])
        rate = np.cos(phase[these]) * (np.pi / (layer.life * period(speed[these], gravity)))
        flight = phase_speed(speed[these])
        columns = (
            x[these] + travelled[these] * cosine - lateral * sine,
            y[these] + travelled[these] * sine + lateral * cosine,
            flight * cosine,
            flight * sine,
            share * rise,
            share * rate,
            shape[these],
        )
        if any(current):
            of_age = (age[these] * current[0], age[these] * current[1], *current)
            columns = (*(own + more for own, more in zip(columns, of_age, strict=False)), *columns[4:])
        parts.append(Particles._make(np.broadcast_to(column, angle.shape).ravel() for column in columns))
    return joined(parts)


def joined(parts: Sequence[Particles]) -> Particles:
    """Concatenate particles."""
    none = (*([np.zeros(0)] * 6), np.zeros(0, np.intp))
    return Particles._make(np.concatenate(columns) for columns in zip(none, *parts, strict=True))


def amplitude(speed: Array, layer: WindFieldLayer, gravity: float) -> Array:
    """Height in m of a wave's particles in the middle of its life, before division.

    Li & Wang (2016), eq. 5, k_a·V; or s·λ/2π for a steepness s, so that long waves are not flatter.
    """
    if layer.height == "WIND_SPEED":
        return np.asarray(layer.amplitude_scale * layer.height_per_speed * speed)
    return np.asarray(layer.amplitude_scale * layer.steepness / (2.0 * np.pi) * wavelength(speed, gravity))


def divisions(travelled: Array, radius: Array, layer: WindFieldLayer) -> NDArray[np.intp]:
    """Number of times the particles of waves have divided in three.

    Li & Wang (2016), eq. 25 with its small angle, and algorithm 1, corrected: half a radius is the limit
    (the algorithm's quarter of a size, which is 2r), and the distance travelled is C·(t - t_born).
    """
    if layer.crest == "PARALLEL" or not layer.splitting:
        return np.zeros(len(travelled), np.intp)
    ratio = travelled * layer.split_angle / (SPACING * radius)
    powers = 3.0 ** np.arange(32)
    return np.searchsorted(powers, ratio, side="left")


def _fan(layer: WindFieldLayer, times: int) -> tuple[Array, Array]:
    """Directions in rad and lateral offsets in radii of a wave's particles, relative to the middle of its
    crest."""
    first = np.arange(layer.particles, dtype=np.float64) - 0.5 * (layer.particles - 1)
    if layer.crest == "PARALLEL":
        return np.zeros(layer.particles), np.asarray(SPACING * first)
    parts = 3**times
    within = (np.arange(parts) - 0.5 * (parts - 1)) / parts
    turn: Array = layer.split_angle * (first[:, np.newaxis] + within).ravel()
    return turn, np.zeros(len(turn))
