# SPDX-License-Identifier: GPL-3.0-or-later
"""Curves to look at hold the energy of the spectrum that they show."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ocean_tweak.core import OceanParameters, Water, WaveLayer
from ocean_tweak.core.statistics.sea_spectrum import frequency_curves, polar_density, resolved_band

SWELL = WaveLayer(
    definition="SEA_STATE", significant_wave_height=2.5, peak_period=14.0, wind_direction=0.7, swell=1.0
)
SEA = OceanParameters(layers=(WaveLayer(wind_speed=11.0, wind_direction=-2.0), SWELL, WaveLayer(muted=True)))


def test_a_layers_curve_holds_its_energy() -> None:
    """Hs = 4 √m0: the swell was asked for with 2.5 m at 14 s. Beyond four peaks an ω⁻⁵ tail holds 0.5 %."""
    curves = frequency_curves(SEA, 2000)
    assert curves.layers.shape == (2, 2000)
    swell = curves.layers[1]
    assert 4.0 * math.sqrt(swell @ np.gradient(curves.omega)) == pytest.approx(2.5, rel=0.005)
    assert curves.omega[np.argmax(swell)] == pytest.approx(2.0 * math.pi / 14.0, rel=0.003)


def test_the_polar_density_holds_the_same_energy_and_its_directions() -> None:
    polar = polar_density(SEA, 400, 360)
    curves = frequency_curves(SEA, 400)
    over_theta = polar.density.sum(axis=1) * (2.0 * np.pi / 360)
    np.testing.assert_allclose(over_theta, curves.layers.sum(axis=0), rtol=2e-3, atol=1e-9)
    ring, direction = np.unravel_index(np.argmax(polar.density), polar.density.shape)
    assert polar.theta[direction] == pytest.approx(0.7, abs=0.02)
    assert polar.omega[ring] == pytest.approx(2.0 * math.pi / 14.0, rel=0.02)


def test_the_resolved_band_is_that_of_the_grid() -> None:
    """Deep water: ω² = g k, from one wave in the domain to two samples a wave."""
    deep = OceanParameters(dispersion="DEEP", water=Water(gravity=9.81), domain_size=400.0, resolution=512)
    low, high = resolved_band(deep)
    assert low == pytest.approx(math.sqrt(9.81 * 2.0 * math.pi / 400.0))
    assert high == pytest.approx(math.sqrt(9.81 * math.pi * 510 / 400.0))


def test_a_sea_without_waves_has_no_curves() -> None:
    flat = OceanParameters(layers=(WaveLayer(muted=True),))
    assert frequency_curves(flat).layers.shape == (0, 256)
    assert not np.any(polar_density(flat).density)
