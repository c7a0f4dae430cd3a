# SPDX-License-Identifier: GPL-3.0-or-later
"""A current: one velocity of all the water, which carries waves, foam and floating objects."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from ..data.validation import Validated, angle, number

#: largest distance in m: a year of the fastest stream
_FARTHEST = 1e9


@dataclass(frozen=True)
class Current(Validated):
    """Speed and direction of the water. At a fixed place its waves have the frequency ω = σ + k·U.

    Examples
    --------
    >>> Current(speed=1.5).velocity
    (1.5, 0.0)
    """

    speed: float = number(
        0.0, 0.0, 20.0, "m/s", "Speed of the current, which carries waves, foam and floating objects",
        "more than the fastest tidal stream", useful=(0.0, 3.0), changes=True,
    )  # fmt: skip
    direction: float = angle(
        "Direction towards which the current runs, counter-clockwise from +x", changes=True
    )
    carried_x: float = number(
        0.0, -_FARTHEST, _FARTHEST, "m", "Displacement of the water along x at time 0: what a changing "
            "current leaves besides its present velocity times the time",
        "a current of years", left_out=True,
    )  # fmt: skip
    carried_y: float = number(
        0.0, -_FARTHEST, _FARTHEST, "m", "Displacement of the water along y at time 0: what a changing "
            "current leaves besides its present velocity times the time",
        "a current of years", left_out=True,
    )  # fmt: skip

    @property
    def velocity(self) -> tuple[float, float]:
        """x and y in m/s."""
        return self.speed * math.cos(self.direction), self.speed * math.sin(self.direction)

    def carried(self, time: float) -> tuple[float, float]:
        """Displacement (x, y) of the water in m at a time in s."""
        x, y = self.velocity
        return self.carried_x + x * time, self.carried_y + y * time

    def turned(self, rotation: float) -> Current:
        """The same current in axes rotated by `rotation` rad."""
        c, s = math.cos(rotation), math.sin(rotation)
        x, y = c * self.carried_x + s * self.carried_y, c * self.carried_y - s * self.carried_x
        return replace(
            self, direction=math.remainder(self.direction - rotation, math.tau),
            carried_x=min(max(x, -_FARTHEST), _FARTHEST), carried_y=min(max(y, -_FARTHEST), _FARTHEST),
        )  # fmt: skip
