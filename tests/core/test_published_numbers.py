# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers that stand in the papers or follow from them by hand."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import integrate, special

from ocean_tweak.core import Ocean, OceanParameters, Water, WaveLayer
from ocean_tweak.core.spectral import spectra, wave_number_spectra
from ocean_tweak.core.spectral.directional_spectrum import DirectionalSpectrum
from ocean_tweak.core.spectral.spectra import wind_at, wind_at_10_m, wind_factor
from ocean_tweak.core.spectral.spreading import (
    Spreading,
    directional_spreading,
    hasselmann_s,
    mean_cosine,
    mitsuyasu_s,
    swell_s,
)
from tests.core.layer_spectra import spectrum_of

RATIOS = np.append(np.geomspace(0.1, 30.0, 25), [0.95, 1.0, 1.05, 1.6])


def moment(spectrum, order: int, peak: float) -> float:
    """∫ωⁿS dω."""
    return integrate.quad(lambda w: w**order * float(spectrum(w)), 1e-3, 80 * peak, points=[peak], limit=800)[
        0
    ]


# Pierson-Moskowitz, Phillips, generalised A,B


def test_pierson_moskowitz() -> None:
    # Hs = 0.02133 U² for the wind at 19.5 m, 0.02245 U² for the one at 10 m, ω_p = 0.855 g/U, Tz = 0.7104 Tp
    for U in (5.0, 20.0):
        spectrum = spectrum_of(spectrum="PIERSON_MOSKOWITZ", wind_speed=U)
        peak = spectrum.peak_frequency
        assert peak == pytest.approx(0.855 * 9.81 / U, rel=3e-4)
        m0, m2 = (moment(spectrum.frequency_spectrum, n, peak) for n in (0, 2))
        assert 4 * np.sqrt(m0) == pytest.approx(0.02245 * U**2, rel=4e-4)
        assert 4 * np.sqrt(m0) == pytest.approx(0.02133 * (1.026 * U) ** 2, rel=4e-4)
        assert np.sqrt(m0 / m2) * peak == pytest.approx(0.7104, rel=1e-3)
        w = peak * np.linspace(0.9, 1.1, 2001)
        assert w[np.argmax(spectrum.frequency_spectrum(w))] == pytest.approx(peak, rel=2e-4)


def test_pierson_moskowitz_is_an_ab_spectrum() -> None:
    # Horvath (2015), § 5.1.2: A = α g², B = 0.6678 (g/U)⁴; and A/ω⁵ exp(-B/ω⁴) itself
    U, w = 14.0, np.linspace(0.2, 4.0, 50)
    A, B = 8.1e-3 * 9.81**2, 0.6678 * (9.81 / U) ** 4
    expected = A / w**5 * np.exp(-B / w**4)
    fully_developed = spectrum_of(spectrum="PIERSON_MOSKOWITZ", wind_speed=U).frequency_spectrum(w)
    np.testing.assert_allclose(fully_developed, expected, rtol=1e-3)
    of_ab = spectrum_of(spectrum="GENERALIZED_AB", generalized_a=A, generalized_b=B).frequency_spectrum(w)
    np.testing.assert_allclose(of_ab, expected, rtol=1e-9)


def test_phillips_has_the_energy_of_pierson_moskowitz() -> None:
    U = 9.0
    spectrum = spectrum_of(spectrum="PHILLIPS", wind_speed=U)
    m0 = moment(spectrum.frequency_spectrum, 0, spectrum.peak_frequency)
    assert 4 * np.sqrt(m0) == pytest.approx(0.02245 * U**2, rel=4e-4)
    # its peak is (4/5)^¼ (g/U) with U at 19.5 m, and its tail α/β g²/ω⁵
    assert spectrum.peak_frequency == pytest.approx(0.8**0.25 * 9.81 / (1.026 * U), rel=1e-9)
    assert spectrum.frequency_spectrum(50.0) * 50.0**5 == pytest.approx(8.1e-3 / 0.74 * 9.81**2, rel=1e-4)


def test_jonswap_zero_crossing_period() -> None:
    # Tz/Tp = 0.777 for γ = 3.3, 0.7104 for γ = 1
    for gamma, ratio in ((1.0, 0.7104), (3.3, 0.777)):
        spectrum = spectrum_of(peak_enhancement=gamma)
        peak = spectrum.peak_frequency
        m0, m2 = (moment(spectrum.frequency_spectrum, n, peak) for n in (0, 2))
        assert np.sqrt(m0 / m2) * peak == pytest.approx(ratio, rel=1e-3)


