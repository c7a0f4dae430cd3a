# SPDX-License-Identifier: GPL-3.0-or-later
"""Weights by a noise that moves and changes: gusts.

The noise g is a sum of waves that the domain holds, with random phases: normal, of mean 0 and variance 1. Its
energy Ψ(k) ∝ (k/k₀)² exp(−(k/k₀)²) is largest at k₀ = 2π/size. It moves with U, as k·U turns each wave, and
each turns by a random rate besides, normal with σ = √2/T: what has moved along resembles itself by
exp(−(t/T)²) after a time t. In a loop all rates are whole numbers of turns.

The weight is w = Φ((c g + Φ⁻¹(p)) / √(1 − c²)), Φ being the normal distribution, c the contrast and p the
coverage: its mean is p, for it is the chance that c g and √(1 − c²) times another normal number are together
above −Φ⁻¹(p), and their sum has variance 1.
"""

from __future__ import annotations

import math
from fractions import Fraction
from statistics import NormalDist
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..numerics.grid import WaveVectorGrid
from ..numerics.interpolation import spline_read, spline_slopes, spline_weights
from ..numerics.memo import MEMO, remembered
from ..numerics.random import hash_wave_vectors, normal, uniform
from .parameters import Mask

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

#: samples of a noise between one gust and the next; waves up to three times k₀ have 4 each, and those beyond
#: a thousandth of the energy
_SAMPLES_A_GUST = 12.0
_HIGHEST = 3.0
_FEWEST = 16

# Φ(x) for x ≥ 0 is 1 − φ(x) t (b₁ + b₂ t + …), t = 1/(1 + p x), to 7.5e-8: Zelen & Severo in Abramowitz &
# Stegun (1964), eq. 26.2.17
_P = 0.2316419
_B = (0.319381530, -0.356563782, 1.781477937, -1.821255978, 1.330274429)


# of another time they are others
MEMO.limit("noises of masks at a time", 64)


class SeaTime(NamedTuple):
    """A moment of a sea.

    time : s
    loop_duration : s after which all is as before; None for never
    """

    time: float | Fraction = 0.0
    loop_duration: Fraction | None = None


#: what is asked of masks that do not move
ANY_TIME = SeaTime()


class _Samples(NamedTuple):
    """Of a noise at a time, (samples, samples): itself, and its change in 1/s."""

    now: Array
    rate: Array

    @property
    def nbytes(self) -> int:
        return self.now.nbytes + self.rate.nbytes


class _Waves(NamedTuple):
    """Of a noise at time 0, over the half plane of a grid: coefficients, and rad/s at which each turns."""

    coefficients: ComplexArray
    rates: Array

    @property
    def nbytes(self) -> int:
        return self.coefficients.nbytes + self.rates.nbytes


def by_noise(
    mask: Mask, domain_size: float, x: Array, y: Array, when: SeaTime
) -> tuple[Array, Array, Array, Array]:
    """Weights at rest positions in m, and their derivatives by x, y and time."""
    noise, by_x, by_y, by_t = _noise(mask, domain_size, x, y, when)
    contrast = mask.noise_contrast
    left = math.sqrt(1.0 - contrast * contrast)
    value, density = normal_distribution(
        (contrast * noise + NormalDist().inv_cdf(mask.noise_coverage)) / left
    )
    slope = density * (contrast / left)
    return value, slope * by_x, slope * by_y, slope * by_t


def _noise(
    mask: Mask, domain_size: float, x: Array, y: Array, when: SeaTime
) -> tuple[Array, Array, Array, Array]:
    """The noise and its derivatives: by the quadratic B-spline that goes through its samples."""
    gusts = domain_size / mask.noise_size
    samples = max(_FEWEST, 2 ** math.ceil(math.log2(_SAMPLES_A_GUST * gusts)))
    now, rate = _sampled(mask, domain_size, samples, when)
    column, row = (place / domain_size * samples for place in (x, y))
    per_metre = samples / domain_size
    if x.ndim == 1 and y.ndim == 2:  # of a grid: row by row first, of which there are fewer samples
        (j, along_x), (i, along_y) = spline_weights(column), spline_weights(row)
        slope_x, slope_y = spline_slopes(column), spline_slopes(row)
        i, j = i[..., 0] % samples, j % samples
        rows = [_sum(part[i], weight) for part, weight in ((now, along_y), (now, slope_y), (rate, along_y))]
        value, by_y, by_t = (_sum_columns(part, j, along_x) for part in rows)
        by_x = _sum_columns(rows[0], j, slope_x)
    else:
        value, by_y, by_x, by_t = spline_read(now, row, column, rate)
    return value, by_x * per_metre, by_y * per_metre, by_t


