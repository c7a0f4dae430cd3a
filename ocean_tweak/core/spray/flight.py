# SPDX-License-Identifier: GPL-3.0-or-later
"""How a drop flies: under its weight and a drag that is linear in its speed against the air."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

RealArray = NDArray[np.floating]

GRAVITY = 9.81  # m/s²


class Flight(NamedTuple):
    """Flights of drops; float32.

    start, velocity : (drops, 3) at birth, m and m/s
    air : (drops, 3) velocity of the air around each, m/s
    response : (drops,) time in which a drop takes over the air's velocity, s
    """

    start: RealArray
    velocity: RealArray
    air: RealArray
    response: RealArray

    def at(self, age: RealArray) -> tuple[RealArray, RealArray]:
        """(drops, 3) places in m and velocities in m/s at ages in s.

        dv/dt = g + (w - v)/τ has the solution v = u + (v₀ - u)·e^(-t/τ), with u = w + gτ; x is its integral.
        """
        response = self.response[:, np.newaxis]
        last = self.air.copy()
        last[:, 2] -= np.float32(GRAVITY) * self.response
        excess = self.velocity - last
        left = -np.expm1(-age / self.response)[:, np.newaxis]
        place = self.start + last * age[:, np.newaxis] + excess * (response * left)
        return place, last + excess * (np.float32(1.0) - left)

    def is_above(self, place: RealArray) -> NDArray[np.bool_]:
        """Whether drops that are at such places have never been lower than where they started.

        Their paths are bent one way all along, so one that rises at first and is still above has not.
        """
        return np.asarray((self.velocity[:, 2] > 0.0) & (place[:, 2] >= self.start[:, 2]))
