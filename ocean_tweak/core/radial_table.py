# SPDX-License-Identifier: GPL-3.0-or-later
"""A layer's spectrum as tables over the wave number, for the many wave vectors of a grid.

But for the angle, everything in Ψ(kx, ky) depends on k alone. The nodes are whole multiples of a step in
ln k, the same for every grid, so that a wave vector has the same value on all of them.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .spreading import Shape

Array = NDArray[np.float64]

#: nodes per unit of ln k: JONSWAP's peak, the narrowest feature, is met to 1e-5 of its value
NODES_PER_LOG = 1024

_LEAST_ENERGY = 1e-300


class Nodes(NamedTuple):
    """Where wave numbers lie between the nodes of a table."""

    index: NDArray[np.int64]
    fraction: Array


class RadialTable:
    """Energy and spreading shape over k, interpolated linearly in ln k (the energy in its logarithm).

    Made for wave numbers from `lowest` to `highest` in rad/m.
    """

    def __init__(self, lowest: float, highest: float) -> None:
        self._first = int(np.floor(np.log(lowest) * NODES_PER_LOG)) - 1
        last = int(np.ceil(np.log(highest) * NODES_PER_LOG)) + 1
        self.k: Array = np.exp(np.arange(self._first, last + 1) / NODES_PER_LOG)

    def fill(self, energy: Array, shape: Shape) -> None:
        """Keep the values at the nodes `k`: energy in m⁴ per unit of D, and the shape of D."""
        first, second = shape.first_weight, shape.second_weight
        self._log_first = np.log(np.maximum(energy * first, _LEAST_ENERGY))
        self._log_second = None if second is None else np.log(np.maximum(energy * second, _LEAST_ENERGY))
        self._shape = shape

    def nodes(self, k: Array) -> Nodes:
        """Where wave numbers lie; k in rad/m within the table's range."""
        position = np.log(k)
        position *= NODES_PER_LOG
        position -= self._first
        index = position.astype(np.int64)
        position -= index
        return Nodes(index, position)

    def shape(self, at: Nodes) -> Shape:
        """The shape of D at some nodes, its weights multiplied by the energy."""
        return Shape(
            np.exp(_interpolated(self._log_first, at)),
            _interpolated(self._shape.first, at),
            None if self._log_second is None else np.exp(_interpolated(self._log_second, at)),
            None if self._shape.second is None else _interpolated(self._shape.second, at),
            None if self._shape.swell is None else _interpolated(self._shape.swell, at),
        )


def _interpolated(values: Array, at: Nodes) -> Array:
    low = values[at.index]
    return low + at.fraction * (values[at.index + 1] - low)
