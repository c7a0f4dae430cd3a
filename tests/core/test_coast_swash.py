# SPDX-License-Identifier: GPL-3.0-or-later
"""Run-up, and the sand that it leaves wet."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from ocean_tweak.core import Ocean, WaveLayer
from ocean_tweak.core.sea.coast_waves import CoastWaves
from ocean_tweak.core.waves.coast.runup import highest_run_up, run_up
from tests.core.test_coast_sea import BEACH, sea

#: of the test's bed
SLOPE, SHORE = 0.065, 12.0 / 0.065


@pytest.fixture(scope="module")
def coast() -> CoastWaves:
    swell = WaveLayer(definition="SEA_STATE", significant_wave_height=1.5, peak_period=9.0)
    found = Ocean(sea().replace(layers=(swell,))).coast
    assert found is not None
    return found


def test_run_up_is_that_of_stockdon_and_others() -> None:
    # Hs 4 m, Tp 11 s, slope 0.1: set-up 0.96 m and R2 2.54 m (Leaman, Beuzen and Goldstein 2020)
    setup, swash = run_up(4.0, 9.81 * 11.0**2 / (2.0 * math.pi), np.array([0.1]))
    assert setup[0] == pytest.approx(0.96, abs=0.01)
    assert highest_run_up(setup, swash)[0] == pytest.approx(2.54, abs=0.01)


def test_beyond_slopes_that_were_measured_the_next_counts() -> None:
    """From 0.01 to 0.16 (Stockdon and others 2006, table 1)."""
    setup, swash = run_up(2.0, 100.0, np.array([0.0, 0.01, 0.16, 0.9]))
    assert_array_equal((setup[0], swash[0], setup[3], swash[3]), (setup[1], swash[1], setup[2], swash[2]))
    assert setup[1] < setup[2]


def test_in_the_lee_of_a_wall_waves_run_up_less() -> None:
    bed = BEACH.copy()
    bed[25:76, 70:73] = -1.0  # y from 50 to 150 m, at x = 140 m
    plain, walled = (Ocean(sea(each)).coast.swash.highest for each in (BEACH, bed))  # type: ignore[union-attr]
    assert walled.min() < 0.65 * plain.min()


def test_waves_run_up_as_high_as_was_measured_and_seldom_so_high(coast: CoastWaves) -> None:
    wavelength = 9.81 * 9.0**2 / (2.0 * math.pi)
    expected = highest_run_up(*run_up(1.5, wavelength, np.array([SLOPE])))[0]
    assert_allclose(coast.swash.highest, expected, rtol=0.12)
    # of many waves: 1 wave in 50 is to run so high
    swash = Ocean(sea()).coast.swash  # type: ignore[union-attr]
    reaches = swash.reach(list(np.linspace(0.0, 511.0, 400)))
    assert (reaches <= swash.highest + 1e-9).all()
    at_highest = np.mean(reaches >= swash.highest - 1e-9)
    assert 0.005 < at_highest < 0.04
    assert reaches.min() > 0.0


def test_sand_is_wet_up_to_where_waves_ran_and_dries(coast: CoastWaves) -> None:
    x = SHORE + np.linspace(-20.0, 15.0, 141)
    y = np.full(x.size, 60.0)
    wet = coast.wet(x, y, 30.0)
    assert (wet[x < SHORE - 3.5] == 1.0).all()
    assert (wet[x > SHORE + coast.swash.highest.max() / SLOPE + 4.0] == 0.0).all()
    on_land = wet[x > SHORE + 0.5]
    assert (np.diff(on_land) <= 1e-6).all()  # never wetter farther up
    assert ((on_land > 0.05) & (on_land < 0.95)).any()
    # where no wave comes it dries steadily, in 40 s
    land = x > SHORE + 0.5
    sequence = np.array([coast.wet(x, y, time)[land] for time in np.arange(30.0, 90.0, 3.0)])
    dried = -np.diff(sequence, axis=0)[(sequence[1:] < sequence[:-1]) & (sequence[1:] > 0.0)]
    assert np.median(dried) == pytest.approx(3.0 / 40.0, abs=0.01)
    assert_array_equal(coast.wet(x, y, 30.0), wet)
