# SPDX-License-Identifier: GPL-3.0-or-later
"""Statistics of a sea: of its spectrum, as resolved by the grid, and of one seed.

Moments: m0 = ∫S dω is the variance of the elevation, m2 = ∫ω²S dω; Hs = 4√m0 is the significant wave
height, Tp the period at the peak of the frequency spectrum, Tz = 2π√(m0/m2) the mean period between
zero up-crossings.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..data.plain_data import to_plain
from ..parameters.ocean_parameters import OceanParameters, Patch
from ..spectral import dispersion
from ..spectral.sea_state import (
    Modes,
    SeaState,
    field_state,
    mode_state,
    modes_state,
    state_of_moments,
    together,
)
from ..synthesis.coefficients import InitialState
from ..waves.contribution import WAVES, Gives
from ..waves.spectral import WaveLayer
from .sea_spectrum import SeaSpectrum
from .sea_state_match import too_steep

Array = NDArray[np.float64]

__all__ = ["SeaState", "Statistics", "field_state", "mode_state", "sea_statistics", "spectrum_state"]

#: warning for a sea without waves
FLAT = "The sea is flat: no layer has energy. Unmute one, or raise its wind, amplitude scale or wave height"

_LEAST_WAVELENGTHS = 3.0
LEAST_RESOLVED_SHARE = 0.95
_LEAST_LOOP_PERIODS = 3.0
_LARGEST_SPEED_CHANGE = 0.1


@dataclass(frozen=True)
class PatchStatistics:
    """A patch of a sea, with the statistics of its band in the sea's axes.

    share : fraction of the resolved variance of the sum, 0…1
    """

    patch: Patch
    statistics: Statistics
    share: float

    def to_dict(self) -> dict[str, object]:
        """Plain data for JSON."""
        patch = self.patch
        return {
            **to_plain(patch, brief=True),
            "spacing": patch.spacing,
            "samples_a_wave": patch.samples_a_wave or None,
            "longest_waves_a_side": patch.longest_waves_a_side,
            "share": self.share,
            **{name: getattr(self.statistics, name).to_dict() for name in ("spectrum", "resolved", "seed")},
        }


@dataclass(frozen=True)
class Statistics:
    """Statistics of a sea.

    spectrum : the continuous spectrum, all wavelengths
    resolved : mean over all seeds of the waves on the grid
    seed : this seed, averaged over time; includes hero waves, unlike the two above
    wavelengths_per_domain : number of peak wavelengths along a side
    sample_spacing : m
    loop_speed_change : largest relative change of a phase speed due to the loop, or None without a loop
    warnings : one sentence each, with a remedy
    patches : for a sea of patches, from long waves to short; all other fields then describe their sum
    """

    spectrum: SeaState
    resolved: SeaState
    seed: SeaState
    wavelengths_per_domain: float
    sample_spacing: float
    loop_speed_change: float | None
    warnings: tuple[str, ...]
    patches: tuple[PatchStatistics, ...] = ()

    @property
    def m0(self) -> float:
        """Variance of the elevation, m², of the continuous spectrum."""
        return self.spectrum.m0

    @property
    def significant_wave_height(self) -> float:
        """Hs of the continuous spectrum, m."""
        return self.spectrum.significant_wave_height

    @property
    def peak_period(self) -> float:
        """Tp of the continuous spectrum, s."""
        return self.spectrum.peak_period

    @property
    def peak_wavelength(self) -> float:
        """Wavelength at the peak of the continuous spectrum, m."""
        return self.spectrum.peak_wavelength

    @property
    def resolved_share(self) -> float:
        """Fraction of the spectrum's energy that the grid resolves, 0…1."""
        return self.resolved.m0 / self.spectrum.m0 if self.spectrum.m0 > 0.0 else 1.0

    def to_dict(self) -> dict[str, object]:
        """Plain data for JSON; undefined values, such as the period of a flat sea, are None."""
        per_domain = self.wavelengths_per_domain
        return {
            "spectrum": self.spectrum.to_dict(),
            "resolved": self.resolved.to_dict(),
            "seed": self.seed.to_dict(),
            "resolved_share": self.resolved_share,
            "wavelengths_per_domain": per_domain if np.isfinite(per_domain) else None,
            "sample_spacing": self.sample_spacing,
            "loop_speed_change": self.loop_speed_change,
            "warnings": list(self.warnings),
            **({"patches": [patch.to_dict() for patch in self.patches]} if self.patches else {}),
        }


