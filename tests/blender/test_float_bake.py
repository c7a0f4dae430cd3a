# SPDX-License-Identifier: GPL-3.0-or-later
"""Floating baked to keyframes: as it was live, and as it was before when taken back."""

import bpy
import numpy as np
import pytest

from . import floats
from .floats import CENTIMETRE, FRAMES, assert_rides

# fixtures for every test here
select, ocean, buoy = floats.select, floats.ocean, floats.buoy


@pytest.fixture
def keys(empty_scene):
    """Frames and interpolations of an object's curves by path and index."""

    def read(item):
        animation = item.animation_data
        curves = [
            animation.action.fcurve_ensure_for_datablock(item, path, index=index)
            for path in ("location", "rotation_euler")
            for index in range(3)
        ]
        return [[(point.co.x, point.interpolation) for point in curve.keyframe_points] for curve in curves]

    return read


@pytest.mark.parametrize("mode", ["XYZ", "QUATERNION", "AXIS_ANGLE"])
def test_bake_to_keyframes(ocean, buoy, select, core, make_parameters, empty_scene, mode):
    buoy.rotation_mode = mode
    select(buoy)
    empty_scene.frame_set(5)
    assert bpy.ops.object.ocean_tweak_float_bake() == {"FINISHED"}
    assert empty_scene.frame_current == 5
    assert not buoy.constraints
    assert set(bpy.data.objects) == {ocean, buoy}
    for frame in range(FRAMES[0], FRAMES[1] + 1):
        empty_scene.frame_set(frame)
        assert_rides(buoy, core, ocean, make_parameters(), frame)  # the sea of the render
    before = buoy.matrix_world.translation.copy()
    empty_scene.frame_set(FRAMES[1] + 10)
    assert buoy.matrix_world.translation == before
    assert bpy.ops.object.ocean_tweak_float_remove() == {"FINISHED"}
    empty_scene.frame_set(9)
    assert tuple(buoy.matrix_world.translation) == (25.0, 40.0, 9.0)
    assert buoy.animation_data is None
    assert not bpy.data.actions


def test_keys_are_linear_and_stand_in_their_range(ocean, buoy, select, keys):
    select(buoy)
    bpy.ops.object.ocean_tweak_float_bake(frame_start=10, frame_end=13)
    for curve in keys(buoy):
        assert curve == [(frame, "LINEAR") for frame in (10, 11, 12, 13)]


@pytest.mark.parametrize("method", ["NODES", "DISPLACE"])
def test_a_baked_ocean(ocean_object, bake, buoy, select, core, make_parameters, empty_scene, method):
    parameters = make_parameters()
    ocean = ocean_object.add(empty_scene, parameters, method, "SEQUENCE", bake(parameters, 3, 10))
    select(buoy)
    bpy.ops.object.ocean_tweak_float()
    for frame in (1, 3, 7, 12):
        empty_scene.frame_set(frame)
        assert_rides(buoy, core, ocean, parameters, frame, shown=min(max(frame, 3), 10))
    # what floats keeps its settings
    assert bpy.ops.object.ocean_tweak_float_bake(frame_start=1, frame_end=12, draft=5.0) == {"FINISHED"}
    assert not buoy.constraints
    for frame in (1, 3, 7, 12):
        empty_scene.frame_set(frame)
        assert_rides(buoy, core, ocean, parameters, frame, shown=min(max(frame, 3), 10))


def test_keys_are_what_floated_live(ocean, buoy, select, empty_scene):
    """Waterline, draft, tilt, drift, a parent and an animated way: the core and the nodes agree."""
    empty_scene.objects["Ocean"].ocean_tweak.viewport_resolution = 32
    parent = bpy.data.objects.new("Tow", None)
    parent.location, parent.rotation_euler = (5.0, 6.0, 1.0), (0.0, 0.1, 0.2)
    empty_scene.collection.objects.link(parent)
    buoy.parent = parent
    for frame, x in ((1, 20.0), (20, 60.0)):
        buoy.location.x = x
        buoy.keyframe_insert("location", frame=frame)
    buoy.rotation_euler = (0.1, 0.0, 0.5)
    action = buoy.animation_data.action
    select(buoy)
    bpy.ops.object.ocean_tweak_float(waterline=20.0, draft=0.4, tilt=0.6, drift=0.5)
    live = {}
    for frame in (1, 8, 15, 20):
        empty_scene.frame_set(frame)
        live[frame] = np.array(buoy.matrix_world)
    bpy.ops.object.ocean_tweak_float_bake(frame_end=20)
    for frame, matrix in live.items():
        empty_scene.frame_set(frame)
        np.testing.assert_allclose(buoy.matrix_world, matrix, atol=1e-3)
    assert buoy.animation_data.action != action
    bpy.ops.object.ocean_tweak_float_remove()
    assert buoy.animation_data.action == action
    empty_scene.frame_set(20)
    assert buoy.location.x == 60.0


