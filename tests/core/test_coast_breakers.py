# SPDX-License-Identifier: GPL-3.0-or-later
"""The single wave over a bed: its shape, which waves break, and the foam that they leave."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from ocean_tweak.core import Foam, Ocean, OceanParameters, Patch, Places, WaveLayer
from ocean_tweak.core.numerics.memo import MEMO
from ocean_tweak.core.waves.coast.breakers import broken_share, least_broken, shape_of, whiteness
from tests.core.test_coast_sea import SAMPLES, SIDE, STEP, sea

TURNS = np.linspace(0.0, 2.0 * np.pi, 4000, endpoint=False)


def one_wave(height: float, depth: float, period: float = 10.0) -> tuple[np.ndarray, float]:
    """A period of a wave at a place, m, and its Ursell number."""
    omega = 2.0 * np.pi / period
    k = omega / np.sqrt(9.81 * depth)
    for _ in range(60):
        k = omega**2 / (9.81 * np.tanh(k * depth)) * 0.5 + 0.5 * k
    ones = np.ones(TURNS.size)
    shape = shape_of(0.5 * height * ones, k * ones, depth * ones, ones)
    wave = shape.elevation(0.5 * height * np.exp(-1j * TURNS))
    return wave, 0.75 * 0.5 * height * k / (k * depth) ** 3


def moments(wave: np.ndarray) -> tuple[float, float]:
    """Skewness, and asymmetry by the Hilbert transform."""
    coefficients = np.fft.fft(wave)
    coefficients[len(wave) // 2 :] = 0.0
    turned = np.imag(np.fft.ifft(2.0 * coefficients))
    return float(np.mean(wave**3) / np.std(wave) ** 3), float(np.mean(turned**3) / np.std(wave) ** 3)


@pytest.mark.parametrize(
    ("height", "depth", "skewness", "asymmetry"),
    # read off Ruessink and others' figures 3 and 4: peaked at Ur = 1, pitched forward at 10
    [(0.2, 8.0, 0.0, 0.0), (1.0, 2.8, 0.6, -0.35), (0.9, 1.0, 0.25, -0.8)],
)
def test_waves_are_peaked_and_pitched_forward_as_they_were_measured(
    height: float, depth: float, skewness: float, asymmetry: float
) -> None:
    wave, _ = one_wave(height, depth)
    found = moments(wave)
    assert found[0] == pytest.approx(skewness, abs=0.1)
    assert found[1] == pytest.approx(asymmetry, abs=0.1)
    assert wave.max() - wave.min() == pytest.approx(height, rel=1e-4)
    assert abs(wave.mean()) < 1e-6
    # a place sees the front first: it rises quicker than it falls
    rate = np.gradient(wave, TURNS)
    assert rate.max() >= -rate.min() * 0.999
    if asymmetry < -0.3:
        assert rate.max() > -1.5 * rate.min()


@pytest.mark.parametrize("depth", [80.0, 200.0])  # half a wavelength is 78 m
def test_in_deep_water_waves_are_sinusoids(depth: float) -> None:
    wave, _ = one_wave(10.0, depth)
    assert_allclose(wave, 5.0 * np.cos(TURNS), atol=1e-6)


@pytest.mark.parametrize("share", [0.1, 0.4, 0.8])
def test_as_many_waves_break_as_are_told(share: float) -> None:
    # an envelope of random waves has Rayleigh's distribution
    rng = np.random.default_rng(7)
    signal = (rng.normal(size=40000) + 1j * rng.normal(size=40000)) * 0.3
    rms = 2.0 * np.sqrt(np.mean(np.abs(signal) ** 2))
    crests = np.abs(signal).astype(complex)
    white = whiteness(crests, np.full(signal.size, least_broken(np.array(rms), np.array(share))))
    assert white.mean() == pytest.approx(share, abs=0.05)
    assert whiteness(-crests, np.zeros(signal.size)).max() == 0.0


def test_waves_break_in_the_surf_for_as_much_of_the_time_as_are_broken() -> None:
    ocean = Ocean(sea())
    assert ocean.coast is not None
    over_bed, share = ocean.coast.over_bed, ocean.coast.broken_share
    wet = ocean.coast.ground.depth > 0.0
    least = least_broken(ocean.coast.pictures.rms_height, share[wet])
    found = np.mean([np.abs(over_bed.signal(time)) > least for time in np.linspace(0.0, 511.0, 120)], axis=0)
    of_row = np.zeros(wet.shape)
    of_row[wet] = found
    for row in np.flatnonzero(wet.all(axis=1) & (share.mean(axis=1) > 0.02)):
        assert of_row[row].mean() == pytest.approx(share[row].mean(), abs=0.05)
    # all that reaches the shore is broken
    last = np.flatnonzero(wet.all(axis=1))[-1]
    assert of_row[last].mean() > 0.95


def foam_along(parameters: OceanParameters, time: float) -> np.ndarray:
    x = np.arange(60.0, 195.0, STEP)
    return Ocean(parameters).surface(time, ("foam", "breaking", "foam_age"), Places(x, np.full(x.size, 30.0)))


def test_foam_is_born_on_fronts_left_behind_and_fades() -> None:
    swell = WaveLayer(definition="SEA_STATE", significant_wave_height=1.5, peak_period=9.0)
    parameters = sea().replace(layers=(swell,))
    now, later = (foam_along(parameters, time) for time in (40.0, 41.0))
    assert now.breaking.max() > 0.8
    assert now.foam.max() > 0.8
    assert (now.foam >= now.breaking - 1e-6).all()
    # what breaks moves towards the shore
    centre = [np.sum(np.arange(each.size) * each) / np.sum(each) for each in (now.breaking, later.breaking)]
    assert centre[0] != centre[1]
    old = (now.foam_age > 0.5) & (now.foam > 0.1)
    assert old.any()
    fresh = foam_along(parameters.replace(foam=Foam(half_life=0.2)), 40.0)
    assert fresh.foam.sum() < 0.8 * now.foam.sum()
    assert foam_along(parameters.replace(foam=Foam(coverage=0.0)), 40.0).foam.max() == 0.0


def test_foam_follows_from_all_patches_whatever_sea_was_asked_before() -> None:
    """Short waves of another patch break too: what their sea and one without them made stays apart."""
    swell = Patch(SIDE, resolution=SAMPLES, shortest_wavelength=20.0)
    one = sea(patches=(swell,))
    both = sea(patches=(swell, Patch(50.0, resolution=64, longest_wavelength=20.0)))
    MEMO.drop()
    alone = foam_along(both, 40.0)
    MEMO.drop()
    other, after = foam_along(one, 40.0), foam_along(both, 40.0)
    assert_array_equal(after.foam, alone.foam)
    assert_array_equal(after.foam_age, alone.foam_age)
    assert np.abs(other.foam - alone.foam).max() > 0.01


def test_in_the_surf_lines_are_white_and_most_of_the_water_between_them_is_not() -> None:
    parameters = sea().replace(foam=Foam(half_life=4.0))
    coast = Ocean(parameters).coast
    assert coast is not None
    surf = (coast.broken_share > 0.3) & (coast.ground.depth > 0.0)
    fields = [coast.over_bed.foam(time) for time in np.arange(0.0, 60.0, 7.3)]
    white = np.mean([(each.foam > 0.5)[surf].mean() for each in fields])
    assert 0.15 < white < 0.40
    for each in fields:
        assert each.breaking.max() > 0.9
        # what is as old as half of it lives is lace
        assert each.foam[each.age >= 4.0].max() < 0.3


def test_waves_are_white_in_front() -> None:
    """Where the water falls away towards the shore."""
    over_bed = Ocean(sea()).coast.over_bed  # type: ignore[union-attr]
    for time in (20.0, 23.0, 31.0):
        white = over_bed.foam(time).breaking
        slope = over_bed.components(time, [(2, "x")])[2, "x"]
        assert np.sum(white * slope) / np.sum(white) < -0.02


def test_breakers_run_ashore() -> None:
    over_bed = Ocean(sea()).coast.over_bed  # type: ignore[union-attr]
    fields = [over_bed.foam(20.0 + 0.25 * step).breaking for step in range(6)]
    ahead = behind = 0.0
    for before, after in pairwise(fields):
        ahead += float(np.sum(before[:-1] * after[1:]))
        behind += float(np.sum(before[1:] * after[:-1]))
    assert ahead > 1.2 * behind


def test_without_breaking_nothing_is_white_and_waves_are_higher() -> None:
    broken, unbroken = (Ocean(sea(breaking=on)) for on in (True, False))
    assert broken.coast is not None
    assert unbroken.coast is not None
    assert unbroken.coast.over_bed.foam(20.0).foam.max() == 0.0
    shallow = (broken.coast.ground.depth > 0.2) & (broken.coast.ground.depth < 2.0)
    highest = [each.coast.significant_height[shallow].mean() for each in (unbroken, broken)]  # type: ignore[union-attr]
    assert highest[0] > 1.5 * highest[1]
    assert broken_share(np.array(0.5), np.array(2.0)) < 1.0
    assert broken.coast.ground.columns * broken.coast.ground.step == SIDE
