# SPDX-License-Identifier: GPL-3.0-or-later
"""Time Stretching moves everything alike: live, keyed, baked and floating, as Blender moves its own keys."""

import json
from fractions import Fraction

import bpy
import numpy as np
import pytest

from .conftest import SAMPLES, evaluated_mesh, sea_of, vertices
from .surfaces import read
from .test_gaps import height_of
from .test_missing_frames import METHODS, warnings

STRETCHES = [(100, 200), (90, 30), (2, 3)]  # old, new


@pytest.fixture(params=STRETCHES, ids=str)
def stretched(request, empty_scene):
    """The scene with a stretch, and what it is: frames of the scene in one of the animation."""
    empty_scene.render.frame_map_old, empty_scene.render.frame_map_new = request.param
    return empty_scene, Fraction(request.param[1], request.param[0])


@pytest.fixture
def live(ocean_object, make_parameters):
    """A live ocean in a scene, the active object."""

    def make(scene, method="NODES", **changes):
        item = ocean_object.add(scene, make_parameters(**changes), method)
        bpy.context.view_layer.objects.active = item
        return item

    return make


def bake_frames(scene, first, last):
    scene.frame_start, scene.frame_end = first, last
    assert bpy.ops.ocean.bake() == {"FINISHED"}


@pytest.mark.parametrize("method", METHODS)
def test_live_and_baked_are_the_sea_of_the_animations_frame(
    stretched, live, ocean_object, bake, make_parameters, expected, core, extension, method
):
    scene, stretch = stretched
    item = live(scene, method)
    item.ocean_tweak.use_velocity = True

    def check():
        for frame in range(1, 8):
            scene.frame_set(frame)
            np.testing.assert_allclose(
                vertices(item), expected(make_parameters(), frame / stretch), atol=2e-3
            )

    check()
    velocity = read(evaluated_mesh(item), SAMPLES + 1, SAMPLES + 1)["velocity"][:-1, :-1]
    time = (7 / stretch - 1) / 24
    slowed = core.Ocean(make_parameters()).surface(time, {"velocity"}).velocity / float(stretch)
    np.testing.assert_allclose(velocity, slowed, atol=2e-3)
    baked = bake(sea_of(item), 1, 7, maps=("disp",))
    ocean_object.use_sequence(item, scene, baked)
    with extension("scene.handlers").asleep():  # as where there is no extension
        check()
    scene.frame_set(8)
    assert warnings(item) == [("WARNING", "Frame 8 was not baked: frame 7 is held")]


@pytest.mark.parametrize("method", METHODS)
def test_a_bake_follows_a_stretch_that_is_changed_later(
    live, ocean_object, bake, make_parameters, expected, empty_scene, method
):
    item = live(empty_scene, method)
    empty_scene.render.frame_map_new = 200
    baked = bake(sea_of(item), 2, 12)
    ocean_object.use_sequence(item, empty_scene, baked)
    empty_scene.render.frame_map_new = 100
    for frame in (1, 2, 6):
        empty_scene.frame_set(frame)
        np.testing.assert_allclose(vertices(item), expected(make_parameters(), frame), atol=2e-3)


def test_keys_of_the_wind_and_of_the_clock(live, core, make_parameters, empty_scene):
    scene, stretch = empty_scene, Fraction(2)
    scene.render.frame_map_new = 200
    item = live(scene)
    settings = item.ocean_tweak
    settings.use_ocean_time = True
    for frame, wind, time in ((-10, 5.0, -1.0), (30, 15.0, 3.0)):
        settings.layers[0].wind_speed, settings.ocean_time = wind, time
        for path in ("ocean_tweak.layers[0].wind_speed", "ocean_tweak.ocean_time"):
            item.keyframe_insert(path, frame=frame)
    straight(item)

    def wanted(frame):
        share = (float(frame / stretch) + 10.0) / 40.0
        layer = core.WaveLayer(wind_speed=5.0 + 10.0 * share, fetch=80e3, wind_direction=0.4)
        sea = core.Ocean(make_parameters(layers=(layer,)))
        return sea.surface(-1.0 + 4.0 * share, {"displacement", "velocity"})

    def check():
        for frame in (1, 2, 5):
            scene.frame_set(frame)
            found = read(evaluated_mesh(item), SAMPLES + 1, SAMPLES + 1)
            fields = wanted(frame)
            np.testing.assert_allclose(found["displacement"][:-1, :-1], fields.displacement, atol=2e-3)
            # 4 s of the clock in 40 frames
            slowed = fields.velocity * 4.0 / 40.0 * 24.0 / float(stretch)
            np.testing.assert_allclose(found["velocity"][:-1, :-1], slowed, atol=5e-3)

    check()
    bake_frames(scene, 1, 5)
    check()