def test_jonswap_peak_is_gamma_times_the_base() -> None:
    # at the peak 5, and one relative width away, where r = exp(-½): σ = 0.07 below and 0.09 above
    peaked, base = (spectrum_of(peak_enhancement=gamma) for gamma in (5.0, 1.0))
    for w, ratio in ((1.0, 5.0), (0.93, 5.0 ** np.exp(-0.5)), (1.09, 5.0 ** np.exp(-0.5))):
        omega = w * base.peak_frequency
        assert peaked.frequency_spectrum(omega) / base.frequency_spectrum(omega) == pytest.approx(ratio)


def test_thompson_vincent() -> None:
    np.testing.assert_allclose(
        spectra.thompson_vincent([0.0, 0.5, 1.0, 1.5, 2.0, 3.0, 100.0]),
        [0.0, 0.125, 0.5, 0.875, 1.0, 1.0, 1.0],
    )


def test_short_waves_are_cut_off() -> None:
    base = DirectionalSpectrum(WaveLayer(), Water(), "DEEP")
    cut = DirectionalSpectrum(WaveLayer(short_wave_cutoff=0.5), Water(), "DEEP")
    k = np.array([0.1, 1.0, 2.0, 6.0])
    omega = np.sqrt(9.81 * k)
    ratio = cut.frequency_spectrum(omega) / base.frequency_spectrum(omega)
    np.testing.assert_allclose(ratio, np.exp(-0.25 * k**2), rtol=1e-6)


# Wind over height


def test_wind_over_height() -> None:
    # at 10 m/s the drag coefficient is 1.45·10⁻³: U_19.5 / U_10 = 1 + 2.5 √0.00145 ln 1.95 = 1.06357
    assert wind_factor(10.0, 19.5) == pytest.approx(1.06357, abs=2e-5)
    assert wind_factor(10.0, 10.0) == 1.0
    assert wind_at(20.0, 5.0) < 20.0
    for speed in (0.1, 5.0, 100.0):
        for height in (2.0, 10.0, 19.5, 100.0):
            assert wind_at_10_m(wind_at(speed, height), height) == pytest.approx(speed, rel=1e-12)


def test_layer_takes_wind_at_its_height() -> None:
    low = WaveLayer(wind_speed=10.0)
    high = WaveLayer(wind_speed=10.0 * 1.0635656, wind_height=19.5)
    same = [Ocean(OceanParameters(resolution=16, layers=(layer,))).statistics() for layer in (low, high)]
    assert same[1].significant_wave_height == pytest.approx(same[0].significant_wave_height, rel=1e-5)


# Chen: spectra over wave numbers, amplitudes


@pytest.mark.parametrize("U", [6.0, 11.0])
def test_wave_number_forms_equal_the_change_of_variables(U: float) -> None:
    k = np.geomspace(0.01, 10.0, 40)[:, np.newaxis]
    theta = np.linspace(-np.pi, np.pi, 25)
    U10 = U / 1.026  # Chen's wind for Phillips and Pierson-Moskowitz is the one at 19.5 m
    half_angle = {"spreading": "COSINE_2S", "spreading_exponent": 1.0}
    for chens, layer in (
        (
            wave_number_spectra.phillips(k, theta, U),
            {"spectrum": "PHILLIPS", "wind_speed": U10, "spreading": "COSINE_SQUARED"},
        ),
        (
            wave_number_spectra.pierson_moskowitz(k, theta, U),
            {"spectrum": "PIERSON_MOSKOWITZ", "wind_speed": U10, **half_angle},
        ),
        (wave_number_spectra.jonswap(k, theta, U, 50e3), {"wind_speed": U, "fetch": 50e3, **half_angle}),
    ):
        shipped = spectrum_of(swell=0.0, **layer).density(k * np.cos(theta), k * np.sin(theta))
        np.testing.assert_allclose(chens, shipped, rtol=1e-6, atol=1e-30, err_msg=str(layer))


def test_chens_spectral_constant() -> None:
    # Chen (2014), after eq. 4: A = 3.48·10⁻³, which is the value of Ψ k⁴ for short waves along the wind
    assert wave_number_spectra.phillips(1e3, 0.0, 10.0) * 1e12 == pytest.approx(3.48e-3, rel=2e-3)


