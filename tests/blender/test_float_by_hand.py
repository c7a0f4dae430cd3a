# SPDX-License-Identifier: GPL-3.0-or-later
"""What floats goes where the hand puts it: moved, turned, parented, copied, deleted, undone, overridden."""

import math

import bpy
import numpy as np
import pytest
from mathutils import Matrix, Vector

from . import floats
from .floats import CENTIMETRE, sea_below

# fixtures for every test here
select, ocean, buoy = floats.select, floats.ocean, floats.buoy


@pytest.fixture
def floating(extension):
    return extension("scene.floating")


@pytest.fixture
def on_the_sea(core, make_parameters):
    """Whether an object is on the surface above a place in the world."""

    def check(item, sea, x, y, frame=1, **changes):
        bpy.context.view_layer.update()
        parameters = make_parameters(resolution=16, **changes)
        point, _ = sea_below(core, sea, parameters, frame, (x, y))
        np.testing.assert_allclose(item.matrix_world.translation, point, atol=CENTIMETRE)

    return check


def helpers():
    """All objects that no collection has."""
    return [item.name for item in bpy.data.objects if not item.users_collection]


def carriers():
    return [item for item in bpy.data.objects if item.get("ocean_tweak_float_part") == "follower"]


def test_nothing_of_it_is_seen(floating, ocean, buoy, select):
    select(buoy)
    bpy.ops.object.ocean_tweak_float()
    assert set(bpy.context.scene.objects) == {ocean, buoy}
    bpy.ops.object.select_all(action="SELECT")
    assert set(bpy.context.selected_objects) == {ocean, buoy}


def test_it_is_moved_and_turned(floating, ocean, buoy, on_the_sea, empty_scene):
    floating.float_on(buoy, ocean)
    buoy.location = (-70.0, 33.0, 4.0)
    on_the_sea(buoy, ocean, -70.0, 33.0)
    buoy.location.x += 100.0
    empty_scene.frame_set(9)  # a script does not wait for an evaluation
    on_the_sea(buoy, ocean, 30.0, 33.0, 9)
    buoy.rotation_euler.z = 1.0
    bpy.context.view_layer.update()
    ahead = buoy.matrix_world.to_3x3() @ Vector((1.0, 0.0, 0.0))
    assert math.atan2(ahead.y, ahead.x) == pytest.approx(1.0, abs=0.1)


def test_it_gets_and_loses_a_parent(floating, ocean, buoy, on_the_sea, empty_scene):
    tug = bpy.data.objects.new("Tug", None)
    empty_scene.collection.objects.link(tug)
    floating.float_on(buoy, ocean)
    buoy.location = (5.0, 6.0, 0.0)
    buoy.parent, buoy.matrix_parent_inverse = tug, Matrix.Translation((1.0, 0.0, 0.0))
    tug.location = (20.0, 0.0, 0.0)
    on_the_sea(buoy, ocean, 26.0, 6.0)
    tug.location.x = 50.0
    on_the_sea(buoy, ocean, 56.0, 6.0)
    buoy.parent = None
    on_the_sea(buoy, ocean, 5.0, 6.0)


def test_it_gets_keys_and_constraints(floating, ocean, buoy, on_the_sea, empty_scene):
    floating.float_on(buoy, ocean)
    for frame, x in ((1, 0.0), (11, 50.0)):
        buoy.location.x = x
        buoy.keyframe_insert("location", frame=frame)
    bpy.context.view_layer.update()
    empty_scene.frame_set(6)
    on_the_sea(buoy, ocean, 25.0, 40.0, 6)
    buoy.animation_data_clear()
    post = bpy.data.objects.new("Post", None)
    post.location = (-10.0, -20.0, 0.0)
    empty_scene.collection.objects.link(post)
    constraint = buoy.constraints.new("COPY_LOCATION")  # after the one that takes it to the water
    constraint.target = post
    on_the_sea(buoy, ocean, -10.0, -20.0, 6)
    constraint.influence = 0.0
    on_the_sea(buoy, ocean, *buoy.location[:2], 6)
    buoy.constraints.remove(constraint)
    buoy.location = (1.0, 2.0, 3.0)
    on_the_sea(buoy, ocean, 1.0, 2.0, 6)


