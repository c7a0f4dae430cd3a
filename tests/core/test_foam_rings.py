# SPDX-License-Identifier: GPL-3.0-or-later
"""Foam around a place: on the crests of the summed sea, the same from everywhere, and as much near as far."""

import dataclasses
from fractions import Fraction

import numpy as np
import pytest

from ocean_tweak.core import Foam, Ocean, OceanParameters, Patch, Places, WaveLayer
from ocean_tweak.core.foam.threshold import foam_outlook
from ocean_tweak.core.sea.foam_levels import FINEST, FoamLevels
from ocean_tweak.core.sea.foam_rings import INNER, SAMPLES, FoamRings, Place, samples_for
from ocean_tweak.core.sea.sums import AnywhereSum
from tests.core.patched_seas import summed

# soon forgotten: each frame alone looks back over its memory
FOAM = Foam(half_life=0.3, coverage=2.0)
TIME = Fraction(25, 8)


@pytest.fixture(scope="module")
def sea():
    """Two turned patches with few enough waves to add them up one by one; foam in windrows."""
    layer = WaveLayer(wind_speed=18.0, fetch=3e3, wind_direction=0.4)
    patches = (Patch(120.0, 0.3, 12.0, 1e6, 40), Patch(31.0, -0.9, 3.0, 12.0, 32))
    return OceanParameters(seed=3, layers=(layer,), patches=patches, foam=FOAM)


@pytest.fixture(scope="module")
def rings(sea):
    return FoamRings(FoamLevels(sea)).at(TIME, Place(300.0, -200.0))


def places_of(rings, number):
    """x and y of a ring's places, (SAMPLES, SAMPLES) each."""
    along = FINEST * 2.0**number * np.arange(SAMPLES)
    x, y = rings.corners[number]
    return np.meshgrid(x + along, y + along)