def sea_statistics(parameters: OceanParameters, state: InitialState) -> Statistics:
    """Statistics of a sea from its parameters and its initial state."""
    sea = SeaSpectrum(parameters)
    spectrum = continuous_state(sea)
    placed = [layer.state(parameters) for layer in parameters.active() if Gives.FIELDS in layer.gives]
    told = [state for state in placed if state is not None]
    resolved, seed = (
        together([modes_state(_modes(state, expected), parameters), *told]) for expected in (True, False)
    )
    result = Statistics(
        spectrum=spectrum,
        resolved=resolved,
        seed=seed,
        wavelengths_per_domain=parameters.domain_size / spectrum.peak_wavelength,
        sample_spacing=parameters.domain_size / parameters.resolution,
        loop_speed_change=_loop_speed_change(parameters, state),
        warnings=(),
    )
    return dataclasses.replace(result, warnings=_warnings(parameters, sea, result))


def _modes(state: InitialState, expected: bool) -> list[Modes]:
    """Energies of all of a sea's states: expected over all seeds, or of this seed."""
    modes = []
    for part in state.parts:
        along, against = part.expected_plus, part.expected_minus
        if not expected:
            along, against = np.abs(part.h_plus) ** 2, np.abs(part.h_minus) ** 2
        if part.omega_against is None:
            modes.append(Modes(part.grid, along, against, part.omega))
        else:
            none = np.zeros_like(along)
            modes.append(Modes(part.grid, along, none, part.omega))
            modes.append(Modes(part.grid, none, against, part.omega_against))
    return modes


def continuous_state(sea: SeaSpectrum) -> SeaState:
    """State of all waves with known heights, whether a grid resolves them or not."""
    others = (layer.state(sea.parameters) for layer in sea.parameters.active())
    return together([spectrum_state(sea), *(state for state in others if state is not None)])


def _loop_speed_change(parameters: OceanParameters, state: InitialState) -> float | None:
    """Largest relative change of the phase speed among the modes that hold 99 % of the energy."""
    if state.loop_duration is None:
        return None
    changes = [0.0]
    for part in state.parts:
        energy = ((part.expected_plus + part.expected_minus) * part.grid.multiplicity).ravel()
        order = np.argsort(energy)[::-1]
        cumulated = np.cumsum(energy[order])
        if not cumulated[-1] > 0.0:
            continue
        carrying = order[: int(np.searchsorted(cumulated, 0.99 * cumulated[-1])) + 1]
        true = _without_loop(parameters, part).ravel()[carrying]
        moving = true > 0.0
        for omega, shift in _both_ways(parameters, part):
            seen = omega.ravel()[carrying][moving] - shift.ravel()[carrying][moving]
            changes.append(np.max(np.abs(seen / true[moving] - 1.0), initial=0.0))
    return float(max(changes))


def _both_ways(parameters: OceanParameters, part: InitialState) -> Iterator[tuple[Array, Array]]:
    """ω of a state's waves along k and, where it is another, of those against it, and what a current adds."""
    x, y = (0.0, 0.0) if parameters.current is None else parameters.current.velocity
    shift = part.grid.kx * x + part.grid.ky * y
    yield part.omega, shift
    if part.omega_against is not None:
        yield part.omega_against, -shift


def _without_loop(parameters: OceanParameters, part: InitialState) -> Array:
    """ω in rad/s of a state's waves as it would be without a loop and a current."""
    own = None if part.layer is None else part.layer.frequencies(parameters, part.grid)
    if own is not None:
        return own
    return dispersion.angular_frequency(part.grid.k, parameters.dispersion, parameters.water)


def _warnings(parameters: OceanParameters, sea: SeaSpectrum, statistics: Statistics) -> tuple[str, ...]:
    of_layers = tuple(layer_warnings(parameters))
    if not np.isfinite(statistics.peak_wavelength):
        return of_layers if is_told_apart(parameters) else (*of_layers, FLAT)
    return (
        *of_layers,
        *grid_warnings(parameters, sea, statistics),
        *loop_warnings(parameters, statistics),
        *fetch_warnings(parameters, sea),
        *steepness_warnings(parameters),
    )


def is_told_apart(parameters: OceanParameters) -> bool:
    """Whether some waves are not included in the statistics, so that a sea may have waves although these say
    it is flat."""
    return any(not layer.gives & (Gives.SPECTRUM | Gives.STATE) for layer in parameters.active())


def layer_warnings(parameters: OceanParameters) -> Iterator[str]:
    """Warnings of the layers, and a note on waves that are not included."""
    for layer in parameters.active():
        yield from layer.warnings(parameters)
        is_told = layer.gives & (Gives.SPECTRUM | Gives.STATE) or type(layer).outlook(parameters) is not None
        if layer.gives & WAVES and not is_told:
            yield (
                f"{layer.names.label}: the height of these waves is not known, so the sea's "
                "numbers and its foam leave them out"
            )


