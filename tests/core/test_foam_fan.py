# SPDX-License-Identifier: GPL-3.0-or-later
"""Foam for pictures from the air: cells of a few pixels, on the sea's crests, and as much as the law has."""

import dataclasses
import math
from fractions import Fraction

import numpy as np
import pytest

from ocean_tweak.core import Foam, Ocean, OceanParameters, Patch, Places, WaveLayer
from ocean_tweak.core.foam.threshold import foam_outlook
from ocean_tweak.core.sea.foam_fan import FoamFan, View
from ocean_tweak.core.sea.foam_levels import FINEST, FoamLevels

TIME = Fraction(25, 8)
PLACES = 12_000
HEIGHT, LOWEST = 40.0, math.radians(27.0)
VIEW = View(
    x=40.0, y=-25.0, near=HEIGHT / math.tan(LOWEST), azimuth=1.9, half_angle=math.radians(33.0), reach=30e3
)
AMONG = dataclasses.replace(VIEW, near=5.0, half_angle=math.radians(20.0), reach=8e3, is_low=True)


@pytest.fixture(scope="module")
def sea():
    layer = WaveLayer(wind_speed=11.0, fetch=3e3, wind_direction=0.4)
    patches = (Patch(150.0, 0.3, 8.0, 1e6, 128), Patch(41.0, -0.9, 1.0, 8.0, 256))
    return OceanParameters(layers=(layer,), patches=patches, foam=Foam(half_life=0.3, coverage=4.0))


@pytest.fixture(scope="module")
def levels(sea):
    return FoamLevels(sea)


@pytest.fixture(scope="module")
def fan(levels):
    return FoamFan(levels, PLACES).at(TIME, VIEW)


def seen_from(fan, view):
    """Distance from the place below the camera and angle from the middle of the picture."""
    away = (fan.x - view.x) + 1j * (fan.y - view.y)
    return np.abs(away), np.angle(away * np.exp(-1j * view.azimuth))


@pytest.mark.parametrize("height", [25.0, 100.0, 400.0])
def test_cells_grow_with_height_and_distance_as_what_a_pixel_covers(levels, height):
    """Of a picture of as many pixels as the fan has places: one to three, near and far."""
    view = dataclasses.replace(VIEW, near=height / math.tan(LOWEST))
    made = FoamFan(levels, PLACES).at(Fraction(0), view)
    assert PLACES * 0.97 < made.x.size <= PLACES
    place = made.x + 1j * made.y
    cells = np.sqrt(np.abs(np.diff(place, axis=0)[:, :-1]) * np.abs(np.diff(place, axis=1)[:-1]))
    distance, angle = (part[:-1, :-1] for part in seen_from(made, view))
    inside = (np.abs(angle) < view.half_angle) & (distance > view.near)
    inside &= distance < 10.0 * height
    pixel = 2.0 * view.half_angle * math.sqrt(27.0 / 64.0 / PLACES)
    slant = np.hypot(distance, height)
    ratio = (cells / (pixel * slant * np.sqrt(slant / height)))[inside]
    assert ratio.min() > 0.7
    assert ratio.max() < 3.0
    np.testing.assert_allclose(made.size[:-1, :-1][inside], cells[inside], rtol=0.1)


def test_before_a_camera_among_the_waves_cells_are_as_a_pixel_on_their_faces(levels):
    """Of a face that rises by a third: as many pixels wide at every distance, and some times as long."""
    made = FoamFan(levels, PLACES).at(Fraction(0), AMONG)
    assert PLACES * 0.97 < made.x.size <= PLACES
    place = made.x + 1j * made.y
    distance, angle = (part[:-1, :-1] for part in seen_from(made, AMONG))
    inside = (np.abs(angle) < AMONG.half_angle) & (distance > 2.0 * AMONG.near)
    inside &= distance < 0.5 * AMONG.reach
    along, across = (np.abs(np.diff(place, axis=0))[:, :-1], np.abs(np.diff(place, axis=1))[:-1])
    assert np.median((along / across)[inside]) == pytest.approx(3.0, rel=0.15)
    wide = (across / distance)[inside]
    assert wide.max() < 1.3 * wide.min()
    assert np.mean(inside) > 0.2  # of vertices all around it would be a ninth


def test_the_whole_picture_lies_on_it(fan):
    distance, angle = seen_from(fan, VIEW)
    corner = VIEW.near
    dense = np.median(fan.size[(distance < 1.1 * corner) & (distance > 0.95 * corner)])
    for aside in (-1.0, -0.5, 0.0, 0.5, 1.0):
        near = np.hypot(distance - corner, corner * (angle - aside * VIEW.half_angle)).min()
        assert near < 2.0 * dense
    assert distance.max() == pytest.approx(VIEW.reach, rel=0.1)
    np.testing.assert_array_equal(fan.x[:, 0], fan.x[:, -1])


