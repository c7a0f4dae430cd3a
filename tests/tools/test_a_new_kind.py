# SPDX-License-Identifier: GPL-3.0-or-later
"""A kind of waves more, before Blender's classes are made: its settings, its entries and its sea follow."""

import json
import math
import os
import subprocess
import sys

import pytest

from tools.project import ROOT

SCRIPT = """
import json, sys
from pathlib import Path

import bpy
import numpy as np
from ocean_tweak.core.waves.kinds import KINDS
from tests.new_kinds import Hump, Ripple

KINDS.extend((Ripple, Hump))
from ocean_tweak import registration
from ocean_tweak.core import Ocean, OceanParameters, WaveLayer
from ocean_tweak.nodes import modifier_inputs
from ocean_tweak.scene import camera_surface, ocean_object
from ocean_tweak.ui import parameter_properties

registration.register("ocean_tweak")
bpy.ops.wm.read_homefile(use_empty=True)
scene = bpy.context.scene
flat = OceanParameters(resolution=32, domain_size=100.0, choppiness=0.0, layers=(WaveLayer(muted=True),))
item = ocean_object.add(scene, flat)
bpy.context.view_layer.objects.active = item
settings, found = item.ocean_tweak, {}
assert bpy.ops.ocean.layer_add(kind="RIPPLE") == {"FINISHED"}
layer = settings.layers[settings.active_layer]
layer.ripple.waves, layer.ripple.amplitude = 8, 0.75
found["settings"] = parameter_properties.names_of(Ripple)
found["named"] = [layer.ripple.bl_rna.properties[name].description for name in ("waves", "amplitude")]
found["icon"] = [layer.kind, layer.bl_rna.properties["kind"].enum_items["RIPPLE"].value]
sea = settings.to_parameters(scene)
found["layers"] = sea.to_dict()["layers"][1:]

def highest(of, name):
    mesh = of.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    places = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.attributes[name].data.foreach_get("vector", places)
    return float(places.reshape(-1, 3)[:, 2].max())

found["highest"] = [highest(item, "position")]
camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
scene.collection.objects.link(camera)
camera.location, scene.camera = (50.0, 50.0, 20.0), camera
around = camera_surface.add_camera_surface(item, scene, camera, 20_000)
found["highest"].append(highest(around, "position"))
bpy.ops.wm.save_as_mainfile(filepath=str(Path(sys.argv[1]).with_suffix(".blend")))
bpy.ops.wm.open_mainfile(filepath=str(Path(sys.argv[1]).with_suffix(".blend")))
(again,) = (each for each in bpy.data.objects if each.ocean_tweak.is_ocean)
found["again"] = again.ocean_tweak.to_parameters(bpy.context.scene) == sea
bpy.context.view_layer.objects.active = again
scene = bpy.context.scene
assert bpy.ops.ocean.layer_add(kind="HUMP") == {"FINISHED"}
found["shown"] = again.ocean_tweak.error
again.ocean_tweak.layers[1].ripple.muted = True
hump = again.ocean_tweak.layers[2].hump
hump.x, hump.y, hump.height, hump.width = 70.0, 40.0, 2.0, 20.0
scene.frame_set(37)

def near(of, x, y):
    # of the vertex at rest nearest to a place
    mesh = of.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    count = len(mesh.vertices)
    values = {}
    for name in ("position", "displacement", "velocity"):
        values[name] = np.empty(3 * count, np.float32)
        mesh.attributes[name].data.foreach_get("vector", values[name])
    normals = np.empty(3 * count, np.float32)
    mesh.vertex_normals.foreach_get("vector", normals)
    values = {**values, "normal": normals}
    values = {name: value.reshape(-1, 3).astype(float) for name, value in values.items()}
    rest = values["position"] - values["displacement"]
    index = np.argmin(np.hypot(rest[:, 0] - x, rest[:, 1] - y))
    told = (values[name][index].tolist() for name in ("displacement", "velocity", "normal"))
    return [rest[index].tolist(), *told]

(surface,) = (each for each in again.children if each.modifiers and "Camera" in each.name)
modifier_inputs.set_input(surface.modifiers[0], "Fade", False)
surface.update_tag()
places = ((70.0, 40.0), (62.0, 44.0), (79.0, 40.0), (-30.0, 40.0), (270.0, 40.0))
found["humped"] = [near(surface, *place) for place in places]
found["own"] = highest(again, "position")
scene.camera.location.x += 33.3
scene.frame_set(37)
found["moved"] = [near(surface, *place) for place in places]
camera_surface.remove_camera_surface(again)
scene.frame_set(38)
found["refused"] = again.ocean_tweak.error
found["left"] = [each.name for each in again.children]
hump.muted = True
found["mended"] = again.ocean_tweak.error
Path(sys.argv[1]).write_text(json.dumps(found))
"""


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    """What a process says that has two kinds more."""
    pytest.importorskip("bpy")
    told = tmp_path_factory.mktemp("kind") / "found.json"
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "BLENDER_USER_RESOURCES": str(told.parent)}
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT, str(told)], env=environment, capture_output=True, text=True, cwd=ROOT
    )
    assert told.is_file(), done.stdout + done.stderr
    return json.loads(told.read_text())


def test_its_settings_are_its_fields(found):
    assert found["settings"] == ["amplitude", "waves"]
    assert found["named"] == ["How many go into the domain (1 to 1000)", "Half its height (0 to 10 m)"]
    assert found["icon"] == ["RIPPLE", 90]


def test_its_sea_is_shown_and_kept(found):
    ripple = {"kind": "RIPPLE", "amplitude": 0.75, "waves": 8, "muted": False, "id": 0, "mask": None}
    assert found["layers"] == [{name: ripple[name] for name in ripple if name != "mask"}]
    assert found["highest"] == pytest.approx([0.75, 0.75], abs=0.02)
    assert found["again"] is True


def test_a_camera_surface_shows_what_does_not_repeat(found):
    assert found["shown"] == ""
    assert found["own"] == 0.0
    time = 36 / 24
    for (x, y, _), displacement, velocity, normal in (*found["humped"], *found["moved"]):
        u, v = (x - 70.0) / 20.0, (y - 40.0) / 20.0
        bell = 2.0 * math.exp(-0.5 * (u * u + v * v))
        assert displacement == pytest.approx([0.0, 0.0, time * bell], abs=0.02)
        assert velocity == pytest.approx([0.0, 0.0, bell], abs=0.02)
        slope = [-time * bell * u / 20.0, -time * bell * v / 20.0]
        length = math.sqrt(1.0 + slope[0] ** 2 + slope[1] ** 2)
        assert normal == pytest.approx([-slope[0] / length, -slope[1] / length, 1.0 / length], abs=0.01)
    heights = [displacement[2] for _, displacement, _, _ in found["humped"]]
    assert heights[0] == pytest.approx(3.0, abs=0.03)
    assert heights[3:] == pytest.approx([0.0, 0.0], abs=1e-3)  # a domain to the side, and the area's own size


def test_what_does_not_repeat_is_refused_with_the_remedy(found):
    assert found["left"] == []
    assert "layers.2 = 'HUMP': its waves do not repeat" in found["refused"]
    assert "mute the layer" in found["refused"]
    assert found["mended"] == ""
