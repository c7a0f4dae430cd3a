# SPDX-License-Identifier: GPL-3.0-or-later
"""Spray where waves break on a coast."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from ocean_tweak.core import (
    Coast,
    Ocean,
    OceanParameters,
    Places,
    Raster,
    Spray,
    Water,
    WaveLayer,
)
from ocean_tweak.core.parameters.shot import Shot
from ocean_tweak.core.sea.shot_spray import ShotSpray
from ocean_tweak.core.sea.spray import CameraSpray
from ocean_tweak.core.sea.spray_outlook import why_none
from ocean_tweak.core.waves.coast.breakers import breaker_spray

SIDE = 200.0
BEACH = np.repeat(np.linspace(12.0, -1.0, 101)[np.newaxis], 101, axis=0)
TIME, BEFORE_THE_SHORE = 20.0, (150.0, 100.0)


def sea(wind: bool = False, **of_coast: object) -> OceanParameters:
    """A swell of 2.5 m on a beach; with a gale that tears its crests, if wanted."""
    coast = Coast(depth=Raster(BEACH), spacing=2.0, rim=40.0, shortest_wavelength=35.0, **of_coast)
    swell = WaveLayer(definition="SEA_STATE", significant_wave_height=2.5, peak_period=9.0)
    layers = (swell, WaveLayer(wind_speed=18.0, fetch=60e3)) if wind else (swell,)
    return OceanParameters(
        resolution=64, domain_size=SIDE, water=Water(depth=20.0), layers=layers, coast=coast, seed=3
    )


def test_breakers_throw_up_water_without_wind() -> None:
    made = CameraSpray.of(sea()).at(TIME, Spray(life=0.6), BEFORE_THE_SHORE)
    assert why_none(sea()) is None
    assert len(made.age) > 300
    x = made.position[:, 0]
    depth = np.interp(x, np.linspace(0.0, SIDE, 101), BEACH[0])
    # of waves of 2.5 m, from a depth of some 6 m on, and water flies a few metres further
    assert np.percentile(depth, 98) < 8.0
    assert np.percentile(depth, 2) > -0.6
    # on the whole shorewards, and up
    assert made.velocity[:, 0].mean() > 1.0
    high = made.position[:, 2]
    assert 1.0 < high.max() < 8.0


@pytest.mark.usefixtures("only_near")
def test_without_breaking_there_is_none() -> None:
    assert why_none(sea(breaking=False)) is not None
    assert not len(CameraSpray.of(sea(breaking=False)).at(TIME, Spray(), BEFORE_THE_SHORE).age)


@pytest.mark.usefixtures("only_near")
def test_any_time_alone_is_as_in_a_sequence() -> None:
    spray, going = Spray(life=0.5), CameraSpray.of(sea())
    for step in range(3):
        found = going.at(TIME + Fraction(step, 24), spray, BEFORE_THE_SHORE)
    alone = CameraSpray.of(sea()).at(TIME + Fraction(2, 24), spray, BEFORE_THE_SHORE)
    for one, other in zip(found, alone, strict=True):
        np.testing.assert_array_equal(one, other)


@pytest.mark.usefixtures("only_near")
def test_spray_of_a_shot_ends_beside_the_bed_as_the_mesh_does() -> None:
    spray, parameters, place = Spray(life=0.5), sea(), (150.0, 20.0)
    baked = ShotSpray(Shot(parameters), spray, place).at(1 + 24 * int(TIME))
    whole = CameraSpray.of(parameters).at(TIME, spray, place)
    there = (whole.position[:, 1] >= 0.0) & (whole.position[:, 1] <= SIDE)
    assert 50 < there.sum() < len(there)
    np.testing.assert_array_equal(baked.position, whole.position[there])


@pytest.mark.usefixtures("only_near")
def test_a_gale_tears_crests_offshore_as_on_the_open_sea_and_none_over_land() -> None:
    spray, place = Spray(life=0.5), (-150.0, 100.0)
    found = CameraSpray.of(sea(wind=True)).at(TIME, spray, place)
    offshore = found.position[found.position[:, 0] < -90.0]
    parameters = sea(wind=True)
    muted = parameters.replace(coast=replace(parameters.coast, muted=True))
    open_sea = CameraSpray.of(muted).at(TIME, spray, place)
    expected = open_sea.position[open_sea.position[:, 0] < -90.0]
    assert len(expected) > 100
    np.testing.assert_allclose(
        np.sort(offshore[np.abs(offshore[:, 0] + 150.0) < 20.0], axis=0),
        np.sort(expected[np.abs(expected[:, 0] + 150.0) < 20.0], axis=0),
        atol=1e-3,
    )
    inland = [
        CameraSpray.of(each).at(TIME, spray, (220.0, 100.0)).position[:, 0] for each in (parameters, muted)
    ]
    # land begins at 185 m, and a gale carries spray some metres over it
    assert [int((x > 200.0).sum()) > 0 for x in inland] == [False, True]


def test_more_is_thrown_by_higher_breakers_and_as_fast_as_they_go() -> None:
    water = np.array([[2.0, 0.0, 0.5], [2.0, 0.0, 0.5], [0.0, -1.0, -0.4]])
    found = breaker_spray(np.ones(3), np.array([1.0, 2.0, 2.0]), np.array([2.0, 3.0, 3.0]), water, 9.81)
    assert found.strength[1] / found.strength[0] == pytest.approx(2.0**2.5)
    assert found.velocity[1, 0] == pytest.approx(np.sqrt(9.81 * 5.0))
    assert found.velocity[2, 1] == pytest.approx(-np.sqrt(9.81 * 5.0))
    assert found.velocity[1, 2] > found.velocity[0, 2] > 0.5
    still = breaker_spray(np.zeros(1), np.ones(1), np.ones(1), np.zeros((1, 3)), 9.81)
    assert still.strength[0] == 0.0
    assert np.isfinite(still.velocity).all()


def test_what_is_thrown_follows_the_whitest_fronts() -> None:
    ocean = Ocean(sea())
    assert ocean.coast is not None
    x, y = (each.ravel() for each in np.meshgrid(np.arange(60.0, 198.0, 2.0), np.arange(0.0, 200.0, 2.0)))
    velocity = ocean.surface(TIME, {"velocity"}, Places(x, y)).velocity
    thrown = ocean.coast.spray(x, y, TIME, velocity).strength
    breaks = ocean.coast.breaks(x, y, TIME)
    assert 0.01 < breaks.mean() < 0.5
    assert (thrown[~breaks] == 0.0).all()
    assert thrown[breaks].max() > 0.3


def test_water_over_the_bed_follows_from_the_open_sea() -> None:
    parameters = sea()
    x, y = np.linspace(-60.0, 199.0, 40), np.linspace(10.0, 190.0, 40)
    names = ("displacement", "velocity", "slope", "strain")
    whole = Ocean(parameters, precision="double")
    muted = Ocean(parameters.replace(coast=replace(parameters.coast, muted=True)), precision="double")
    before = muted.surface(TIME, names, Places(x, y))
    assert whole.coast is not None
    found = whole.coast.over({name: before[name] for name in names}, x, y, TIME)
    expected = whole.surface(TIME, names, Places(x, y))
    for name in names:
        np.testing.assert_allclose(found[name], expected[name], atol=2e-6, err_msg=name)
