# SPDX-License-Identifier: GPL-3.0-or-later
"""The sea's Fourier coefficients: random initial ones with the spectrum's energy, and those at any time,
computed from these alone, so that frames can be made in any order."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import NamedTuple

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
    omega_against : the same of h_minus, where a current makes it another; None for one that is as `omega`.
        Against the current it may be negative: such waves are carried backwards
    carried : x and y in m that a current has carried the waves by time 0
    expected_plus, expected_minus : real, m²: means over all seeds of |h_plus|² and |h_minus|²,
        without the hero waves, which no seed changes
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
    omega_against: Array | None = None
    carried: tuple[float, float] = (0.0, 0.0)

    @property
    def parts(self) -> tuple[InitialState, ...]:
        """The state itself and the others."""
        return self, *self.others

    @property
    def nbytes(self) -> int:
        """Bytes of all arrays, with those of the other states."""
        own = (
            self.h_plus, self.h_minus, self.omega, self.omega_against, self.expected_plus,
            self.expected_minus,
        )  # fmt: skip
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

    grid, omega, omega_against : of the sea, in its current, as `InitialState` has them
    h_plus, h_minus, expected_plus, expected_minus : of its state, as `InitialState` has them
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
        self.omega, self.omega_against = _frequencies(self.grid, still_frequency(self.grid, sea), sea)
        self.carried = (0.0, 0.0) if sea.current is None else (sea.current.carried_x, sea.current.carried_y)
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
        """Add a layer's waves with frequencies of their own; the arguments are as `InitialState` has them,
        but for what a current does to the frequencies."""
        against = None
        if self._sea.moves:
            still = layer.frequencies(self._sea, self.grid)
            if still is None:
                still = still_frequency(self.grid, self._sea)
            omega, against = _frequencies(self.grid, still, self._sea)
            mirrored = False
        self._others.append(
            InitialState(
                self.grid, h_plus, h_minus, omega, expected_plus, expected_minus,
                self._sea.loop_duration, _orbit_depth(self._sea), mirrored, layer=layer,
                omega_against=against, carried=self.carried,
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
            mirrored=self.omega_against is None,
            others=tuple(self._others),
            omega_against=self.omega_against,
            carried=self.carried,
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


def still_frequency(grid: WaveVectorGrid, parameters: OceanParameters) -> Array:
    """ω(k) in rad/s, (N, N//2+1), of water without a current and without a loop."""
    result = np.empty(grid.shape[::-1])
    for columns in grid.column_blocks():
        k = np.hypot(grid.kx[0, columns, np.newaxis], grid.ky[: grid.resolution // 2 + 1, 0])
        omega = dispersion.angular_frequency(k, parameters.dispersion, parameters.water)
        result[columns] = grid.mirror(omega)
    return result.T


class Frequencies(NamedTuple):
    """ω in rad/s, (N, N//2+1), of waves along k and against it; None where those are as along it."""

    along: Array
    against: Array | None


def _in_loop(omega: Array, duration: Fraction | None) -> Array:
    """The nearest multiples of 2π/T in a loop of duration T, at least one."""
    if duration is None:
        return omega
    fundamental = 2.0 * np.pi / float(duration)
    return np.asarray(fundamental * np.maximum(1.0, np.rint(omega / fundamental)))


def _frequencies(grid: WaveVectorGrid, still: Array, parameters: OceanParameters) -> Frequencies:
    """Of waves with frequencies in rad/s in still water, (N, N//2+1): ω = σ ± k·U in the sea's current.

    In a loop both are rounded after they are shifted; a wave that the current holds may then stand still.
    """
    duration, current = parameters.repeats_after, parameters.current
    if current is None or not parameters.moves:
        return Frequencies(_in_loop(still, duration), None)
    x, y = current.velocity
    shift = grid.kx * x + grid.ky * y
    both = [still + shift, still - shift]
    if duration is not None:
        fundamental = 2.0 * np.pi / float(duration)
        both = [fundamental * np.rint(omega / fundamental) for omega in both]
    along, against = (np.asfortranarray(omega) for omega in both)
    return Frequencies(along, against)


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
    return _turns(state.omega.T[columns, :rows], time, state.loop_duration)


def _turns(omega: Array, time: float | Fraction, period: Fraction | None) -> Array:
    """ωt/2π, reduced to [-½, ½]."""
    if period is None:
        result = omega * (float(time) / (2.0 * np.pi))
    else:
        turns_a_loop = np.rint(omega * (float(period) / (2.0 * np.pi)))
        result = turns_a_loop * float(Fraction(time) % period / period)
    result -= np.rint(result)
    return result


def _carried_phasors(
    state: InitialState, time: float | Fraction, columns: slice, dtype: type, scale: float
) -> tuple[ComplexArray, ComplexArray]:
    """exp(-iωt) of waves along k and exp(+iωt) of those against it, (columns, N), in a current."""
    assert state.omega_against is not None
    grid, (x, y) = state.grid, state.carried
    carried = (grid.kx[0, columns, np.newaxis] * x + grid.ky[:, 0] * y) / (2.0 * np.pi)
    carried -= np.rint(carried)
    period = state.loop_duration
    along = -_turns(state.omega.T[columns], time, period) - carried
    against = _turns(state.omega_against.T[columns], time, period) - carried
    return _phasors_of(along, dtype, scale), _phasors_of(against, dtype, scale)


def _phasors_of(turned: Array, dtype: type, scale: float) -> ComplexArray:
    """exp(2πi·turns), times `scale`."""
    real = np.float32 if dtype is np.complex64 else np.float64
    angle = np.asarray(2.0 * np.pi * turned, real)
    result: ComplexArray = np.empty(angle.shape, dtype)
    np.cos(angle, out=result.real)
    np.sin(angle, out=result.imag)
    if scale != 1.0:
        result *= real(scale)
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
    h_plus: ComplexArray = state.h_plus.T[columns].astype(dtype, copy=False)
    h_minus: ComplexArray = state.h_minus.T[columns].astype(dtype, copy=False)
    if state.omega_against is None:
        half = _phasors_of(turns(state, time, columns), dtype, scale)  # ω is mostly even in ky
        turn = state.grid.mirror(half) if state.mirrored else half
        against = np.multiply(h_minus, turn, out=np.empty_like(turn))
        along = np.conjugate(turn, out=turn)
        along *= h_plus
    else:
        along, against = _carried_phasors(state, time, columns, dtype, scale)
        along *= h_plus
        against *= h_minus
    rate = None
    if with_rate:
        faster = dtype(-1j) * state.omega.T[columns].astype(real)
        if state.omega_against is None:
            rate = (faster * (along - against)).T
        else:
            rate = (faster * along + dtype(1j) * state.omega_against.T[columns].astype(real) * against).T
    # adding complex numbers as pairs of real ones takes half the time
    np.add(along.view(real), against.view(real), out=along.view(real))
    for other in state.others:
        moved = propagate(other, time, dtype, with_rate, columns, scale)
        along += moved.elevation.T
        if rate is not None and moved.rate is not None:
            rate += moved.rate
    return PropagatedState(along.T, rate)
