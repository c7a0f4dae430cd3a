# SPDX-License-Identifier: GPL-3.0-or-later
"""How much foam a sea has, and where whitecaps begin: the compression of the surface beyond which it is foam.

With true wave heights hardly anything folds, so foam cannot wait for folding. Instead the threshold follows
from the sea's own strains, so that the share of the surface under foam is the one that winds leave at sea.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..numerics import random
from ..parameters.ocean_parameters import OceanParameters
from ..spectral import constants
from ..synthesis.coefficients import InitialState
from ..waves.contribution import Wind
from .model import FoamModel, strength_levels

Array = NDArray[np.float64]

_SAMPLES = 2**18

#: compression from which foam may be born: below it are roundings of float32 fields, and of a sea without any
LEAST_COMPRESSION = 1e-6


def foam_wind(parameters: OceanParameters) -> Wind | None:
    """The strongest of the winds that the layers are given by; None without one: swell does not break."""
    winds = [wind for layer in parameters.active() if (wind := layer.wind(parameters)) is not None]
    return max(winds, key=lambda wind: wind.speed) if winds else None


def whitecap_coverage(wind_speed: float) -> float:
    """Share of the sea under whitecaps for a wind in m/s at 10 m: 3.84·10⁻⁶ U^3.41, at most 1.

    Monahan & O'Muircheartaigh (1980).
    """
    return min(1.0, constants.WHITECAP_FACTOR * wind_speed**constants.WHITECAP_EXPONENT)


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


@dataclass(frozen=True)
class Strains:
    """Strains of a random sea at some points: compression (1 - minimum eigenvalue) and its rate in 1/s."""

    compression: Array
    rate: Array

    def threshold(self, coverage: float, duration: float, rises: Array) -> float:
        """The compression from which foam is to be born, so that it covers a share of the sea.

        A point counts as covered while its foam is at least half as dense as it can be. Foam is born with
        a strength that rises with the compression; it covers for `duration` s when it was born at full
        strength, shorter otherwise. By Rice (1944) a level is crossed upwards at the mean of the positive
        rates there times the compression's density; rare crossings are independent. It is never below
        LEAST_COMPRESSION, so that a sea without compression has no foam.

        coverage : 0…1
        rises : compressions over the threshold at which the strength is 2^-1 … 2^0, evenly spaced in the
            exponent
        """
        order = np.argsort(self.compression)
        compression, rising = self.compression[order], np.maximum(self.rate[order], 0.0)
        rank = np.arange(_SAMPLES)
        above = 1.0 - (rank + 0.5) / _SAMPLES
        # crossings at each point: the mean over its neighbours, fewer of them towards the rare end
        half = np.maximum(8, (0.2 * _SAMPLES * above).astype(np.int64))
        low, high = (np.clip(rank + sign * half, 0, _SAMPLES - 1) for sign in (-1, 1))
        sums = np.concatenate(([0.0], np.cumsum(rising)))
        crossings = (
            (sums[high + 1] - sums[low]) / _SAMPLES / np.maximum(compression[high] - compression[low], 1e-12)
        )
        candidates = np.linspace(compression[_SAMPLES // 2], compression[-1], 2000)
        levels = candidates[:, np.newaxis] * rises
        now = np.interp(levels[:, 0], compression, above)
        later = np.interp(levels, compression, crossings).mean(axis=1) * duration
        covered = 1.0 - (1.0 - now) * np.exp(-later / np.maximum(1.0 - now, 1e-3))
        enough = np.nonzero(covered >= coverage)[0]
        return max(LEAST_COMPRESSION, float(candidates[enough[-1]] if len(enough) else candidates[0]))


def strain_covariances(
    state: InitialState,
    choppiness: float,
    drift: tuple[float, float],
    rotation: float = 0.0,
    interpolated: bool = False,
) -> tuple[Array, Array]:
    """Covariances (3, 3) of the gradient's xx, yy and xy, and of their rates in 1/s²; those of waves add.

    They are of the waves that the grid resolves, as seen by a point that drifts with (x, y) m/s. The gradient
    of the horizontal displacement is Gaussian with the covariance of its spectrum; so is its rate,
    independent of it, with ω² (ω as the drifting point meets the waves) in the integral.

    rotation : by which the grid is turned against the axes of the drift and of the gradient, rad
    interpolated : whether what is wanted are the strains between the samples, bilinear: the mean square of a
        wave is less there, by (2 + cos kΔ)/3 along each axis
    """
    grid = state.grid
    kx, ky = grid.kx, grid.ky
    if rotation:
        c, s = np.cos(rotation), np.sin(rotation)
        kx, ky = c * grid.kx - s * grid.ky, s * grid.kx + c * grid.ky
    factor = choppiness * state.potential_factor.real.astype(np.float64)
    along = kx * drift[0] + ky * drift[1]
    components = np.stack([np.broadcast_to(c, grid.shape) for c in (kx**2, ky**2, kx * ky)])
    components *= factor
    energy, rates = np.zeros(grid.shape), np.zeros(grid.shape)
    for part in state.parts:
        present = part.expected_plus * grid.multiplicity, part.expected_minus * grid.multiplicity
        frequency = part.omega - along, part.omega + along
        energy += present[0] + present[1]
        rates += present[0] * frequency[0] ** 2 + present[1] * frequency[1] ** 2
    if interpolated:
        spacing = grid.domain_size / grid.resolution
        left = (2.0 + np.cos(grid.kx * spacing)) * (2.0 + np.cos(grid.ky * spacing)) / 9.0
        energy, rates = energy * left, rates * left
    flat = components.reshape(3, -1)
    gradient, change = ((flat * weight.ravel()) @ flat.T for weight in (energy, rates))
    return gradient, change


def sampled_strains(of_gradient: Array, of_rates: Array) -> Strains:
    """Random strains with the covariances that `strain_covariances` gives."""
    gradient, change = (_correlated(c, stream) for c, stream in ((of_gradient, 0), (of_rates, 8)))
    half_difference, shear = 0.5 * (gradient[0] - gradient[1]), gradient[2]
    root = np.hypot(half_difference, shear)
    compression = root - 0.5 * (gradient[0] + gradient[1])
    across = half_difference * 0.5 * (change[0] - change[1]) + shear * change[2]
    rate = across / np.maximum(root, 1e-30) - 0.5 * (change[0] + change[1])
    return Strains(compression, rate)


def _correlated(covariance: Array, stream: int) -> Array:
    """(3, samples) Gaussian numbers with a covariance (3, 3)."""
    values, vectors = np.linalg.eigh(covariance)
    key = np.arange(_SAMPLES, dtype=np.uint64)
    independent = np.stack([random.normal(key, stream + 2 * i) for i in range(3)])
    return vectors @ (np.sqrt(np.maximum(values, 0.0))[:, np.newaxis] * independent)


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
