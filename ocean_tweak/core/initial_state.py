# SPDX-License-Identifier: GPL-3.0-or-later
"""The sea's Fourier coefficients before time enters: random, with the spectrum's energy."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from . import dispersion, random
from .directional_spectrum import DirectionalSpectrum
from .grid import WaveVectorGrid
from .parameters import OceanParameters

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]


@dataclass(frozen=True)
class InitialState:
    """Coefficients of the waves that travel along +k and along -k, for the half plane kx ≥ 0.

    h_plus, h_minus : (N, N//2+1) complex128, m. The elevation's coefficient at time t is
        h_plus·exp(-iωt) + h_minus·exp(+iωt); h_minus(k) is the conjugate of h_plus(-k).
    omega : (N, N//2+1) float64, rad/s
    expected : (N, N//2+1) float64, m²: mean over all seeds of the energy |h_plus|² + |h_minus|²
    """

    grid: WaveVectorGrid
    h_plus: ComplexArray
    h_minus: ComplexArray
    omega: Array
    expected: Array

    @property
    def energy(self) -> Array:
        """(N, N//2+1) m²: this seed's share of the elevation's variance, averaged over time, of each
        mode of the full plane that the half plane stands for; its sum is m0 of the seed."""
        both = np.abs(self.h_plus) ** 2 + np.abs(self.h_minus) ** 2
        return both * self.grid.multiplicity

    @property
    def expected_energy(self) -> Array:
        """(N, N//2+1) m²: the mean of `energy` over all seeds; its sum is m0 resolved by the grid."""
        return self.expected * self.grid.multiplicity


@lru_cache(maxsize=4)
def random_phasors(grid: WaveVectorGrid, seed: int) -> tuple[ComplexArray, ComplexArray]:
    """ν·exp(iε) for k and for -k, (N, N//2+1) each: ν standard normal, ε uniform in [0, 2π).

    Horvath (2015), eq. 47 and § 7.1.2.
    """
    return _phasors(grid.kx, grid.ky, seed), _phasors(-grid.kx, -grid.ky, seed)


def _phasors(kx: Array, ky: Array, seed: int) -> ComplexArray:
    key = random.hash_wave_vectors(kx, ky, seed)
    return random.normal(key, 0) * np.exp(2j * np.pi * random.uniform(key, 2))


def layer_seed(parameters: OceanParameters, index: int) -> int:
    """The seed of one layer: layers of a sea are independent of each other."""
    return random.combine(parameters.seed, index)


def initial_state(parameters: OceanParameters) -> InitialState:
    """Coefficients of all layers together: layers add in the spectrum.

    The amplitude of a cosine is ν√(2ΨΔkxΔky), so its coefficient is half of that (Horvath 2015, eq. 47,
    corrected by this half; Chen 2014, eq. 10 and 18), and the elevation's variance is ΣΨΔkxΔky = m0.
    """
    grid = WaveVectorGrid(parameters.resolution, parameters.domain_size)
    omega = dispersion.angular_frequency(grid.k, parameters.dispersion, parameters.water)
    h_plus = np.zeros(grid.shape, np.complex128)
    h_minus = np.zeros(grid.shape, np.complex128)
    expected = np.zeros(grid.shape)
    for index, layer in enumerate(parameters.layers):
        spectrum = DirectionalSpectrum(layer, parameters.water, parameters.dispersion)
        forward, backward = spectrum.cell_means(grid)
        along, against = random_phasors(grid, layer_seed(parameters, index))
        h_plus += along * np.sqrt(0.5 * grid.cell_area * forward)
        h_minus += np.conj(against) * np.sqrt(0.5 * grid.cell_area * backward)
        expected += 0.5 * grid.cell_area * (forward + backward)
    return InitialState(grid, h_plus, h_minus, omega, expected)
