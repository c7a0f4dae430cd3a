# SPDX-License-Identifier: GPL-3.0-or-later
"""The foam of a sea: its threshold, its history and its field at the sea's resolution."""

from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .foam import FoamHistory, FoamModel, strength_levels
from .foam_threshold import Strains, foam_wind, strains, whitecap_coverage
from .initial_state import InitialState
from .parameters import OceanParameters

RealArray = NDArray[np.floating]


class FoamOutlook(NamedTuple):
    """What foam a sea will have, and what it costs.

    coverage : share of the sea under foam, 0…1
    memory : earlier surfaces that a frame alone must look at
    """

    coverage: float
    memory: int


def foam_outlook(parameters: OceanParameters) -> FoamOutlook:
    """Coverage and cost of the foam, without making any."""
    coverage = _coverage(parameters)
    model = FoamModel(1.0 if coverage > 0.0 else math.inf, parameters.foam.half_life, (0.0, 0.0), 1.0)
    return FoamOutlook(coverage, model.memory)


def _coverage(parameters: OceanParameters) -> float:
    wind = foam_wind(parameters)
    return min(1.0, parameters.foam.coverage * whitecap_coverage(wind.speed)) if wind is not None else 0.0


def foam_model(parameters: OceanParameters, state: InitialState) -> FoamModel:
    """How the foam of a sea is born and lives.

    state : of the sea at the resolution at which foam is made: the threshold follows from the strains that
        this grid holds, so that foam made coarser covers as much
    """
    spacing = parameters.domain_size / state.grid.resolution
    return foam_model_of(parameters, lambda drift: strains(state, parameters, drift), spacing)


def foam_model_of(
    parameters: OceanParameters, strains_of: Callable[[tuple[float, float]], Strains], spacing: float
) -> FoamModel:
    """The same with what gives the strains that a drifting point meets."""
    foam, wind = parameters.foam, foam_wind(parameters)
    drift, threshold = (0.0, 0.0), math.inf
    if wind is not None:
        speed = foam.drift * wind.speed
        drift = (speed * math.cos(wind.direction), speed * math.sin(wind.direction))
    coverage = _coverage(parameters)
    if coverage > 0.0:
        threshold = strains_of(drift).threshold(coverage, foam.half_life, strength_levels())
    return FoamModel(
        threshold=threshold,
        half_life=foam.half_life,
        drift=drift,
        spacing=spacing,
        loop_duration=parameters.loop_duration,
    )


class FoamField:
    """Foam at any time, at the sea's resolution; quickest when times ascend."""

    def __init__(self, model: FoamModel, resolution: int, cusp_at: Callable[[Fraction], RealArray]) -> None:
        """`model` and `cusp_at`, the squeeze at a time, are those of the samples on which foam is made."""
        self.model = model
        self._resolution = resolution
        self.history = FoamHistory(self.model, cusp_at)

    def at(self, time: float | Fraction) -> RealArray:
        """(N, N) float32, 0…1."""
        return resampled(self.history.foam(time), self._resolution)


def resampled(field: RealArray, resolution: int) -> RealArray:
    """A periodic (M, M) field on (N, N) samples, bilinear; the first sample is the same."""
    size = field.shape[0]
    if size == resolution:
        return field
    position = np.arange(resolution) * (size / resolution)
    low = position.astype(np.intp)
    fraction = (position - low).astype(field.dtype)
    high = (low + 1) % size
    rows = field[low] + fraction[:, np.newaxis] * (field[high] - field[low])
    return rows[:, low] + fraction * (rows[:, high] - rows[:, low])
