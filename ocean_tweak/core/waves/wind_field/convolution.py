# SPDX-License-Identifier: GPL-3.0-or-later
"""Fourier coefficients of many particles at once: points on the grid, times the transform of their shape.

A particle becomes nine samples of a quadratic B-spline, whose width, unlike that of a bilinear deposit, does
not depend on its position between the samples; dividing by the spline's transform gives the bump shifted by
spline interpolation, exact where the particle coincides with a sample.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...numerics.grid import WaveVectorGrid
from ...numerics.interpolation import spline_weights
from ...numerics.memo import remembered
from .shape import bump

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complexfloating]

#: particles deposited at a time
_CHUNK = 2**17

#: NumPy before 2.0 transforms in double precision only, and not in place
_IN_PLACE = int(np.__version__.partition(".")[0]) >= 2

#: rows transformed at a time
_ROWS = 32


@dataclass(frozen=True)
class Kernel:
    """The transform of a bump for kx and ky from 0 to N/2, (N//2+1, N//2+1) indexed [kx, ky].

    Both are complex, as each product with coefficients would otherwise convert them.

    height : for z; real, even in kx and ky, without the mean
    sideways : for x; imaginary, odd in kx, even in ky. The one for y is its transpose
    """

    height: ComplexArray
    sideways: ComplexArray

    @property
    def nbytes(self) -> int:
        """Bytes of both."""
        return self.height.nbytes + self.sideways.nbytes

    def columns(self, component: int, block: slice, grid: WaveVectorGrid) -> ComplexArray:
        """(columns, N) transform of x, y or z, for all ky in FFT order."""
        if component == 1:
            full = grid.mirror(self.sideways.T[block])
            np.negative(full[:, grid.resolution // 2 + 1 :], out=full[:, grid.resolution // 2 + 1 :])
            return full
        return grid.mirror((self.height if component == 2 else self.sideways)[block])


@remembered("particle shapes")
def kernel(grid: WaveVectorGrid, radius: float, dtype: type) -> Kernel:
    """The transform of a bump of a radius in m, sampled on the grid, in complex64 or complex128."""
    n = grid.resolution
    reach = min(int(np.ceil(radius * n / grid.domain_size)), n // 2)
    index = np.arange(-reach, reach + (2 * reach < n))
    offset: Array = index.astype(np.float64) * (grid.domain_size / n)
    shape = bump(offset[np.newaxis, :], offset[:, np.newaxis], radius).position
    half = n // 2 + 1
    spline = (3.0 + np.cos(2.0 * np.pi * np.arange(half) / n)) / 4.0
    parts = []
    values = np.zeros((n, n))
    for component in (2, 0):
        values[np.ix_(index % n, index % n)] = shape[..., component]
        transform = np.fft.rfft2(values)[:half].T / (spline[:, np.newaxis] * spline)
        transform[-1, :] = transform[:, -1] = 0.0  # modes at Nyquist are zero
        parts.append(transform)
    height, sideways = parts
    height[0, 0] = 0.0
    # by symmetry one is real and the other imaginary, except for rounding
    return Kernel(np.ascontiguousarray(height.real, dtype), np.ascontiguousarray(1j * sideways.imag, dtype))


def deposit(x: Array, y: Array, weights: Sequence[Array], grid: WaveVectorGrid) -> list[Array]:
    """(N, N) float64 [y, x] grids, one for each weight, onto which particles at places in m are deposited.

    Sums are in the order of the particles, so they are the same bit for bit on any machine.
    """
    n = grid.resolution
    sums: list[Array] = []
    for first in range(0, len(x), _CHUNK):
        chunk = slice(first, first + _CHUNK)
        columns, along = _spline(x[chunk], n, grid.domain_size)
        rows, up = _spline(y[chunk], n, grid.domain_size)
        cells = (rows[:, np.newaxis] * n + columns).ravel()
        shares = up[:, np.newaxis] * along
        parts = [np.bincount(cells, (shares * weight[chunk]).ravel(), minlength=n * n) for weight in weights]
        for total, part in zip(sums, parts, strict=False):
            total += part
        sums = sums or parts
    return [total.reshape(n, n) for total in sums]


def _spline(places: Array, n: int, domain_size: float) -> tuple[NDArray[np.intp], Array]:
    """The three samples around each place, (3, places), and their quadratic B-spline weights."""
    samples, weight = spline_weights(places * (n / domain_size))
    return samples % n, weight


class Points(NamedTuple):
    """Particles of one radius on the grid, transformed along x: (N, N//2+1) each.

    amplitude : m; None if only rates are needed
    rates : time derivative of the amplitude, and amplitude times velocity along x and along y; None if not
        needed
    """

    kernel: Kernel
    amplitude: ComplexArray | None
    rates: tuple[ComplexArray, ComplexArray, ComplexArray] | None

    def coefficients(self, rate: bool, block: slice, grid: WaveVectorGrid) -> ComplexArray:
        """(columns, N) transform of the points, or of their time derivative, for some columns kx.

        A bump changes by its height and by its motion: dP/dt = (da/dt)·W - a·C·∇W.
        """
        if rate and self.rates is not None:
            growing, along, up = (_transposed(part, block) for part in self.rates)
            kx, ky = grid.kx[0, block, np.newaxis], grid.ky[:, 0]
            growing -= (1j * kx).astype(along.dtype) * along
            result = _along_y(growing)
            result -= (1j * ky).astype(along.dtype) * _along_y(up)
        elif not rate and self.amplitude is not None:
            result = _along_y(_transposed(self.amplitude, block))
        else:
            raise ValueError("only what was asked for is there")
        dtype = (self.amplitude if self.rates is None else self.rates[0]).dtype  # type: ignore[union-attr]
        return result.astype(dtype, copy=False)


def _along_y(columns: ComplexArray) -> ComplexArray:
    """Transform along the last axis, in place if NumPy can."""
    return np.fft.fft(columns, axis=-1, out=columns) if _IN_PLACE else np.fft.fft(columns, axis=-1)


def _transposed(values: ComplexArray, block: slice) -> ComplexArray:
    return np.ascontiguousarray(values[:, block].T)


def along_x(values: Array, dtype: type) -> ComplexArray:
    """(N, N//2+1) transform along x of an (N, N) grid, in complex64 or complex128."""
    real = np.float32 if dtype is np.complex64 else np.float64
    rows, n = values.shape
    result: ComplexArray = np.empty((rows, n // 2 + 1), dtype)
    for first in range(0, rows, _ROWS):  # few enough to stay in a cache
        block = slice(first, first + _ROWS)
        if _IN_PLACE:
            np.fft.rfft(values[block].astype(real), axis=-1, out=result[block])
        else:
            result[block] = np.fft.rfft(values[block], axis=-1)
    return result
