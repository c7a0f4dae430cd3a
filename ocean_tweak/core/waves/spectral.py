# SPDX-License-Identifier: GPL-3.0-or-later
"""Waves drawn from a spectrum."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Self

from ..data.errors import ParameterError
from ..data.validation import LARGEST_INTEGER, Off, choice, nested, number, switch
from ..masks.parameters import Mask
from ..numerics import random
from ..spectral import constants, dispersion
from ..spectral.directional_spectrum import DirectionalSpectrum
from ..spectral.equaliser import Equaliser, Equalising
from ..spectral.measured import MeasuredSpectra
from ..spectral.measured_spectrum import MeasuredSpectrum
from ..spectral.spectra import combined_peak, wind_at_10_m
from .contribution import (
    Contribution,
    Gives,
    MemoryNeed,
    Names,
    Wind,
    amplitude_scale,
    check_band,
    direction,
    identity,
    longest_wavelength,
    muted,
    own_seed,
    shortest_wavelength,
    wave_height,
    wind_speed,
)

if TYPE_CHECKING:
    from ..parameters.ocean_parameters import OceanParameters

SPECTRA = ("TMA", "JONSWAP", "PIERSON_MOSKOWITZ", "PHILLIPS", "GENERALIZED_AB")
SPREADINGS = ("DONELAN_BANNER", "HASSELMANN", "MITSUYASU", "COSINE_SQUARED", "COSINE_2S", "FLAT")
#: spectra that depend on the fetch
FETCH_LIMITED = ("TMA", "JONSWAP")
DEFINITIONS = ("WIND", "SEA_STATE", "MEASURED")
DEPTH_FACTORS = ("KITAIGORODSKII", "THOMPSON_VINCENT")

#: largest allowed direction, rad
_MOST_TURNED = 1e6

#: number of layers whose random numbers are cached
_KEPT = 4

#: m/s; measured winds are taken for no more
_STRONGEST_WIND = 100.0

#: share of the energy above which it is told that it is left out
_TOLD, _TOLD_OF_BLOCKED = 0.005, 0.0005


@dataclass(frozen=True)
class WaveLayer(Contribution):
    """One wave system, defined by wind and fetch or by wave height and period.

    Examples
    --------
    >>> WaveLayer(wind_speed=25.0, fetch=800e3, wind_direction=0.5).spectrum
    'TMA'
    """

    kind = "WAVES"
    gives = Gives.SPECTRUM | Gives.LOOPS
    names = Names(0, "", "wave layer", "Waves", "A wave system: a wind and its fetch, or a swell", "MOD_WAVE")

    spectrum: str = choice("TMA", SPECTRA, "How the energy is shared among wavelengths")
    wind_speed: float = wind_speed(
        "Mean wind speed. Sets wave height and length; 0 is a calm, without waves", changes=True
    )
    wind_direction: float = direction(changes=True)
    fetch: float = number(
        150e3, 0.0, 20e6, "m", "Distance of open water over which the wind has blown; 0 raises no waves",
        "from the shore to half the Earth's circumference", changes=True,
    )  # fmt: skip
    limit_fetch: bool = switch(True, "Stop the sea's growth where it is fully developed for its wind")
    spreading: str = choice("DONELAN_BANNER", SPREADINGS, "How the energy is shared among directions")
    swell: float = number(
        0.3, 0.0, 4.0, "", "Stretches waves into long parallel trains; 0 to 1 is the useful range",
        "beyond 4, all waves run in one direction", useful=(0.0, 1.0), changes=True,
    )  # fmt: skip
    amplitude_scale: float = amplitude_scale(
        "Multiplies the layer's wave height; 1 is physically correct", changes=True
    )
    peak_enhancement: float = number(
        constants.PEAK_ENHANCEMENT, 1.0, 10.0, "", "Peak enhancement γ of JONSWAP and TMA: how strongly "
        "the longest waves dominate",
        "measured seas lie between 1 and 7",
    )  # fmt: skip
    depth_factor: str = choice(
        "KITAIGORODSKII",
        DEPTH_FACTORS,
        "How TMA loses energy in shallow water: exactly, or by the approximation",
    )
    generalized_a: float = number(
        0.7795,
        0.0,
        1e6,
        "m²/s⁴",
        "A of the generalised spectrum A/ω⁵ exp(-B/ω⁴)",
        "beyond it no liquid holds together",
    )
    generalized_b: float = number(
        0.6185, 1e-12, 1e12, "1/s⁴", "B of the generalised spectrum A/ω⁵ exp(-B/ω⁴)",
        "peaks from a thousandth to a thousand rad/s",
    )  # fmt: skip
    short_wave_cutoff: float = number(
        0.0, 0.0, 1e3, "m", "Length l of the factor exp(-k²l²), which removes waves shorter than about 2πl",
        "longer than any wave's cut-off", off=Off(0.0, 0.05, "removes none"),
    )  # fmt: skip
    wind_height: float = number(
        10.0, 2.0, 100.0, "m", "Height above the water at which the wind was measured",
        "lower, the log law has no solution at every wind speed",
    )  # fmt: skip
    definition: str = choice(
        "WIND",
        DEFINITIONS,
        "What sets the layer's energy: wind and fetch, wave height and period, or a "
        "spectrum that was measured, turned by the layer's direction",
    )
    significant_wave_height: float = wave_height(
        2.0, "Significant wave height Hs of a layer defined by its sea state"
    )
    peak_period: float = number(
        10.0,
        0.05,
        60.0,
        "s",
        "Peak period Tp of a layer defined by its sea state",
        "from ripples to long swell",
    )
    spreading_exponent: float = number(
        1.0,
        0.0,
        1e4,
        "",
        "Exponent s of the spreading cos²ˢ(θ/2)",
        "beyond it, all waves run in one direction",
    )
    second_spreading: str = choice("FLAT", SPREADINGS, "Second spreading, mixed into the first")
    spreading_mix: float = number(0.0, 0.0, 1.0, "", "Share of the second spreading", "a share")
    shortest_wavelength: float = shortest_wavelength(
        "Shortest wavelength of the band: shorter waves are left out"
    )
    longest_wavelength: float = longest_wavelength(
        "Longest wavelength of the band: longer waves are left out"
    )
    band_softness: float = number(
        0.0,
        0.0,
        4.0,
        "octaves",
        "Width over which the band's ends fade; 0 cuts sharply",
        "the width of a band",
    )
    band_inverted: bool = switch(False, "Keep the waves outside the band instead")
    muted: bool = muted()
    id: int = identity()
    seed: int = own_seed()
    mask: Mask | None = nested(Mask, optional=True)
    equaliser: Equaliser | None = nested(Equaliser, optional=True)
    measured: MeasuredSpectra | None = nested(MeasuredSpectra, optional=True)
    measured_time: float = number(
        0.0, 0.0, 1e8, "s", "Time after the first of the measured spectra; between two, their energies blend",
        "three years", changes=True, left_out=True,
    )  # fmt: skip

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.definition == "MEASURED" and self.measured is None:
            reason = "needs a spectrum in measured: read one from a file with the command `spectrum`"
            raise ParameterError("definition", self.definition, reason)
        check_band(self.shortest_wavelength, self.longest_wavelength)

    @property
    def is_calm(self) -> bool:
        """Whether it is defined by a wind that raises no waves: no wind, or no fetch."""
        if self.definition != "WIND" or self.spectrum == "GENERALIZED_AB":
            return False  # its energy is not the wind's
        has_fetch = self.spectrum in FETCH_LIMITED
        return self.wind_speed < constants.CALM or (has_fetch and self.fetch < constants.CALM)

    def random_seed(self, sea: OceanParameters) -> int:
        """Its own seed, or one derived from the ocean's seed and its id."""
        return self.seed if self.seed >= 0 else random.combine(sea.seed, self.id)

    def in_patch(self, sea: OceanParameters, patch: int, rotation: float) -> Self:
        """The same layer in the patch's axes, in which a direction θ becomes θ - rotation.

        Each patch except the first has its own random numbers. Otherwise waves at the end of a band, of which
        two patches hold a part each, would be correlated.
        """
        changes = {}
        if rotation:
            turned = self.wind_direction - rotation
            far = abs(turned) > _MOST_TURNED
            changes["wind_direction"] = math.remainder(turned, math.tau) if far else turned
        if patch:
            changes["seed"] = random.combine(self.random_seed(sea), patch) & LARGEST_INTEGER
        return self.changed(**changes) if changes else self

    def directional_spectrum(self, sea: OceanParameters) -> DirectionalSpectrum | None:
        """In the sea's water, within its band; None in a calm."""
        plain = self.plain_spectrum(sea)
        if plain is None:
            return None
        at_work = []
        if self.equaliser is not None and not self.equaliser.is_flat:
            at_work.append(_at_work(self.equaliser, (plain,)))
        if sea.equaliser is not None and not sea.equaliser.is_flat:
            at_work.append(_at_work(sea.equaliser, plain_spectra(sea)))
        return replace(plain, equalisers=tuple(at_work)) if at_work else plain

    def plain_spectrum(self, sea: OceanParameters) -> DirectionalSpectrum | None:
        """Without equalisers."""
        if self.definition == "MEASURED":
            current = (0.0, 0.0) if sea.current is None else sea.current.velocity
            return MeasuredSpectrum(self, sea.water, sea.dispersion, sea.band, current=current)
        return None if self.is_calm else DirectionalSpectrum(self, sea.water, sea.dispersion, sea.band)

    def wind(self, sea: OceanParameters) -> Wind | None:
        """The layer's own, at 10 m, or what was measured beside the waves."""
        if self.is_calm or self.definition == "SEA_STATE" or self.amplitude_scale == 0.0:
            return None
        if self.definition == "MEASURED":
            return self._measured_wind(sea)
        return Wind(wind_at_10_m(self.wind_speed, self.wind_height), self.wind_direction)

    def _measured_wind(self, sea: OceanParameters) -> Wind | None:
        """What was measured; else the layer's wind speed, along the waves' mean direction."""
        assert self.measured is not None
        found = self.measured.wind_at(self.measured_time)
        speed = self.wind_speed if found is None else abs(found)
        if speed < constants.CALM:
            return None
        at_10_m = wind_at_10_m(min(speed, _STRONGEST_WIND), self.wind_height)
        if found is not None:
            return Wind(at_10_m, self.wind_direction + cmath.phase(found))
        spectrum = self.plain_spectrum(sea)
        assert isinstance(spectrum, MeasuredSpectrum)
        return Wind(at_10_m, spectrum.mean_direction)

    def warnings(self, sea: OceanParameters) -> Iterable[str]:
        """What of measured waves the domain, its samples or a current leaves out."""
        spectrum = self.plain_spectrum(sea)
        if not isinstance(spectrum, MeasuredSpectrum):
            return
        lengths, shares = spectrum.shares_of_lengths
        samples = sea.domain_size / sea.resolution
        longer, shorter = (
            float(shares[lengths > sea.domain_size].sum()),
            float(shares[lengths < 2.0 * samples].sum()),
        )
        if longer > _TOLD and not sea.is_cascade:
            yield (
                f"{100.0 * longer:.3g} % of the measured energy is in waves longer than the domain of "
                f"{sea.domain_size:g} m: make it larger, or give it patches"
            )
        if shorter > _TOLD and not sea.is_cascade:
            yield (
                f"{100.0 * shorter:.3g} % of the measured energy is in waves shorter than two samples, "
                f"{2.0 * samples:.3g} m: raise the resolution, or give it patches"
            )
        if spectrum.blocked_share > _TOLD_OF_BLOCKED:
            yield (
                f"The current blocks waves with {100.0 * spectrum.blocked_share:.3g} % of the measured "
                "energy, which are left out: make the current slower, or turn it"
            )

    @classmethod
    def memory(cls, sea: OceanParameters, real: int, moving: bool) -> MemoryNeed:
        """The cached random numbers."""
        kept = min(len(sea.active(cls)), _KEPT)
        return MemoryNeed(sea.resolution * (sea.resolution // 2 + 1) * kept * 2 * 2 * real, 0, 0)


def plain_spectra(sea: OceanParameters) -> tuple[DirectionalSpectrum, ...]:
    """Those of a sea's wave layers that have waves, without equalisers."""
    spectra = (layer.plain_spectrum(sea) for layer in sea.active(WaveLayer))
    return tuple(spectrum for spectrum in spectra if spectrum is not None)


def with_settled_equaliser(sea: OceanParameters) -> OceanParameters:
    """The same sea, whose equaliser says from which wavelength its bands are counted: that of the whole
    sea's peak, of which a part of the sea does not know."""
    equaliser = sea.equaliser
    if equaliser is None or equaliser.is_flat or equaliser.wavelength:
        return sea
    peak = _at_work(equaliser, plain_spectra(sea)).peak
    return sea.replace(equaliser=replace(equaliser, wavelength=min(1e6, math.tau / peak)))


def _at_work(equaliser: Equaliser, spectra: tuple[DirectionalSpectrum, ...]) -> Equalising:
    """An equaliser with the wave number that its bands are counted from: that of the spectra's peak, whatever
    the band of a patch holds of it."""
    if equaliser.wavelength:
        return Equalising(equaliser, math.tau / equaliser.wavelength)
    omega = combined_peak([replace(spectrum, patch_band=None) for spectrum in spectra])
    if not math.isfinite(omega):  # there are no waves to change
        return Equalising(equaliser, 1.0)
    return Equalising(
        equaliser, float(dispersion.wave_number(omega, spectra[0].dispersion, spectra[0].water))
    )
