# SPDX-License-Identifier: GPL-3.0-or-later
"""Mask weights by a noise that moves and evolves: gusts.

The noise g is a sum of the domain's Fourier modes with random phases: Gaussian, with mean 0 and variance 1.
Its energy Ψ(k) ∝ (k/k₀)² exp(−(k/k₀)²) is largest at k₀ = 2π/size. It travels at the velocity U, by the rate
k·U of each mode's phase, to which a random rate is added, Gaussian with σ = √2/T: in the moving frame the
autocorrelation after a time t is exp(−(t/T)²). In a loop all rates are integer numbers of turns.

The weight is w = Φ((c g + Φ⁻¹(p)) / √(1 − c²)), with Φ the normal distribution function, c the contrast and p
the coverage. Its mean is p: w is the probability that c g plus √(1 − c²) times an independent normal number
exceeds −Φ⁻¹(p), and that sum has variance 1.
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

#: samples from one gust to the next; modes up to three times k₀ have at least 4, and those beyond hold a
# thousandth of the energy
_SAMPLES_A_GUST = 12.0
_HIGHEST = 3.0
_FEWEST = 16

# Φ(x) for x ≥ 0 is 1 − φ(x) t (b₁ + b₂ t + …), t = 1/(1 + p x), to 7.5e-8: Zelen & Severo in Abramowitz &
# Stegun (1964), eq. 26.2.17
_P = 0.2316419
_B = (0.319381530, -0.356563782, 1.781477937, -1.821255978, 1.330274429)


# at another time the weights differ
MEMO.limit("noises of masks at a time", 64)


class SeaTime(NamedTuple):
    """A moment of a sea.

    time : s
    loop_duration : period of the loop, s; None without a loop
    """

    time: float | Fraction = 0.0
    loop_duration: Fraction | None = None


#: used for masks that do not move
ANY_TIME = SeaTime()


class _Samples(NamedTuple):
    """Samples of a noise at one time, (samples, samples): its value and its time derivative in 1/s."""

    now: Array
    rate: Array

    @property
    def nbytes(self) -> int:
        return self.now.nbytes + self.rate.nbytes


class _Waves(NamedTuple):
    """Modes of a noise over the half plane of a grid: coefficients at time 0, and angular frequencies in
    rad/s."""

    coefficients: ComplexArray
    rates: Array

    @property
    def nbytes(self) -> int:
        return self.coefficients.nbytes + self.rates.nbytes


def by_noise(
    mask: Mask, domain_size: float, x: Array, y: Array, when: SeaTime
) -> tuple[Array, Array, Array, Array]:
    """Weights at rest positions in m, and their derivatives with respect to x, y and time."""
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
    """The noise and its derivatives, by an interpolating quadratic B-spline."""
    gusts = domain_size / mask.noise_size
    samples = max(_FEWEST, 2 ** math.ceil(math.log2(_SAMPLES_A_GUST * gusts)))
    now, rate = _sampled(mask, domain_size, samples, when)
    column, row = (place / domain_size * samples for place in (x, y))
    per_metre = samples / domain_size
    if x.ndim == 1 and y.ndim == 2:  # for a grid, interpolate across rows first, of which there are fewer
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
    """Weighted sum (rows, samples) of (3, rows, samples) with (3, rows, 1) weights."""
    return np.asarray(rows[0] * weights[0] + rows[1] * weights[1] + rows[2] * weights[2])


def _sum_columns(rows: Array, j: NDArray[np.intp], weights: Array) -> Array:
    """Weighted sum (rows, columns) of (rows, samples), from the (3, columns) neighbours and their weights."""
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
    # on the axis, the half plane holds both of each pair of conjugate modes: one is enough
    held = grid.usable & (ratio <= _HIGHEST) & ((kx > 0.0) | (ky > 0.0))
    # relative to the largest, as otherwise a gust as large as the domain would have no energy
    exponent = np.log(np.maximum(ratio, 1e-12) ** 2) - ratio**2
    energy = np.where(held, np.exp(exponent - float(np.max(exponent[held]))), 0.0)
    amplitude = np.sqrt(2.0 * energy / energy.sum())
    # amplitudes are halved for k and −k, except in the column that has no mirror image
    amplitude = amplitude * np.where(kx > 0.0, 0.5, 1.0)
    key = hash_wave_vectors(kx, ky, mask.noise_seed)
    coefficients = amplitude * np.exp(2j * np.pi * uniform(key, 0))
    # prefilter, so that the B-spline interpolates: it weights a sample by 3/4 and either neighbour by 1/8
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
    """Phase of each mode at a time, rad; exactly 0 after a loop."""
    if when.loop_duration is None:
        return rates * float(when.time)
    turns = np.rint(rates * (float(when.loop_duration) / (2.0 * np.pi)))
    share = float(Fraction(when.time) % when.loop_duration / when.loop_duration)
    return 2.0 * np.pi * (turns * share % 1.0)


def normal_distribution(x: Array) -> tuple[Array, Array]:
    """The normal distribution function Φ, and its density φ."""
    density = np.exp(-0.5 * x * x) / math.sqrt(2.0 * math.pi)
    t = 1.0 / (1.0 + _P * np.abs(x))
    tail = np.zeros_like(x)
    for factor in reversed(_B):
        tail = (tail + factor) * t
    tail *= density
    return np.where(x < 0.0, tail, 1.0 - tail), density
