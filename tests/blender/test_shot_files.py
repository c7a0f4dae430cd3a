# SPDX-License-Identifier: GPL-3.0-or-later
"""JSON of a sea that changes during its shot: imported as keys, exported as samples."""

import json

import bpy
import numpy as np
import pytest

TOLERANCE = 1e-4  # m
#: a sample a frame from frame 3 on, m/s and s
WIND = [6.0, 7.5, 12.0, 12.5]
CLOCK = [0.0, 0.25, 0.375, 0.25]


@pytest.fixture
def active(ocean_object, make_parameters, empty_scene):
    item = ocean_object.add(empty_scene, make_parameters(seed=2))
    bpy.context.view_layer.objects.active = item
    return item


@pytest.fixture
def file(make_parameters, tmp_path):
    """An animated sea of another seed."""
    samples = {"layers.0.wind_speed": WIND, "ocean_time": CLOCK}
    animation = {"first_frame": 3, "samples": samples}
    path = tmp_path / "shot.json"
    path.write_text(json.dumps({**make_parameters().to_dict(), "animation": animation}))
    return path


def sea(core, parameters, wind):
    data = parameters.to_dict()
    data["layers"][0]["wind_speed"] = wind
    return core.OceanParameters.from_dict(data)


@pytest.mark.parametrize("scale", [1.0, 0.01])
def test_import_makes_keys(active, core, make_parameters, empty_scene, file, evaluated, scale):
    empty_scene.unit_settings.scale_length = scale
    assert bpy.ops.ocean.import_parameters(filepath=str(file)) == {"FINISHED"}
    for frame, wind, time in zip((3, 4, 5, 6), WIND, CLOCK, strict=True):
        empty_scene.frame_set(frame)
        fields = core.Ocean(sea(core, make_parameters(), wind)).surface(time)
        heights = evaluated(active)[:-1, :-1, 2] * scale
        np.testing.assert_allclose(heights, fields.displacement[..., 2], atol=TOLERANCE)
    empty_scene.frame_set(4, subframe=0.5)
    fields = core.Ocean(sea(core, make_parameters(), (7.5 + 12.0) / 2)).surface((0.25 + 0.375) / 2)
    np.testing.assert_allclose(
        evaluated(active)[:-1, :-1, 2] * scale, fields.displacement[..., 2], atol=TOLERANCE
    )


def test_export_has_a_sample_a_frame(active, core, empty_scene, file, tmp_path):
    bpy.ops.ocean.import_parameters(filepath=str(file))
    empty_scene.frame_start, empty_scene.frame_end = 4, 5
    written = tmp_path / "again.json"
    assert bpy.ops.ocean.export_parameters(filepath=str(written)) == {"FINISHED"}
    animation = json.loads(written.read_text())["animation"]
    assert animation["first_frame"] == 3
    np.testing.assert_allclose(animation["samples"]["layers.0.wind_speed"], WIND, rtol=1e-6)
    np.testing.assert_allclose(animation["samples"]["ocean_time"], CLOCK, rtol=1e-6)


def test_a_constant_sea_takes_keys_and_drivers_away(active, make_parameters, empty_scene, file, tmp_path):
    bpy.ops.ocean.import_parameters(filepath=str(file))
    active.driver_add("ocean_tweak.choppiness").driver.expression = "frame"
    active.keyframe_insert("location", frame=1)
    constant = tmp_path / "constant.json"
    constant.write_text(make_parameters().to_json())
    assert bpy.ops.ocean.import_parameters(filepath=str(constant)) == {"FINISHED"}
    assert not active.ocean_tweak.use_ocean_time
    assert not active.animation_data.drivers
    empty_scene.frame_set(5)
    assert active.ocean_tweak.to_parameters(empty_scene) == make_parameters()
    (strip,) = active.animation_data.action.layers[0].strips
    curves = strip.channelbag(active.animation_data.action_slot).fcurves
    assert {curve.data_path for curve in curves} == {"location"}


def test_what_cannot_be_animated_changes_nothing(active, empty_scene, file):
    before = active.ocean_tweak.to_parameters(empty_scene)
    data = json.loads(file.read_text())
    data["animation"]["samples"]["water.depth"] = [1.0, 2.0, 3.0, 4.0]
    file.write_text(json.dumps(data))
    with pytest.raises(RuntimeError, match=r"water\.depth"):
        bpy.ops.ocean.import_parameters(filepath=str(file))
    assert active.ocean_tweak.to_parameters(empty_scene) == before
    assert active.animation_data is None
