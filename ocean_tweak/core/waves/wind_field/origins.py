# SPDX-License-Identifier: GPL-3.0-or-later
"""Where waves are born: one or a few places in each cell of the patch, drawn from a seed."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...numerics import random

if TYPE_CHECKING:
    from .parameters import WindFieldLayer

Array = NDArray[np.float64]

_X, _Y, _PHASE = 0, 1, 2  # streams of an origin's random numbers

#: tells the numbers of these layers from those of spectral layers with the same ids
_SALT = 0x57494E44


class Origins(NamedTuple):
    """Places (n,) in m, and the share of a period (n,) by which each is ahead, in [0, 1)."""

    x: Array
    y: Array
    phase: Array


def layer_origins(layer: WindFieldLayer, ocean_seed: int, domain_size: float) -> Origins:
    """The origins of a layer, cell after cell."""
    seed = layer.seed if layer.seed >= 0 else random.combine(ocean_seed, layer.id)
    count = layer.columns * layer.rows * layer.origins
    start = np.uint64(random.combine(seed, _SALT))
    keys = random.mix(np.arange(count, dtype=np.uint64) ^ start)
    cell = np.arange(count) // layer.origins
    row, column = cell // layer.columns, cell % layer.columns

    def place(index: NDArray[np.intp], cells: int, stream: int) -> Array:
        offset = 0.5 + layer.jitter * (random.uniform(keys, stream) - 0.5)
        return np.asarray((index + offset) * (domain_size / cells))

    phase = layer.phase_jitter * random.uniform(keys, _PHASE)
    return Origins(place(column, layer.columns, _X), place(row, layer.rows, _Y), phase)
