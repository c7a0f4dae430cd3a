# SPDX-License-Identifier: GPL-3.0-or-later
"""What is rendered of foam around a hull, and of water that laps at it."""

import contextlib
import math

import bpy
import numpy as np
import pytest

from . import afloat, floats
from .afloat import AT, update
from .test_velocity_blur import EEVEE_NAMES

# fixtures for every test here
ocean, disc, select = afloat.ocean, afloat.disc, floats.select

PIXELS, WIDTH = 128, 16.0  # of what is seen from above, m


@pytest.fixture
def shone_from_above(empty_scene, tmp_path):
    """Render from above what a socket of an object's material says: (pixels, pixels) brightness."""
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.data.type, camera.data.ortho_scale = "ORTHO", WIDTH
    camera.location = (*AT, 60.0)
    empty_scene.collection.objects.link(camera)
    empty_scene.camera = camera
    empty_scene.render.engine, empty_scene.cycles.device = "CYCLES", "CPU"
    empty_scene.cycles.samples, empty_scene.cycles.use_denoising = 4, False
    empty_scene.render.resolution_x = empty_scene.render.resolution_y = PIXELS
    empty_scene.render.image_settings.file_format = "OPEN_EXR"
    empty_scene.render.filepath = str(tmp_path / "foam.exr")

    def pixels(item, socket, to):
        tree = item.material_slots[0].material.node_tree
        shine = tree.nodes.new("ShaderNodeEmission")
        if socket is not None:
            tree.links.new(socket, shine.inputs[to])
        out = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
        tree.links.new(shine.outputs[0], out.inputs["Surface"])
        hidden = [other for other in bpy.data.objects if other.type == "MESH" and other != item]
        for other in hidden:
            other.hide_render = True
        bpy.ops.render.render(write_still=True)
        tree.nodes.remove(shine)
        for other in hidden:
            other.hide_render = False
        image = bpy.data.images.load(empty_scene.render.filepath)
        result = np.array(image.pixels[:]).reshape(PIXELS, PIXELS, 4)[..., 0]
        bpy.data.images.remove(image)
        return result

    return pixels


@pytest.fixture
def seen_from_above(shone_from_above):
    """The collars' foam alone, from above."""

    def pixels(ocean):
        tree = ocean.material_slots[0].material.node_tree
        water = next(node for node in tree.nodes if node.type == "GROUP" and "Foam Color" in node.inputs)
        links = water.inputs["Foam Map"].links
        return shone_from_above(ocean, links[0].from_socket if links else None, "Strength")

    return pixels


def places():
    along = (np.arange(PIXELS) + 0.5) / PIXELS * WIDTH - 0.5 * WIDTH
    return np.stack(np.meshgrid(AT[0] + along, AT[1] + along), axis=-1)


def test_foam_lies_around_the_hull_and_follows_it(
    extension, ocean, disc, select, empty_scene, seen_from_above
):
    """Full at the waterline, thinned out outwards; nothing where there is no hull."""
    item, floating = disc(), extension("scene.floating")
    select(item)
    bpy.ops.object.ocean_tweak_float()
    (collar,) = extension("scene.contact").collars_of(item)
    amount, width = collar.inputs["Foam"].default_value, collar.inputs["Foam Width"].default_value
    assert (collar.inputs["Half Length"].default_value, collar.inputs["Half Beam"].default_value) == (
        pytest.approx(1.0, abs=1e-3), pytest.approx(1.0, abs=1e-3))  # fmt: skip
    assert collar.inputs["Fullness"].default_value == pytest.approx(2.0, abs=0.11)
    with extension("scene.handlers").asleep():  # as where there is no extension
        for shift in (0.0, 4.0):
            item.location.x = floating.carrier_of(item).location.x = AT[0] + shift
            empty_scene.frame_set(5)
            foam = seen_from_above(ocean)
            middle = np.array(item.matrix_world.translation)[:2]
            away = np.linalg.norm(places() - middle, axis=-1) - 1.0
            assert foam[np.abs(away) < 0.07].min() > 0.3 * amount
            assert foam[np.abs(away) < 0.07].mean() > 0.8 * amount
            assert foam[(away > 0.1) & (away < 2.5)].max() < amount
            assert foam[away > 12.0 * width].max() < 0.01
            rings = [foam[(away > low) & (away < low + width)].mean() for low in width * np.arange(4)]
            assert np.all(np.diff(rings) < 0.0)
        bpy.data.objects.remove(item)
        update()
        empty_scene.frame_set(6)
        assert seen_from_above(ocean).max() == 0.0  # its node is left, without an object


