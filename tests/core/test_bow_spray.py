# SPDX-License-Identifier: GPL-3.0-or-later
"""Spray of bows: where, how much and which way, and that it is part of the sea's."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest

from ocean_tweak.core import (
    Current,
    Foam,
    Mask,
    Ocean,
    OceanParameters,
    PathSample,
    Places,
    Spray,
    WakeLayer,
    WaveLayer,
)
from ocean_tweak.core.sea.foam_levels import FoamLevels
from ocean_tweak.core.sea.foam_rings import FoamRings, Place
from ocean_tweak.core.sea.hull_motion import HullMotion
from ocean_tweak.core.sea.patch_plan import Wish, planned
from ocean_tweak.core.sea.placed_waves import has_tile, is_seen_around, own_spray
from ocean_tweak.core.sea.spray import CameraSpray
from ocean_tweak.core.sea.spray_outlook import check_spray, why_none
from ocean_tweak.core.spray.particles import Particles

SPEED = 9.0
#: its middle is at the origin at 10 s, its bow at x = 20 m
SHIP = WakeLayer(
    path=(PathSample(0.0, -10.0 * SPEED), PathSample(20.0, 10.0 * SPEED)),
    length=40.0, beam=10.0, draught=3.0, area_size=512.0, area_resolution=256, decay=0.06,
)  # fmt: skip
TIME = 10.0


def around(ship: WakeLayer = SHIP, wind: float = 17.0, **changes: object) -> OceanParameters:
    breeze = WaveLayer(wind_speed=wind, fetch=30e3)
    sea = planned(OceanParameters(seed=3, layers=(breeze,)), Wish(finest=2.0, area=200.0))
    return sea.replace(layers=(breeze, ship), **changes)


def thrown(
    height: float = 0.0,
    water: tuple[float, float, float] = (0.0, 0.0, 0.0),
    ship: WakeLayer = SHIP,
    **changes: object,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Places (P, 2) around the bow, strengths and velocities."""
    x, y = (each.ravel() for each in np.meshgrid(np.arange(-30.0, 30.0, 0.5), np.arange(-15.25, 15.5, 0.5)))
    own = own_spray(around(ship, **changes), x, y, TIME, np.full(x.size, height), np.tile(water, (x.size, 1)))
    return np.stack((x, y), axis=-1), own.strength, own.velocity


def test_a_bow_throws_water_ahead_aside_and_up() -> None:
    """From its own quarter of the hull, to either side alike, away from the hull."""
    place, strength, velocity = thrown()
    there = strength > 0.05
    assert place[there, 0].min() >= 10.0 - 1e-9
    assert place[there, 0].max() <= 20.0 + 1e-9
    port, starboard = there & (place[:, 1] > 0.0), there & (place[:, 1] < 0.0)
    assert strength[port].sum() == pytest.approx(strength[starboard].sum(), rel=1e-6)
    assert np.all(velocity[port, 1] > 2.0)
    assert np.all(velocity[starboard, 1] < -2.0)
    assert np.all(velocity[there, 2] > 0.5 * SPEED)
    assert np.all(velocity[there, 0] < SPEED)  # the hull overtakes it


def test_the_faster_hull_and_water_meet_the_more_is_thrown() -> None:
    """As the square: water that comes towards the bow, or rises at it; none that goes with the hull."""
    calm = thrown()[1].sum()
    assert thrown(water=(-SPEED, 0.0, 0.0))[1].sum() == pytest.approx(4.0 * calm, rel=1e-6)
    assert thrown(water=(0.0, 0.0, SPEED))[1].sum() == pytest.approx(2.0 * calm, rel=1e-6)
    assert thrown(water=(0.0, 0.0, -SPEED))[1].sum() == pytest.approx(calm, rel=1e-6)
    assert thrown(water=(SPEED, 0.0, 0.0))[1].sum() == 0.0


def test_a_hull_meets_the_water_as_fast_as_it_goes_down_itself() -> None:
    """A bow that falls is as water that rises, and one that is lifted out throws nothing."""

    def with_bow(raised: float, rise: float) -> float:
        x, y = (each.ravel() for each in np.meshgrid(np.arange(0.0, 25.0, 0.5), np.arange(-10.25, 10.5, 0.5)))
        still, water = np.zeros(x.size), np.zeros((x.size, 3))

        def lifts(layer: object, *_: object) -> tuple[np.ndarray, np.ndarray]:
            assert layer is SHIP
            return np.full(x.size, raised), np.full(x.size, rise)

        own = own_spray(around(), x, y, TIME, still, water, lifts)
        there = own.strength > 0.0
        assert np.all(own.velocity[there, 2] > 0.0)
        return float(own.strength.sum())

    calm = with_bow(0.0, 0.0)
    assert with_bow(0.0, -SPEED) == pytest.approx(2.0 * calm, rel=1e-6)
    assert with_bow(0.0, SPEED) == pytest.approx(calm, rel=1e-6)
    assert with_bow(SHIP.draught, 0.0) == 0.0
    assert with_bow(-SHIP.draught, 0.0) == pytest.approx(2.0 * calm, rel=1e-6)


