# SPDX-License-Identifier: GPL-3.0-or-later
"""Where and when waves are born: at a few random places in each cell of the patch, at times determined by the
wind there alone.

The phase of an origin grows by dt/T, T = √(2π)·V/g the period of its wind's waves; a wave is born whenever it
passes an integer. So the live waves at any time can be computed directly.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...numerics import random
from ...numerics.memo import remembered, total_bytes
from .relations import period
from .wind import winds_at

if TYPE_CHECKING:
    from .parameters import WindFieldLayer

Array = NDArray[np.float64]
Indices = NDArray[np.intp]

_X, _Y, _PHASE = 0, 1, 2  # random streams of an origin

#: keeps the random numbers of these layers distinct from those of spectral layers with the same ids
_SALT = 0x57494E44

#: table size above which steps between two keys of the wind become coarser, and the largest and smallest
# number of steps between two keys
_TABLE, _MOST_STEPS = 2_000_000, 128


class Origins(NamedTuple):
    """Places (n,) in m, and the initial phase (n,) of each in periods, in [0, 1)."""

    x: Array
    y: Array
    phase: Array


def layer_origins(layer: WindFieldLayer, ocean_seed: int, domain_size: float) -> Origins:
    """The origins of a layer, cell by cell."""
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


class Births(NamedTuple):
    """Live waves at a time: where and when each was born, and the wind it was born in.

    x, y : (n,) m
    age : (n,) s
    wind : (n, 2) m/s
    """

    x: Array
    y: Array
    age: Array
    wind: Array


class Emission:
    """Computes the births of a layer's waves."""

    def __init__(self, layer: WindFieldLayer, origins: Origins, domain_size: float, gravity: float) -> None:
        self._layer = layer
        self._origins = origins
        self._gravity = gravity
        self._times, self._winds = winds_at(layer, origins.x, origins.y, domain_size)
        speed = np.hypot(self._winds[..., 0], self._winds[..., 1])
        #: (origins,) s: longest life of a wave from each origin
        self._longest_life = layer.life * period(speed.max(axis=0), gravity)
        self._nodes = self._node_times()
        self._phases = self._table()
        self._rate_after = self._rate(self._winds[-1])

    @property
    def nbytes(self) -> int:
        """Bytes of the winds and phases at the origins."""
        own = (self._times, self._winds, self._longest_life, self._nodes, self._phases, self._rate_after)
        return total_bytes((*own, *self._origins))

    def births(self, time: float) -> Births:
        """The waves alive at a time in s, by origin, oldest first."""
        start = np.maximum(self._nodes[0], time - self._longest_life)
        first = np.floor(self._phase(start))
        last = np.floor(self._phase(np.full(len(start), max(time, self._nodes[0]))))
        counts = (last - first).astype(np.intp)
        origin = np.repeat(np.arange(len(counts)), counts)
        before = np.repeat(np.cumsum(counts) - counts, counts)
        number = first[origin] + 1.0 + (np.arange(len(origin)) - before)
        born = self._time_of(number, origin)
        wind = self._wind(born, origin)
        speed = np.hypot(wind[:, 0], wind[:, 1])
        age = time - born
        alive = (speed >= self._layer.minimum_wind_speed) & (age >= 0.0)
        alive &= age < self._layer.life * period(speed, self._gravity)
        origin = origin[alive]
        return Births(self._origins.x[origin], self._origins.y[origin], age[alive], wind[alive])

    def _rate(self, winds: Array) -> Array:
        """1/T in 1/s for winds (…, 2), 0 in a calm."""
        speed = np.hypot(winds[..., 0], winds[..., 1])
        blowing = speed >= self._layer.minimum_wind_speed
        return np.divide(1.0, period(speed, self._gravity), out=np.zeros(speed.shape), where=blowing)

    def _node_times(self) -> Array:
        """Times at which phases are tabulated, from the start; after the last one the wind is constant."""
        start = self._layer.start_time
        keys = np.concatenate(([start], self._times[self._times > start]))
        if len(self._times) == 1:
            return keys[:1]
        intervals = len(keys) - 1
        steps = _TABLE // max(1, intervals * self._winds.shape[1])
        steps = min(_MOST_STEPS, max(1, steps))
        within = np.arange(steps) / steps
        inner = keys[:-1, np.newaxis] + np.diff(keys)[:, np.newaxis] * within
        return np.append(inner.ravel(), keys[-1])

    def _table(self) -> Array:
        """(nodes, origins) phases at the nodes, integrated by the midpoint rule."""
        phases = np.empty((len(self._nodes), self._winds.shape[1]))
        phases[0] = self._origins.phase
        widths = np.diff(self._nodes)
        middles = self._nodes[:-1] + 0.5 * widths
        everywhere = np.arange(phases.shape[1])
        for first in range(0, len(widths), _MOST_STEPS):
            some = slice(first, first + _MOST_STEPS)
            times = np.repeat(middles[some], len(everywhere))
            origin = np.tile(everywhere, len(middles[some]))
            rates = self._rate(self._wind(times, origin)).reshape(-1, len(everywhere))
            growth = np.cumsum(rates * widths[some, np.newaxis], axis=0)
            phases[first + 1 : first + 1 + len(growth)] = phases[first] + growth
        return phases

    def _wind(self, times: Array, origin: Indices) -> Array:
        """(n, 2) wind at times (n,) and origins (n,)."""
        if len(self._times) == 1:
            return np.asarray(self._winds[0, origin])
        key = np.clip(np.searchsorted(self._times, times, side="right") - 1, 0, len(self._times) - 2)
        width = self._times[key + 1] - self._times[key]
        share = np.clip((times - self._times[key]) / width, 0.0, 1.0)[:, np.newaxis]
        return np.asarray((1.0 - share) * self._winds[key, origin] + share * self._winds[key + 1, origin])

    def _phase(self, times: Array) -> Array:
        """(origins,) phases, each at its own time, not before the first node."""
        everywhere = np.arange(len(times))
        node = np.maximum(np.searchsorted(self._nodes, times, side="right") - 1, 0)
        elapsed = np.maximum(times - self._nodes[node], 0.0)
        return np.asarray(self._phases[node, everywhere] + elapsed * self._slope(node, everywhere))

    def _slope(self, node: Indices, origin: Indices) -> Array:
        """Rate of the phase after a node, 1/s."""
        last = len(self._nodes) - 1
        if last == 0:
            return np.asarray(self._rate_after[origin])
        inner = np.minimum(node, last - 1)
        rise = self._phases[inner + 1, origin] - self._phases[inner, origin]
        width = self._nodes[inner + 1] - self._nodes[inner]
        return np.where(node == last, self._rate_after[origin], rise / width)

    def _time_of(self, number: Array, origin: Indices) -> Array:
        """Times at which the phases of origins pass given numbers, all above the phase at the first node."""
        low = np.zeros(len(number), np.intp)  # the last node whose phase is below the number, by bisection
        high = np.full(len(number), len(self._nodes))
        while np.any(high - low > 1):
            middle = (low + high) // 2
            below = self._phases[middle, origin] < number
            low, high = np.where(below, middle, low), np.where(below, high, middle)
        missing = number - self._phases[low, origin]
        slope = self._slope(low, origin)
        elapsed = np.divide(missing, slope, out=np.zeros(len(number)), where=slope > 0.0)
        return np.asarray(self._nodes[low] + elapsed)


@remembered("winds at origins")
def emission_of(layer: WindFieldLayer, seed: int, domain_size: float, gravity: float) -> Emission:
    """The emission of a layer in a sea with a seed."""
    return Emission(layer, layer_origins(layer, seed, domain_size), domain_size, gravity)