def test_rings_of_fewer_places_are_a_part_of_them(sea, rings):
    """A surface of a fourth of the vertices has half of them along each side, and the same foam there."""
    count = samples_for(50_000)
    assert (count, samples_for(200_000), samples_for(10**7)) == (SAMPLES // 2, SAMPLES, SAMPLES)
    shares = []
    few = FoamRings(FoamLevels(sea), count).at(TIME, Place(300.0, -200.0), told=shares.append)
    assert shares == pytest.approx(np.arange(len(shares)) / len(shares))
    assert len(shares) > 1
    for number, (own, whole) in enumerate(zip(few.foam, rings.foam, strict=True)):
        cell = FINEST * 2.0**number
        column, row = (
            round((first - of_whole) / cell)
            for first, of_whole in zip(few.corners[number], rings.corners[number], strict=True)
        )
        block = slice(row, row + count), slice(column, column + count)
        np.testing.assert_allclose(own.foam, whole.foam[block], atol=1e-6)
        np.testing.assert_allclose(own.breaking, whole.breaking[block], atol=1e-6)


def compression(waves):
    half_sum = 0.5 * (waves["x_x"] + waves["y_y"])
    root = np.hypot(0.5 * (waves["x_x"] - waves["y_y"]), 0.5 * (waves["x_y"] + waves["y_x"]))
    return root - half_sum


def test_crests_break_where_the_sum_of_all_waves_is_compressed(sea, rings):
    x, y = (along[::3, ::3] for along in places_of(rings, 0))
    squeezed = compression(summed(sea, x, y, float(TIME)))
    breaking = rings.foam[0].breaking[::3, ::3]
    share = np.mean(breaking > 0.5)
    assert share > 0.005
    threshold = np.quantile(squeezed, 1.0 - share)
    assert np.mean(squeezed[breaking > 0.5] > threshold) > 0.8
    # of the same foam on samples 5 m apart, bilinear between them, little is on these crests
    coarse = OceanParameters.from_dict(sea.on_one_grid(24).to_dict())
    fields = Ocean(coarse.replace(foam=dataclasses.replace(FOAM, half_life=0.0))).surface(TIME, {"foam"}).foam
    i, j = (np.floor(along / 5.0).astype(int) for along in (y, x))
    u, v = x / 5.0 - j, y / 5.0 - i

    def at(a, b):
        return fields[(i + a) % 24, (j + b) % 24]

    between = (at(0, 0) * (1 - u) + at(0, 1) * u) * (1 - v) + (at(1, 0) * (1 - u) + at(1, 1) * u) * v

    def correlation(foam):
        return np.corrcoef(foam.ravel(), (squeezed > threshold).ravel())[0, 1]

    assert correlation(breaking) > 0.75
    assert correlation(between) < 0.5 * correlation(breaking)


def test_new_and_old_foam_are_told_apart(rings):
    for foam in rings.foam:
        assert (foam.breaking <= foam.foam).all()
        assert foam.foam.max() <= 1.0
    near = rings.foam[0]
    assert (near.foam_age[near.breaking > 0.01] == 0.0).all()
    assert (near.foam > 0.1)[near.foam_age > 0.0].any()


def test_it_is_the_same_from_elsewhere_and_whatever_came_before(sea, rings):
    other = FoamRings(FoamLevels(sea))
    other.at(TIME - 1, Place(0.0, 0.0))
    other.at(TIME - Fraction(1, 8), Place(307.0, -195.0))
    moved = other.at(TIME, Place(309.0, -193.0))
    alone = FoamRings(FoamLevels(sea)).at(TIME, Place(309.0, -193.0))
    for number, (ours, theirs, again) in enumerate(zip(rings.foam, moved.foam, alone.foam, strict=True)):
        cell = FINEST * 2.0**number
        step = np.subtract(moved.corners[number], rings.corners[number]) / cell
        columns, rows = np.rint(step).astype(int)
        np.testing.assert_allclose(step, (columns, rows), atol=1e-6)
        assert max(abs(columns), abs(rows)) < SAMPLES // 4
        low = max(columns, 0), max(rows, 0)
        high = SAMPLES + min(columns, 0), SAMPLES + min(rows, 0)
        for mine, other_foam, alone_foam in zip(ours, theirs, again, strict=True):
            np.testing.assert_array_equal(other_foam, alone_foam)
            there = other_foam[low[1] - rows : high[1] - rows, low[0] - columns : high[0] - columns]
            here = mine[low[1] : high[1], low[0] : high[0]]
            np.testing.assert_allclose(there, here, atol=2e-3)


def test_who_moves_on_looks_back_only_where_nobody_did(sea, monkeypatch):
    """Two steps of the finest ring: its strips of 8 of 192 columns each, and less of coarser ones."""
    looked = []
    original = AnywhereSum.compression_at

    def counted(self, x, y, time):
        looked.append(x.size)
        return original(self, x, y, time)

    monkeypatch.setattr(AnywhereSum, "compression_at", counted)
    following = FoamRings(FoamLevels(sea))
    shown = len(following.at(TIME, Place(0.0, 0.0)).foam) * SAMPLES**2
    whole = sum(looked)
    for x in (2.0, 4.0):
        looked.clear()
        following.at(TIME, Place(x, 0.0))
        assert sum(looked) - shown < 0.1 * (whole - shown)
    looked.clear()
    following.at(TIME, Place(4.0, 0.0))
    assert sum(looked) == shown


@pytest.mark.parametrize("wind", [12.0, 18.0, 24.0])
def test_places_can_be_replaced_by_others_at_any_time(wind):
    """Below, in and above the winds in which windrows rise: what stays where it was born has its own past."""
    layer = WaveLayer(wind_speed=wind, fetch=20e3, wind_direction=0.4)
    patches = (Patch(120.0, 0.3, 12.0, 1e6, 40), Patch(31.0, -0.9, 3.0, 12.0, 32))
    ocean = Ocean(OceanParameters(seed=3, layers=(layer,), patches=patches, foam=Foam(coverage=6.0)))
    rows = ocean.foam_model.windrows
    assert (rows is None, rows is not None and rows.strength == 1.0) == (wind == 12.0, wind == 24.0)

    def remembering(foam, time):
        for index in foam.missing(time):
            foam.remember(index)
        return foam.whitecaps(time)

    x, y = np.random.default_rng(5).uniform(0.0, 300.0, (2, 3000))
    following = ocean.new_drifting_foam(*np.random.default_rng(6).uniform(0.0, 300.0, (2, 3000)))
    left = np.arange(3000)
    for time in np.arange(20.0, 26.0, 0.4):
        remembering(following, time)
        some, left = left[:220], left[220:]
        entering = ocean.new_drifting_foam(x[some], y[some])
        remembering(entering, time)
        following.put(some, entering)
    alone = remembering(ocean.new_drifting_foam(x, y), 26.1)
    assert np.mean(alone.foam > 0.1) > 0.005
    for ours, theirs in zip(remembering(following, 26.1), alone, strict=True):
        np.testing.assert_array_equal(ours, theirs)


def test_rings_lie_around_the_place(rings):
    for number in range(len(rings.foam)):
        x, y = places_of(rings, number)
        reach = FINEST * 2.0**number * INNER * SAMPLES
        assert x.min() < 300.0 - reach
        assert x.max() > 300.0 + reach
        assert y.min() < -200.0 - reach
        assert y.max() > -200.0 + reach


def test_as_much_near_as_far():
    """The mean over the horizontal plane is the law's, on each ring and beyond them."""
    layer = WaveLayer(wind_speed=11.0, fetch=3e3, wind_direction=0.4)
    patches = (Patch(150.0, 0.3, 8.0, 1e6, 128), Patch(41.0, -0.9, 1.0, 8.0, 256))
    sea = OceanParameters(layers=(layer,), patches=patches, foam=Foam(half_life=0.3))
    wanted = foam_outlook(sea).coverage
    found = []
    for seed in range(4):
        rings = FoamRings(FoamLevels(sea.replace(seed=seed, patches=patches))).at(TIME, Place(20.0, 10.0))
        whole = Ocean(sea.replace(seed=seed, patches=patches))
        of_seed = []
        for number, foam in enumerate(rings.foam):
            on = Places(*(along[::2, ::2] for along in places_of(rings, number)))
            area = np.maximum(whole.surface(TIME, {"jacobian"}, on=on).jacobian, 0.0)
            of_seed.append(np.average(foam.foam[::2, ::2], weights=area))
        assert rings.beyond.foam == pytest.approx(wanted)
        found.append(of_seed)
    assert np.mean(found, axis=0) == pytest.approx(wanted, rel=0.25)


def test_no_lattice_shows_at_two_samples_a_wave():
    """Samples 2 m apart and waves down to 4 m: along rows foam has no more of 2 m, or of any length."""
    layer = WaveLayer(wind_speed=12.0, fetch=8e3, wind_direction=0.4)
    patch = Patch(128.0, 0.0, 4.0, 1e6, 64)
    power = np.zeros(SAMPLES // 2 + 1)
    for seed in range(3):
        sea = OceanParameters(seed=seed, layers=(layer,), patches=(patch,), foam=FOAM)
        foam = FoamRings(FoamLevels(sea)).at(TIME, Place(64.0, 64.0)).foam[0].foam
        for rows in (foam, foam.T):
            power += (np.abs(np.fft.rfft(rows * np.hanning(SAMPLES), axis=1)) ** 2).mean(axis=0)
    number = np.arange(8, 80)
    trend = np.polynomial.Polynomial.fit(number, np.log(power[number]), 6)
    beyond = power[number] / np.exp(trend(number))
    assert beyond.max() < 1.3