def straight(item):
    """Make all keys linear."""
    for layer in item.animation_data.action.layers:
        for strip in layer.strips:
            for bag in strip.channelbags:
                for curve in bag.fcurves:
                    for point in curve.keyframe_points:
                        point.interpolation = "LINEAR"


def test_what_floats_keeps_to_the_sea_when_it_is_baked_to_keys(stretched, live, extension):
    scene, _ = stretched
    item = live(scene)
    boat = bpy.data.objects.new("Boat", bpy.data.meshes.new("Boat"))
    boat.location = (60.0, 60.0, 0.0)
    scene.collection.objects.link(boat)
    scene.view_layers.update()
    floating = extension("scene.floating")
    floating.float_on(boat, item)
    before = [height_of(boat, scene, frame) for frame in range(1, 9)]
    bake = extension("scene.float_bake").FloatBake(
        scene, [boat], item, lambda _: floating.Ride(), range(1, 9)
    )
    for _ in bake.frames:
        bake.advance()
    bake.finish()
    assert np.ptp(before) > 0.05
    np.testing.assert_allclose([height_of(boat, scene, frame) for frame in range(1, 9)], before, atol=1e-3)


def test_a_shot_takes_the_stretch_along(stretched, live, core, make_parameters, expected, tmp_path):
    """As JSON, which the command line, USD and farms read, and back into a scene that has none."""
    scene, stretch = stretched
    item = live(scene)
    file = tmp_path / "shot.json"
    assert bpy.ops.ocean.export_parameters(filepath=str(file)) == {"FINISHED"}
    parameters = core.OceanParameters.from_json(file.read_text())
    assert parameters.timing.stretch == stretch
    heights = core.Ocean(parameters).frame(7).displacement[..., 2]
    scene.frame_set(7)
    np.testing.assert_allclose(vertices(item)[:-1, :-1, 2], heights, atol=2e-3)
    scene.render.frame_map_old = scene.render.frame_map_new = 100
    assert bpy.ops.ocean.import_parameters(filepath=str(file)) == {"FINISHED"}
    assert Fraction(scene.render.frame_map_new, scene.render.frame_map_old) == stretch
    assert sea_of(item).timing.stretch == stretch
    scene.frame_set(6)
    np.testing.assert_allclose(vertices(item), expected(make_parameters(), 6 / stretch), atol=2e-3)


def test_a_farm_renders_no_bake_of_another_stretch(
    extension, core, make_parameters, bake, empty_scene, tmp_path
):
    render_baked = extension("export.farm.render_baked")
    folder = tmp_path / "sea-1" / "v001-0123abcd"
    folder.mkdir(parents=True)
    bake(make_parameters(), 1, 2, directory=folder)
    (folder / "bake.json").write_text(json.dumps({"shot": make_parameters().to_dict()}))
    baked = render_baked.Bake(tmp_path, "sea-1/0123abcd")
    baked.check([1, 2])
    with pytest.raises(render_baked.RenderError, match=r"sea_disp\.0003\.exr is missing"):
        baked.check([1, 3])
    empty_scene.render.frame_map_new = 200
    with pytest.raises(
        render_baked.RenderError, match=r"Time Stretching, new / old, is 2 in .* and 1 in the"
    ):
        baked.check([1, 2])
    slowed = make_parameters().replace(timing=core.Timing(stretch=Fraction(7, 10)))
    (folder / "bake.json").write_text(json.dumps({"shot": slowed.to_dict()}))
    empty_scene.render.frame_map_new = 70
    render_baked.Bake(tmp_path, "sea-1/0123abcd").check([1, 2])
