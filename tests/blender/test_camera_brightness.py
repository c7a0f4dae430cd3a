# SPDX-License-Identifier: GPL-3.0-or-later
"""The sea stays as bright where waves go from the geometry of the surface around the camera into shading."""

import math

import bpy
import numpy as np
import pytest

from . import camera_views
from .camera_views import moved_to

# fixture for the tests here
camera = camera_views.camera


@pytest.fixture
def brightness(empty_scene, camera, tmp_path):
    """Mean of the far and of the near half of what the camera sees, under a sky brighter at the horizon."""
    world = empty_scene.world = bpy.data.worlds.new("Sky")
    if world.node_tree is None:
        world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    place, parts, strength = (
        nodes.new(f"ShaderNode{kind}") for kind in ("TexCoord", "SeparateXYZ", "MapRange")
    )
    links.new(place.outputs["Generated"], parts.inputs[0])
    links.new(parts.outputs["Z"], strength.inputs[0])
    strength.inputs[3].default_value, strength.inputs[4].default_value = 1.0, 0.4
    background = next(node for node in nodes if node.type == "BACKGROUND")
    background.inputs[0].default_value = (1.0, 1.0, 1.0, 1.0)
    links.new(strength.outputs[0], background.inputs[1])
    render = empty_scene.render
    render.engine, render.filepath = "CYCLES", str(tmp_path / "seen.exr")
    render.resolution_x, render.resolution_y = 64, 12
    render.image_settings.file_format = "OPEN_EXR"
    cycles = empty_scene.cycles
    cycles.samples, cycles.seed, cycles.device, cycles.use_denoising = 24, 1, "CPU", False
    camera.rotation_euler.x = math.radians(79.0)
    camera.data.angle, camera.data.clip_end = math.radians(50.0), 1000.0
    moved_to(camera, 1.3, -1.2, 15.0)

    def seen():
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(render.filepath)
        pixels = np.empty(4 * 64 * 12, np.float32)
        image.pixels.foreach_get(pixels)
        bpy.data.images.remove(image)
        rows = pixels.reshape(12, 64, 4)[..., 0]
        # how much neighbours differ
        seen.spread = lambda: float(np.abs(np.diff(rows, axis=1)).mean())
        return pixels.reshape(2, -1, 4)[::-1, :, 0].mean(axis=1)

    return seen


@pytest.fixture
def seas(core, make_parameters):
    """Seas for a wind in m/s: of one patch, and of several."""

    def make(wind, patches):
        layer = core.WaveLayer(wind_speed=wind, fetch=20e3)
        if not patches:
            return make_parameters(domain_size=40.0, layers=(layer,))
        several = (
            core.Patch(domain_size=60.0, shortest_wavelength=6.0, resolution=32),
            core.Patch(
                domain_size=20.0, longest_wavelength=6.0, shortest_wavelength=2.5, rotation=0.9, resolution=32
            ),
        )
        return make_parameters(layers=(layer,), patches=several)

    return make


# in a strong wind the roughness of shorter waves is large already, and adds up with these otherwise
@pytest.mark.parametrize(("wind", "most"), [(4.0, 0.05), (15.0, 0.07)])
@pytest.mark.parametrize("patches", [False, True])
def test_brightness_stays_when_waves_become_roughness(
    extension, ocean_object, seas, empty_scene, brightness, wind, most, patches
):
    ocean = ocean_object.add(empty_scene, seas(wind, patches))
    water = extension("scene.water_material")
    material = water.water_material()
    water.assign(ocean, material)
    group = next(node for node in material.node_tree.nodes if node.type == "GROUP")
    for name in ("Ripples", "Gusts", "Foam Amount"):  # patterns of their own
        group.inputs[name].default_value = 0.0
    item = extension("scene.camera_surface").add_camera_surface(ocean, empty_scene)
    set_inputs = extension("nodes.modifier_inputs").set_inputs
    settings = {"To Horizon": False, "Reach": 166.0, "Curvature": False}
    set_inputs(item.modifiers[0], {**settings, "Fade": False, "Vertex Budget": 500_000})
    in_mesh = brightness()
    set_inputs(item.modifiers[0], {**settings, "Fade": True, "Vertex Budget": 5000})
    item.update_tag()
    assert brightness() == pytest.approx(in_mesh, rel=most)


def test_ripples_are_drawn_of_what_the_surface_leaves_out(
    extension, ocean_object, seas, empty_scene, brightness
):
    """The image gets structure from them."""
    ocean = ocean_object.add(empty_scene, seas(4.0, True))
    water = extension("scene.water_material")
    material = water.water_material()
    water.assign(ocean, material)
    group = next(node for node in material.node_tree.nodes if node.type == "GROUP")
    group.inputs["Gusts"].default_value = 0.0
    item = extension("scene.camera_surface").add_camera_surface(ocean, empty_scene, budget=5000)
    set_inputs = extension("nodes.modifier_inputs").set_inputs
    set_inputs(item.modifiers[0], {"To Horizon": False, "Reach": 166.0, "Curvature": False})
    # what is shorter than the patches hold is another matter
    item["ocean_tweak_slope_variance"] = 0.0
    shown = {}
    for ripples in (0.0, 1.0):
        group.inputs["Ripples"].default_value = ripples
        item.update_tag()
        brightness()
        shown[ripples] = brightness.spread()
    assert shown[1.0] > 1.5 * shown[0.0]
