# SPDX-License-Identifier: GPL-3.0-or-later
"""Slopes that a grid cannot hold, against integrals done by hand and slopes measured at sea."""

from __future__ import annotations

import numpy as np
import pytest

from ocean_tweak.core import Ocean, OceanParameters, Water, WaveLayer
from ocean_tweak.core.statistics.unresolved_slopes import (
    capillary_limit,
    total_slope_variance,
    unresolved_slope_variance,
)

ALPHA = 8.1e-3  # Phillips' constant in the Pierson-Moskowitz spectrum


def wind_sea(wind_speed=12.0, **changes):
    """Pierson-Moskowitz in deep water: Ψ = α/(2k⁴)·(2/π)cos²θ wherever k is well above the peak."""
    layer = WaveLayer(
        spectrum="PIERSON_MOSKOWITZ", wind_speed=wind_speed, spreading="COSINE_SQUARED", swell=0.0,
        wind_direction=changes.pop("wind_direction", 0.0),
    )  # fmt: skip
    values = {"resolution": 256, "domain_size": 400.0, "dispersion": "DEEP", "layers": (layer,)}
    return OceanParameters(**{**values, **changes})


def outside_of_square(parameters, limit):
    """½α∫D(θ) ln(K/k₀(θ)) dθ, with k₀(θ) where a ray leaves the square of the grid's modes."""
    angle = (np.arange(200_000) + 0.5) * np.pi / 200_000 - np.pi / 2
    direction = parameters.layers[0].wind_direction + angle
    half_side = (parameters.resolution - 1) * np.pi / parameters.domain_size
    leaves = half_side / np.maximum(np.abs(np.cos(direction)), np.abs(np.sin(direction)))
    octaves = np.log(np.maximum(limit / leaves, 1.0))
    return 0.5 * ALPHA * np.mean(2.0 / np.pi * np.cos(angle) ** 2 * octaves) * np.pi


@pytest.mark.parametrize(
    "changes", [{}, {"wind_direction": 0.5}, {"domain_size": 40.0}, {"resolution": 1024, "domain_size": 10.0}]
)
def test_unresolved_slopes_are_those_outside_of_the_square(changes):
    parameters = wind_sea(**changes)
    # √(ρg/σ) of clean water
    limit = np.sqrt(1000.0 * 9.81 / 0.074)
    expected = outside_of_square(parameters, limit)
    assert unresolved_slope_variance(parameters) == pytest.approx(expected, rel=2e-3)


def test_slopes_of_grid_and_rest_are_all_slopes():
    parameters = wind_sea(domain_size=600.0)
    held = Ocean(parameters).statistics().resolved.mean_square_slope
    assert held + unresolved_slope_variance(parameters) == pytest.approx(
        total_slope_variance(parameters), rel=5e-3
    )


@pytest.mark.parametrize("wind_speed", [3.0, 7.0, 14.0])
def test_all_slopes_are_as_large_as_measured(wind_speed):
    """Cox & Munk (1954), clean sea: 0.003 + 0.00512 U; the spectra are no better than a factor of two."""
    parameters = OceanParameters(layers=(WaveLayer(wind_speed=wind_speed, fetch=500e3),))
    measured = 0.003 + 0.00512 * wind_speed
    assert 0.5 * measured < total_slope_variance(parameters) < 2.0 * measured


def test_the_capillary_limit():
    """Lamb: the slowest waves of clean water are 1.7 cm long."""
    assert 2.0 * np.pi / capillary_limit(Water()) == pytest.approx(0.0173, abs=1e-4)
    assert capillary_limit(Water(surface_tension=0.0)) == capillary_limit(Water())


def test_ends():
    """A grid finer than capillaries leaves nothing, nor does a sea without energy."""
    assert unresolved_slope_variance(wind_sea(resolution=1024, domain_size=1.0)) == 0.0
    muted = wind_sea(layers=(WaveLayer(muted=True),))
    assert unresolved_slope_variance(muted) == total_slope_variance(muted) == 0.0
    cut = wind_sea(layers=(WaveLayer(shortest_wavelength=20.0),))
    assert unresolved_slope_variance(cut) == 0.0