def test_water_that_a_storm_carries_into_the_picture_has_its_own_foam():
    """Beside the picture there is the mean, and where that came into it there was a straight edge."""
    layer = WaveLayer(wind_speed=25.0, fetch=300e3, wind_direction=0.4)
    patches = (Patch(900.0, 0.3, 20.0, 1e6, 128), Patch(130.0, -0.9, 3.0, 20.0, 128))
    storm = OceanParameters(layers=(layer,), patches=patches, foam=Foam(half_life=0.3), choppiness=1.25)
    levels = FoamLevels(storm)
    made = FoamFan(levels, PLACES).at(TIME, AMONG)
    displacement = Ocean(storm).surface(TIME, {"displacement"}, on=Places(made.x, made.y)).displacement
    is_mean = made.foam.foam == np.float32(levels.beyond.foam)
    away = np.hypot(displacement[..., 0], displacement[..., 1])
    assert away.max() > 4.0
    shown = dataclasses.replace(made, x=made.x + displacement[..., 0], y=made.y + displacement[..., 1])
    distance, angle = seen_from(shown, AMONG)
    inside = (np.abs(angle) < AMONG.half_angle) & (distance > 3.0 * AMONG.near) & (distance < 100.0)
    assert np.count_nonzero(inside) > 500
    assert np.mean(is_mean[inside]) < 0.003


def test_foam_is_that_of_the_sea_with_the_waves_that_are_seen(fan, levels):
    level = 2
    whole = (fan.size > 1.05 * FINEST * 2.0**level) & (fan.size < 1.7 * FINEST * 2.0**level)
    distance, angle = seen_from(fan, VIEW)
    whole &= (np.abs(angle) < VIEW.half_angle) & (distance > 60.0)
    assert np.count_nonzero(whole) > 300
    sea = levels.seas[level]
    fields = sea.surface(TIME, {"foam", "breaking"}, on=Places(fan.x[whole], fan.y[whole]))
    for ours, own in ((fan.foam.foam, fields.foam), (fan.foam.breaking, fields.breaking)):
        share, rest = np.polyfit(own, ours[whole], 1)
        np.testing.assert_allclose(ours[whole], share * own + rest, atol=5e-3)
        assert 0.5 < share < 1.001
    # as much foam as the law has, of which the even rest is the part that no pixel tells
    assert rest < 0.5 * levels.beyond.breaking


def test_beside_the_picture_and_beyond_its_cells_there_is_the_mean(fan, sea):
    distance, angle = seen_from(fan, VIEW)
    outside = (np.abs(angle) > VIEW.half_angle + math.radians(15.0)) | (distance > 12e3)
    assert fan.foam.foam[outside] == pytest.approx(foam_outlook(sea).coverage)


def test_a_view_near_by_has_the_same_fan_and_any_order_the_same_foam(levels, fan):
    near = dataclasses.replace(VIEW, x=VIEW.x - 1.0, azimuth=VIEW.azimuth + 0.01)
    other = FoamFan(levels, PLACES)
    other.at(TIME - 1, dataclasses.replace(VIEW, azimuth=0.0))
    other.at(TIME - Fraction(1, 8), VIEW)
    made = other.at(TIME, near)
    np.testing.assert_array_equal(made.x, fan.x)
    for ours, theirs in zip(fan.foam, made.foam, strict=True):
        np.testing.assert_array_equal(ours, theirs)


def test_as_much_as_the_law_has_at_every_distance(sea):
    wanted = foam_outlook(sea).coverage
    found = []
    for seed in range(3):
        own = sea.replace(seed=seed, patches=sea.patches)
        made = FoamFan(FoamLevels(own), 4 * PLACES).at(TIME, VIEW)
        area = Ocean(own).surface(TIME, {"jacobian"}, on=Places(made.x, made.y)).jacobian
        area = np.maximum(area, 0.0) * made.size**2
        distance, angle = seen_from(made, VIEW)
        inside = np.abs(angle) < VIEW.half_angle
        bands = ((58.0, 90.0), (90.0, 130.0), (130.0, 900.0))
        chosen = [inside & (distance > low) & (distance < high) for low, high in bands]
        found.append([np.average(made.foam.foam[each], weights=area[each]) for each in chosen])
    assert np.mean(found, axis=0) == pytest.approx(wanted, rel=0.2)
