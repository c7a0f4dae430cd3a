# SPDX-License-Identifier: GPL-3.0-or-later
"""Make Waves: from a selected hull to its wake, live, and what is said where there can be none."""

import math

import bpy
import numpy as np
import pytest
from mathutils import Matrix, Vector

from . import floats
from .conftest import sea_of

# fixtures for every test here
select, ocean = floats.select, floats.ocean

#: of the hull, m; its lowest point is a metre and a half below its origin
LENGTH, BEAM, KEEL = 20.0, 5.0, 1.5
FIRST, LAST = floats.FRAMES


def new_hull(scene, name="Ship", along_y=False):
    size = (BEAM, LENGTH) if along_y else (LENGTH, BEAM)
    corners = [(x * size[0] / 2, y * size[1] / 2, z) for x in (-1, 1) for y in (-1, 1) for z in (-KEEL, 2.0)]
    faces = [(0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5)]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(corners, [], faces)
    item = bpy.data.objects.new(name, mesh)
    scene.collection.objects.link(item)
    return item


@pytest.fixture
def ship(empty_scene, ocean):
    """It goes 48 m in the scene's frames, along x of the world, at the height of the calm water."""
    item = new_hull(empty_scene)
    key(item, {FIRST: (20.0, 10.0, 2.0), LAST: (44.0, 10.0, 2.0)})
    return item


def key(item, places):
    for frame, place in places.items():
        item.location = place
        item.keyframe_insert("location", frame=frame)
    for curve in curves(item):
        for point in curve.keyframe_points:
            point.interpolation = "LINEAR"


def curves(item):
    action = item.animation_data.action
    if hasattr(action, "layers") and action.layers:
        return action.layers[0].strips[0].channelbag(item.animation_data.action_slot).fcurves
    return action.fcurves


def wake_of(ocean):
    return next(layer for layer in sea_of(ocean).layers if layer.kind == "WAKE")


def in_ocean(ocean, place):
    return ocean.matrix_world.inverted() @ Vector(place)


def test_two_presses_from_a_selected_ship(ocean, ship, select, core, extension, empty_scene, capfd):
    """It has its size, its path in the ocean's axes, and its waves on a camera surface."""
    select(ship)
    assert bpy.ops.object.ocean_tweak_float() == {"FINISHED"}
    assert bpy.ops.object.ocean_tweak_wake() == {"FINISHED"}
    wake = wake_of(ocean)
    draft = min(BEAM / 3.0, 1.75)
    assert (wake.length, wake.beam, wake.draught) == pytest.approx((LENGTH, BEAM, draft), abs=1e-5)
    assert wake.headings == "OF_SAMPLES"
    assert [sample.time for sample in wake.path] == pytest.approx([0.0, (LAST - FIRST) / 24.0])
    for sample, x in zip(wake.path, (20.0, 44.0), strict=True):
        place = in_ocean(ocean, (x, 10.0, 0.0))
        assert (sample.x, sample.y) == pytest.approx((place.x, place.y), abs=1e-3)
        assert sample.heading == pytest.approx(-0.6, abs=1e-5)  # the ocean is turned by 0.6
    assert core.WakeLayer.outlook(sea_of(ocean)).wakes[0].speed == pytest.approx(24.0 * 24.0 / (LAST - FIRST))
    assert extension("scene.plan").camera_surface_of(ocean) is not None
    for frame in (FIRST, 20):
        empty_scene.frame_set(frame)
        assert ocean.ocean_tweak.error == ""
        area = next(child for child in ocean.children if child.name.endswith("Area"))
        moved = np.empty(3 * len(area.data.vertices), np.float32)
        area.data.attributes["displacement"].data.foreach_get("vector", moved)
        depth = moved.reshape(-1, 3)[:, 2]
        assert depth.min() < -0.5 * draft  # where the hull lies
        assert depth.max() > 0.05
    assert capfd.readouterr().err == ""  # no dependency cycle, no other complaint


def test_a_hull_rides_as_if_it_made_no_waves(ocean, ship, select, empty_scene):
    """It would lie in the dent that it makes itself."""
    select(ship)
    bpy.ops.object.ocean_tweak_float(riding="DAMPED")
    empty_scene.frame_set(12)
    before = ship.matrix_world.copy()
    bpy.ops.object.ocean_tweak_wake()
    empty_scene.frame_set(13)
    empty_scene.frame_set(12)
    assert np.abs(np.array(ship.matrix_world) - np.array(before)).max() < 1e-4