@pytest.mark.parametrize(
    ("code", "L", "geometry", "height_factor", "A", "ratio"),
    [
        ("osgOcean", 256.0, 256.0, 1.0, 0.64e-6, 1.64),
        ("oceanFFT", 100.0, 2.0, 0.5, 1.0e-8, 1.10),
        ("fftrefraction", 128.0, 128.0, 0.1, 0.8e-3, 0.52),  # the table prints 10⁻⁴, with which it is 5.24
    ],
)
def test_chens_table_1(
    code: str, L: float, geometry: float, height_factor: float, A: float, ratio: float
) -> None:
    """Variance of Chen's sea over that of three programs, from eq. 25-27 and our constant."""
    scale = L / geometry
    equivalent = wave_number_spectra.tessendorf_constant(L)
    assert equivalent / (A * (height_factor * scale) ** 2) == pytest.approx(ratio, abs=0.01)


def test_amplitude_malformation() -> None:
    """Chen (2014), eq. 3 and 20-22: without the cell's area the variance grows with L²; with it, it stays."""
    variances: dict[float, tuple[float, float]] = {}
    U, spacing = 10.0, 2.0
    for L in (256.0, 512.0):
        n = int(L / spacing)
        index = np.fft.fftfreq(n, 1.0 / n)
        kx, ky = np.meshgrid(2 * np.pi / L * index, 2 * np.pi / L * index)
        k = np.hypot(kx, ky)
        k[0, 0] = 1.0
        psi = wave_number_spectra.phillips(k, np.arctan2(ky, kx), U)
        psi[0, 0] = 0.0
        generator = np.random.default_rng(1)
        unscaled = []
        for _ in range(20):
            noise = generator.normal(size=(2, n, n))
            h0 = (noise[0] + 1j * noise[1]) * np.sqrt(psi / 2.0)
            h0_of_minus_k = np.roll(h0[::-1, ::-1], 1, axis=(0, 1))
            unscaled.append(np.var(np.fft.ifft2(h0 + np.conj(h0_of_minus_k)).real * n * n))
        variances[L] = (float(np.mean(unscaled)), float(np.sum(psi) * (2 * np.pi / L) ** 2))
    malformed, correct = (variances[512.0][i] / variances[256.0][i] for i in (0, 1))
    assert malformed == pytest.approx(4.0, rel=0.15)
    assert correct == pytest.approx(1.0, rel=0.03)
    for L, (without, proper) in variances.items():
        assert without / proper == pytest.approx(2.0 / (2 * np.pi / L) ** 2, rel=0.1)


@pytest.mark.parametrize("spectrum", ["TMA", "JONSWAP", "PIERSON_MOSKOWITZ", "PHILLIPS", "GENERALIZED_AB"])
def test_lattice_sum_is_constant(spectrum: str) -> None:
    """Chen's claim, from 3 to 64 peak wavelengths a side at one spacing of the samples: within 2 %."""
    layer = WaveLayer(spectrum=spectrum, wind_direction=0.3, swell=0.5)
    base = OceanParameters(resolution=16, layers=(layer,), water=Water(depth=30.0))
    wavelength = Ocean(base).statistics().peak_wavelength
    sums = []
    for count in (3, 8, 21, 64):
        sea = base.replace(resolution=8 * count, domain_size=count * wavelength)
        sums.append(Ocean(sea).statistics().resolved.m0)
    assert max(sums) / min(sums) < 1.02
    assert sums[0] / Ocean(base).statistics().m0 > 0.9


# Directions


def test_directional_models_at_tabulated_angles() -> None:
    # cos²: 2/π cos²θ for |θ| < π/2 (Horvath 2015, eq. 32)
    theta = np.array([0.0, np.pi / 6, np.pi / 4, np.pi / 3, 2.0, np.pi])
    np.testing.assert_allclose(
        directional_spreading(1.0, theta, Spreading("COSINE_SQUARED")),
        2 / np.pi * np.array([1.0, 0.75, 0.5, 0.25, 0.0, 0.0]), atol=1e-7,
    )  # fmt: skip
    np.testing.assert_allclose(
        directional_spreading(1.0, theta, Spreading("FLAT")), 1 / (2 * np.pi), rtol=1e-7
    )
    # Longuet-Higgins: Γ(s+1) / (2√π Γ(s+½)) |cos θ/2|^2s (eq. 33 and 34)
    s = hasselmann_s(1.0, 1.17)
    expected = (
        special.gamma(s + 1) / (2 * np.sqrt(np.pi) * special.gamma(s + 0.5)) * np.cos(theta / 2) ** (2 * s)
    )
    model = Spreading("HASSELMANN", wind_frequency=1.17)
    np.testing.assert_allclose(directional_spreading(1.0, theta, model), expected, rtol=1e-6, atol=1e-20)


