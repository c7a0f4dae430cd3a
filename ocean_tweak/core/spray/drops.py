# SPDX-License-Identifier: GPL-3.0-or-later
"""Drops: how many are torn off by which wind, how large they are, and how fast they fall in still air."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from .flight import GRAVITY

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]

#: what a particle is: many small drops in a sheet, a single large drop, or a puff of the smallest
SPUME, DROPLET, MIST = 0, 1, 2

#: of all particles, and the radii in m between which they are
SHARE = {SPUME: 0.798, DROPLET: 0.2, MIST: 0.002}
_RADII = {SPUME: (0.3e-3, 1.0e-3), DROPLET: (0.6e-3, 2.0e-3), MIST: (0.1e-3, 0.25e-3)}
#: powers of the radius by which there are fewer of the larger ones: Andreas (1992) has r⁻⁸ from 0.1 to
#: 0.25 mm; to larger ones, which his function lacks, Veron and others (2012) fit r⁻⁵
_POWER = {SPUME: 5.0, DROPLET: 5.0, MIST: 8.0}

#: particles a second and m² that breaks at 15 m/s, and the power of the wind with which they become more:
#: 400 at 20 and 1,200 at 25 m/s look right
_RATE, _RATE_WIND, _RATE_POWER = 100.0, 15.0, 4.85
#: m/s of wind at 10 m from which on crests are torn, and at which all of them are
LEAST_WIND, _ALL_TORN = 9.0, 13.0

_AIR_DENSITY, _WATER_DENSITY = 1.2, 1025.0  # kg/m³
_AIR_VISCOSITY = 1.5e-5  # m²/s, kinematic
#: Reynolds numbers of a drop, between which the law of drag is tabulated
_REYNOLDS = np.geomspace(1e-3, 1e4, 400)


def torn_rate(wind_speed: float) -> float:
    """Particles a second and m² of breaking crest, for a wind in m/s at 10 m.

    Spume begins at 9 to 11 m/s (Andreas 1992). The numbers are of what looks right, not of true drops: those
    are many more, and each particle stands for as many as its size covers.
    """
    part = min(1.0, max(0.0, (wind_speed - LEAST_WIND) / (_ALL_TORN - LEAST_WIND)))
    return part * part * (3.0 - 2.0 * part) * _RATE * (wind_speed / _RATE_WIND) ** _RATE_POWER


def kinds(share: Array, mist: RealArray) -> NDArray[np.int8]:
    """SPUME, DROPLET or MIST for numbers evenly between 0 and 1, and shares of mist among them."""
    spume = mist + (1.0 - mist) * (SHARE[SPUME] / (SHARE[SPUME] + SHARE[DROPLET]))
    return np.where(share < mist, MIST, np.where(share < spume, SPUME, DROPLET)).astype(np.int8)


def radii(kind: NDArray[np.int8], share: Array) -> RealArray:
    """Radii in m of drops of some kinds, float32, for numbers evenly between 0 and 1."""
    result = np.empty(kind.shape, np.float32)
    for each, (least, most) in _RADII.items():
        own, power = kind == each, 1.0 - _POWER[each]
        # the inverse of the share of drops that are smaller, of a density r⁻ⁿ
        between = share[own] * (most**power - least**power)
        result[own] = (least**power + between) ** (1.0 / power)
    return result


def fall_speed(radius: RealArray) -> RealArray:
    """Speed in m/s at which drops fall at last through still air, float32, of radii in m.

    That at which the drag of Schiller & Naumann (1933), 24/Re·(1 + 0.15 Re^0.687), carries a drop's weight.
    """
    log_radius, log_speed = _falling()
    return np.exp(np.interp(np.log(radius), log_radius, log_speed)).astype(np.float32)


def response_time(radius: RealArray) -> RealArray:
    """Seconds in which a drop takes over the wind's speed, float32: of linear drag that lets it fall as
    fast."""
    return np.asarray(fall_speed(radius) / np.float32(GRAVITY))


@lru_cache(maxsize=1)
def _falling() -> tuple[Array, Array]:
    """Logarithms of radii and of the speeds at which these fall: both follow from the Reynolds number."""
    stokes = 2.0 / 9.0 * GRAVITY * (_WATER_DENSITY / _AIR_DENSITY - 1.0) / _AIR_VISCOSITY
    slower = 1.0 + 0.15 * _REYNOLDS**0.687
    # v = Re ν/2r, and v = stokes r²/slower
    radius = np.cbrt(0.5 * _REYNOLDS * _AIR_VISCOSITY * slower / stokes)
    return np.log(radius), np.log(0.5 * _REYNOLDS * _AIR_VISCOSITY / radius)
