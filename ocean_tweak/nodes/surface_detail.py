# SPDX-License-Identifier: GPL-3.0-or-later
"""Patterns for what no grid holds: ripples, the lace and billows of foam, and gusts.

All are square, repeat and are of unit size: a shader gives them their length in metres and their strength.
"""

from __future__ import annotations

from statistics import NormalDist

import numpy as np
from numpy.typing import NDArray

from ..core.numerics import random

Array = NDArray[np.float64]

#: the wavelengths of the ripples as waves in the pattern; all have the same slope variance per octave
FEWEST_WAVES, MOST_WAVES = 8, 128

#: cells of the foam's lace along a side, and the weight of each number of cells
LACE_CELLS = 11
_LACE = ((LACE_CELLS, 1.0), (29, 0.3))
#: logarithm of how much larger than the mean a cell can be, and how many cells far it then reaches
_SIZES = 0.9
_REACH = 2
#: cells of billows along a side, from large to small: a dome is as high as its cell is wide
BILLOW_CELLS = 6
_BILLOWS = (BILLOW_CELLS, 13, 29, 65)
#: logarithm of how much larger than the mean a dome can be
_DOMES = 0.6
#: how far domes are from round, as a share of the side
_ROUND = 0.008
#: how far the water has carried the walls, as a share of the side, and how uneven the foam lies on them
_CARRIED, _UNEVEN = 0.035, 0.04