def test_the_path_follows_its_keys_and_the_hand(ocean, ship, select, empty_scene):
    select(ship)
    bpy.ops.object.ocean_tweak_wake()
    key(ship, {FIRST: (20.0, 10.0, 2.0), 25: (44.0, 10.0, 2.0), LAST: (44.0, 30.0, 2.0)})
    bpy.context.view_layer.update()
    path = wake_of(ocean).path
    assert [round(24.0 * sample.time) + 1 for sample in path] == [FIRST, 25, LAST]
    place = in_ocean(ocean, (44.0, 30.0, 0.0))
    assert (path[-1].x, path[-1].y) == pytest.approx((place.x, place.y), abs=1e-3)
    ship.animation_data_clear()
    ship.location = (5.0, 6.0, 2.0)
    bpy.context.view_layer.update()
    (still,) = wake_of(ocean).path
    place = in_ocean(ocean, (5.0, 6.0, 0.0))
    assert (still.x, still.y) == pytest.approx((place.x, place.y), abs=1e-3)


def test_pressed_again_it_takes_the_new_size_and_keeps_the_rest(ocean, ship, select):
    select(ship)
    bpy.ops.object.ocean_tweak_wake()
    group = ocean.ocean_tweak.layers[1].wake
    assert group.object == ship
    group.decay, group.area_resolution = 0.05, 1000
    ship.scale.x = 1.5
    bpy.context.view_layer.update()
    bpy.ops.object.ocean_tweak_wake()
    wake = wake_of(ocean)
    assert len(sea_of(ocean).layers) == 2
    assert wake.length == pytest.approx(1.5 * LENGTH, rel=1e-5)
    assert (wake.decay, wake.area_resolution) == (pytest.approx(0.05), 1000)


def test_a_hull_along_y_that_goes_backwards_has_its_bow_in_front(ocean, select, empty_scene):
    ship = new_hull(empty_scene, along_y=True)
    key(ship, {FIRST: (0.0, 30.0, 2.0), LAST: (0.0, 0.0, 2.0)})
    select(ship)
    bpy.ops.object.ocean_tweak_wake()
    wake = wake_of(ocean)
    assert (wake.length, wake.beam) == pytest.approx((LENGTH, BEAM))
    ahead = Matrix.Rotation(wake.path[0].heading + 0.6, 3, "Z") @ Vector((1.0, 0.0, 0.0))
    assert tuple(ahead) == pytest.approx((0.0, -1.0, 0.0), abs=1e-5)


def test_what_hangs_over_the_water_is_no_hull(ocean, select, empty_scene):
    """A boom, twice as long as the hull, behind it and above the water: the hull is what the water cuts."""
    ship, boom = new_hull(empty_scene), new_hull(empty_scene, "Boom")
    boom.parent, boom.location, boom.scale = ship, (-20.0, 0.0, 5.0), (2.0, 0.1, 0.1)
    ship.location = (0.0, 0.0, 2.0)
    select(ship)
    bpy.ops.object.ocean_tweak_wake()
    wake = wake_of(ocean)
    assert (wake.length, wake.beam, wake.draught) == pytest.approx((LENGTH, BEAM, KEEL), abs=1e-5)
    place = in_ocean(ocean, (0.0, 0.0, 0.0))
    assert (wake.path[0].x, wake.path[0].y) == pytest.approx((place.x, place.y), abs=1e-3)


def test_what_constraints_move_is_recorded(ocean, ship, select, empty_scene):
    """And stays as it was recorded: the ship follows a tug."""
    tug = bpy.data.objects.new("Tug", None)
    empty_scene.collection.objects.link(tug)
    key(tug, {FIRST: (0.0, 0.0, 2.0), LAST: (20.0, 20.0, 2.0)})
    ship.animation_data_clear()
    ship.constraints.new("COPY_LOCATION").target = tug
    empty_scene.frame_set(7)
    select(ship)
    bpy.ops.object.ocean_tweak_wake()
    assert empty_scene.frame_current == 7
    path = wake_of(ocean).path
    assert len(path) == 2
    place = in_ocean(ocean, (20.0, 20.0, 0.0))
    assert (path[-1].x, path[-1].y) == pytest.approx((place.x, place.y), abs=0.05)
    ship.location.x += 1.0
    bpy.context.view_layer.update()
    assert wake_of(ocean).path == path


