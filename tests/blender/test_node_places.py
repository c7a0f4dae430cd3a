# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes that artists open stand apart, in trees that are no groups: no two have the same place."""

import math
import sys
from pathlib import Path
from types import SimpleNamespace

import bpy
import pytest

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


def lit_water(extension, _scene):
    water = extension("scene.water_material")
    material = water.water_material()
    water.light_by(material, bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN")))
    return material


def world(extension, _scene):
    sky = extension("scene.sky").Sky(math.radians(-5.0), 0.0, clouds=0.5, overcast=0.5)
    return extension("scene.sky_world").new_world("Sky", sky)


def spray(extension, scene):
    core = extension("core")
    storm = core.WaveLayer(wind_speed=20.0, fetch=400e3)
    sea = core.OceanParameters(resolution=32, domain_size=60.0, layers=(storm,), spray=core.Spray(0.1))
    extension("scene.ocean_object").add(scene, sea)
    return bpy.data.materials["Ocean Tweak Spray"]


def cloud_shadows(extension, scene):
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(EXAMPLES)
        import cloud_shadows as example

        item = example.add(SimpleNamespace(module=extension), scene, example.CloudShadows(400.0))
    for name in ("cloud_shadows", "extension"):
        sys.modules.pop(name, None)
    return item.data.materials[0]


@pytest.mark.parametrize("new", [lit_water, world, spray, cloud_shadows])
def test_no_two_nodes_share_a_place(extension, empty_scene, new):
    nodes = new(extension, empty_scene).node_tree.nodes
    assert len(nodes) > 1
    assert len({tuple(node.location) for node in nodes}) == len(nodes)
