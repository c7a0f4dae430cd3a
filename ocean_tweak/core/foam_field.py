# SPDX-License-Identifier: GPL-3.0-or-later
"""The foam of a sea: how much there is, how it is born, and its field at the sea's resolution."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .bilinear import stretched, wrapped
from .foam import FoamModel, strength_levels
from .foam_threshold import Strains, foam_wind, whitecap_coverage
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


def foam_model(
    parameters: OceanParameters, strains_of: Callable[[tuple[float, float]], Strains], spacing: float
) -> FoamModel:
    """How the foam of a sea is born and lives.

    strains_of : gives the strains that a point with this drift in m/s meets, of the waves that the samples
        hold on which foam is made: so foam made coarser covers as much
    spacing : of those samples, m
    """
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


def resampled(field: RealArray, resolution: int) -> RealArray:
    """A periodic (M, M) field on (N, N) samples, bilinear; the first sample is the same."""
    size = field.shape[0]
    if size == resolution:
        return field
    return stretched(stretched(wrapped(field), 0, resolution), 1, resolution)[:-1, :-1]
