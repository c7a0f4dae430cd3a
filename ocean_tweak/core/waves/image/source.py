# SPDX-License-Identifier: GPL-3.0-or-later
"""The image behind the waves, and its Fourier coefficients."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

import numpy as np
from numpy.typing import NDArray

from ...data.raster import Raster
from ...numerics import random
from ...numerics.memo import remembered

if TYPE_CHECKING:
    from .parameters import ImageLayer

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
_Modes = TypeVar("_Modes", NDArray[np.complex128], NDArray[np.float64])

#: the noise lies this far around its mean, evenly, in whole grey levels
NOISE_REACH, NOISE_MEAN = 127, 128

#: samples a side of what larger images are resampled to
LARGEST_SIDE = 2048


def white_noise(resolution: int, seed: int) -> Array:
    """(N, N) integer grey levels from 1 to 255, uniform and independent, with the mean 128 subtracted: -127 …
    127.

    Mastin, Watterberg & Mareda (1987), fig. 5.
    """
    place = np.arange(resolution, dtype=np.float64)  # not wave vectors here, but a sample's whole numbers
    share = random.uniform(random.hash_wave_vectors(place, place[:, np.newaxis], seed), 0)
    levels = 2 * NOISE_REACH + 1
    return np.minimum(np.floor(levels * share), levels - 1.0) - NOISE_REACH + NOISE_MEAN


def noise_variance() -> float:
    """Variance of the distribution of the white noise's grey levels."""
    return ((2 * NOISE_REACH + 1) ** 2 - 1) / 12.0


@remembered("noise")
def noise_coefficients(resolution: int, seed: int) -> ComplexArray:
    """(N, N//2+1) of the white noise without its mean, over its standard deviation; read-only."""
    noise = white_noise(resolution, seed) / np.sqrt(noise_variance())
    return _frozen(_transformed(noise, resolution))


@remembered("images")
def image_coefficients(image: Raster) -> ComplexArray:
    """(S, S//2+1) of an image without its mean, S even and at least its longer side; read-only.

    The image counts as periodic and is stretched to a square, band-limited: its first sample stays the
    first, and what is finer than S/2 waves a side is left out.
    """
    return _frozen(_transformed(image.values[..., 0].astype(np.float64), _image_side(image)))


def side(layer: ImageLayer) -> int:
    """Samples along each side of a layer's source image or noise."""
    return layer.noise_resolution if layer.image is None else _image_side(layer.image)


def _image_side(image: Raster) -> int:
    longest = max(image.shape[:2])
    return min(LARGEST_SIDE, longest + longest % 2)


def fitted(coefficients: _Modes, resolution: int) -> _Modes:
    """(N, N//2+1) of the same modes on a grid with more or fewer samples; those at Nyquist are 0."""
    side = len(coefficients)
    return coefficients if side == resolution else _placed(coefficients, (side, side), resolution)


def _transformed(values: Array, resolution: int) -> ComplexArray:
    """Coefficients c of Σ c exp(2πi(jx + iy)), x and y from 0 to 1: Σ|c|² is the variance."""
    coefficients = np.fft.rfft2(values - np.mean(values)) / values.size
    return _placed(coefficients, values.shape, resolution)


def _placed(coefficients: _Modes, shape: tuple[int, ...], resolution: int) -> _Modes:
    """Coefficients of samples of any shape moved to a square grid: the modes below Nyquist of both."""
    result = np.zeros((resolution, resolution // 2 + 1), coefficients.dtype)
    rows, columns = ((min(size, resolution) + 1) // 2 for size in shape)  # modes from 0 on, without Nyquist
    result[:rows, :columns] = coefficients[:rows, :columns]
    if rows > 1:
        result[1 - rows :, :columns] = coefficients[1 - rows :, :columns]
    result[0, 0] = 0.0
    return result


def _frozen(array: ComplexArray) -> ComplexArray:
    array.flags.writeable = False
    return array
