# SPDX-License-Identifier: GPL-3.0-or-later
"""Height, breaking and direction of all waves at a place, which no time changes.

Each wave has the mean square of its elevation, and a flow: that mean square times the unit vector of its
direction. The flows of all waves add up to the direction of most of the energy.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..waves.coast.ground import Ground
from ..waves.coast.march import MOST_TURN, SHALLOWEST, wave_numbers
from .coast_pictures import Pictures
from .part_waves import PartWaves

Array = NDArray[np.float64]


class StateFields(NamedTuple):
    """At places of one flat shape.

    significant_height : (places,) m
    broken_share : (places,) 0…1, of waves that are broken for lack of depth
    mean_direction : (places, 2) unit vector towards which most of the energy runs; 0 where there are no waves
    """

    significant_height: Array
    broken_share: Array
    mean_direction: Array

    @classmethod
    def of(cls, variance: Array, broken_share: Array, flow: Array) -> StateFields:
        """From mean squares in m², and flows (places, 2) in m²."""
        length = np.hypot(flow[..., 0], flow[..., 1])[..., np.newaxis]
        towards = np.divide(flow, length, out=np.zeros_like(flow), where=length > 1e-12)
        return cls(4.0 * np.sqrt(variance), broken_share, towards)


def open_state(parts: Iterable[PartWaves]) -> tuple[float, Array]:
    """Mean square in m² of all waves of the open sea, and their flow (2,) in m² in the sea's axes: what is
    expected of the spectrum on its grids, without masks.
    """
    variance, flow = 0.0, np.zeros(2)
    for waves in parts:
        for state in waves.initial_state.parts:
            grid = state.grid
            plus, minus = (each * grid.multiplicity for each in (state.expected_plus, state.expected_minus))
            variance += float(np.sum(plus + minus))
            net = np.divide(plus - minus, grid.k, out=np.zeros(grid.shape), where=grid.k > 0.0)
            own = float(np.sum(net * grid.kx)), float(np.sum(net * grid.ky))
            flow += turned_by(waves.part.rotation, np.array(own))
    return variance, flow


def turned_by(angle: float, vectors: Array) -> Array:
    """Vectors (…, 2) turned counter-clockwise."""
    c, s = math.cos(angle), math.sin(angle)
    return np.stack(
        (c * vectors[..., 0] - s * vectors[..., 1], s * vectors[..., 0] + c * vectors[..., 1]), -1
    )


def flow_over_bed(pictures: Pictures, ground: Ground, period: float, gravity: float) -> Array:
    """(rows, columns, 2) m², along the march and across, of the waves of all pictures.

    period : s, after which the sea repeats

    Of each frequency ½|A|²/k times the gradient of its phase, of a single wave ½|A|² times its direction.
    """
    wet = ground.depth > 0.0
    depth = np.maximum(ground.depth, SHALLOWEST)
    counts = [
        np.maximum(sum(np.where(there, 1.0, 0.0) for there in _beside(_both_wet(wet, axis), axis)), 1.0)
        for axis in (0, 1)
    ]
    flow = np.zeros((*wet.shape, 2))
    for number, values in zip(pictures.numbers, pictures.elevation, strict=True):
        field = np.zeros(wet.shape, np.complex64)
        field[wet] = values
        k = wave_numbers(np.array(2.0 * np.pi / period * number), depth, gravity)
        weight = 0.5 * np.abs(field) ** 2 / (np.minimum(k, MOST_TURN / ground.step) * ground.step)
        for axis, count in enumerate(counts):
            # between samples: across, these repeat
            onwards = np.angle(np.roll(field, -1, axis) * np.conj(field))
            onwards[~_both_wet(wet, axis)] = 0.0
            flow[..., axis] += weight * sum(_beside(onwards, axis)) / count
    return flow


def _both_wet(wet: NDArray[np.bool_], axis: int) -> NDArray[np.bool_]:
    """Whether a sample and the one after it are wet; after the last row there is none."""
    both: NDArray[np.bool_] = wet & np.roll(wet, -1, axis)
    if axis == 0:
        both[-1] = False
    return both


def _beside(between: NDArray, axis: int) -> tuple[NDArray, NDArray]:  # type: ignore[type-arg]
    """What is between each sample and the next, and between it and the one before."""
    return between, np.roll(between, 1, axis)