def test_layers_may_be_added_and_ships_deleted(ocean, ship, select, empty_scene):
    """A wake keeps its object while layers come and go, and its path when the object is gone."""
    select(ship)
    bpy.ops.object.ocean_tweak_wake()
    path = wake_of(ocean).path
    select(ocean)
    bpy.ops.ocean.layer_add(kind="WAVES")
    number = next(n for n, layer in enumerate(ocean.ocean_tweak.layers) if layer.kind == "WAKE")
    assert ocean.ocean_tweak.layers[number].wake.object == ship
    bpy.data.objects.remove(ship)
    bpy.context.view_layer.update()
    empty_scene.frame_set(5)
    assert wake_of(ocean).path == path
    assert ocean.ocean_tweak.error == ""


def test_two_ships_and_a_copy_of_one(ocean, ship, select, empty_scene):
    other = ship.copy()
    other.animation_data_clear()
    other.location = (60.0, 60.0, 2.0)
    empty_scene.collection.objects.link(other)
    select(ship, other)
    bpy.ops.object.ocean_tweak_wake()
    makers = ocean.ocean_tweak.wake_makers()
    assert {item.name for _, item in makers} == {ship.name, other.name}
    assert len({layer.path for layer in sea_of(ocean).layers if layer.kind == "WAKE"}) == 2


def test_one_step_of_undo(ocean, ship, select, window):
    select(ship)
    with window.override():
        bpy.ops.ed.undo_push(message="before")
        bpy.ops.object.ocean_tweak_wake()
        bpy.ops.ed.undo_push(message="waves")
        assert len(bpy.data.objects["Ocean"].ocean_tweak.layers) == 2
        bpy.ops.ed.undo()
    assert len(bpy.data.objects["Ocean"].ocean_tweak.layers) == 1


def test_a_file_keeps_wakes(ocean, ship, select, tmp_path):
    select(ship)
    bpy.ops.object.ocean_tweak_wake()
    before = sea_of(ocean)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "wake.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "wake.blend"))
    ocean = bpy.data.objects["Ocean"]
    assert sea_of(ocean) == before
    assert ocean.ocean_tweak.layers[1].wake.object == bpy.data.objects["Ship"]


def refused(*changes):
    with pytest.raises(RuntimeError) as error:
        bpy.ops.object.ocean_tweak_wake()
    return str(error.value)


def test_what_makes_no_waves_is_told_with_the_remedy(ocean, ship, select, empty_scene):
    ship.animation_data_clear()
    ship.location.z = 10.0
    select(ship)
    assert "Ship is 6.5 m above the water: lower it, or press Float on Ocean first" in refused()
    ship.location.z, ship.scale.y = 2.0, 0.0
    select(ship)
    assert "Ship is flat, 20 by 0 m: choose what has a width" in refused()
    empty = bpy.data.objects.new("Empty", None)
    empty_scene.collection.objects.link(empty)
    select(empty)
    assert "Empty has no mesh that is rendered" in refused()
    ship.scale.y = 1.0
    key(ship, {FIRST: (0.0, 0.0, 2.0), FIRST + 1: (900.0, 0.0, 2.0), LAST: (901.0, 0.0, 2.0)})
    select(ship)
    assert "where it jumps, as at a cut, begin the path after the jump" in refused()
    ship.animation_data_clear()
    ocean.ocean_tweak.use_ocean_time = True
    select(ship)
    assert "has Keyed Time, which no path follows: switch it off" in refused()
    assert [layer.kind for layer in ocean.ocean_tweak.layers] == ["WAVES"]
    select(ocean)
    assert "Only oceans are selected" in refused()


