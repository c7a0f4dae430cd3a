# SPDX-License-Identifier: GPL-3.0-or-later
"""Spectra and spreading against published numbers and limits."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import integrate, special

from ocean_tweak.core import Ocean, OceanParameters, Water, WaveLayer
from ocean_tweak.core.spectral import spectra
from ocean_tweak.core.spectral.directional_spectrum import RadialTable
from ocean_tweak.core.spectral.spreading import Spreading, directional_spreading, donelan_banner_beta
from tests import reference
from tests.core.layer_spectra import jonswap_scales, spectrum_of


def test_depth_factor_has_the_published_values() -> None:
    # Kitaigorodskii's Φ at ω_h = 0.5, 1, 1.5, 2, solved by hand from Horvath (2015), eq. 29
    values = spectra.kitaigorodskii([0.5, 1.0, 1.5, 2.0])
    np.testing.assert_allclose(values, [0.1248, 0.4828, 0.8785, 0.9934], atol=5e-5)
    assert spectra.kitaigorodskii(0.0) == 0.0
    assert spectra.kitaigorodskii(50.0) == pytest.approx(1.0, abs=1e-12)
    # Thompson and Vincent (1983): ½ω_h² below 1, 1 - ½(2 - ω_h)² up to 2, within 0.023
    w = np.linspace(0.01, 2.0, 200)
    approximation = np.where(w <= 1.0, 0.5 * w**2, 1.0 - 0.5 * (2.0 - w) ** 2)
    assert np.max(np.abs(spectra.kitaigorodskii(w) - approximation)) < 0.023


@pytest.mark.parametrize(("gamma", "factor"), [(1.0, 0.2000), (3.3, 0.3050), (7.0, 0.4450)])
def test_energy_of_jonswap(gamma: float, factor: float) -> None:
    # m0 = factor · α g² ω_p⁻⁴
    (alpha, omega_p), g = jonswap_scales(17.0, 300e3), 9.81
    spectrum = spectrum_of(wind_speed=17.0, fetch=300e3, peak_enhancement=gamma).frequency_spectrum
    m0, _ = integrate.quad(
        lambda w: float(spectrum(w)),
        0.0,
        60.0 * omega_p,
        points=[omega_p],
        limit=500,
    )
    assert m0 == pytest.approx(factor * alpha * g**2 / omega_p**4, rel=6e-4)


def test_jonswap_parameters() -> None:
    # Hasselmann et al. (1973): ω_p = 22 (g/U) X^(-1/3), α = 0.076 X^-0.22 with X = g F / U²
    # at U = 10 m/s, F = 100 km: X = 9810
    assert spectra.jonswap_peak(10.0, 100e3) == pytest.approx(1.0082, rel=1e-4)
    assert spectra.jonswap_alpha(10.0, 100e3) == pytest.approx(0.010061, rel=1e-4)
    # at U = 20 m/s, F = 500 km: X = 12262.5
    assert spectra.jonswap_peak(20.0, 500e3) == pytest.approx(0.46796, rel=1e-4)
    assert spectra.full_development_fetch(10.0) * 9.81 / 100.0 == pytest.approx(17036, rel=1e-4)


def test_peak_lies_at_the_peak_frequency() -> None:
    # 22 · 0.981 · 9810^(-1/3) and, for a fully developed sea, 0.855 g/U; (4/5)^¼ / 1.026 for Phillips' factor
    w = np.linspace(0.3, 3.0, 27001)
    for changes, peak in (
        ({"peak_enhancement": 1.0}, 1.0082),
        ({"peak_enhancement": 7.0}, 1.0082),
        ({"spectrum": "TMA"}, 1.0082),
        ({"spectrum": "PIERSON_MOSKOWITZ"}, 0.8386),
        ({"spectrum": "PHILLIPS"}, 0.9043),
        ({"spectrum": "GENERALIZED_AB", "generalized_b": 2.0}, 1.1247),
    ):
        spectrum = spectrum_of(wind_speed=10.0, fetch=100e3, **changes)
        assert w[np.argmax(spectrum.frequency_spectrum(w))] == pytest.approx(peak, abs=2e-4), changes
        assert spectrum.peak_frequency == pytest.approx(peak, abs=1e-4), changes


def test_tma_is_jonswap_in_deep_water() -> None:
    w = np.linspace(0.3, 5.0, 100)
    jonswap = spectrum_of().frequency_spectrum(w)
    np.testing.assert_allclose(spectrum_of(spectrum="TMA").frequency_spectrum(w), jonswap, rtol=1e-9)
    # at 5 m, ω_h = ω√(h/g) is 0.5, 1, 1.5 and 2: there Φ is known
    shallow = Water(depth=5.0)
    w = np.array([0.5, 1.0, 1.5, 2.0]) * np.sqrt(9.81 / 5.0)
    share = spectrum_of(shallow, spectrum="TMA").frequency_spectrum(w) / spectrum_of().frequency_spectrum(w)
    np.testing.assert_allclose(share, [0.1248, 0.4828, 0.8785, 0.9934], atol=5e-5)
    share = spectrum_of(shallow, spectrum="TMA", depth_factor="THOMPSON_VINCENT").frequency_spectrum(
        w
    ) / spectrum_of().frequency_spectrum(w)
    np.testing.assert_allclose(share, [0.125, 0.5, 0.875, 1.0], rtol=1e-9)


@pytest.mark.parametrize("model", ["MITSUYASU", "HASSELMANN"])
def test_spreading_knows_the_wind_of_its_spectrum(model: str) -> None:
    """U ω_p / g, by hand: 22 X^(-1/3), 0.855, (4/5)^¼ / 1.026, U/g (B/1.25)^¼, and of a sea state the fully
    developed one. At the peak D(0) = Γ(s+1) / (2√π Γ(s+½)) with s = 11.5 (U ω_p/g)^-2.5 (Mitsuyasu), at
    1.1 ω_p with s = 9.77 · 1.1^(-2.33 - 1.45 (U ω_p/g - 1.17)) (Hasselmann)."""
    for changes, ratio in (
        ({}, 22.0 * 9810.0 ** (-1.0 / 3.0)),
        ({"spectrum": "TMA"}, 22.0 * 9810.0 ** (-1.0 / 3.0)),
        ({"spectrum": "PIERSON_MOSKOWITZ"}, 0.592**0.25 / 1.026),
        ({"spectrum": "PHILLIPS"}, 0.8**0.25 / 1.026),
        ({"spectrum": "GENERALIZED_AB", "generalized_b": 2.0}, 10.0 / 9.81 * 1.6**0.25),
        ({"definition": "SEA_STATE"}, 0.855),
    ):
        spectrum = spectrum_of(wind_speed=10.0, fetch=100e3, spreading=model, swell=0.0, **changes)
        x = 1.0 if model == "MITSUYASU" else 1.1
        s = 11.5 * ratio**-2.5 if x == 1.0 else 9.77 * x ** (-2.33 - 1.45 * (ratio - 1.17))
        expected = special.gamma(s + 1.0) / (2.0 * np.sqrt(np.pi) * special.gamma(s + 0.5))
        found = spectrum.directional_spreading(x * spectrum.peak_frequency, 0.0)
        assert found == pytest.approx(expected, rel=1e-4), changes


@pytest.mark.parametrize("row", reference.rows("reference_seas.csv"), ids=lambda row: row["name"])
def test_reference_seas(row: dict[str, str]) -> None:
    parameters = OceanParameters(
        resolution=16,
        domain_size=float(row["domain_size"]),
        water=Water(depth=float(row["depth"])),
        layers=(
            WaveLayer(
                wind_speed=float(row["wind_speed"]),
                fetch=1e3 * float(row["fetch_km"]),
                swell=float(row["swell"]),
            ),
        ),
    )
    statistics = Ocean(parameters).statistics()
    for value, name in (
        (statistics.significant_wave_height, "Hs"),
        (statistics.peak_period, "Tp"),
        (statistics.peak_wavelength, "peak_wavelength"),
    ):
        digits = len(row[name].partition(".")[2])
        assert value == pytest.approx(float(row[name]), abs=0.51 * 10.0**-digits), name


def test_growth_ends_at_full_development() -> None:
    def height(**changes: object) -> float:
        layer = WaveLayer(wind_speed=5.0, fetch=300e3, **changes)  # type: ignore[arg-type]
        parameters = OceanParameters(resolution=16, water=Water(depth=11e3), layers=(layer,))
        return Ocean(parameters).statistics().significant_wave_height

    # JONSWAP without an end of growth has 2.1 m over 300 km; at full development, X = 17036,
    # 4 √(0.3050 α g² ω_p⁻⁴) with α = 0.076 X^-0.22 = 0.00891 and ω_p = 0.855 g/U = 1.6775
    assert height(limit_fetch=False) == pytest.approx(2.1, rel=0.02)
    assert height() == pytest.approx(0.7273, rel=0.002)


def test_donelan_banner_beta() -> None:
    # Horvath (2015), eq. 38, worked out by hand
    expected = {0.5: 2.61 * 0.5**1.3, 1.0: 2.28, 1.3: 2.28 * 1.3**-1.3, 2.0: 0.960345, 10.0: 0.458826}
    for ratio, beta in expected.items():
        assert float(donelan_banner_beta(ratio)) == pytest.approx(beta, rel=1e-4)


@pytest.mark.parametrize("ends", [(0.01, 3.0), (0.5, 0.5), (math.exp(-2.0), math.exp(1.0))])
def test_a_table_of_wave_numbers_reaches_beyond_its_ends(ends: tuple[float, float]) -> None:
    """Values lie between two nodes: nothing is extrapolated."""
    table = RadialTable(*ends)
    index, weight = table.nodes(np.array(ends))
    assert np.all(index >= 0)
    assert np.all(index + 1 < len(table.k))
    assert np.all((weight >= 0.0) & (weight < 1.0))


@pytest.mark.parametrize("swell", [0.0, 0.3, 1.0, 2.0])
def test_spreading_sums_to_one(swell: float) -> None:
    for ratio in np.append(np.geomspace(0.1, 30.0, 40), [0.95, 1.0, 1.6]):

        def density(theta: float, ratio: float = ratio) -> float:
            return float(directional_spreading(ratio, theta, Spreading("DONELAN_BANNER", swell)))

        assert density(np.pi) >= 0.0
        half, _ = integrate.quad(density, 0.0, np.pi, epsabs=1e-9, limit=200)
        assert 2.0 * half == pytest.approx(1.0, abs=1e-6)


def test_spreading_without_swell_is_the_published_one() -> None:
    # D = β sech²(βθ) / (2 tanh βπ), Horvath (2015), eq. 38
    theta = np.linspace(-np.pi, np.pi, 101)
    for ratio in (0.5, 1.0, 3.0):
        beta = float(donelan_banner_beta(ratio))
        expected = beta / (2 * np.tanh(beta * np.pi)) / np.cosh(beta * theta) ** 2
        np.testing.assert_allclose(
            directional_spreading(ratio, theta, Spreading("DONELAN_BANNER")), expected, rtol=2e-6
        )


def test_swell_draws_long_waves_together() -> None:
    straight = [
        float(directional_spreading(1.0, 0.0, Spreading("DONELAN_BANNER", swell)))
        for swell in (0.0, 0.5, 1.0, 2.0)
    ]
    assert straight == sorted(straight)
    assert straight[2] > 1.2 * straight[0]
    # the angle is wrapped: sech² is not periodic
    model = Spreading("DONELAN_BANNER", 0.5)
    once, again = directional_spreading(1.0, [0.3, 0.3 + 2 * np.pi], model)
    assert once == pytest.approx(again)


def test_a_band_ends_at_the_wave_numbers_of_its_wavelengths() -> None:
    ends = spectrum_of(shortest_wavelength=4.0, longest_wavelength=50.0).band_ends
    assert ends == pytest.approx([0.5 * np.pi, 0.04 * np.pi])
    assert len(spectrum_of().band_ends) == 0