def _sum(rows: Array, weights: Array) -> Array:
    """(rows, samples) of (3, rows, samples) with (3, rows, 1) weights."""
    return np.asarray(rows[0] * weights[0] + rows[1] * weights[1] + rows[2] * weights[2])


def _sum_columns(rows: Array, j: NDArray[np.intp], weights: Array) -> Array:
    """(rows, columns) of (rows, samples), with the (3, columns) samples around each and their weights."""
    total = rows[:, j[0]] * weights[0]
    for a in (1, 2):
        total += rows[:, j[a]] * weights[a]
    return np.asarray(total)


@remembered("noises of masks at a time")
def _sampled(mask: Mask, domain_size: float, samples: int, when: SeaTime) -> _Samples:
    waves = _waves(mask, domain_size, samples, when.loop_duration)
    moved = waves.coefficients * np.exp(-1j * _turned(waves.rates, when))
    return _Samples(*(np.fft.irfft2(each, norm="forward") for each in (moved, -1j * waves.rates * moved)))


@remembered("noises of masks")
def _waves(mask: Mask, domain_size: float, samples: int, loop: Fraction | None) -> _Waves:
    grid = WaveVectorGrid(samples, domain_size)
    kx, ky, k = grid.kx, grid.ky, grid.k
    ratio = k * (mask.noise_size / (2.0 * np.pi))
    # of two waves that are each other's mirror image along the axis the half plane holds both: one is enough
    held = grid.usable & (ratio <= _HIGHEST) & ((kx > 0.0) | (ky > 0.0))
    # relative to the largest, or a gust as large as the domain would have none
    exponent = np.log(np.maximum(ratio, 1e-12) ** 2) - ratio**2
    energy = np.where(held, np.exp(exponent - float(np.max(exponent[held]))), 0.0)
    amplitude = np.sqrt(2.0 * energy / energy.sum())
    # the halves of a wave at k and −k; the column without a mirror image has both in one
    amplitude = amplitude * np.where(kx > 0.0, 0.5, 1.0)
    key = hash_wave_vectors(kx, ky, mask.noise_seed)
    coefficients = amplitude * np.exp(2j * np.pi * uniform(key, 0))
    # a quadratic B-spline through samples: at each it counts 3/4 of that and 1/8 of its neighbours
    step = domain_size / samples
    coefficients /= (0.75 + 0.25 * np.cos(kx * step)) * (0.75 + 0.25 * np.cos(ky * step))
    along = kx * math.cos(mask.noise_direction) + ky * math.sin(mask.noise_direction)
    rates = mask.noise_speed * along
    if mask.noise_evolution > 0.0:
        rates = rates + math.sqrt(2.0) / mask.noise_evolution * normal(key, 1)
    if loop is not None:
        fundamental = 2.0 * np.pi / float(loop)
        rates = fundamental * np.rint(rates / fundamental)
    return _Waves(coefficients, np.where(held, rates, 0.0))


def _turned(rates: Array, when: SeaTime) -> Array:
    """By how much each wave has turned, rad; after a loop exactly by nothing."""
    if when.loop_duration is None:
        return rates * float(when.time)
    turns = np.rint(rates * (float(when.loop_duration) / (2.0 * np.pi)))
    share = float(Fraction(when.time) % when.loop_duration / when.loop_duration)
    return 2.0 * np.pi * (turns * share % 1.0)


def normal_distribution(x: Array) -> tuple[Array, Array]:
    """The normal distribution Φ, and its density φ."""
    density = np.exp(-0.5 * x * x) / math.sqrt(2.0 * math.pi)
    t = 1.0 / (1.0 + _P * np.abs(x))
    tail = np.zeros_like(x)
    for factor in reversed(_B):
        tail = (tail + factor) * t
    tail *= density
    return np.where(x < 0.0, tail, 1.0 - tail), density
