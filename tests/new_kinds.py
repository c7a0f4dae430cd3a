# SPDX-License-Identifier: GPL-3.0-or-later
"""Two kinds of waves that exist only in tests: one of coefficients, and one that does not repeat."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np

from ocean_tweak.core.data.validation import integer, nested, number
from ocean_tweak.core.masks.parameters import Mask
from ocean_tweak.core.spectral.sea_state import SeaState, mode_state
from ocean_tweak.core.synthesis.coefficients import Coefficients
from ocean_tweak.core.waves.contribution import Contribution, Gives, Names, Wind, identity, muted
from ocean_tweak.core.waves.kinds import KINDS


@dataclass(frozen=True)
class Ripple(Contribution):
    """One wave along x, which may be under a mask."""

    kind = "RIPPLE"
    gives = Gives.COEFFICIENTS | Gives.STATE | Gives.LOOPS
    names = Names(90, "ripple", "ripple", "Ripple", "One wave along x", "RNDCURVE")

    amplitude: float = number(0.5, 0.0, 10.0, "m", "Half its height")
    waves: int = integer(4, 1, 1000, "How many go into the domain")
    muted: bool = muted()
    id: int = identity()
    mask: Mask | None = nested(Mask, optional=True)

    def add(self, sea, to):
        to.h_plus[0, self.waves] += 0.5 * self.amplitude
        to.expected_plus[0, self.waves] += 0.25 * self.amplitude**2

    def state(self, sea):
        alone = Coefficients(sea, np.complex128)
        self.add(sea, alone)
        return mode_state(alone.expected_plus, alone.expected_minus, alone.grid, sea)

    def wind(self, sea):
        return Wind(30.0, 0.5)


@dataclass(frozen=True)
class Hump(Contribution):
    """A bell of water that rises, stands at one place, and pulls the water around it together."""

    kind = "HUMP"
    gives = Gives.FIELDS | Gives.STATE
    names = Names(91, "hump", "hump", "Hump", "A bell of water", "SPHERECURVE")

    x: float = number(30.0, -1e6, 1e6, "m", "Its place along x")
    y: float = number(20.0, -1e6, 1e6, "m", "Its place along y")
    height: float = number(2.0, 0.0, 10.0, "m", "Its height")
    width: float = number(10.0, 0.1, 1e3, "m", "The bell's deviation")
    muted: bool = muted()
    mask: Mask | None = nested(Mask, optional=True)

    def fields(self, sea, x, y, time, keys):
        u, v = (x - self.x) / self.width, (y - self.y) / self.width
        bell = self.height * np.exp(-0.5 * (u * u + v * v))
        of_z = {"": bell * float(time), "x": -u * bell * float(time) / self.width, "t": bell}
        of_z["y"] = -v * bell * float(time) / self.width
        return {(part, by): of_z[by] if part == 2 else np.zeros_like(bell) for part, by in keys}

    def strain_covariances(self, sea, drift):
        return 0.01 * np.diag([1.0, 1.0, 0.5]), np.diag([0.1, 0.1, 0.05])

    def state(self, sea):
        return SeaState(self.height**2, 8.0, 7.0, 100.0, 0.01, 0.0, 0.1)


@contextmanager
def registered(*kinds: type[Contribution]) -> Iterator[None]:
    """The kinds are in the table as long as this is open."""
    KINDS.extend(kinds)
    try:
        yield
    finally:
        for kind in kinds:
            KINDS.remove(kind)