def test_speed_is_in_metres_whatever_the_units(ocean, ship, select, empty_scene, core):
    """A foot a unit: 24 of them in 47 frames are 7.3 m in 2 s."""
    empty_scene.unit_settings.scale_length = 0.3048
    select(ship)
    bpy.ops.object.ocean_tweak_wake()
    wake = wake_of(ocean)
    assert wake.length == pytest.approx(0.3048 * LENGTH, rel=1e-5)
    speed = core.WakeLayer.outlook(sea_of(ocean)).wakes[0].speed
    assert speed == pytest.approx(24.0 * 0.3048 * 24.0 / (LAST - FIRST), rel=1e-4)
    assert math.isfinite(wake.area_size)


def test_over_a_bake_of_the_tile_alone_wakes_go_on(ocean, ship, select, bake, extension, empty_scene):
    """No image that repeats can hold them: they stay live, and another bake has them beside the tile."""
    select(ship)
    bpy.ops.object.ocean_tweak_wake()
    shots = extension("scene.shots")
    shot = shots.bake_shot_of(ocean, empty_scene)
    assert shots.needed_maps(ocean) == ("wakes",)
    job = extension("export.cache.job").Job("sea", "0" * 8, shot, ("disp", "wakes"), frames=(1, 2))
    assert job.maps == ("disp", "wakes")
    found = extension("scene.bake_state").differences(shot, 1, ocean.ocean_tweak, empty_scene)
    assert found == []
    tile = extension("core.sea.placed_waves").without_placed(shot.parameters)
    sequence = bake(tile, 1, 2)
    ocean.ocean_tweak.use_sequence(sequence.directory, sequence.name, sequence.frames)
    empty_scene.frame_set(2)
    area = next(child for child in ocean.children if child.name.endswith("Area"))
    moved = np.empty(3 * len(area.data.vertices), np.float32)
    area.data.attributes["displacement"].data.foreach_get("vector", moved)
    assert moved.reshape(-1, 3)[:, 2].min() < -0.5
    (need,) = extension("scene.portability").needs_of(ocean)  # on a machine without the extension
    assert (
        "shows waves of Ocean that do not repeat, which its bake does not have: bake Ocean again" in need.text
    )


def lofted(scene, name, half_beam, keel=1.5, above=1.0, upside=1.0):
    """An open boat of 20 m along x, its half beam at each of some stations, from its stern to its bow."""
    stations = np.linspace(-LENGTH / 2, LENGTH / 2, len(half_beam))
    corners, faces = [], []
    for x, half in zip(stations, half_beam, strict=True):
        corners += [(x, side * half, upside * z) for side in (-1, 1) for z in (-keel, above)]
    for first in range(0, 4 * (len(half_beam) - 1), 4):
        for a, b in ((0, 1), (2, 3), (0, 2)):  # starboard, port, bottom
            faces.append((first + a, first + b, first + b + 4, first + a + 4))
    last = 4 * (len(half_beam) - 1)
    faces += [(0, 1, 3, 2), (last, last + 1, last + 3, last + 2)]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(corners, [], faces)
    item = bpy.data.objects.new(name, mesh)
    scene.collection.objects.link(item)
    return item


def volume(wake):
    return float(wake.footprint.values.mean()) * wake.length * wake.beam * wake.draught


def test_the_footprint_is_the_part_of_the_mesh_below_the_water(ocean, select, empty_scene):
    """An open wedge, sharp at its bow, displaces half of its box, and comes to a point ahead."""
    half = BEAM / 2 * np.linspace(1.0, 0.02, 9)
    for turn, name in ((0.0, "Wedge"), (0.5 * math.pi, "Turned")):
        ship = lofted(empty_scene, name, half)
        ship.data.transform(Matrix.Rotation(turn, 4, "Z"))
        ship.location.z = 2.0  # the calm water's height
        way = Matrix.Rotation(turn, 3, "Z") @ Vector((20.0, 0.0, 0.0))
        key(ship, {FIRST: (0.0, 0.0, 2.0), LAST: (way.x, way.y, 2.0)})
        select(ship)
        bpy.ops.object.ocean_tweak_wake()
        wake = next(layer for layer in reversed(sea_of(ocean).layers) if layer.kind == "WAKE")
        assert volume(wake) == pytest.approx(0.51 * LENGTH * BEAM * KEEL, rel=0.05)
        rows, columns, _ = wake.footprint.shape
        shares = wake.footprint.values[..., 0].mean(axis=0)
        assert shares[4] > 0.85  # the stern
        assert shares[-4] < 0.15
        assert columns > rows