def ripple_slopes(resolution: int, seed: int = 0) -> Array:
    """(2, N, N) slopes along x and y of waves that run along +x, with a mean square of 1 together.

    Ψ ~ k⁻⁴ cos²θ: the equilibrium range (Phillips 1958), in which every octave has the same slopes.
    """
    index = np.fft.fftfreq(resolution, 1.0 / resolution)
    kx, ky = index[: resolution // 2 + 1], index[:, np.newaxis]
    k = np.hypot(kx, ky)
    band = (k >= FEWEST_WAVES) & (k <= min(MOST_WAVES, resolution // 2 - 1))
    amplitude = np.where(band, np.maximum(kx, 0.0) / np.maximum(k, 1.0) ** 3, 0.0)
    elevation = amplitude * np.exp(2j * np.pi * _uniform(kx, ky, seed))
    slopes = np.stack([np.fft.irfft2(1j * part * elevation, s=k.shape[:1] * 2) for part in (kx, ky)])
    return slopes / np.sqrt(np.mean(np.sum(slopes**2, axis=0)))


def foam_lace(resolution: int, seed: int = 1) -> Array:
    """(N, N), normally distributed: a share F of foam covers where this is below the normal quantile of F.

    The walls between cells of many sizes are covered first, as in foam that thins out; eddies have drawn them
    into curves, so that no cell is round.
    """
    place = (np.arange(resolution) + 0.5) / resolution
    x, y = np.meshgrid(place, place)
    moved_x, moved_y = (_CARRIED * _smooth_noise(resolution, seed + number) for number in (39, 40))
    height = _UNEVEN * _smooth_noise(resolution, seed + 12)
    for number, (cells, weight) in enumerate(_LACE):
        height += weight * _wall_distance(x + moved_x, y + moved_y, cells, seed + number)
    return normal(height)


def billows(resolution: int, seed: int = 3) -> Array:
    """(N, N) heights, in sides of the pattern, of domes on domes with creases between them, as foam piles up.

    The upper envelope of paraboloids around the points of Worley (1996), on every size of cells.
    """
    place = (np.arange(resolution) + 0.5) / resolution
    x, y = np.meshgrid(place, place)
    moved_x, moved_y = (_ROUND * _smooth_noise(resolution, seed + number) for number in (39, 40))
    height = np.zeros((resolution, resolution))
    for number, cells in enumerate(_BILLOWS):
        distance, _ = _distances(x + moved_x, y + moved_y, cells, seed + number, _DOMES)
        height -= distance**2 / cells
    return height - np.mean(height)


def normal(field: Array) -> Array:
    """The field with its values normally distributed, in the same order."""
    return _normal_quantile(_evened(field))


def gradient(field: Array) -> Array:
    """(2, N, N): how a periodic field changes along x and y over a whole side, by central differences."""
    steps = [np.roll(field, -1, axis) - np.roll(field, 1, axis) for axis in (1, 0)]
    return np.stack(steps) * 0.5 * len(field)


def spline_weights(field: Array) -> Array:
    """(N, N): what a periodic cubic B-spline must weigh, to have the field's values on the samples.

    A B-spline mixes a sample with its neighbours by 1/6, 2/3, 1/6 along each axis (Unser 1999).
    """
    angle = 2.0 * np.pi * np.fft.fftfreq(len(field))
    mixed = (2.0 + np.cos(angle)) / 3.0
    modes = np.fft.rfft2(field) / (mixed[:, np.newaxis] * mixed[: len(field) // 2 + 1])
    return np.asarray(np.fft.irfft2(modes, s=field.shape))


def gusts(resolution: int, seed: int = 2) -> Array:
    """(N, N) in 0…1, evenly distributed: smooth bumps of an eighth to a third of the pattern."""
    return _evened(_smooth_noise(resolution, seed))


def _evened(field: Array) -> Array:
    """Each value's rank, 0…1."""
    order = np.empty(field.size)
    order[np.argsort(field, axis=None, kind="stable")] = np.arange(field.size) + 0.5
    return order.reshape(field.shape) / field.size


def _normal_quantile(share: Array) -> Array:
    """Of shares between 0 and 1; exact at a thousand of them, which are dense at both ends."""
    value = np.linspace(-5.0, 5.0, 1001)
    normal = NormalDist()
    return np.interp(share, [normal.cdf(each) for each in value], value)


def _wall_distance(x: Array, y: Array, cells: int, seed: int) -> Array:
    """How far from the wall to the next cell a point is, about 0…1.

    A periodic pattern of Worley (1996), in which each cell measures distances by a size of its own: so walls
    are arcs of circles (Apollonius), and cells small and large.
    """
    nearest, next_nearest = _distances(x, y, cells, seed, _SIZES)
    return np.asarray(next_nearest - nearest)


def _distances(x: Array, y: Array, cells: int, seed: int, uneven: float) -> tuple[Array, Array]:
    """To the nearest and the next nearest point, in cells, each over its own size.

    uneven : logarithm of how much larger than the mean a size can be
    """
    column, row = np.floor(x * cells), np.floor(y * cells)
    nearest, next_nearest = (np.full(x.shape, np.inf) for _ in range(2))
    reach = range(-_REACH, _REACH + 1)
    corner = np.arange(float(cells))
    draws = [_uniform(corner, corner[:, np.newaxis], seed, stream) for stream in range(3)]
    sizes = np.exp(uneven * (2.0 * draws[2] - 1.0))
    for shift_y in reach:
        for shift_x in reach:
            of_x, of_y = column + shift_x, row + shift_y
            corner_x, corner_y = (np.mod(of, cells).astype(np.int64) for of in (of_x, of_y))
            point_x = of_x + draws[0][corner_y, corner_x]
            point_y = of_y + draws[1][corner_y, corner_x]
            distance = np.hypot(x * cells - point_x, y * cells - point_y) / sizes[corner_y, corner_x]
            next_nearest = np.minimum(next_nearest, np.maximum(nearest, distance))
            nearest = np.minimum(nearest, distance)
    return nearest, next_nearest


def _smooth_noise(resolution: int, seed: int) -> Array:
    """(N, N) random bumps of an eighth to a third of the pattern, with a mean square of 1."""
    index = np.fft.fftfreq(resolution, 1.0 / resolution)
    kx, ky = index[: resolution // 2 + 1], index[:, np.newaxis]
    k = np.hypot(kx, ky)
    modes = np.where((k >= 3.0) & (k <= 8.0), np.exp(2j * np.pi * _uniform(kx, ky, seed)) / k.clip(1.0), 0.0)
    noise = np.fft.irfft2(modes, s=k.shape[:1] * 2)
    return np.asarray(noise / np.sqrt(np.mean(noise**2)))


def _uniform(x: Array, y: Array, seed: int, stream: int = 0) -> Array:
    # not a wave vector here, but a cell's or a mode's two whole numbers
    x, y = np.broadcast_arrays(np.asarray(x, np.float64), np.asarray(y, np.float64))
    return random.uniform(random.hash_wave_vectors(x, y, seed), stream)
