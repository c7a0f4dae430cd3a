# SPDX-License-Identifier: GPL-3.0-or-later
"""A .blend file and a bake of the program as it was when each kind of layers had a list of its own, and a
.blend file of when many settings had other names."""

import json
from pathlib import Path

import bpy
import pytest

FORMER = Path(__file__).parents[1] / "former"


@pytest.fixture
def shot(extension):
    return extension("export.sea_files").read_sea(FORMER / "sea.json")


def test_a_file_has_the_same_layers_and_keys(shot, extension):
    bpy.ops.wm.open_mainfile(filepath=str(FORMER / "former.blend"))
    (item,) = (each for each in bpy.data.objects if each.ocean_tweak.is_ocean)
    scene = bpy.context.scene
    settings = item.ocean_tweak
    kinds = [layer.kind for layer in settings.layers]
    assert kinds == ["WAVES", "WAVES", "WIND_FIELD", "IMAGE", "IMAGE", "HERO_WAVE"]
    found = extension("scene.shots").shot_of(item, scene, range(1, 4))
    own, wanted = (json.loads(each.to_json()) for each in (found, shot))
    first = {path: values[0] for path, values in wanted["animation"]["samples"].items()}
    assert own["animation"]["first_frame"] == 0  # one more on either side
    for path, values in wanted["animation"]["samples"].items():
        assert own["animation"]["samples"][path][1:4] == pytest.approx(values, rel=1e-6)
    # the frame at which the file was saved
    wanted["layers"][0]["wind_speed"] = first["layers.0.wind_speed"]
    wanted["layers"][1]["swell"] = pytest.approx(first["layers.1.swell"])
    wanted["choppiness"] = pytest.approx(first["choppiness"])
    assert own["layers"] == wanted["layers"]
    assert own["choppiness"] == wanted["choppiness"]
    settings.from_parameters(shot.parameters, scene)
    assert settings.to_parameters(scene).layers == shot.parameters.layers


def test_an_image_tells_its_sea(shot, extension):
    (image,) = FORMER.glob("*/*/*_disp.0002.exr")
    assert extension("scene.bake_state").parameters_of(image, 2) == shot.at(2).parameters


def test_settings_are_found_under_their_former_names(extension):
    """Values, exact ones too, in layers, in their groups and in masks; keys, drivers, and who reads them."""
    bpy.ops.wm.open_mainfile(filepath=str(FORMER / "names.blend"))
    (item,) = (each for each in bpy.data.objects if each.ocean_tweak.is_ocean)
    scene = bpy.context.scene
    wanted = extension("export.sea_files").read_sea(FORMER / "names.json").parameters
    found = item.ocean_tweak.to_parameters(scene)
    assert (found.orbital_motion, found.amplitudes) == ("FINITE_DEPTH", "DETERMINISTIC")
    assert [layer.amplitude_scale for layer in found.layers] == [0.7, 0.25, 0.6, 0.8]
    image, wind = found.layers[2:]
    assert image.image.shape == (8, 8, 1)
    assert (wind.wind_scale, wind.minimum_wind_speed, wind.crest) == (0.9, 1.5, "PARALLEL")
    masks = [layer.mask for layer in found.layers if layer.mask is not None]
    assert [(mask.inner_radius, mask.outer_radius) for mask in masks] == [(5.0, 9.0)] * 3
    plain = [extension("core.data.plain_data").to_plain(sea, brief=True) for sea in (found, wanted)]
    for sea in plain:  # Blender gave the image a name
        del sea["layers"][2]["image"]
    assert plain[0] == plain[1]
    scene.frame_set(11)
    assert item.ocean_tweak.layers[0].amplitude_scale == pytest.approx(0.35)
    (driver,) = item.animation_data.drivers
    assert driver.data_path == "ocean_tweak.layers[1].amplitude_scale"
    item.ocean_tweak.layers[3].wind_field.wind_scale = 0.5
    bpy.context.view_layer.update()
    gauge = bpy.data.objects["Gauge"].evaluated_get(bpy.context.evaluated_depsgraph_get())
    assert gauge.location.z == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("ocean_tweak.orbits", "ocean_tweak.orbital_motion"),
        ("ocean_tweak.layers[3].gain", "ocean_tweak.layers[3].amplitude_scale"),
        ("ocean_tweak.layers[12].picture.gain", "ocean_tweak.layers[12].image_waves.amplitude_scale"),
        ("ocean_tweak.layers[0].picture.mask.near", "ocean_tweak.layers[0].image_waves.mask.inner_radius"),
        ("ocean_tweak.layers[0].wind_field.calm", "ocean_tweak.layers[0].wind_field.minimum_wind_speed"),
        ("ocean_tweak.layers[0].wind_field.front", "ocean_tweak.layers[0].wind_field.crest"),
        ("ocean_tweak.patches[1].mask.far", "ocean_tweak.patches[1].mask.outer_radius"),
        ("ocean_tweak.layers[0].calm", "ocean_tweak.layers[0].calm"),
        ("ocean_tweak.layers[0].gains", "ocean_tweak.layers[0].gains"),
        ("ocean_tweak.choppiness", "ocean_tweak.choppiness"),
        ('pose.bones["ocean_tweak.orbits"].location', 'pose.bones["ocean_tweak.orbits"].location'),
    ],
)
def test_paths_of_before(extension, before, after):
    modern_path = extension("scene.former_settings").modern_path
    assert modern_path(before) == after
    assert modern_path(after) == after