def swell(period: float, height: float, size: float) -> OceanParameters:
    waves = WaveLayer(definition="SEA_STATE", significant_wave_height=height, peak_period=period)
    return OceanParameters(resolution=128, domain_size=size, seed=2, layers=(waves, SHIP))


def test_on_a_long_swell_a_bow_goes_with_the_water() -> None:
    """Waves of 15 hulls, and shorter ones down to 2: at the bow, hull and water go up and down together."""
    sea = swell(20.0, 4.0, 4096.0)
    motion, calm = HullMotion(sea), Ocean(sea.replace(layers=sea.layers[:1]))
    found = []
    for time in np.arange(5.0, 60.0, 3.7).tolist():
        x, y = np.array([-10.0 * SPEED + SPEED * time + 20.0]), np.array([0.0])
        lifted = motion.at(SHIP, x, y, Fraction(time))
        assert lifted is not None
        water = calm.surface(time, {"displacement", "velocity"}, on=Places(x, y))
        of_water = water.displacement[0, 2], water.velocity[0, 2]
        found.append((*of_water, lifted.height.item(), lifted.rise.item()))
    height, speed, raised, rise = np.array(found).T
    assert height.std() > 0.2
    for of_hull, of_water in ((raised, height), (rise, speed)):
        assert np.corrcoef(of_hull, of_water)[0, 1] > 0.9
        assert of_hull.std() == pytest.approx(of_water.std(), rel=0.3)


def test_short_waves_do_not_lift_a_hull() -> None:
    sea = swell(2.2, 0.2, 256.0)  # 7.5 m long
    motion = HullMotion(sea)
    assert motion.at(sea.layers[0], np.zeros(1), np.zeros(1), Fraction(1)) is None
    at = [motion.at(SHIP, np.array([20.0]), np.zeros(1), Fraction(time)) for time in (3, 7, 11)]
    assert max(abs(each.height.item()) for each in at if each is not None) < 0.1


def test_a_bow_in_a_trough_throws_nothing() -> None:
    calm = thrown()[1].sum()
    assert thrown(height=-SHIP.draught)[1].sum() == 0.0
    for deep in (1.0, 3.0):  # at most twice as much
        assert thrown(height=deep * SHIP.draught)[1].sum() == pytest.approx(2.0 * calm, rel=1e-6)


def test_at_two_and_a_half_metres_a_second_it_is_as_much_as_of_a_breaking_crest() -> None:
    place, strength, _ = thrown(water=(SPEED - 2.5, 0.0, 0.0))
    own = SHIP.own_foam(around(), *place.T, TIME)
    assert own is not None
    np.testing.assert_allclose(strength, own.breaking, atol=1e-6)
    assert strength.max() > 0.5


def test_a_slow_hull_one_without_foam_and_one_under_a_mask_throw_nothing() -> None:
    slow = SHIP.changed(path=(PathSample(0.0, -10.0), PathSample(20.0, 10.0)))
    for ship in (slow, SHIP.changed(foam=0.0), SHIP.changed(mask=Mask(x=500.0, y=0.0))):
        assert thrown(ship=ship)[1].max() < 0.02


def test_a_hull_that_has_stopped_throws_nothing() -> None:
    """Not at the moment of its stop either, when its way so far still has a bow."""
    stops = SHIP.changed(path=(PathSample(0.0, -10.0 * SPEED), PathSample(TIME), PathSample(2.0 * TIME)))
    with np.errstate(divide="raise", invalid="raise"):
        place, strength, velocity = thrown(ship=stops)
    assert strength.max() == 0.0
    assert np.all(velocity == 0.0)
    assert len(place) == len(velocity)


def test_a_current_along_with_hull_and_water_changes_nothing() -> None:
    """They meet as fast: what is thrown has the current's velocity besides."""
    _, strength, velocity = thrown()
    current = Current(speed=1.5, direction=0.0)
    carried = SHIP.changed(
        path=tuple(PathSample(each.time, each.x + 1.5 * (each.time - TIME)) for each in SHIP.path)
    )
    _, moved, faster = thrown(water=(1.5, 0.0, 0.0), ship=carried, current=current)
    np.testing.assert_allclose(moved, strength, atol=1e-6)
    there = strength > 0.05
    np.testing.assert_allclose(
        faster[there] - velocity[there], np.tile((1.5, 0.0, 0.0), (there.sum(), 1)), atol=1e-6
    )


