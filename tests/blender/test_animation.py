# SPDX-License-Identifier: GPL-3.0-or-later
"""Wind, fetch, swell, amplitude scale, choppiness and the ocean's time can be keyed and driven."""

from fractions import Fraction

import bpy
import numpy as np
import pytest

from .conftest import SAMPLES
from .surfaces import read

TOLERANCE = 1e-4  # m


def key(item, path, values):
    """Key values at frames, linear between them; a path inside the settings."""
    owner, _, name = f"ocean_tweak.{path}".rpartition(".")
    group = item.path_resolve(owner)
    for frame, value in values.items():
        setattr(group, name, value)
        group.keyframe_insert(name, frame=frame)
    for layer in item.animation_data.action.layers:
        for strip in layer.strips:
            for curve in strip.channelbag(item.animation_data.action_slot).fcurves:
                for point in curve.keyframe_points:
                    point.interpolation = "LINEAR"


def drive(item, path, expression):
    curve = item.driver_add(f"ocean_tweak.{path}")
    curve.driver.expression = expression
    return curve


def attribute(item, name):
    """(N+1, N+1, …) of the evaluated mesh."""
    mesh = item.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    return read(mesh, SAMPLES + 1, SAMPLES + 1)[name]


def with_wind(core, parameters, wind):
    layer = core.WaveLayer(**{**vars(parameters.layers[0]), "wind_speed": wind})
    return parameters.replace(layers=(layer,))


@pytest.mark.parametrize("method", ["NODES", "DISPLACE"])
def test_keyed_wind_is_that_of_the_frame(
    ocean_object, make_parameters, expected, evaluated, empty_scene, core, method
):
    parameters = make_parameters()
    item = ocean_object.add(empty_scene, parameters, method)
    key(item, "layers[0].wind_speed", {1: 6.0, 11: 16.0})
    for frame, wind in ((1, 6.0), (6, 11.0), (3, 8.0)):
        empty_scene.frame_set(frame)
        np.testing.assert_allclose(
            evaluated(item), expected(with_wind(core, parameters, wind), frame), atol=TOLERANCE
        )
    assert not item.ocean_tweak.error


def test_driven_choppiness(ocean, make_parameters, expected, evaluated, empty_scene):
    drive(ocean, "choppiness", "frame / 10")
    empty_scene.frame_set(4)
    np.testing.assert_allclose(evaluated(ocean), expected(make_parameters(choppiness=0.4), 4), atol=TOLERANCE)


def test_the_nonlinear_animation_counts_too(ocean, extension):
    is_animated = extension("scene.animated").is_animated
    assert not is_animated(ocean)
    key(ocean, "choppiness", {1: 0.0, 11: 1.0})
    assert is_animated(ocean)
    data = ocean.animation_data
    track = data.nla_tracks.new()
    strip = track.strips.new("strip", 1, data.action)
    strip.action_slot = data.action_slot
    data.action = None
    assert is_animated(ocean)
    track.strips.remove(strip)
    assert not is_animated(ocean)


def test_what_is_constant_cannot_be_keyed(ocean):
    settings = ocean.ocean_tweak
    water, layer = settings.water, settings.layers[0]
    constant = [(water, "depth"), (water, "gravity"), (layer, "spectrum")]
    constant += [(settings, name) for name in ("domain_size", "seed", "dispersion")]
    for group, name in constant:
        with pytest.raises(TypeError, match="not animatable"):
            group.keyframe_insert(name, frame=1)


def test_time_of_its_own(ocean, core, make_parameters, evaluated, empty_scene):
    """Four seconds of the sea in ten frames at 24 a second: 9.6 times as fast."""
    ocean.ocean_tweak.use_ocean_time = True
    key(ocean, "ocean_time", {1: 2.0, 11: 6.0})
    surface = core.Ocean(make_parameters()).surface(4.0, {"displacement", "velocity"})
    empty_scene.frame_set(6)
    np.testing.assert_allclose(evaluated(ocean)[:-1, :-1, 2], surface.displacement[..., 2], atol=TOLERANCE)
    velocity = attribute(ocean, "velocity")[:-1, :-1]
    np.testing.assert_allclose(velocity, 9.6 * surface.velocity, atol=1e-3 * np.abs(velocity).max())
    empty_scene.frame_set(40)  # after the last key it stands still
    assert not np.any(attribute(ocean, "velocity"))


def test_a_time_scale(ocean, core, make_parameters, evaluated, empty_scene, extension):
    """At half the speed, frame 25 shows what frame 13 showed: half a second at 24 a second."""
    ocean.ocean_tweak.time_scale = 0.5
    empty_scene.frame_set(25)
    surface = core.Ocean(make_parameters()).surface(0.5, {"displacement", "velocity"})
    np.testing.assert_allclose(evaluated(ocean)[:-1, :-1, 2], surface.displacement[..., 2], atol=TOLERANCE)
    velocity = attribute(ocean, "velocity")[:-1, :-1]
    np.testing.assert_allclose(velocity, 0.5 * surface.velocity, atol=1e-3 * np.abs(velocity).max())
    shot = extension("scene.shots").shot_of(ocean, empty_scene, range(1, 49))
    moment = shot.at(25)
    assert (float(moment.time), moment.rate) == (pytest.approx(0.5), pytest.approx(0.5))


def test_a_driven_time_has_no_velocity_but_moves_within_the_frame(
    ocean, core, make_parameters, evaluated, empty_scene
):
    ocean.ocean_tweak.use_ocean_time = True
    drive(ocean, "ocean_time", "frame / 12")
    empty_scene.frame_set(6)
    surface = core.Ocean(make_parameters()).surface(0.5)
    np.testing.assert_allclose(evaluated(ocean)[:-1, :-1, 2], surface.displacement[..., 2], atol=TOLERANCE)
    mesh = ocean.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    assert "velocity" not in mesh.attributes


def test_renders_show_the_frames_own_wind(ocean_object, make_parameters, core, empty_scene, tmp_path):
    """A render finer than the viewport, at another frame than the window's."""
    parameters = make_parameters(resolution=64)
    item = ocean_object.add(empty_scene, parameters, viewport_resolution=32)
    key(item, "layers[0].wind_speed", {1: 6.0, 11: 16.0})
    empty_scene.frame_set(1)
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    empty_scene.collection.objects.link(camera)
    empty_scene.camera = camera
    empty_scene.render.engine = "CYCLES"
    empty_scene.cycles.samples = 1
    empty_scene.render.resolution_x = empty_scene.render.resolution_y = 16
    empty_scene.frame_start = empty_scene.frame_end = 6
    empty_scene.render.filepath = str(tmp_path / "image")
    bpy.ops.render.render(animation=True)
    image = item.ocean_tweak.render_maps.disp
    texels = np.empty(64 * 64 * 4, np.float32)
    image.pixels.foreach_get(texels)
    surface = core.Ocean(with_wind(core, parameters, 11.0)).surface(Fraction(5, 24)).displacement
    np.testing.assert_allclose(texels.reshape(64, 64, 4)[..., :3], surface, atol=TOLERANCE)
