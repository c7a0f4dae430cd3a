# SPDX-License-Identifier: GPL-3.0-or-later
"""From Fourier coefficients at one time to positions and their derivatives over the patch.

The position of the sample that rests at (x, y, 0) is (x, y, 0) + P with P = (λDx, λDy, h) and
D(k) = +i (k/|k|) ĥ: the transform of Chen (2014), eq. 11, with which points move towards the crests and
sharpen them for λ > 0 (Tessendorf's and Lantz's -i flattens them).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .grid import WaveVectorGrid
from .parameters import OceanParameters
from .propagation import PropagatedState
from .trough_damping import TroughDamping

RealArray = NDArray[np.floating]
ComplexArray = NDArray[np.complexfloating]

X, Y, Z = 0, 1, 2


def inverse_transform(coefficients: ComplexArray) -> RealArray:
    """(N, N) real field Σ ĥ(k) exp(ik·x) of a half plane of coefficients, in their precision.

    NumPy before 2.0 transforms in double precision only; the result is rounded back.
    """
    n = coefficients.shape[0]
    field: RealArray = np.fft.irfft2(coefficients, s=(n, n))
    field = field.astype(np.float32 if coefficients.dtype == np.complex64 else np.float64, copy=False)
    field *= n * n
    return field


class Synthesis:
    """Fields of one time, each transformed once, when it is first needed."""

    def __init__(
        self,
        state: PropagatedState,
        grid: WaveVectorGrid,
        parameters: OceanParameters,
        damping: TroughDamping | None = None,
    ) -> None:
        self._state = state
        self._grid = grid
        self._damping = damping
        self._dtype = state.elevation.dtype.type
        self._horizontal = _horizontal_factors(grid, parameters)
        self._transformed: dict[tuple[int, str, bool], RealArray] = {}

    def position(self, component: int, derivative: str = "") -> RealArray:
        """(N, N) P[component] in m or its derivative by "x", "y" (m/m) or "t" (m/s)."""
        everything = self._transform(component, derivative)
        if self._damping is None:
            return everything
        long_waves = self._transform(component, derivative, long=True)
        weight, slope = self._damping.weight(self._transform(Z, "", long=True))
        result = long_waves + weight * (everything - long_waves)
        if derivative:
            short = self._transform(component, "") - self._transform(component, "", long=True)
            result += slope * self._transform(Z, derivative, long=True) * short
        return result

    def _transform(self, component: int, derivative: str, long: bool = False) -> RealArray:
        key = (component, derivative, long)
        if key not in self._transformed:
            self._transformed[key] = inverse_transform(self._coefficients(*key))
        return self._transformed[key]

    def _coefficients(self, component: int, derivative: str, long: bool) -> ComplexArray:
        source = self._state.rate if derivative == "t" else self._state.elevation
        if source is None:
            raise ValueError("the state was propagated without its rate, so there is no velocity")
        factor: ArrayLike = self._horizontal[component] if component != Z else 1.0
        if derivative == "x":
            factor = np.multiply(factor, 1j * self._grid.kx)
        elif derivative == "y":
            factor = np.multiply(factor, 1j * self._grid.ky)
        if long and self._damping is not None:
            factor = np.multiply(factor, self._damping.long_waves)
        return source * np.asarray(factor, dtype=self._dtype)


def _horizontal_factors(
    grid: WaveVectorGrid, parameters: OceanParameters
) -> tuple[ComplexArray, ComplexArray]:
    """iλ kx/k and iλ ky/k, (N, N//2+1): elevation to horizontal displacement.

    In finite depth the water's orbits are wider by coth kh (linear theory, Airy) where `orbits` asks for it.
    """
    k = np.where(grid.k > 0.0, grid.k, 1.0)
    factor = 1j * parameters.choppiness / k
    if parameters.orbits == "FINITE_DEPTH":
        factor = factor / np.tanh(k * parameters.water.depth)
    return factor * grid.kx, factor * grid.ky
