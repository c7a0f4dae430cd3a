# SPDX-License-Identifier: GPL-3.0-or-later
"""Dispersion relations against their limits, differences and textbook values."""

from __future__ import annotations

import numpy as np
import pytest

from ocean_tweak.core import Water
from ocean_tweak.core.spectral import dispersion

K = np.geomspace(1e-4, 1e4, 400)
WATERS = [
    Water(depth=0.1),
    Water(depth=15.0),
    Water(depth=11e3),
    Water(depth=5.0, gravity=1.62, surface_tension=0.4),
]


def test_textbook_values() -> None:
    # a 156 m long wave in deep water has a period of 10 s (λ = g T² / 2π)
    wavelength = 9.81 * 10.0**2 / (2.0 * np.pi)
    assert dispersion.angular_frequency(2 * np.pi / wavelength, "DEEP", Water()) == pytest.approx(
        2 * np.pi / 10
    )
    # very long waves travel at √(g h)
    k = 1e-6
    assert dispersion.angular_frequency(k, "FINITE_DEPTH", Water(depth=4000.0)) / k == pytest.approx(
        np.sqrt(9.81 * 4000.0), rel=1e-4
    )
    # the slowest ripples on water: 1.7 cm long, 23 cm/s (Lamb, Hydrodynamics, § 267: 1.73 cm, 23.2 cm/s)
    speed = dispersion.angular_frequency(K, "CAPILLARY", Water(depth=100.0)) / K
    assert 2 * np.pi / K[np.argmin(speed)] == pytest.approx(0.0173, rel=0.05)
    assert speed.min() == pytest.approx(0.232, rel=0.01)


@pytest.mark.parametrize("name", dispersion.RELATIONS)
@pytest.mark.parametrize("water", WATERS)
def test_derivative_is_that_of_the_relation(name: str, water: Water) -> None:
    step = 1e-5 * K
    upper = dispersion.angular_frequency(K + step, name, water)
    lower = dispersion.angular_frequency(K - step, name, water)
    np.testing.assert_allclose(
        dispersion.group_velocity(K, name, water), (upper - lower) / (2 * step), rtol=1e-8
    )


@pytest.mark.parametrize("name", dispersion.RELATIONS)
@pytest.mark.parametrize("water", WATERS)
def test_wave_number_inverts_the_relation(name: str, water: Water) -> None:
    omega = dispersion.angular_frequency(K, name, water)
    np.testing.assert_allclose(dispersion.wave_number(omega, name, water), K, rtol=1e-12)
    assert dispersion.wave_number(0.0, name, water) == 0.0


def test_relations_agree_where_they_should() -> None:
    long_waves = K[K < 1.0]
    ocean = Water(depth=11e3)
    shallow = Water(depth=15.0)
    short = K[K > 2.0]
    np.testing.assert_allclose(
        dispersion.capillary(long_waves, shallow), dispersion.finite_depth(long_waves, shallow), rtol=1e-5
    )
    np.testing.assert_allclose(
        dispersion.finite_depth(short, shallow), dispersion.deep(short, shallow), rtol=1e-12
    )
    np.testing.assert_allclose(
        dispersion.finite_depth(K[K > 1e-2], ocean), dispersion.deep(K[K > 1e-2], ocean), rtol=1e-12
    )
