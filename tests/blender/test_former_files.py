# SPDX-License-Identifier: GPL-3.0-or-later
"""A .blend file and a bake of the program as it was when each kind of layers had a list of its own."""

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
