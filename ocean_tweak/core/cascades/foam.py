# SPDX-License-Identifier: GPL-3.0-or-later
"""Foam of several patches together: born where their sum is squeezed, so it repeats with none of them.

It is the foam of `core.foam`, F(x, t) = max of 2^(-age/T)·c(x - v·age, t - age) over a fixed lattice of
times, but there is no grid on which it could be kept: each place looks back along its own drift.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from ..foam import FAINTEST, FoamModel, faded

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]

#: gives the squeeze of the sea at places in m, at a time in s
SqueezeAt = Callable[[Array, Array, Fraction], RealArray]


def foam_at(model: FoamModel, squeeze_at: SqueezeAt, x: Array, y: Array, time: float | Fraction) -> RealArray:
    """(places,) float32 F in 0…1 at rest positions x and y in m."""
    now = model.reduced(time)
    result = model.strength(squeeze_at(x, y, now)).astype(np.float32)
    last = math.floor(now / model.step)
    for index in range(last - model.memory + 1, last + 1):
        then = index * model.step
        age = float(now - then)
        squeeze = squeeze_at(x - age * model.drift[0], y - age * model.drift[1], model.reduced(then))
        np.maximum(result, faded(model.birth(squeeze, then), now, model), out=result)
    result[result < FAINTEST] = 0.0
    return result
