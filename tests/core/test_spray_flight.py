# SPDX-License-Identifier: GPL-3.0-or-later
"""How particles of spray start, how fast they fly, and when they are gone."""

from __future__ import annotations

import numpy as np

from ocean_tweak.core import Spray
from ocean_tweak.core.numerics import random
from ocean_tweak.core.spray import drops
from ocean_tweak.core.spray.flight import Flight
from ocean_tweak.core.spray.particles import Crests, Particles, friction_velocity, in_the_air
from ocean_tweak.core.waves.contribution import Wind

STEP = 0.125


def thrown(wind: float, since: float, water: float = 0.0, births: float = 10.0) -> Particles:
    """Of cells without extent at the origin, whose water moves along x."""
    count = 4000
    key, gust = (random.hash_cells(np.arange(count), np.arange(count), 3, stream) for stream in (1, 2))
    ones, rest = np.ones(count, np.float32), np.zeros((count, 3), np.float32)
    moving = np.tile(np.float32((water, 0.0, 0.0)), (count, 1))
    crests = Crests(key, gust, births * ones, ones, rest, np.zeros((count, 2, 3), np.float32), moving)
    return in_the_air(crests, Spray(), Wind(wind, 0.0), STEP, since)


def test_what_air_lifts_out_of_the_water_into_which_it_was_thrown_is_not_spray() -> None:
    start, none = np.zeros((1, 3), np.float32), np.zeros((1, 3), np.float32)
    rising = Flight(
        start, np.float32([[0.0, 0.0, -2.0]]), none + np.float32([0.0, 0.0, 9.0]), np.float32([0.3])
    )
    place, _ = rising.at(np.float32([2.0]))
    assert place[0, 2] > 1.0
    assert not rising.is_above(place)[0]


def test_what_starts_within_a_moment_starts_from_where_the_water_is_then() -> None:
    """Big drops that have just left a crest of 10 m/s are still over it."""
    found = thrown(wind=0.0, since=0.0, water=10.0)
    some = found.kind == drops.DROPLET
    assert some.sum() > 100
    assert found.age[some].max() > 0.8 * 0.5 * STEP
    assert np.all(np.abs(found.position[some, 0]) < 0.25 * 10.0 * found.age[some] + 1e-3)


def test_mist_flies_no_faster_than_the_wind_ten_metres_up() -> None:
    found = thrown(wind=40.0, since=1.0, births=1000.0)
    mist = found.kind == drops.MIST
    assert mist.sum() > 100
    speed = np.hypot(*found.velocity[mist, :2].T)
    assert 39.0 < speed.max() <= 40.0 + 1e-3


def test_puffs_of_mist_spread_by_the_turbulence_of_the_wind() -> None:
    """By 0.3 friction velocities, from the size that they are born with."""
    young, old = (thrown(wind=25.0, since=since, births=300.0) for since in (0.25, 1.0))
    rates = []
    for found in (young, old):
        mist = found.kind == drops.MIST
        assert mist.sum() > 20
        grown = found.radius[mist] - 240.0 * Spray().size
        rates.append(grown / found.age[mist])
    np.testing.assert_allclose(np.concatenate(rates), 0.3 * friction_velocity(25.0), rtol=1e-3)


def test_mist_rises_as_a_plume_over_ground_does() -> None:
    """By 0.4 friction velocities on average (Batchelor 1964), less what its drops fall: 0.17 to 0.7 m/s."""
    found = thrown(wind=25.0, since=3.0, births=300.0)
    mist = found.kind == drops.MIST
    assert mist.sum() > 100
    rising = float((found.position[mist, 2] / found.age[mist]).mean())
    rate = 0.4 * friction_velocity(25.0)
    assert rate - 0.3 < rising < rate + 0.1  # those that have fallen back are not among them