def test_where_nothing_changes_nothing_is_written(floating, ocean, buoy, extension, empty_scene):
    post = bpy.data.objects.new("Post", None)
    empty_scene.collection.objects.link(post)
    buoy.constraints.new("TRACK_TO").target = post
    buoy.constraints.new("CHILD_OF").target = post
    buoy.keyframe_insert("location", frame=1)
    floating.float_on(buoy, ocean)
    bpy.context.view_layer.update()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    for _ in range(2):
        extension("scene.float_carrier").follow()
        depsgraph.update()
        changed = {each.id.name for each in depsgraph.updates if isinstance(each.id, bpy.types.Object)}
    assert not changed


def test_copies_float_by_themselves(floating, ocean, buoy, select, on_the_sea, window):
    floating.float_on(buoy, ocean, floating.Ride(tilt=0.3))
    bpy.context.view_layer.update()
    first = floating.carrier_of(buoy)
    select(buoy)
    with window.override():
        bpy.ops.object.duplicate()
    twin = bpy.context.object
    assert twin != buoy
    bpy.context.view_layer.update()
    assert floating.carrier_of(buoy) == first
    assert floating.carrier_of(twin) not in (None, first)
    assert floating.ride_of(floating.carrier_of(twin))[1].tilt == pytest.approx(0.3)
    twin.location.x = -40.0
    on_the_sea(twin, ocean, -40.0, 40.0)
    on_the_sea(buoy, ocean, 25.0, 40.0)


def test_the_carrier_goes_with_the_object(floating, ocean, buoy, select, window):
    floating.float_on(buoy, ocean)
    select(buoy)
    with window.override():
        bpy.ops.object.duplicate()
        bpy.context.view_layer.update()
        assert len(carriers()) == 2
        bpy.ops.object.delete()
        bpy.context.view_layer.update()
    assert len(carriers()) == 1
    bpy.data.objects.remove(buoy)
    bpy.context.view_layer.update()
    assert [item.name for item in bpy.data.objects] == ["Ocean"]
    assert len(bpy.data.meshes) == 1


def test_undo_and_redo(ocean, buoy, select, on_the_sea, window):
    select(buoy)
    steps = []  # what was done, and where things float after it
    with window.override():
        bpy.ops.ed.undo_push(message="before")
        bpy.ops.object.ocean_tweak_float()
        bpy.ops.ed.undo_push(message="float")
        steps.append({"Buoy": (25.0, 40.0)})
        bpy.data.objects["Buoy"].location.x = -60.0
        bpy.context.view_layer.update()
        bpy.ops.ed.undo_push(message="move")
        steps.append({"Buoy": (-60.0, 40.0)})
        bpy.ops.object.duplicate()
        bpy.data.objects["Buoy.001"].location.y = 0.0
        bpy.ops.ed.undo_push(message="copy")
        steps.append({"Buoy": (-60.0, 40.0), "Buoy.001": (-60.0, 0.0)})
        bpy.context.view_layer.update()
        bpy.data.objects.remove(bpy.data.objects["Buoy"])
        bpy.ops.ed.undo_push(message="delete")
        steps.append({"Buoy.001": (-60.0, 0.0)})
        moves = [bpy.ops.ed.undo] * 3 + [bpy.ops.ed.redo] * 3
        for move, index in zip(moves, (2, 1, 0, 1, 2, 3), strict=True):
            move()
            bpy.context.view_layer.update()
            present = {each.name for each in bpy.context.scene.objects} - {"Ocean"}
            assert present == set(steps[index])
            assert len(carriers()) == len(present)
            for name, place in steps[index].items():
                on_the_sea(bpy.data.objects[name], bpy.data.objects["Ocean"], *place)


def test_two_oceans(ocean, buoy, ocean_object, make_parameters, select, on_the_sea, floating, empty_scene):
    lake = ocean_object.add(empty_scene, make_parameters(resolution=16, seed=3), name="Lake")
    lake.location.z = 50.0
    floating.float_on(buoy, ocean)
    other = buoy.copy()
    empty_scene.collection.objects.link(other)
    bpy.context.view_layer.update()
    floating.let_ride(floating.carrier_of(other), lake, floating.Ride())
    buoy.location.x = other.location.x = 60.0
    on_the_sea(buoy, ocean, 60.0, 40.0)
    on_the_sea(other, lake, 60.0, 40.0, seed=3)


