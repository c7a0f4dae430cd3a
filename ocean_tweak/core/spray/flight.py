# SPDX-License-Identifier: GPL-3.0-or-later
"""Flight of a drop: gravity, and a drag linear in its speed relative to the air."""

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
    response : (drops,) response time, s
    """

    start: RealArray
    velocity: RealArray
    air: RealArray
    response: RealArray

    def at(self, age: RealArray) -> tuple[RealArray, RealArray]:
        """Positions in m and velocities in m/s, (drops, 3) each, at ages in s.

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
        """Whether drops at these positions have never been below their start.

        Paths are concave, so a drop that rises at first and is still above its start has not.
        """
        return np.asarray((self.velocity[:, 2] > 0.0) & (place[:, 2] >= self.start[:, 2]))
