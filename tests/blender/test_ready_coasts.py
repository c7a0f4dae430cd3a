# SPDX-License-Identifier: GPL-3.0-or-later
"""What stands and floats in the ready scenes with a coast, and their ground."""

import numpy as np
import pytest


@pytest.fixture
def beds(extension):
    return extension("core.waves.coast.beds").BEDS


@pytest.mark.parametrize("bed", ["BEACH", "HARBOUR", "ISLET"])
def test_ground_is_the_bed_under_water_and_land_stays_land(empty_scene, extension, beds, bed):
    scale = 0.5
    item = extension("scene.ground").add_ground("Ground", bed, empty_scene.collection, scale)
    places = np.empty(3 * len(item.data.vertices), np.float32)
    item.data.attributes["position"].data.foreach_get("vector", places)
    x, y, height = places.reshape(-1, 3).T.astype(np.float64) / scale
    expected = beds[bed](x, y)
    np.testing.assert_allclose(height[expected <= 0.0], expected[expected <= 0.0], atol=1e-4)
    assert (height[expected > 0.0] > 0.0).all()
    assert (np.abs(height - expected).max() > 1.0) == (bed != "HARBOUR")


def test_rock_that_is_seen_has_steps_between_level_places(empty_scene, extension, beds):
    """The formula of the islet is smooth, and the mesh is finer on rock than elsewhere."""
    item = extension("scene.ground").add_ground("Ground", "ISLET", empty_scene.collection, 1.0)
    places = np.empty(3 * len(item.data.vertices), np.float32)
    item.data.attributes["position"].data.foreach_get("vector", places)
    side = round(len(item.data.vertices) ** 0.5)
    x, y, height = places.reshape(side, side, 3).T.astype(np.float64)
    steps = np.abs(np.diff(height, axis=0)) / np.diff(x, axis=0)
    of_formula = np.abs(np.diff(beds["ISLET"](x, y), axis=0)) / np.diff(x, axis=0)
    rock = beds["ISLET"](x, y)[1:] > 2.0
    assert np.diff(x, axis=0)[rock].max() < 0.5
    assert (of_formula[rock] > 1.5).mean() < 0.01
    assert 0.05 < (steps[rock] > 1.5).mean() < 0.4
    assert (steps[rock] < 0.5).mean() > 0.2


def test_land_goes_on_behind_the_harbour_and_waves_do_not_see_it(empty_scene, extension, beds):
    item = extension("scene.hinterland").add_hinterland("Land", empty_scene.collection, 0.5)
    places = np.empty(3 * len(item.data.vertices), np.float32)
    item.data.attributes["position"].data.foreach_get("vector", places)
    x, y, height = places.reshape(-1, 3).T.astype(np.float64) / 0.5
    over_bed = (x < 512.0) & (y > 0.0) & (y < 512.0)
    assert (height[over_bed] < beds["HARBOUR"](x, y)[over_bed]).all()
    assert (height[(x > 460.0) & ~over_bed] > 2.0).all()
    assert y.min() < -2000.0
    assert y.max() > 2000.0
    assert 40.0 < height[x > 2000.0].max() < 200.0
    assert item.data.polygons[0].normal.z > 0.0


def test_sand_is_level_and_rock_is_not(empty_scene, extension):
    """The bay's beach is sand down its whole length, its headlands are rock."""
    item = extension("scene.ground").add_ground("Ground", "BEACH", empty_scene.collection, 1.0)
    places = np.empty(3 * len(item.data.vertices), np.float32)
    rock = np.empty(len(item.data.vertices), np.float32)
    item.data.attributes["position"].data.foreach_get("vector", places)
    item.data.attributes["rock"].data.foreach_get("value", rock)
    x, y, height = places.reshape(-1, 3).T
    beach = (np.abs(y - 256.0) < 90.0) & (height > 0.0) & (height < 2.0)
    cliff = (y < 40.0) & (height > 3.0) & (height < 6.0) & (x < 300.0)
    assert rock[beach].max() < 0.1
    assert rock[cliff].mean() > 0.8


def test_beacons_and_sheds_stand_on_stone_and_boats_have_water_below_their_keels(extension, beds):
    coasts = extension("scene.moods").COASTS
    boat_hull = extension("scene.boat_hull")
    shores = [mood.shore for mood in coasts.values()]
    assert any(shore.beacons for shore in shores)
    assert any(shore.boat for shore in shores)
    assert any(shore.sheds for shore in shores)
    for shore in shores:
        for x, y, z in shore.beacons:
            assert beds[shore.bed](np.array(x), np.array(y)) == pytest.approx(z, abs=0.2)
        for x, y, z in shore.sheds:
            assert beds[shore.bed](np.array(x), np.array(y)) == pytest.approx(z, abs=0.01)
        if shore.boat is not None:
            x, y, _heading = shore.boat
            assert beds[shore.bed](np.array(x), np.array(y)) < -2.0 * (boat_hull.DRAFT + boat_hull.LADEN)


@pytest.mark.parametrize(("is_port", "strongest"), [(True, 0), (False, 1)])
def test_beacons_are_red_to_port_and_green_to_starboard(empty_scene, extension, is_port, strongest):
    item = extension("scene.beacon").new_beacon(is_port, metres=0.5)
    assert int(np.argmax(item.data.materials[0].diffuse_color[:3])) == strongest
    assert max(corner[2] for corner in item.bound_box) == pytest.approx(2.0 * 7.6)


def test_sheds_have_roofs_over_their_walls(empty_scene, extension):
    item = extension("scene.sheds").new_sheds([(10.0, 20.0, 2.0)], metres=0.5)
    low, high = np.array(item.bound_box).min(axis=0), np.array(item.bound_box).max(axis=0)
    assert low[2] == pytest.approx(2.0 * 2.0)
    assert high[2] == pytest.approx(2.0 * (2.0 + 9.2))
    # as far to each side
    assert low[1] + high[1] == pytest.approx(2.0 * 40.0)