@pytest.mark.parametrize("kind", ["CAMERA", "LIGHT"])
def test_what_looks_or_lights_keeps_its_height(kind, ocean, select, core, make_parameters, empty_scene):
    data = bpy.data.cameras.new("Eye") if kind == "CAMERA" else bpy.data.lights.new("Lamp", "POINT")
    item = bpy.data.objects.new("Eye", data)
    item.location = (25.0, 40.0, 9.0)
    empty_scene.collection.objects.link(item)
    select(item)
    bpy.ops.object.ocean_tweak_float()
    for height in (9.0, 5.5):  # of the ocean's calm water is 2
        item.location.z = height
        for frame in (1, 7):
            empty_scene.frame_set(frame)
            point, _ = sea_below(core, ocean, make_parameters(resolution=16), frame, (25.0, 40.0))
            above = item.matrix_world.translation - Vector(point)
            np.testing.assert_allclose(above, (0.0, 0.0, height - 2.0), atol=CENTIMETRE)
    place = item.matrix_world.copy()
    bpy.ops.object.ocean_tweak_float_bake(frame_start=7, frame_end=8)
    empty_scene.frame_set(7)
    ocean.ocean_tweak.resolution = 16
    np.testing.assert_allclose(item.matrix_world.translation.z, place.translation.z, atol=0.2)


def test_a_ship_by_one_choice(floating, ocean, select, empty_scene):
    ship = bpy.data.objects.new("Ship", bpy.data.meshes.new("Ship"))
    corners = [(x, y, z) for x in (-9.0, 9.0) for y in (-3.0, 3.0) for z in (0.0, 8.0)]
    ship.data.from_pydata(corners, [(i, i ^ bit) for i in range(8) for bit in (1, 2, 4) if i < i ^ bit], [])
    empty_scene.collection.objects.link(ship)
    select(ship)
    bpy.ops.object.ocean_tweak_float(ride="SHIP")
    ride = floating.ride_of(floating.carrier_of(ship))[1]
    assert (ride.waterline, ride.draft, ride.tilt) == pytest.approx((18.0, 2.0, 0.8))
    bpy.ops.object.ocean_tweak_float(ride="OBJECT")
    assert floating.ride_of(floating.carrier_of(ship))[1].waterline == pytest.approx(6.0)


def test_an_override_is_moved_in_its_shot(floating, ocean, buoy, on_the_sea, tmp_path):
    floating.float_on(buoy, ocean)
    bpy.context.view_layer.update()
    library = str(tmp_path / "library.blend")
    bpy.ops.wm.save_as_mainfile(filepath=library)
    bpy.ops.wm.read_homefile(use_empty=True)
    with bpy.data.libraries.load(library, link=True) as (_, here):
        here.objects = ["Ocean", "Buoy"]
    for item in here.objects:
        bpy.context.scene.collection.objects.link(item)
    bpy.context.view_layer.update()
    moved = bpy.data.objects["Buoy"].override_create(remap_local_usages=True)
    sea = next(item for item in bpy.data.objects if item.name == "Ocean")
    moved.location = (-30.0, 10.0, 0.0)
    on_the_sea(moved, sea, -30.0, 10.0)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "shot.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "shot.blend"))
    moved = next(item for item in bpy.context.scene.objects if item.override_library)
    sea = bpy.data.objects["Ocean"]
    on_the_sea(moved, sea, -30.0, 10.0)
    moved.location.x = 70.0
    on_the_sea(moved, sea, 70.0, 10.0)


def test_a_file_in_which_the_carrier_was_moved(floating, ocean, buoy, on_the_sea, empty_scene, tmp_path):
    carrier = floating.float_on(buoy, ocean)
    # as it was then: seen, and where the artist put it
    carrier["ocean_tweak_float_part"] = "carrier"
    carrier.use_fake_user = carrier.hide_viewport = carrier.hide_select = False
    for item in [carrier, *[each for each in bpy.data.objects if each.parent == carrier]]:
        empty_scene.collection.objects.link(item)
    for frame, x in ((1, -50.0), (11, 50.0)):
        carrier.location = (x, 7.0, 0.0)
        carrier.keyframe_insert("location", frame=frame)
    file = str(tmp_path / "former.blend")
    bpy.ops.wm.save_as_mainfile(filepath=file)
    bpy.ops.wm.open_mainfile(filepath=file)
    buoy, ocean = bpy.data.objects["Buoy"], bpy.data.objects["Ocean"]
    assert set(bpy.context.scene.objects) == {ocean, buoy}
    bpy.context.scene.frame_set(6)
    on_the_sea(buoy, ocean, 0.0, 7.0, 6)
    buoy.animation_data_clear()
    buoy.location = (12.0, 13.0, 0.0)
    on_the_sea(buoy, ocean, 12.0, 13.0, 6)