def test_baking_again_begins_at_the_place_on_land(ocean, buoy, select, core, make_parameters, empty_scene):
    select(buoy)
    bpy.ops.object.ocean_tweak_float_bake(frame_end=4, drift=1.0, draft=3.0)
    bpy.ops.object.ocean_tweak_float_bake(frame_end=4)
    empty_scene.frame_set(3)
    assert_rides(buoy, core, ocean, make_parameters(), 3)
    bpy.ops.object.ocean_tweak_float()  # live again
    bpy.context.view_layer.update()
    assert_rides(buoy, core, ocean, make_parameters(resolution=16), 3)
    bpy.ops.object.ocean_tweak_float_remove()
    bpy.context.view_layer.update()
    assert tuple(buoy.matrix_world.translation) == (25.0, 40.0, 9.0)
    assert not bpy.data.actions


def test_a_constraint_of_the_object_s_own(ocean, buoy, select, core, make_parameters, empty_scene):
    target = bpy.data.objects.new("Target", None)
    target.location = (25.0, 40.0, 1.0)
    empty_scene.collection.objects.link(target)
    constraint = buoy.constraints.new("COPY_LOCATION")
    constraint.target = target
    buoy.location = (0.0, 0.0, 0.0)
    select(buoy)
    bpy.ops.object.ocean_tweak_float()
    empty_scene.frame_set(4)
    assert_rides(buoy, core, ocean, make_parameters(resolution=16), 4)
    bpy.ops.object.ocean_tweak_float_bake(frame_end=4)
    empty_scene.frame_set(4)
    assert_rides(buoy, core, ocean, make_parameters(), 4)
    bpy.ops.object.ocean_tweak_float_remove()
    bpy.context.view_layer.update()
    assert buoy.constraints[0].enabled
    assert tuple(buoy.matrix_world.translation) == (25.0, 40.0, 1.0)


def test_in_centimetres(ocean_object, buoy, select, core, make_parameters, empty_scene):
    empty_scene.unit_settings.scale_length = 0.01
    parameters = make_parameters()
    ocean_object.add(empty_scene, parameters)
    buoy.location = (1000.0, 2000.0, 0.0)
    select(buoy)
    bpy.ops.object.ocean_tweak_float_bake(frame_start=9, frame_end=9)
    empty_scene.frame_set(9)
    height = float(core.Ocean(parameters).height_at(10.0, 20.0, parameters.timing.time(9)))
    assert buoy.location.z / 100.0 == pytest.approx(height, abs=CENTIMETRE)


def test_an_animated_sea(ocean, buoy, select, core, make_parameters, empty_scene):
    """Its own clock at half speed, and a choppiness that grows."""
    ocean.ocean_tweak.use_ocean_time = True
    for frame, time, choppiness in ((1, 0.0, 0.2), (25, 0.5, 1.0)):
        ocean.ocean_tweak.ocean_time, ocean.ocean_tweak.choppiness = time, choppiness
        ocean.keyframe_insert("ocean_tweak.ocean_time", frame=frame)
        ocean.keyframe_insert("ocean_tweak.choppiness", frame=frame)
    select(buoy)
    bpy.ops.object.ocean_tweak_float_bake(frame_start=24, frame_end=25)
    empty_scene.frame_set(25)
    # 0.5 s are frame 13 of a sea that keeps the scene's time
    assert_rides(buoy, core, ocean, make_parameters(choppiness=1.0), 13)
    bpy.ops.object.ocean_tweak_float()
    empty_scene.frame_set(1)
    assert_rides(buoy, core, ocean, make_parameters(resolution=16, choppiness=0.2), 1)


def test_esc_leaves_everything_as_it_was(ocean, buoy, extension, empty_scene):
    floating = extension("scene.floating")
    action = bpy.data.actions.new("Own")
    buoy.animation_data_create().action = action
    empty_scene.frame_set(3)
    things, matrix = set(bpy.data.objects), buoy.matrix_world.copy()
    bake = extension("scene.float_bake").FloatBake(
        empty_scene, [buoy], ocean, lambda _: floating.Ride(), range(1, 10)
    )
    bake.advance()
    bake.advance()
    assert (bake.done, empty_scene.frame_current) == (2, 2)
    bake.cancel()
    assert empty_scene.frame_current == 3
    assert set(bpy.data.objects) == things
    assert buoy.matrix_world == matrix
    assert buoy.animation_data.action == action
    assert list(bpy.data.actions) == [action]


def test_a_lost_file_is_told_and_nothing_is_changed(
    ocean_object, bake, buoy, select, make_parameters, empty_scene
):
    sequence = bake(make_parameters(), 1, 4)
    ocean_object.add(empty_scene, make_parameters(), "NODES", "SEQUENCE", sequence)
    sequence.path(3).unlink()
    select(buoy)
    with pytest.raises(RuntimeError, match=r"sea_disp\.0003\.exr"):
        bpy.ops.object.ocean_tweak_float_bake(frame_start=1, frame_end=4)
    assert buoy.animation_data is None
    assert [each.name for each in bpy.data.objects if each.type == "MESH"] == ["Ocean"]
