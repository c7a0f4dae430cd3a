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

    below: NDArray[np.int64]
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
        self._values = shape._replace(
            first_weight=np.log(np.maximum(energy * first, _LEAST_ENERGY)),
            second_weight=None if second is None else np.log(np.maximum(energy * second, _LEAST_ENERGY)),
        )

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
        values = self._values.map(lambda table: _interpolated(table, at))
        second = values.second_weight
        return values._replace(
            first_weight=np.exp(values.first_weight),
            second_weight=None if second is None else np.exp(second),
        )


def _interpolated(values: Array, at: Nodes) -> Array:
    low = values[at.below]
    return low + at.fraction * (values[at.below + 1] - low)
