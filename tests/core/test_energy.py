# SPDX-License-Identifier: GPL-3.0-or-later
"""Energy: the variance of the sea is the spectrum's integral, whatever the domain and the wind."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from scipy import integrate

from ocean_tweak.core import Ocean, OceanParameters, Water, WaveLayer
from ocean_tweak.core.numerics.grid import WaveVectorGrid
from ocean_tweak.core.spectral.directional_spectrum import DirectionalSpectrum
from ocean_tweak.core.spectral.dispersion import angular_frequency
from ocean_tweak.core.statistics.sea_statistics import field_state
from ocean_tweak.core.synthesis.coefficients import initial_state, propagate


def test_parseval(windy: OceanParameters) -> None:
    ocean = Ocean(windy)
    coefficients = propagate(ocean.initial_state, 12.3).elevation
    energy = np.sum(np.abs(coefficients.astype(np.complex128)) ** 2 * ocean.initial_state.grid.multiplicity)
    elevation = ocean.surface(12.3).displacement[..., 2].astype(np.float64)
    assert np.var(elevation) == pytest.approx(energy, rel=1e-6)
    assert np.mean(elevation) == pytest.approx(0.0, abs=1e-5)
    assert field_state(elevation, windy).m0 == pytest.approx(energy, rel=1e-6)


def test_seeds_scatter_around_the_expected_energy(windy: OceanParameters) -> None:
    seeds = [Ocean(dataclasses.replace(windy, seed=seed)) for seed in range(32)]
    variances = [np.var(ocean.surface(5.0).displacement[..., 2].astype(np.float64)) for ocean in seeds]
    state = seeds[0].initial_state
    expected = float(np.sum((state.expected_plus + state.expected_minus) * state.grid.multiplicity))
    error = np.std(variances, ddof=1) / np.sqrt(len(variances))
    assert abs(np.mean(variances) - expected) < 3.0 * error
    assert error < 0.1 * expected


@pytest.mark.parametrize("direction", [0.0, np.pi / 4])
@pytest.mark.parametrize("wavelengths", [3.0, 5.3, 10.0, 30.0])
def test_cells_hold_the_integral_of_the_spectrum(wavelengths: float, direction: float) -> None:
    layer = WaveLayer(wind_speed=17.0, fetch=300e3, swell=0.3, wind_direction=direction)
    spectrum = DirectionalSpectrum(layer, Water(depth=11e3), "DEEP")
    integral, _ = integrate.quad(
        lambda w: float(spectrum.frequency_spectrum(w)),
        0.0,
        40.0,
        points=[spectrum.peak_frequency],
        limit=1000,
    )
    domain = wavelengths * 2 * np.pi * 9.81 / spectrum.peak_frequency**2
    grid = WaveVectorGrid(2 * round(16 * wavelengths), domain)
    forward, backward = spectrum.cell_means(grid)
    cells = np.sum(0.5 * (forward + backward) * grid.multiplicity) * grid.cell_area
    assert cells == pytest.approx(integral, rel=0.01)


def test_sampling_alone_would_not_do(windy: OceanParameters) -> None:
    """The reason for the averages: at 200 m, sampled energy swings with the wind's direction."""
    grid = WaveVectorGrid(256, 200.0)
    shares = []
    for direction in (0.0, np.pi / 4):
        layer = WaveLayer(wind_speed=17.0, fetch=300e3, swell=0.0, wind_direction=direction)
        spectrum = DirectionalSpectrum(layer, Water(), "CAPILLARY")
        row, column = np.nonzero(grid.usable)
        kx, ky = grid.kx[0, column], grid.ky[row, 0]
        sampled = (spectrum.density(kx, ky) + spectrum.density(-kx, -ky)) * grid.multiplicity[0, column]
        averaged = np.add(*spectrum.cell_means(grid)) * grid.multiplicity
        shares.append(np.sum(sampled) / np.sum(averaged))
    assert shares[0] > 1.4
    assert shares[1] < 1.0


@pytest.mark.parametrize("mix", [0.0, 0.3])
def test_far_cells_hold_the_spectrum_itself(mix: float) -> None:
    """Far from the origin a cell is narrow: its mean, made by tables, is the closed formula at its centre.

    But where Donelan-Banner's branches do not quite meet: there the table goes from one to the other.
    """
    layer = WaveLayer(wind_speed=17.0, fetch=300e3, wind_direction=0.4, spreading_mix=mix)
    spectrum = DirectionalSpectrum(layer, Water(depth=30.0), "CAPILLARY")
    grid = WaveVectorGrid(256, 6000.0)
    ratio = angular_frequency(grid.k, "CAPILLARY", Water(depth=30.0)) / spectrum.peak_frequency
    branches = (np.abs(ratio - 0.95) < 2e-3) | (np.abs(ratio - 1.6) < 2e-3)
    row, column = np.nonzero(grid.usable & (grid.k > 34.0 * grid.spacing) & ~branches)
    kx, ky = grid.kx[0, column], grid.ky[row, 0]
    forward, backward = spectrum.cell_means(grid)
    for means, sign in ((forward, 1.0), (backward, -1.0)):
        expected = spectrum.density(sign * kx, sign * ky)
        np.testing.assert_allclose(means[row, column], expected, rtol=1e-4, atol=1e-9 * np.max(expected))


def test_gain_multiplies_wave_height(windy: OceanParameters) -> None:
    doubled = dataclasses.replace(windy, layers=(dataclasses.replace(windy.layers[0], amplitude_scale=2.0),))
    np.testing.assert_allclose(
        Ocean(doubled).surface(1.0).displacement, 2.0 * Ocean(windy).surface(1.0).displacement, atol=1e-5
    )
    assert Ocean(doubled).statistics().significant_wave_height == pytest.approx(
        2.0 * Ocean(windy).statistics().significant_wave_height
    )


def test_layers_add_their_energies(windy: OceanParameters) -> None:
    swell = WaveLayer(wind_speed=9.0, fetch=900e3, swell=1.0, wind_direction=2.0)
    both = dataclasses.replace(windy, layers=(*windy.layers, swell))
    first = initial_state(windy).expected_plus
    second = initial_state(dataclasses.replace(windy, layers=(swell,))).expected_plus
    np.testing.assert_allclose(initial_state(both).expected_plus, first + second)
    assert not np.array_equal(initial_state(both).h_plus, initial_state(windy).h_plus)


def test_column_of_zero_kx_is_hermitian(windy: OceanParameters) -> None:
    coefficients = propagate(initial_state(windy), 7.7, np.complex128).elevation
    column = coefficients[:, 0]
    np.testing.assert_allclose(column[1:], np.conj(column[1:][::-1]), rtol=1e-12)
    assert np.any(np.abs(column) > 0.0)
    assert column[0] == 0.0
    assert not np.any(coefficients[:, -1])
    assert not np.any(coefficients[windy.resolution // 2, :])
