# SPDX-License-Identifier: GPL-3.0-or-later
"""Random numbers that belong to a wave vector or a cell, not to an array index.

A number depends on (kx, ky, seed) alone, so more resolution or a larger domain refines or extends the
same sea (Horvath 2015, § 7.1.1). The integers are the same on every platform and NumPy version.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

#: wave vectors are distinguished to 1e-5 rad/m, which still resolves a domain of 100 km
QUANTUM = 1e-5

_GOLDEN = 0x9E3779B97F4A7C15  # 2⁶⁴ divided by the golden ratio: an odd constant with evenly spread bits
_MASK = 2**64 - 1


def mix(value: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """Spread every input bit over all 64 output bits (the finaliser of SplitMix64, Steele et al. 2014)."""
    value = (value ^ (value >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    value = (value ^ (value >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return value ^ (value >> np.uint64(31))


def combine(*integers: int) -> int:
    """One 64-bit integer that depends on each of the given ones and on their order."""
    state = np.zeros(1, np.uint64)
    for integer in integers:
        state = mix((state ^ np.uint64(integer & _MASK)) + np.uint64(_GOLDEN))
    return int(state[0])


def hash_wave_vectors(kx: ArrayLike, ky: ArrayLike, seed: int) -> NDArray[np.uint64]:
    """(…) uint64: a hash of (round(kx·10⁵), round(ky·10⁵), seed), broadcast over kx and ky in rad/m."""
    x, y = (np.rint(np.asarray(k, np.float64) / QUANTUM).astype(np.int64) for k in (kx, ky))
    return hash_cells(x, y, seed)


def hash_cells(column: NDArray[np.int64], row: NDArray[np.int64], *seeds: int) -> NDArray[np.uint64]:
    """(…) uint64: a hash of two integers, broadcast, and of further integers that are the same for all."""
    x, y = column.view(np.uint64), row.view(np.uint64)
    start = np.uint64(combine(*seeds))
    return mix(mix((x ^ start) + np.uint64(_GOLDEN)) ^ mix(y + np.uint64(2 * _GOLDEN & _MASK)))


def members(key: NDArray[np.uint64], number: NDArray[np.int64]) -> NDArray[np.uint64]:
    """(…) uint64: keys of numbered members of a group, from the group's key."""
    return mix(key + (number.view(np.uint64) + np.uint64(1)) * np.uint64(_GOLDEN))


def uniform(key: NDArray[np.uint64], stream: int) -> NDArray[np.float64]:
    """Uniform numbers in (0, 1], independent for each stream."""
    offset = np.uint64(_GOLDEN * (stream + 1) & _MASK)
    bits = mix(key + offset) >> np.uint64(11)
    return (bits.astype(np.float64) + 0.5) * 2.0**-53


def normal(key: NDArray[np.uint64], stream: int) -> NDArray[np.float64]:
    """Standard normal numbers (Box and Muller 1958) from the streams `stream` and `stream + 1`."""
    radius = np.sqrt(-2.0 * np.log(uniform(key, stream)))
    return radius * np.cos(2.0 * np.pi * uniform(key, stream + 1))