def test_a_strong_wind_draws_a_wash_down_the_wind(
    extension, ocean, disc, select, empty_scene, seen_from_above
):
    """However the hull is turned; none in a breeze."""
    wind = 1.1
    ocean.ocean_tweak.layers[0].wind_direction = wind
    lee, windward = (np.linalg.norm(places() - to, axis=-1) < 0.3 for to in washed(wind, 3.0))
    for speed, turn, reaches in ((9.0, 0.0, False), (25.0, 0.0, True), (25.0, 2.0, True)):
        ocean.ocean_tweak.layers[0].wind_speed = speed
        item = disc()
        item.rotation_euler.z = turn
        update()
        select(item)
        bpy.ops.object.ocean_tweak_float()
        (collar,) = extension("scene.contact").collars_of(item)
        collar.inputs["Foam Width"].default_value = 0.05  # so that only the wash is as far away
        empty_scene.frame_set(5)
        foam = seen_from_above(ocean)
        assert foam[windward].max() < 0.01
        assert (foam[lee].min() > 0.15) == reaches
        bpy.data.objects.remove(item)
        update()


def washed(wind, away):
    """Places so far down the wind and up the wind from the middle, in m."""
    step = away * np.array((math.cos(wind), math.sin(wind)))
    return AT + step, AT - step


def test_eevee_draws_the_same_collar(ocean, disc, select, empty_scene, seen_from_above):
    item = disc()
    select(item)
    bpy.ops.object.ocean_tweak_float()
    empty_scene.frame_set(5)
    of_cycles = seen_from_above(ocean)
    for engine in EEVEE_NAMES:
        with contextlib.suppress(TypeError):  # the name in another version
            empty_scene.render.engine = engine
    empty_scene.eevee.taa_render_samples = 4
    difference = np.abs(seen_from_above(ocean) - of_cycles)
    assert of_cycles.max() > 0.5
    assert difference.mean() < 0.1 * of_cycles.mean()


def test_white_water_laps_at_a_hull_just_above_the_water(extension, empty_scene, shone_from_above):
    """A black board that reaches from the water's surface, at the left, to the top of the wet band and on."""
    half = 0.5 * WIDTH
    mesh = bpy.data.meshes.new("Board")
    corners = ((-half, -half), (half, -half), (half, half), (-half, half))
    mesh.from_pydata([(AT[0] + x, AT[1] + y, 0.0) for x, y in corners], [], [(0, 1, 2, 3)])
    for name, values in (("wet", (1.0, -1.0, -1.0, 1.0)), ("slop", (1.0,) * 4)):
        mesh.attributes.new(name, "FLOAT", "POINT").data.foreach_set("value", values)
    item = bpy.data.objects.new("Board", mesh)
    empty_scene.collection.objects.link(item)
    material = bpy.data.materials.new("Board")
    if material.node_tree is None:
        material.use_nodes = True
    mesh.materials.append(material)
    group = material.node_tree.nodes.new("ShaderNodeGroup")
    group.node_tree = extension("nodes.versioned").node_group(extension("nodes.contact").WET_BAND)
    group.inputs["Color"].default_value = (0.0, 0.0, 0.0, 1.0)
    white = shone_from_above(item, group.outputs["Color"], "Color").mean(axis=0)
    near, middle, top = (
        white[: PIXELS // 16].mean(),
        white[PIXELS // 6 : PIXELS // 3].mean(),
        white[-60:].max(),
    )
    assert near > 0.25
    assert near > 1.5 * middle > 0.0
    assert top == 0.0
    group.inputs["Roughness"].default_value = 0.1  # of what is dry; what is wet is smoother
    assert shone_from_above(item, group.outputs["Roughness"], "Strength").max() > 0.4
    group.inputs["Slop"].default_value = 0.0
    assert shone_from_above(item, group.outputs["Color"], "Color").max() == 0.0
    group.inputs["Slop"].default_value = 1.0
    for name, value in (("wet", 2.0), ("slop", 0.0)):  # below the water, and where no water laps
        before = [each.value for each in mesh.attributes[name].data]
        mesh.attributes[name].data.foreach_set("value", (value,) * 4)
        assert shone_from_above(item, group.outputs["Color"], "Color").max() == 0.0
        mesh.attributes[name].data.foreach_set("value", before)
