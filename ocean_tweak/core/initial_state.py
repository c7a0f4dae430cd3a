# SPDX-License-Identifier: GPL-3.0-or-later
"""The sea's Fourier coefficients before time enters: random, with the spectrum's energy."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from . import dispersion, random
from .directional_spectrum import DirectionalSpectrum
from .grid import WaveVectorGrid
from .memo import remembered, total_bytes
from .parameters import OceanParameters, WaveLayer
from .waves.hero.group import add_hero_wave
from .waves.image.state import PictureWaves, picture_waves

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]
ComplexArray = NDArray[np.complexfloating]

_NORMAL, _PHASE = 0, 2  # streams of a wave vector's random numbers; a normal number takes two


@dataclass(frozen=True)
class InitialState:
    """Coefficients of the waves that travel along +k and along -k, for the half plane kx ≥ 0.

    All arrays are (N, N//2+1), indexed [ky, kx]. Those of `initial_state` are transposed in memory (their
    `.T` is contiguous), which is how the transforms read them.

    h_plus, h_minus : complex, m. The elevation's coefficient at time t is
        h_plus·exp(-iωt) + h_minus·exp(+iωt); h_minus(k) is the conjugate of h_plus(-k).
    omega : float64, rad/s; in a loop a multiple of 2π/T
    expected_plus, expected_minus : real, m²: means over all seeds of |h_plus|² and |h_minus|²,
        without the hero waves, which no seed changes
    loop_duration : T in s, or None
    orbit_depth : depth in m that widens the water's orbits; infinite for those of deep water
    mirrored : whether ω is even in ky, which halves the work; where it is not, it still is even in k
    others : states on the same grid whose waves add to these, with frequencies of their own
    """

    grid: WaveVectorGrid
    h_plus: ComplexArray
    h_minus: ComplexArray
    omega: Array
    expected_plus: RealArray
    expected_minus: RealArray
    loop_duration: Fraction | None = None
    orbit_depth: float = float("inf")
    mirrored: bool = True
    others: tuple[InitialState, ...] = ()

    @property
    def parts(self) -> tuple[InitialState, ...]:
        """All of a sea's states, each with frequencies of its own."""
        return self, *self.others

    @property
    def nbytes(self) -> int:
        """Bytes of all arrays, with those of the other states."""
        own = (self.h_plus, self.h_minus, self.omega, self.expected_plus, self.expected_minus)
        factor = vars(self).get("potential_factor")
        return total_bytes((*own, factor, *self.others))

    @cached_property
    def potential_factor(self) -> ComplexArray:
        """1/k, (N, N//2+1) m, complex: from the elevation to the potential of the horizontal displacement.

        In finite depth orbits are wider by coth kh (linear theory, Airy).
        """
        grid = self.grid
        result = np.empty(grid.shape[::-1], self.h_plus.dtype)  # complex, or each product would convert it
        for columns in grid.column_blocks():
            k = np.hypot(grid.kx[0, columns, np.newaxis], grid.ky[: grid.resolution // 2 + 1, 0])
            k = np.maximum(k, 0.5 * grid.spacing)  # the mean, which is no wave
            result[columns] = grid.mirror(1.0 / (k * np.tanh(k * self.orbit_depth)))
        return result.T


@remembered("random phases")
def random_phasors(
    grid: WaveVectorGrid, seed: int, amplitudes: str, dtype: type = np.complex128
) -> ComplexArray:
    """ν·exp(iε) for k and for -k, (2, N, N//2+1): ε uniform in [0, 2π); ν standard normal
    (Horvath 2015, eq. 47 and § 7.1.2) or, for FIXED amplitudes, 1 (Chen 2014, eq. 19)."""
    result: ComplexArray = np.empty((2, *grid.shape[::-1]), dtype)
    along, against = result
    for columns in grid.column_blocks():
        kx, ky = grid.kx[0, columns, np.newaxis], grid.ky[:, 0]
        along[columns] = _phasors(kx, ky, seed, amplitudes)
        against[columns] = _phasors(-kx, -ky, seed, amplitudes)
    return result.swapaxes(1, 2)


def _phasors(kx: Array, ky: Array, seed: int, amplitudes: str) -> ComplexArray:
    key = random.hash_wave_vectors(kx, ky, seed)
    angle = 2.0 * np.pi * random.uniform(key, _PHASE)
    phasors = np.empty(key.shape, np.complex128)
    phasors.real, phasors.imag = np.cos(angle), np.sin(angle)
    if amplitudes == "GAUSSIAN":
        phasors *= random.normal(key, _NORMAL)
    return phasors


def layer_seed(parameters: OceanParameters, layer: WaveLayer) -> int:
    """The seed of one layer: its own, or one that follows from the ocean's seed and the layer's id."""
    return layer.seed if layer.seed >= 0 else random.combine(parameters.seed, layer.id)


def initial_state(parameters: OceanParameters, dtype: type = np.complex128) -> InitialState:
    """Coefficients of all layers together: layers add in the spectrum, and so do hero waves.

    The amplitude of a cosine is ν√(2ΨΔkxΔky), so its coefficient is half of that (Horvath 2015, eq. 47,
    corrected by this half; Chen 2014, eq. 10 and 18), and the elevation's variance is ΣΨΔkxΔky = m0.
    """
    grid = WaveVectorGrid(parameters.resolution, parameters.domain_size)
    transposed = grid.shape[::-1]
    h_plus, h_minus = (np.zeros(transposed, dtype).T for _ in range(2))
    expected_plus, expected_minus = (np.zeros(transposed, h_plus.real.dtype).T for _ in range(2))
    for layer in parameters.raised_layers:
        spectrum = DirectionalSpectrum(layer, parameters.water, parameters.dispersion, parameters.band)
        forward, backward = spectrum.cell_means(grid)
        along, against = random_phasors(grid, layer_seed(parameters, layer), parameters.amplitudes, dtype)
        for mean, phasors, h, expected in (
            (forward, along, h_plus, expected_plus),
            (backward, np.conj(against), h_minus, expected_minus),
        ):
            mean *= 0.5 * grid.cell_area
            expected += mean
            h += phasors * np.sqrt(mean).astype(expected.dtype, copy=False)
    if parameters.match_height:
        _match_height(grid, h_plus, h_minus, expected_plus + expected_minus)
    omega = _angular_frequency(grid, parameters)
    for wave in parameters.active_hero_waves:
        add_hero_wave(wave, grid, omega, h_plus, h_minus)
    others = []
    for picture in parameters.active_pictures:
        waves = picture_waves(
            picture, grid, parameters.dispersion, parameters.water, parameters.seed,
            parameters.loop_duration, parameters.match_height, dtype,
        )  # fmt: skip
        if picture.animation == "DISPERSION":  # of the same frequencies: no more work for any frame
            _add(waves, h_plus, h_minus, expected_plus, expected_minus)
        else:
            others.append(_state(grid, waves, parameters, mirrored=picture.animation != "TRANSLATION"))
    state = InitialState(
        grid,
        h_plus,
        h_minus,
        omega,
        expected_plus,
        expected_minus,
        loop_duration=parameters.loop_duration,
        orbit_depth=_orbit_depth(parameters),
        others=tuple(others),
    )
    state.potential_factor  # noqa: B018  made with the state, not by its first surface
    return state


def _orbit_depth(parameters: OceanParameters) -> float:
    return parameters.water.depth if parameters.orbits == "FINITE_DEPTH" else float("inf")


def _add(waves: PictureWaves, *to: ComplexArray | RealArray) -> None:
    parts = (waves.h_plus, waves.h_minus, waves.expected_plus, waves.expected_minus)
    for target, part in zip(to, parts, strict=True):
        target += part


def _state(
    grid: WaveVectorGrid, waves: PictureWaves, parameters: OceanParameters, mirrored: bool
) -> InitialState:
    """A picture's waves as a state of its own."""
    return InitialState(
        grid, waves.h_plus, waves.h_minus, waves.omega, waves.expected_plus, waves.expected_minus,
        parameters.loop_duration, _orbit_depth(parameters), mirrored,
    )  # fmt: skip


def _match_height(grid: WaveVectorGrid, h_plus: ComplexArray, h_minus: ComplexArray, mean: RealArray) -> None:
    """Scale a seed's coefficients so that its energy is the expected one."""
    energy = np.sum((np.abs(h_plus) ** 2 + np.abs(h_minus) ** 2) * grid.multiplicity)
    if energy > 0.0:
        factor = h_plus.real.dtype.type(np.sqrt(np.sum(mean * grid.multiplicity) / energy))
        h_plus *= factor
        h_minus *= factor


def _angular_frequency(grid: WaveVectorGrid, parameters: OceanParameters) -> Array:
    """ω(k), (N, N//2+1); in a loop of duration T the nearest multiple of 2π/T, at least one."""
    result = np.empty(grid.shape[::-1])
    for columns in grid.column_blocks():
        k = np.hypot(grid.kx[0, columns, np.newaxis], grid.ky[: grid.resolution // 2 + 1, 0])
        omega = dispersion.angular_frequency(k, parameters.dispersion, parameters.water)
        if parameters.loop_duration is not None:
            fundamental = 2.0 * np.pi / float(parameters.loop_duration)
            omega = fundamental * np.maximum(1.0, np.rint(omega / fundamental))
        result[columns] = grid.mirror(omega)
    return result.T