def test_shape_parameters() -> None:
    # Hasselmann, Dunckel & Ewing (1980): 6.97 at the peak, 8.50 and 8.72 on either side of 1.05 ω_p
    assert hasselmann_s(1.0, 1.17) == pytest.approx(6.97)
    assert hasselmann_s(np.nextafter(1.05, 0), 1.17) == pytest.approx(8.50, abs=0.005)
    assert hasselmann_s(1.05, 1.17) == pytest.approx(8.72, abs=0.005)
    assert hasselmann_s(2.0, 2.17) == pytest.approx(9.77 * 2.0**-3.78)
    assert hasselmann_s(0.5, 9.0) == pytest.approx(6.97 * 0.5**4.06)
    # Mitsuyasu (1975): s_p = 11.5 (ω_p U/g)^-2.5, falling with the fifth power below and -2.5 above the peak
    assert mitsuyasu_s(1.0, 1.0) == pytest.approx(11.5)
    assert mitsuyasu_s(1.0, 4.0) == pytest.approx(11.5 / 32.0)
    assert mitsuyasu_s(0.5, 1.0) == pytest.approx(11.5 / 32.0)
    assert mitsuyasu_s(4.0, 1.0) == pytest.approx(11.5 / 32.0)
    # swell: 16 tanh(ω_p/ω) ξ²
    assert swell_s(1.0, 1.0) == pytest.approx(12.1855, abs=1e-4)
    assert swell_s(2.0, 0.5) == pytest.approx(4.0 * np.tanh(0.5))


@pytest.mark.parametrize("model", ["MITSUYASU", "HASSELMANN"])
def test_swell_adds_to_the_shape_of_longuet_higgins(model: str) -> None:
    """Horvath (2015), § 6.1: the product is a Longuet-Higgins function again, with the sum of both s."""
    shape = {"MITSUYASU": mitsuyasu_s, "HASSELMANN": hasselmann_s}[model]
    theta = np.linspace(-3.0, 3.0, 13)
    for ratio in (0.8, 1.0, 2.5):
        s = float(shape(ratio, 1.2) + swell_s(ratio, 0.7))
        closed = np.exp(special.gammaln(s + 1) - special.gammaln(s + 0.5)) / (2 * np.sqrt(np.pi))
        density = directional_spreading(ratio, theta, Spreading(model, 0.7, wind_frequency=1.2))
        np.testing.assert_allclose(
            density, closed * np.abs(np.cos(theta / 2)) ** (2 * s), rtol=1e-5, atol=1e-20
        )


@pytest.mark.parametrize("swell", [0.0, 0.3, 1.0, 2.0])
@pytest.mark.parametrize(
    "model", ["DONELAN_BANNER", "HASSELMANN", "MITSUYASU", "COSINE_SQUARED", "COSINE_2S", "FLAT"]
)
def test_every_model_sums_to_one(model: str, swell: float) -> None:
    for mix in (0.0, 0.4):
        spreading = Spreading(
            model, swell, second="COSINE_SQUARED", mix=mix, exponent=3.0, wind_frequency=1.5
        )
        for ratio in RATIOS[:: 1 if mix == 0.0 else 6]:

            def density(theta: float, ratio: float = ratio, spreading: Spreading = spreading) -> float:
                return float(directional_spreading(ratio, theta, spreading))  # fmt: skip

            half, _ = integrate.quad(density, 0.0, np.pi, points=[0.1, np.pi / 2], epsabs=1e-9, limit=200)
            assert 2 * half == pytest.approx(1.0, abs=1e-6), (ratio, mix)
            assert density(np.pi) >= 0.0


def test_mixture_of_two_models() -> None:
    """Horvath (2015), eq. 40."""
    theta = np.linspace(-3.0, 3.0, 31)
    first, second = (
        directional_spreading(1.3, theta, Spreading(model)) for model in ("DONELAN_BANNER", "COSINE_SQUARED")
    )
    mixed = directional_spreading(1.3, theta, Spreading("DONELAN_BANNER", second="COSINE_SQUARED", mix=0.25))
    np.testing.assert_allclose(mixed, 0.75 * first + 0.25 * second, rtol=1e-5)


def test_mean_cosine() -> None:
    # of cos² it is (2/π)(4/3), of Longuet-Higgins s/(s+1), of flat 0
    assert mean_cosine(1.0, Spreading("COSINE_SQUARED")) == pytest.approx(8 / (3 * np.pi), abs=1e-6)
    assert mean_cosine(1.0, Spreading("COSINE_2S", exponent=4.0)) == pytest.approx(0.8, abs=1e-6)
    assert mean_cosine(1.0, Spreading("FLAT")) == pytest.approx(0.0, abs=1e-6)
