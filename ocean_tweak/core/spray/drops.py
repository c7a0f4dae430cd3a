# SPDX-License-Identifier: GPL-3.0-or-later
"""Drops: emission rate as a function of the wind, size distribution, and terminal velocity."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ..numerics.interpolation import smoothstep
from .flight import GRAVITY

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]

#: kinds of particles: many small drops in a sheet, a single large drop, or a puff of the smallest
SPUME, DROPLET, MIST = 0, 1, 2

#: fractions of all particles, and ranges of radii in m
SHARE = {SPUME: 0.794, DROPLET: 0.2, MIST: 0.006}
_RADII = {SPUME: (0.3e-3, 1.0e-3), DROPLET: (0.6e-3, 2.0e-3), MIST: (37.5e-6, 0.1e-3)}
#: exponents of the size distributions: r⁻²·⁸ from 37.5 µm to 0.1 mm (Andreas 1992), drops that fall by less
# than a metre a second and drift, and r⁻⁵ for those that he lacks (fitted by Veron and others 2012)
_POWER = {SPUME: 5.0, DROPLET: 5.0, MIST: 2.8}

#: particles per second and m² of breaking crest at 15 m/s, and the exponent of the wind, chosen by eye: 400
# at 20 m/s and 1,200 at 25 m/s
_RATE, _RATE_WIND, _RATE_POWER = 100.0, 15.0, 4.85
#: wind at 10 m in m/s at which crests begin to be torn, and at which all of them are
LEAST_WIND, _ALL_TORN = 9.0, 13.0

_AIR_DENSITY, _WATER_DENSITY = 1.2, 1025.0  # kg/m³
_AIR_VISCOSITY = 1.5e-5  # m²/s, kinematic
#: range of Reynolds numbers of the drag table
_REYNOLDS = np.geomspace(1e-3, 1e4, 400)


def torn_rate(wind_speed: float) -> float:
    """Particles per second and m² of breaking crest, for a wind in m/s at 10 m.

    Spume begins at 9 to 11 m/s (Andreas 1992). The rates are chosen by eye, far below those of real drops:
    each particle represents many.
    """
    torn = float(smoothstep(np.array((wind_speed - LEAST_WIND) / (_ALL_TORN - LEAST_WIND))))
    return torn * _RATE * (wind_speed / _RATE_WIND) ** _RATE_POWER


def kinds(share: Array, mist: RealArray) -> NDArray[np.int8]:
    """SPUME, DROPLET or MIST for uniform numbers in 0…1, with given fractions of mist."""
    spume = mist + (1.0 - mist) * (SHARE[SPUME] / (SHARE[SPUME] + SHARE[DROPLET]))
    return np.where(share < mist, MIST, np.where(share < spume, SPUME, DROPLET)).astype(np.int8)


def radii(kind: NDArray[np.int8], share: Array) -> RealArray:
    """Radii in m of drops by kind, float32, for uniform numbers in 0…1."""
    result = np.empty(kind.shape, np.float32)
    for each, (least, most) in _RADII.items():
        own, power = kind == each, 1.0 - _POWER[each]
        # inverse of the cumulative distribution of a density r⁻ⁿ
        between = share[own] * (most**power - least**power)
        result[own] = (least**power + between) ** (1.0 / power)
    return result


def fall_speed(radius: RealArray) -> RealArray:
    """Terminal velocity in m/s of drops in still air, float32, for radii in m.

    At this speed the drag of Schiller & Naumann (1933), 24/Re·(1 + 0.15 Re^0.687), balances a drop's weight.
    """
    log_radius, log_speed = _falling()
    return np.exp(np.interp(np.log(radius), log_radius, log_speed)).astype(np.float32)


def response_time(radius: RealArray) -> RealArray:
    """Response time of a drop in s, float32, for a linear drag with the same terminal velocity."""
    return np.asarray(fall_speed(radius) / np.float32(GRAVITY))


@lru_cache(maxsize=1)
def _falling() -> tuple[Array, Array]:
    """Table of log radii and log terminal velocities, parametrised by the Reynolds number."""
    stokes = 2.0 / 9.0 * GRAVITY * (_WATER_DENSITY / _AIR_DENSITY - 1.0) / _AIR_VISCOSITY
    slower = 1.0 + 0.15 * _REYNOLDS**0.687
    # v = Re ν/2r, and v = stokes r²/slower
    radius = np.cbrt(0.5 * _REYNOLDS * _AIR_VISCOSITY * slower / stokes)
    return np.log(radius), np.log(0.5 * _REYNOLDS * _AIR_VISCOSITY / radius)
