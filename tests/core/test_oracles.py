# SPDX-License-Identifier: GPL-3.0-or-later
"""Other people's programs as judges: wavespectra for spectra, SciPy for integrals and for records in time."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from scipy import constants as si
from scipy import integrate, signal
from wavespectra.construct import frequency

from ocean_tweak.core import Ocean, OceanParameters, Water, WaveLayer
from ocean_tweak.core.spectral.directional_spectrum import DirectionalSpectrum
from tests.core.layer_spectra import jonswap_scales, spectrum_of

HERTZ = np.geomspace(0.03, 2.0, 400)
OMEGA = 2.0 * np.pi * HERTZ
THEIR_WATER = Water(depth=11e3, gravity=si.g)

SEAS = {
    "wind sea": OceanParameters(
        resolution=16,
        water=Water(depth=100.0),
        layers=(WaveLayer(wind_speed=17.0, wind_direction=0.4, fetch=300e3, swell=0.3),),
    ),
    "wide sea in shallow water": OceanParameters(
        resolution=16,
        dispersion="FINITE_DEPTH",
        water=Water(depth=12.0),
        layers=(WaveLayer(spreading="MITSUYASU", wind_speed=14.0, wind_direction=-2.8, swell=0.0),),
    ),
    "swell across a wind sea": OceanParameters(
        resolution=16,
        dispersion="DEEP",
        layers=(
            WaveLayer(spectrum="JONSWAP", wind_speed=8.0, wind_direction=1.9, spreading="HASSELMANN"),
            WaveLayer(
                definition="SEA_STATE", significant_wave_height=2.2, peak_period=13.0,
                wind_direction=3.0, swell=1.0, spreading="COSINE_SQUARED",
            ),
        ),
    ),
}  # fmt: skip


# wavespectra: E(f) in m²/Hz is 2πS(ω), and its g is the standard one


@pytest.mark.parametrize("gamma", [1.0, 3.3, 7.0])
def test_jonswap_agrees_with_wavespectra(gamma: float) -> None:
    alpha, peak = jonswap_scales(15.0, 200e3, si.g)
    theirs = frequency.jonswap(HERTZ, fp=peak / (2.0 * np.pi), alpha=alpha, gamma=gamma).values
    layer = {"wind_speed": 15.0, "fetch": 200e3, "peak_enhancement": gamma}
    ours = 2.0 * np.pi * spectrum_of(THEIR_WATER, **layer).frequency_spectrum(OMEGA)
    np.testing.assert_allclose(ours, theirs, rtol=1e-12)


def test_pierson_moskowitz_agrees_with_wavespectra() -> None:
    U = 13.0
    # 0.74 (ω₀/ω)⁴ is 5/4 (ω_p/ω)⁴ at ω_p = (0.592)^¼ ω₀
    peak = 0.592**0.25 * si.g / (1.026 * U) / (2.0 * np.pi)
    theirs = frequency.pierson_moskowitz(HERTZ, fp=peak, alpha=8.1e-3).values
    ours = (
        2.0
        * np.pi
        * spectrum_of(THEIR_WATER, spectrum="PIERSON_MOSKOWITZ", wind_speed=U).frequency_spectrum(OMEGA)
    )
    np.testing.assert_allclose(ours, theirs, rtol=1e-12, atol=1e-300)


@pytest.mark.parametrize("depth", [4.0, 10.0, 20.0])
def test_tma_agrees_with_wavespectra(depth: float) -> None:
    """Its depth factor is the exact one at an approximate wave number, up to 0.1 % beside the true one: that
    makes up to 0.12 % of the spectrum."""
    alpha, peak = jonswap_scales(15.0, 200e3, si.g)
    theirs = frequency.tma(HERTZ, fp=peak / (2.0 * np.pi), dep=depth, alpha=alpha, gamma=3.3).values
    layer = {"spectrum": "TMA", "wind_speed": 15.0, "fetch": 200e3}
    ours = 2.0 * np.pi * spectrum_of(Water(depth=depth, gravity=si.g), **layer).frequency_spectrum(OMEGA)
    np.testing.assert_allclose(ours, theirs, rtol=1.3e-3)


@pytest.mark.parametrize("name", SEAS)
def test_sea_read_by_wavespectra(name: str) -> None:
    """It wants m²/Hz/degree over the compass direction that waves come from, clockwise from north; ours go
    where θ points, counter-clockwise from east."""
    parameters = SEAS[name]
    hertz = np.geomspace(0.01, 12.0, 1500)
    towards = np.radians(np.arange(0.0, 360.0, 2.0))
    density = np.zeros((hertz.size, towards.size))
    for layer in parameters.layers:
        spectrum = DirectionalSpectrum(layer, parameters.water, parameters.dispersion)
        omega = 2.0 * np.pi * hertz[:, np.newaxis]
        density += spectrum.frequency_spectrum(omega) * spectrum.directional_spreading(omega, towards)
    array = xr.DataArray(
        2.0 * np.pi * density * (np.pi / 180.0),
        coords={"freq": hertz, "dir": (270.0 - np.degrees(towards)) % 360.0},
        dims=("freq", "dir"),
        name="efth",
    )
    sea = array.sortby("dir").spec
    ours = Ocean(parameters).statistics().spectrum
    assert float(sea.hs()) == pytest.approx(ours.significant_wave_height, rel=1e-4)
    assert float(sea.tp()) == pytest.approx(ours.peak_period, rel=1e-3)
    assert float(sea.tm02()) == pytest.approx(ours.zero_crossing_period, rel=1e-4)
    assert float(sea.dspr()) == pytest.approx(np.degrees(ours.directional_spread), rel=5e-4)
    difference = 270.0 - np.degrees(ours.mean_direction) - float(sea.dm())
    assert (difference + 180.0) % 360.0 - 180.0 == pytest.approx(0.0, abs=0.1)


# SciPy: integrals over the plane of wave vectors


LAYERS = {
    "wind sea": WaveLayer(wind_speed=17.0, fetch=300e3, wind_direction=0.7, swell=0.3),
    "long swell": WaveLayer(
        definition="SEA_STATE", significant_wave_height=2.5, peak_period=14.0, wind_direction=-2.0, swell=1.0
    ),
    "young sea": WaveLayer(spectrum="JONSWAP", wind_speed=9.0, fetch=2e3, spreading="HASSELMANN", swell=0.0),
    "old sea": WaveLayer(spectrum="PIERSON_MOSKOWITZ", wind_speed=10.0, spreading="COSINE_2S", swell=0.5),
    "mixed": WaveLayer(
        spectrum="PHILLIPS", spreading="COSINE_SQUARED", second_spreading="FLAT", spreading_mix=0.3, swell=0.0
    ),
}


@pytest.mark.parametrize("depth", [10.0, 4000.0])
@pytest.mark.parametrize("name", LAYERS)
def test_plane_of_wave_vectors_holds_the_energy(name: str, depth: float) -> None:
    """∬Ψ dkx dky in polar coordinates, over ln k and θ, is m0 whatever the depth and the spreading."""
    water, layer = Water(depth=depth), LAYERS[name]
    spectrum = DirectionalSpectrum(layer, water, "CAPILLARY")

    def ring(log_k: float) -> float:
        k = np.exp(log_k)
        theta = layer.wind_direction + np.linspace(-np.pi, np.pi, 721)
        density = spectrum.density(k * np.cos(theta), k * np.sin(theta))
        return float(k**2 * integrate.simpson(density, x=theta))

    statistics = Ocean(OceanParameters(resolution=16, water=water, layers=(layer,))).statistics()
    peak = np.log(2.0 * np.pi / statistics.peak_wavelength)
    energy, _ = integrate.quad(
        ring, peak - 8.0, peak + 9.0, points=[peak, peak + 1.0], epsrel=1e-5, limit=300
    )
    assert energy == pytest.approx(statistics.m0, rel=5e-5)
    if name == "old sea":  # 0.02245 U², in water of any depth: this spectrum does not feel the ground
        assert 4.0 * np.sqrt(energy) == pytest.approx(2.245, rel=1e-3)
    if name == "long swell":
        assert 4.0 * np.sqrt(energy) == pytest.approx(2.5, rel=5e-4)


# SciPy: what a wave buoy would measure


def test_record_of_twenty_minutes() -> None:
    """Welch's spectrum of the elevation, 2 Hz at 64 places, has the fields' Hs and the spectrum's peak."""
    base = OceanParameters(
        resolution=64,
        seed=3,
        amplitudes="DETERMINISTIC",
        water=Water(depth=300.0),
        layers=(WaveLayer(wind_speed=13.0, wind_direction=0.5, fetch=180e3, swell=0.2),),
    )
    expected = Ocean(base).statistics()
    ocean = Ocean(base.replace(domain_size=12.0 * expected.peak_wavelength))
    assert ocean.statistics().wavelengths_per_domain == pytest.approx(12.0)
    record, variance = np.empty((2400, 64)), 0.0
    for index in range(2400):
        elevation = ocean.surface(0.5 * index).displacement[..., 2].astype(np.float64)
        record[index] = elevation[3::8, 5::8].ravel()
        variance += np.var(elevation) / 2400
    hertz, density = signal.welch(record, fs=2.0, nperseg=256, axis=0)
    density = density.mean(axis=1)
    height = 4.0 * np.sqrt(integrate.trapezoid(density, hertz))
    assert height == pytest.approx(4.0 * np.sqrt(variance), rel=0.03)
    assert height == pytest.approx(ocean.statistics().resolved.significant_wave_height, rel=0.03)
    assert abs(hertz[np.argmax(density)] - 1.0 / expected.peak_period) <= hertz[1]