def at_bow(particles: Particles) -> int:
    x, y, _ = particles.position.T
    return int(np.count_nonzero((x > 0.0) & (x < 25.0) & (np.abs(y) < 12.0)))


@pytest.mark.usefixtures("only_near")
def test_bows_are_part_of_the_sea_s_spray() -> None:
    """Around a camera there is much more at the bow than without a hull, and any frame is made alone."""
    with_ship, spray = CameraSpray(FoamLevels(around())), Spray(life=0.6)
    before, found = (with_ship.at(time, spray, (10.0, 0.0)) for time in (TIME - 1.0 / 24.0, TIME))
    without = CameraSpray(FoamLevels(around(SHIP.changed(muted=True)))).at(TIME, spray, (10.0, 0.0))
    assert at_bow(found) > 300 + 3 * at_bow(without)
    quarter = CameraSpray(FoamLevels(around(SHIP.changed(foam=0.25)))).at(TIME, spray, (10.0, 0.0))
    own, own_quarter = (at_bow(each) - at_bow(without) for each in (found, quarter))
    assert own == pytest.approx(4.0 * own_quarter, rel=0.25)  # not bounded by a cell's area
    assert not set(found.id.tolist()).isdisjoint(before.id.tolist())
    alone = CameraSpray(FoamLevels(around())).at(TIME, spray, (10.0, 0.0))
    assert all(one.tobytes() == other.tobytes() for one, other in zip(found, alone, strict=True))
    high = found.position[:, 2][(np.abs(found.position[:, 0] - 12.0) < 12.0)]
    assert 2.0 < np.quantile(high, 0.98) < 12.0
    assert math.isfinite(float(found.velocity.sum()))


@pytest.mark.usefixtures("only_near")
def test_in_calm_water_a_fast_ship_throws_what_its_speed_says() -> None:
    """No wind tears anything off: 183 particles a second and m², as of crests at 17 m/s, times the strength.

    On a single patch: one that has no tile, because of the ship.
    """
    sea = OceanParameters(resolution=64, domain_size=100.0, layers=(WaveLayer(wind_speed=0.0), SHIP))
    assert why_none(sea.replace(layers=sea.layers[:1])) is not None
    assert why_none(sea) is None
    spray, counts = Spray(life=0.125), []
    for seed in range(8):  # gusts come by chance
        found = CameraSpray(FoamLevels(sea.replace(seed=seed))).at(TIME, spray, (10.0, 0.0))
        assert len(found.age) == at_bow(found)
        counts.append(len(found.age))
    x, y = (each.ravel() for each in np.meshgrid(np.arange(5.0, 25.0, 0.25), np.arange(-12.0, 12.0, 0.25)))
    fields = Ocean(sea).surface(TIME, {"displacement", "velocity"}, on=Places(x, y))
    own = own_spray(sea, x, y, TIME, fields.displacement[:, 2], fields.velocity)
    born = 0.0625 * own.strength.sum() * 100.0 * (17.0 / 15.0) ** 4.85 * spray.life
    assert np.mean(counts) == pytest.approx(born, rel=0.2)
    breeze = sea.replace(layers=(WaveLayer(wind_speed=5.0, fetch=2e3), SHIP), seed=seed)
    in_breeze = CameraSpray(FoamLevels(breeze)).at(TIME, spray, (10.0, 0.0))
    assert at_bow(in_breeze) == pytest.approx(counts[-1], rel=0.05)


def test_what_has_no_tile_is_asked_where_it_is_seen_and_what_has_one_is_not() -> None:
    sea = OceanParameters(resolution=64, layers=(WaveLayer(wind_speed=15.0),))
    assert (has_tile(sea), is_seen_around(sea)) == (True, False)
    with_ship = sea.replace(layers=(*sea.layers, SHIP))
    assert (has_tile(with_ship), is_seen_around(with_ship)) == (False, True)
    check_spray(with_ship, Spray())
    muted = sea.replace(layers=(*sea.layers, SHIP.changed(muted=True)))
    assert (has_tile(muted), is_seen_around(muted)) == (True, False)


def test_foam_of_hulls_is_seen_as_far_off_whatever_the_waves() -> None:
    """Without a ship, rings end where the waves are shorter than their cells."""
    short = OceanParameters(resolution=64, domain_size=20.0, layers=(WaveLayer(wind_speed=4.0, fetch=500.0),))
    assert len(FoamLevels(short).seas) < 4
    short = short.replace(foam=Foam(half_life=0.3))
    for levels in (FoamLevels(short, far=True), FoamLevels(short.replace(layers=(*short.layers, SHIP)))):
        assert len(levels.seas) == 6
        rings = FoamRings(levels, 32).at(TIME, Place(0.0, 0.0))
        assert all(np.isfinite(np.stack(foam)).all() for foam in rings.foam)