def test_a_wedge_that_goes_blunt_end_first_has_its_blunt_end_ahead(ocean, select, empty_scene):
    """And it stays the bow when its keys are turned round: then it goes astern."""
    ship = lofted(empty_scene, "Wedge", BEAM / 2 * np.linspace(1.0, 0.02, 9))
    key(ship, {FIRST: (20.0, 0.0, 2.0), LAST: (0.0, 0.0, 2.0)})
    select(ship)
    bpy.ops.object.ocean_tweak_wake()
    before = wake_of(ocean)
    assert before.footprint.values[:, -4].mean() > 0.85
    key(ship, {FIRST: (0.0, 0.0, 2.0), LAST: (20.0, 0.0, 2.0)})
    bpy.context.view_layer.update()
    after = wake_of(ocean)
    assert after.path[0].heading == pytest.approx(before.path[0].heading)
    assert after.footprint == before.footprint
    assert after.path != before.path


def test_a_hull_without_an_inside_makes_the_waves_of_an_ellipse(ocean, select, empty_scene, extension):
    """One that is upside down, or has no sides, is told of."""
    capsized = lofted(empty_scene, "Capsized", np.full(3, BEAM / 2), upside=-1.0)
    leaky = lofted(empty_scene, "Leaky", np.full(3, BEAM / 2))
    leaky.data.clear_geometry()
    leaky.data.from_pydata([(-9, -2, -1), (9, -2, -1), (9, 2, -1), (-9, 2, -1)], [], [(0, 1, 2, 3)])
    for item in (capsized, leaky):
        item.location.z = 2.0
        select(item)
        assert bpy.ops.object.ocean_tweak_wake() == {"FINISHED"}
        wake = next(layer for layer in reversed(sea_of(ocean).layers) if layer.kind == "WAKE")
        assert wake.footprint is None
        told = []
        extension("scene.wake_recording").new_wake(item, ocean, empty_scene, None, told.append)
        assert f"{item.name} makes the waves of an ellipse of its size: the hull encloses nothing" in told[0]


def test_it_stays_at_its_ship_at_another_frame_rate_and_start(ocean, ship, select, empty_scene):
    select(ship)
    bpy.ops.object.ocean_tweak_wake()
    empty_scene.render.fps = 48
    empty_scene.frame_set(3)
    assert [sample.time for sample in wake_of(ocean).path] == pytest.approx([0.0, (LAST - FIRST) / 48.0])
    ocean.ocean_tweak.timing.start_frame = FIRST + 12
    empty_scene.frame_set(4)
    assert wake_of(ocean).path[0].time == pytest.approx(-0.25)


def test_a_moved_ocean_leaves_the_wake_where_the_ship_is(ocean, ship, select, empty_scene):
    select(ship)
    bpy.ops.object.ocean_tweak_wake()
    bpy.context.view_layer.update()
    ocean.location.x += 10.0
    ocean.rotation_euler.z += 0.3
    bpy.context.view_layer.update()
    first, place = wake_of(ocean).path[0], in_ocean(ocean, (20.0, 10.0, 0.0))
    assert (first.x, first.y) == pytest.approx((place.x, place.y), abs=1e-3)
    assert first.heading == pytest.approx(-0.9, abs=1e-5)


def test_other_units_keep_path_and_hull_together(ocean, ship, select, empty_scene):
    select(ship)
    bpy.ops.object.ocean_tweak_wake()
    before = wake_of(ocean)
    bpy.context.view_layer.update()
    empty_scene.unit_settings.scale_length = 0.5
    empty_scene.frame_set(3)
    after = wake_of(ocean)
    assert after.length == pytest.approx(0.5 * before.length)
    assert after.path[0].x == pytest.approx(0.5 * before.path[0].x)


def test_what_makes_waves_may_float_afterwards(ocean, ship, select, empty_scene):
    """Blender 4.5 crashes where a handler evaluates what another one has just changed."""
    select(ship)
    bpy.ops.object.ocean_tweak_wake()
    assert bpy.ops.object.ocean_tweak_float(riding="DAMPED") == {"FINISHED"}
    empty_scene.frame_set(12)
    assert wake_of(ocean).path[0].time == 0.0
