# SPDX-License-Identifier: GPL-3.0-or-later
"""At frames between two a baked sea is the nearest file's, moved by its velocity: any engine blurs it."""

from fractions import Fraction

import bpy
import numpy as np
import pytest

from .camera_views import camera  # noqa: F401
from .conftest import DOMAIN, SAMPLES, vertices

METHODS = ("NODES", "DISPLACE")
MAPS = ("disp", "vel")
FRAMES = (4, 8)
FINE = 2e-4  # m


@pytest.fixture
def baked(ocean_object, bake, make_parameters, empty_scene):
    """An ocean that reads a bake."""

    def add(method="NODES", maps=MAPS, **changes):
        sequence = bake(make_parameters(**changes), *FRAMES, maps=maps)
        return ocean_object.add(empty_scene, make_parameters(**changes), method, "SEQUENCE", sequence)

    return add


@pytest.fixture
def moved(core, make_parameters):
    """Where the vertices must be, m: the water of a whole frame, and its velocity for some seconds."""

    def positions(frame, seconds, **changes):
        parameters = make_parameters(**changes)
        timing = parameters.timing
        time = (Fraction(frame) / timing.stretch - timing.start_frame) / timing.fps
        fields = core.Ocean(parameters).surface(time, {"displacement", "velocity"})
        shift = fields.displacement + float(seconds / timing.stretch) * fields.velocity.astype(np.float64)
        place = np.arange(SAMPLES + 1)
        flat = np.zeros((SAMPLES + 1, SAMPLES + 1, 3))
        flat[..., 0], flat[..., 1] = place * DOMAIN / SAMPLES, place[:, np.newaxis] * DOMAIN / SAMPLES
        return flat + shift[np.ix_(place % SAMPLES, place % SAMPLES)]

    return positions


def at(scene, frame):
    whole = int(np.floor(frame))
    scene.frame_set(whole, subframe=frame - whole)


@pytest.mark.parametrize("method", METHODS)
def test_velocity_moves_the_nearest_file(baked, moved, empty_scene, method):
    """Speeds are metres a second: a quarter of a frame is centimetres."""
    item = baked(method)
    for frame, file in ((6.0, 6), (6.25, 6), (6.49, 6), (6.51, 7), (6.75, 7), (5.625, 6), (6.0, 6)):
        at(empty_scene, frame)
        wanted = moved(file, (frame - file) / 24)
        np.testing.assert_allclose(vertices(item), wanted, atol=FINE, err_msg=str(frame))
        if frame != file:
            assert np.abs(wanted - moved(file, 0)).max() > 0.01


@pytest.mark.parametrize("method", METHODS)
def test_half_way_the_next_file_takes_over_without_a_jump(
    baked, moved, expected, make_parameters, empty_scene, method
):
    """Both are the sea's path to the second order: what they differ by is of the third."""
    item = baked(method)
    seen = []
    for frame in (6.499, 6.501):
        at(empty_scene, frame)
        seen.append(vertices(item))
    of_two_thousandths = np.abs(moved(6, 0.002 / 24) - moved(6, 0)).max()
    step = np.abs(moved(7, 0) - moved(6, 0)).max()
    assert step > 0.05
    assert np.abs(seen[1] - seen[0]).max() < of_two_thousandths + 0.005 * step
    np.testing.assert_allclose(seen[0], expected(make_parameters(), 6.499), atol=0.05 * step)


@pytest.mark.parametrize("method", METHODS)
def test_without_velocity_the_water_stands_through_the_shutter(baked, moved, empty_scene, method):
    item = baked(method, maps=("disp",))
    for frame, file in ((5.75, 6), (6.25, 6), (6.49, 6), (6.51, 7)):
        at(empty_scene, frame)
        np.testing.assert_allclose(vertices(item), moved(file, 0), atol=FINE, err_msg=str(frame))


@pytest.mark.parametrize("method", METHODS)
def test_before_the_first_file_and_after_the_last_one_moves_as_at_them(baked, moved, empty_scene, method):
    """So that a frame that is held is blurred as its own."""
    item = baked(method)
    for frame, file, since in ((2.25, 4, 0.25), (10.75, 8, -0.25)):
        at(empty_scene, frame)
        np.testing.assert_allclose(vertices(item), moved(file, since / 24), atol=FINE, err_msg=str(frame))


def test_in_other_units_and_stretched_time(ocean_object, moved, make_parameters, core, empty_scene):
    """Bakes hold velocity per second of the shot; at half the speed the water goes half as far."""
    empty_scene.unit_settings.scale_length = 0.5
    empty_scene.render.frame_map_new = 200
    empty_scene.frame_start, empty_scene.frame_end = FRAMES
    item = ocean_object.add(empty_scene, make_parameters())
    item.ocean_tweak.use_velocity = True
    bpy.context.view_layer.objects.active = item
    assert bpy.ops.ocean.bake() == {"FINISHED"}
    timing = item.ocean_tweak.to_parameters(empty_scene).timing
    assert timing.stretch == 2
    for frame, file in ((6.0, 6), (6.25, 6), (5.75, 6)):
        at(empty_scene, frame)
        wanted = moved(file, (frame - file) / 24, timing=timing)
        np.testing.assert_allclose(0.5 * vertices(item), wanted, atol=FINE, err_msg=str(frame))


