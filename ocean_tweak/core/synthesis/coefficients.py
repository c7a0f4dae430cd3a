# SPDX-License-Identifier: GPL-3.0-or-later
"""The sea's Fourier coefficients: random initial ones with the spectrum's energy, and those at any time,
computed from these alone, so that frames can be made in any order."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..numerics import random
from ..numerics.grid import WaveVectorGrid
from ..numerics.memo import remembered, total_bytes
from ..parameters.ocean_parameters import OceanParameters
from ..spectral import dispersion
from ..spectral.directional_spectrum import DirectionalSpectrum
from ..waves.contribution import Contribution, Gives

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]
ComplexArray = NDArray[np.complexfloating]

_ALL = slice(None)

_NORMAL, _PHASE = 0, 2  # random streams of a wave vector; a normal number uses two


@dataclass(frozen=True)
class InitialState:
    """Coefficients of the waves that travel along +k and along -k, for the half plane kx ≥ 0.

    All arrays are (N, N//2+1), indexed [ky, kx]. Those of `initial_state` are transposed in memory (their
    `.T` is contiguous), which is how the transforms read them.

    h_plus, h_minus : complex, m. The elevation's coefficient at time t is
        h_plus·exp(-iωt) + h_minus·exp(+iωt); h_minus(k) is the conjugate of h_plus(-k).
    omega : float64, rad/s; in a loop a multiple of 2π/T
    expected_plus, expected_minus : real, m²: means over all seeds of |h_plus|² and |h_minus|², without hero
        waves, which do not depend on the seed
    loop_duration : T in s, or None
    orbit_depth : depth in m for the horizontal orbital motion; infinite for deep water
    mirrored : whether ω is even in ky, which halves the work; it is always even in k
    others : states on the same grid with frequencies of their own, whose waves are added to these
    layer : the layer whose waves these are, for one of the others
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
    layer: Contribution | None = None

    @property
    def parts(self) -> tuple[InitialState, ...]:
        """The state itself and the others."""
        return self, *self.others

    @property
    def nbytes(self) -> int:
        """Bytes of all arrays, including those of the other states."""
        own = (self.h_plus, self.h_minus, self.omega, self.expected_plus, self.expected_minus)
        factor = vars(self).get("potential_factor")
        return total_bytes((*own, factor, *self.others))

    @cached_property
    def potential_factor(self) -> ComplexArray:
        """1/k, (N, N//2+1) m, complex: from the elevation to the potential of the horizontal displacement.

        In finite depth, horizontal orbits are wider by coth kh (linear theory, Airy).
        """
        grid = self.grid
        result = np.empty(
            grid.shape[::-1], self.h_plus.dtype
        )  # complex, as each product would otherwise convert it
        for columns in grid.column_blocks():
            k = np.hypot(grid.kx[0, columns, np.newaxis], grid.ky[: grid.resolution // 2 + 1, 0])
            k = np.maximum(k, 0.5 * grid.spacing)  # the mean, which is not a wave
            result[columns] = grid.mirror(1.0 / (k * np.tanh(k * self.orbit_depth)))
        return result.T


@remembered("random phases")
def random_phasors(
    grid: WaveVectorGrid, seed: int, amplitudes: str, dtype: type = np.complex128
) -> ComplexArray:
    """ν·exp(iε) for k and for -k, (2, N, N//2+1): ε uniform in [0, 2π); ν standard normal
    (Horvath 2015, eq. 47 and § 7.1.2) or, for DETERMINISTIC amplitudes, 1 (Chen 2014, eq. 19)."""
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
    if amplitudes == "RANDOM":
        phasors *= random.normal(key, _NORMAL)
    return phasors


class Coefficients:
    """Accumulates the waves of all layers; arrays (N, N//2+1), transposed in memory.

    grid, omega : of the sea
    h_plus, h_minus, expected_plus, expected_minus : as in `InitialState`
    dtype : of the coefficients
    """

    def __init__(self, sea: OceanParameters, dtype: type) -> None:
        self._sea = sea
        self.dtype = dtype
        self.grid = WaveVectorGrid(sea.resolution, sea.domain_size)
        shape = self.grid.shape[::-1]
        self.h_plus, self.h_minus = (np.zeros(shape, dtype).T for _ in range(2))
        real = self.h_plus.real.dtype
        self.expected_plus, self.expected_minus = (np.zeros(shape, real).T for _ in range(2))
        self.omega = _angular_frequency(self.grid, sea)
        self._others: list[InitialState] = []

    def set_apart(
        self,
        layer: Contribution,
        h_plus: ComplexArray,
        h_minus: ComplexArray,
        omega: Array,
        expected_plus: RealArray,
        expected_minus: RealArray,
        mirrored: bool,
    ) -> None:
        """Add a layer's waves that have their own frequencies; for the arguments see `InitialState`."""
        self._others.append(
            InitialState(
                self.grid, h_plus, h_minus, omega, expected_plus, expected_minus,
                self._sea.loop_duration, _orbit_depth(self._sea), mirrored, layer=layer,
            )
        )  # fmt: skip

    def state(self) -> InitialState:
        """The sea's state with everything that was added."""
        state = InitialState(
            self.grid,
            self.h_plus,
            self.h_minus,
            self.omega,
            self.expected_plus,
            self.expected_minus,
            loop_duration=self._sea.repeats_after,
            orbit_depth=_orbit_depth(self._sea),
            others=tuple(self._others),
        )
        state.potential_factor  # noqa: B018  made with the state, not by its first surface
        return state


def initial_state(parameters: OceanParameters, dtype: type = np.complex128) -> InitialState:
    """Coefficients of all layers together, summed per wave vector."""
    made = Coefficients(parameters, dtype)
    for layer in parameters.active():
        spectrum = layer.directional_spectrum(parameters)
        if spectrum is not None:
            _add_random_waves(spectrum, parameters, made)
    if parameters.match_height:
        _match_height(made.grid, made.h_plus, made.h_minus, made.expected_plus + made.expected_minus)
    for layer in parameters.active():
        if Gives.COEFFICIENTS in layer.gives:
            layer.add(parameters, made)
    return made.state()


def _add_random_waves(spectrum: DirectionalSpectrum, sea: OceanParameters, to: Coefficients) -> None:
    """Draw random waves from a spectrum.

    The amplitude of a cosine is ν√(2ΨΔkxΔky), so its coefficient is half of that (Horvath 2015, eq. 47,
    corrected by this half; Chen 2014, eq. 10 and 18), and the elevation's variance is ΣΨΔkxΔky = m0.
    """
    forward, backward = spectrum.cell_means(to.grid)
    seed = spectrum.layer.random_seed(sea)
    along, against = random_phasors(to.grid, seed, sea.amplitudes, to.dtype)
    for mean, phasors, h, expected in (
        (forward, along, to.h_plus, to.expected_plus),
        (backward, np.conj(against), to.h_minus, to.expected_minus),
    ):
        mean *= 0.5 * to.grid.cell_area
        expected += mean
        h += phasors * np.sqrt(mean).astype(expected.dtype, copy=False)


def _orbit_depth(parameters: OceanParameters) -> float:
    return parameters.water.depth if parameters.orbital_motion == "FINITE_DEPTH" else float("inf")


def _match_height(grid: WaveVectorGrid, h_plus: ComplexArray, h_minus: ComplexArray, mean: RealArray) -> None:
    """Scale a seed's coefficients to the expected energy."""
    energy = np.sum((np.abs(h_plus) ** 2 + np.abs(h_minus) ** 2) * grid.multiplicity)
    if energy > 0.0:
        factor = h_plus.real.dtype.type(np.sqrt(np.sum(mean * grid.multiplicity) / energy))
        h_plus *= factor
        h_minus *= factor


def _angular_frequency(grid: WaveVectorGrid, parameters: OceanParameters) -> Array:
    """ω(k), (N, N//2+1); in a sea that repeats after T the nearest multiple of 2π/T, at least one."""
    result = np.empty(grid.shape[::-1])
    for columns in grid.column_blocks():
        k = np.hypot(grid.kx[0, columns, np.newaxis], grid.ky[: grid.resolution // 2 + 1, 0])
        omega = dispersion.angular_frequency(k, parameters.dispersion, parameters.water)
        if parameters.repeats_after is not None:
            fundamental = 2.0 * np.pi / float(parameters.repeats_after)
            omega = fundamental * np.maximum(1.0, np.rint(omega / fundamental))
        result[columns] = grid.mirror(omega)
    return result.T


@dataclass(frozen=True)
class PropagatedState:
    """Coefficients at one time, of all columns or of a block of them, indexed [ky, kx].

    elevation : complex64 or complex128, m
    rate : its time derivative, m/s, or None if not requested
    """

    elevation: ComplexArray
    rate: ComplexArray | None


def turns(state: InitialState, time: float | Fraction, columns: slice = _ALL) -> Array:
    """ωt/2π for ky from 0 to N/2, (columns, N//2+1), reduced to [-½, ½] in float64, so that single precision
    suffices afterwards; for all ky, (columns, N), if ω is not even in ky.

    In a loop, ω is an integer number of turns per loop and the time is reduced exactly, so the end of the
    loop has bit for bit the phases of its start.
    """
    rows = state.grid.resolution // 2 + 1 if state.mirrored else state.grid.resolution
    omega = state.omega.T[columns, :rows]
    if state.loop_duration is None:
        result = omega * (float(time) / (2.0 * np.pi))
    else:
        period = state.loop_duration
        turns_a_loop = np.rint(omega * (float(period) / (2.0 * np.pi)))
        result = turns_a_loop * float(Fraction(time) % period / period)
    result -= np.rint(result)
    return result


def propagate(
    state: InitialState,
    time: float | Fraction,
    dtype: type = np.complex64,
    with_rate: bool = False,
    columns: slice = _ALL,
    scale: float = 1.0,
) -> PropagatedState:
    """ĥ(k, t) = h₊·exp(-iωt) + h₋·exp(+iωt), and its time derivative, times `scale`, for some columns kx.

    The sum includes the state's others. Horvath (2015), § 7.1.2: waves along +k and along -k are separate;
    Chen (2014), eq. 9.
    """
    real = np.float32 if dtype is np.complex64 else np.float64
    angle = np.asarray(2.0 * np.pi * turns(state, time, columns), real)
    half: ComplexArray = np.empty(angle.shape, dtype)  # ω, and with it exp(iωt), is usually even in ky
    np.cos(angle, out=half.real)
    np.sin(angle, out=half.imag)
    if scale != 1.0:
        half *= real(scale)
    turn = state.grid.mirror(half) if state.mirrored else half
    against = np.multiply(state.h_minus.T[columns].astype(dtype, copy=False), turn, out=np.empty_like(turn))
    along = np.conjugate(turn, out=turn)
    along *= state.h_plus.T[columns].astype(dtype, copy=False)
    rate = None
    if with_rate:
        rate = ((dtype(-1j) * state.omega.T[columns].astype(real)) * (along - against)).T
    # adding complex arrays as real pairs takes half the time
    np.add(along.view(real), against.view(real), out=along.view(real))
    for other in state.others:
        moved = propagate(other, time, dtype, with_rate, columns, scale)
        along += moved.elevation.T
        if rate is not None and moved.rate is not None:
            rate += moved.rate
    return PropagatedState(along.T, rate)