def grid_warnings(parameters: OceanParameters, sea: SeaSpectrum, statistics: Statistics) -> list[str]:
    """Warnings for a grid too small or too coarse for its waves."""
    warnings = []
    wavelength = statistics.peak_wavelength
    if parameters.has_states:
        wavelength = _longest_random_wave(parameters, 2.0 * np.pi / sea.peak_wave_number)
    if parameters.domain_size / wavelength < _LEAST_WAVELENGTHS:
        warnings.append(
            f"The domain of {parameters.domain_size:g} m holds only "
            f"{parameters.domain_size / wavelength:.2g} of the longest waves ({wavelength:.3g} "
            "m), so wave height varies much between seeds. Make the domain at least "
            f"{_round_up(_LEAST_WAVELENGTHS * wavelength)} m"
        )
    if statistics.resolved_share < LEAST_RESOLVED_SHARE:
        warnings.append(
            f"The grid resolves only {100.0 * statistics.resolved_share:.0f} % of the energy: "
            f"samples are {statistics.sample_spacing:.3g} m apart. Raise the resolution, or make "
            "the domain smaller"
        )
    return warnings


def _longest_random_wave(parameters: OceanParameters, of_spectra: float) -> float:
    """Longest peak wavelength in m of the layers whose height varies with the seed; NaN for none."""
    peaks = (of_spectra, *(layer.longest_random_wave(parameters) for layer in parameters.active()))
    return max((peak for peak in peaks if np.isfinite(peak)), default=float("nan"))


def _round_up(length: float) -> str:
    """A length rounded up to two significant digits."""
    unit = 10.0 ** (np.floor(np.log10(length)) - 1.0)
    return f"{np.ceil(length / unit) * unit:.10g}"


def _round_down(length: float) -> str:
    """A length rounded down to two significant digits."""
    unit = 10.0 ** (np.floor(np.log10(length)) - 1.0)
    return f"{np.floor(length / unit) * unit:.10g}"


def loop_warnings(parameters: OceanParameters, statistics: Statistics) -> list[str]:
    """Warnings for a loop that is too short."""
    if parameters.loop_duration is None or statistics.loop_speed_change is None:
        return []
    duration, shortest = float(parameters.loop_duration), _LEAST_LOOP_PERIODS * statistics.peak_period
    warnings = []
    if duration < shortest:
        warnings.append(
            f"The loop of {duration:g} s is shorter than {_LEAST_LOOP_PERIODS:g} peak periods and will look "
            f"mechanical. Make it at least {_round_up(shortest)} s"
        )
    if statistics.loop_speed_change > _LARGEST_SPEED_CHANGE:
        warnings.append(
            f"The loop changes the speed of some waves by {100.0 * statistics.loop_speed_change:.0f} %. "
            "Make it longer"
        )
    return warnings


def fetch_warnings(parameters: OceanParameters, sea: SeaSpectrum) -> list[str]:
    """Warnings for fetches beyond full development."""
    numbers = {(layer.kind, layer.id): number for number, layer in enumerate(parameters.layers, 1)}
    return [
        f"Layer {numbers[spectrum.layer.kind, spectrum.layer.id]}: the sea is fully developed "
        f"after {spectrum.scales.fetch / 1000.0:.4g} km; the rest of the fetch of "
        f"{spectrum.layer.fetch / 1000.0:.4g} km has no effect"
        for spectrum in sea.layers
        if spectrum.fetch_is_limited
    ]


def steepness_warnings(parameters: OceanParameters) -> list[str]:
    """Warnings for layers steeper than any wind sea, with the nearest possible sea states."""
    warnings = []
    for number, layer in enumerate(parameters.layers, 1):
        if not isinstance(layer, WaveLayer) or layer.muted:
            continue
        found = too_steep(layer, parameters.water)
        if found is None:
            continue
        height, period = layer.significant_wave_height, layer.peak_period
        nearest = f"{_round_down(found.height)} m at {period:g} s"
        if math.isfinite(found.period):
            nearest += f", or {height:g} m at {_round_up(found.period)} s"
        warnings.append(
            f"Layer {number}: no sea has waves of {height:g} m at {period:g} s. Their steepness, height over "
            f"wavelength, would be {found.steepness:.2f}; {found.limit:.2f} is the most. Nearest: {nearest}"
        )
    return warnings


def spectrum_state(sea: SeaSpectrum) -> SeaState:
    """Combined state of the layers' continuous spectra, by quadrature over ln ω."""
    omega, weight = sea.rule
    parameters = sea.parameters
    k = dispersion.wave_number(omega, parameters.dispersion, parameters.water)
    spectrum, vector = np.zeros_like(omega), 0.0j
    for layer in sea.layers:
        energy = layer.frequency_spectrum(omega)
        vector += layer.direction_vector(omega, energy, weight)
        spectrum += energy
    m0, m2 = np.sum(spectrum * weight), np.sum(omega**2 * spectrum * weight)
    slope = np.sum(k**2 * spectrum * weight)
    return state_of_moments(m0, m2, slope, vector, sea.peak_frequency, parameters)
