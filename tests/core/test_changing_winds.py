# SPDX-License-Identifier: GPL-3.0-or-later
"""Wind fields that differ from place to place and from time to time."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ocean_tweak.core import Ocean, Raster, WindFieldLayer, WindKey
from ocean_tweak.core.waves.wind_field.emission import Emission, layer_origins
from ocean_tweak.core.waves.wind_field.shape import radius_classes
from ocean_tweak.core.waves.wind_field.wind import bilinear, sampled_wind
from tests.core.wind_seas import LONE, G, keyed, particles, sea


def test_rasters_are_bilinear_and_periodic() -> None:
    raster = Raster(np.array([[[0.0, 0.0], [4.0, 8.0]], [[2.0, 0.0], [6.0, 8.0]]]))
    x = np.array([0.0, 50.0, 25.0, 75.0, 25.0, 125.0])
    y = np.array([0.0, 0.0, 0.0, 0.0, 25.0, 25.0])
    values = bilinear(raster, x, y, 100.0)
    np.testing.assert_allclose(values[:, 0], [0.0, 4.0, 2.0, 2.0, 3.0, 3.0])
    np.testing.assert_allclose(values[:, 1], [0.0, 8.0, 4.0, 4.0, 4.0, 4.0])
    made = sampled_wind(lambda x, y: (x, 3.0 * y), 100.0, 4)
    np.testing.assert_allclose(made.values[2, 3], [75.0, 150.0])


def test_a_constant_wind_in_keys_is_the_constant_wind() -> None:
    """The table of phases, inverted, against the closed form."""
    wind = 10.0 * np.array([math.cos(0.3), math.sin(0.3)])
    options = {"rows": 3, "columns": 3, "start_time": -7.0}
    plain = particles(sea(wind_direction=0.3, wind_speed=10.0, **options), 31.7)
    for keys in (keyed((0.0, [[wind]])), keyed(*((t, [[wind]]) for t in (-20.0, -3.3, 4.0, 90.0)))):
        now = particles(sea(keys=keys, **options), 31.7)
        assert len(now.x) == len(plain.x)
        for one, other in zip(plain, now, strict=True):
            np.testing.assert_allclose(one, other, rtol=2e-5, atol=1e-4)


@pytest.mark.parametrize("begin", [0.0, 40.0])
def test_births_of_a_growing_wind_follow_the_integral(begin: float) -> None:
    """Wind 5 + t/2 for 20 s: ∫g/(√(2π)V)dt = 2g/√(2π)·ln(1 + t/10)."""
    winds = keyed((begin, [[[5.0, 0.0]]]), (begin + 20.0, [[[15.0, 0.0]]]))
    field = WindFieldLayer(**{**LONE, "keys": winds, "start_time": begin, "life": 50})
    births = Emission(field, layer_origins(field, 0, 100.0), 100.0, G).births(begin + 19.0)
    born = 19.0 - births.age
    phase = 2.0 * G / math.sqrt(2.0 * math.pi) * np.log1p(born / 10.0)
    np.testing.assert_allclose(phase, np.arange(1, len(born) + 1), atol=3e-4)
    assert len(born) == math.floor(2.0 * G / math.sqrt(2.0 * math.pi) * math.log1p(1.9))
    np.testing.assert_allclose(births.wind[:, 0], 5.0 + 0.5 * born, rtol=1e-9)


def test_calm_and_what_the_grid_cannot_hold_emit_nothing() -> None:
    assert len(particles(sea(wind_speed=1.9), 50.0).x) == 0
    assert len(particles(sea(wind_speed=0.0), 50.0).x) == 0
    fine, coarse = (sea(resolution=n, wind_speed=4.0) for n in (512, 256))  # 1.63 m: 5.2 and 2.6 texels
    assert len(particles(fine, 50.0).x) > 0
    assert len(particles(coarse, 50.0).x) == 0
    lull = keyed(
        (0.0, [[[10.0, 0.0]]]), (1.0, [[[0.0, 0.0]]]), (30.0, [[[0.0, 0.0]]]), (31.0, [[[9.0, 0.0]]])
    )
    field = WindFieldLayer(keys=lull, start_time=-20.0, life=8.0)
    emission = Emission(field, layer_origins(field, 0, 160.0), 160.0, G)
    born = 29.0 - emission.births(29.0).age
    assert len(emission.births(29.0).age) == 0 or born.max() < 1.0
    assert len(emission.births(60.0).age) > 0


def test_more_resolution_is_the_same_sea() -> None:
    wind = Raster(np.random.default_rng(5).normal(0.0, 9.0, (6, 5, 2)))
    low, high = (sea(resolution=n, keys=(WindKey(0.0, wind),), rows=4, columns=4) for n in (512, 1024))
    coarse, fine = particles(low, 10.0), particles(high, 10.0)
    radii = [WindFieldLayer.shares(of).classes.radii for of in (low, high)]
    np.testing.assert_array_equal(*radii)
    assert set(zip(coarse.x, coarse.y, strict=True)) <= set(zip(fine.x, fine.y, strict=True))


def test_never_more_than_four_radii() -> None:
    for spread in (0.01, 1.0, 30.0):
        wind = Raster(20.0 + np.random.default_rng(2).uniform(-0.5, 0.5, (9, 9, 2)) * spread)
        field = WindFieldLayer(keys=(WindKey(0.0, wind),))
        radii = radius_classes((field,), G).radii
        assert 1 <= len(radii) <= 4
        assert np.all(np.diff(radii) > 0.0)
        assert radii[-1] <= 0.5 * field.greatest_speed**2 / G


def test_two_halves_of_opposite_wind_run_against_each_other() -> None:
    size, n = 200.0, 256
    halves = sampled_wind(lambda x, y: (np.where(y < 0.5 * size, 9.0, -9.0), 0.0 * x), size, 64)
    parameters = sea(n, size, keys=(WindKey(0.0, halves),), rows=8, columns=8, life=4.0, split_angle=0.03)
    ocean, step = Ocean(parameters), 0.2
    early, late = (ocean.surface(t).displacement[..., 2].astype(float) for t in (10.0, 10.0 + step))
    expected = 9.0 / math.sqrt(2.0 * math.pi)
    for rows, sign in ((slice(32, 96), 1.0), (slice(160, 224), -1.0)):
        one, two = np.fft.rfft(early[rows], axis=1), np.fft.rfft(late[rows], axis=1)
        # the phase of the band around λ = 8.3 m turns by -k·C·dt
        mode = np.arange(12, 40)
        turned = np.angle(np.sum(two[:, mode] * np.conj(one[:, mode]), axis=0))
        weight = np.sum(np.abs(one[:, mode]) ** 2, axis=0)
        measured = -np.average(turned / (2 * np.pi * mode / size * step), weights=weight)
        assert measured == pytest.approx(sign * expected, rel=0.1)