def test_at_another_frame_rate_files_are_as_far_apart(baked, moved, empty_scene):
    """It plays slower, but from file to file the water goes the same way."""
    item = baked()
    empty_scene.render.fps = 12
    item.ocean_tweak.viewport_resolution += 2  # what a changed rate does in a window
    at(empty_scene, 6.25)
    np.testing.assert_allclose(vertices(item), moved(6, 0.25 / 24), atol=FINE)


def test_a_stretch_after_the_bake_is_smooth_slow_motion(baked, moved, empty_scene):
    item = baked()
    empty_scene.render.frame_map_new = 200
    item.ocean_tweak.viewport_resolution += 2
    for frame, file in ((12, 6), (13, 7), (12.5, 6)):
        at(empty_scene, frame)
        wanted = moved(file, (frame / 2 - file) / 24)
        np.testing.assert_allclose(vertices(item), wanted, atol=FINE, err_msg=str(frame))


def test_what_floats_is_keyed_on_that_slow_motion(extension, baked, empty_scene):
    item = baked()
    empty_scene.render.frame_map_new = 200
    boat = bpy.data.objects.new("Boat", None)
    boat.location = (60.0, 70.0, 0.0)
    empty_scene.collection.objects.link(boat)
    floating = extension("scene.floating")
    floating.float_on(boat, item)
    item.ocean_tweak.viewport_resolution += 2
    frames = range(9, 16)

    def heights():
        result = []
        for frame in frames:
            empty_scene.frame_set(frame)
            result.append(boat.matrix_world.translation.z)
        return result

    live = heights()
    bake = extension("scene.float_bake").FloatBake(
        empty_scene, [boat], item, lambda _: floating.Ride(), frames
    )
    for _ in frames:
        bake.advance()
    bake.finish()
    assert np.all(np.abs(np.diff(live)) > 2e-3)
    np.testing.assert_allclose(heights(), live, atol=1e-3)


def test_a_bake_without_velocity_is_told_when_blur_is_on(extension, baked, empty_scene, caplog):
    item = baked(maps=("disp",))
    told = extension("scene.portability").sharp_under_blur
    begin = extension("scene.scene_handlers").begin_render
    empty_scene.render.use_motion_blur = False
    assert told(item, empty_scene) == ""
    begin(empty_scene)
    empty_scene.render.use_motion_blur = True
    begin(empty_scene)
    lines = [record.message for record in caplog.records if "blur" in record.message]
    assert lines == [f"{item.name}, frame 1: {told(item, empty_scene)}"]
    assert "Bake it with Velocity on" in lines[0]
    extension("scene.scene_handlers").end_render(empty_scene)
    assert told(baked(), empty_scene) == ""


def test_baked_points_move_too(extension, ocean_object, core, make_parameters, camera, empty_scene):  # noqa: F811
    """Those of which a surface around the camera is made where a sea has several patches."""
    patches = tuple(
        core.Patch(domain_size=size, resolution=32, **bounds)
        for size, bounds in ((DOMAIN, {"shortest_wavelength": 15.0}), (41.0, {"longest_wavelength": 15.0}))
    )
    empty_scene.frame_start, empty_scene.frame_end = FRAMES
    ocean = ocean_object.add(empty_scene, make_parameters(patches=patches))
    extension("scene.camera_surface").add_camera_surface(ocean, empty_scene)
    bpy.context.view_layer.objects.active = ocean
    assert bpy.ops.ocean.bake() == {"FINISHED"}
    parts = extension("core.parameters.patch_seas").parts(ocean.ocean_tweak.to_parameters(empty_scene))
    items = [child for child in ocean.children if "Patch" in child.name]
    assert len(items) == len(parts) == 2
    for frame, file in ((6.0, 6), (6.25, 6), (6.75, 7)):
        at(empty_scene, frame)
        for item, part in zip(items, parts, strict=True):
            found = vertices(item) - vertices_at_rest(part.parameters)
            time = part.parameters.timing.time(file)
            fields = core.Ocean(part.parameters).surface(time, {"displacement", "velocity"})
            wanted = fields.displacement + (frame - file) / 24 * fields.velocity.astype(np.float64)
            np.testing.assert_allclose(found[:-1, :-1], wanted, atol=FINE, err_msg=str(frame))


def vertices_at_rest(parameters):
    samples = parameters.resolution
    place = np.arange(samples + 1) * parameters.domain_size / samples
    flat = np.zeros((samples + 1, samples + 1, 3))
    flat[..., 0], flat[..., 1] = place, place[:, np.newaxis]
    return flat
