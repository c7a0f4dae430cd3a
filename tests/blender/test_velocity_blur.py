# SPDX-License-Identifier: GPL-3.0-or-later
"""Motion blur from the attribute `velocity` is what an open shutter sees, in EEVEE too of a bake."""

from functools import partial

import bpy
import numpy as np
import pytest

from .conftest import SAMPLES
from .surfaces import ALL_MAPS

PIXELS = 128
DOMAIN = 600.0  # m
WIDTH = 25.0  # of what is seen, m
FRAME = 3
SHUTTER = 0.8  # frames
MOMENTS = 16
EEVEE_NAMES = ("BLENDER_EEVEE_NEXT", "BLENDER_EEVEE")  # of 4.5 and 5.x
DOT = 0.5  # of a dot on the water, its radius, m
WAYS = (("NODES", "LIVE"), ("NODES", "SEQUENCE"), ("DISPLACE", "LIVE"), ("DISPLACE", "SEQUENCE"))


@pytest.fixture
def render(empty_scene, tmp_path):
    """Render stripes that swim on the water, from above; returns the pixels' brightness."""
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.data.type, camera.data.ortho_scale = "ORTHO", WIDTH
    camera.location = (DOMAIN / 2, DOMAIN / 2, 90.0)
    empty_scene.collection.objects.link(camera)
    empty_scene.camera = camera
    empty_scene.render.engine, empty_scene.cycles.device = "CYCLES", "CPU"
    empty_scene.cycles.use_denoising = False
    empty_scene.render.resolution_x = empty_scene.render.resolution_y = PIXELS
    empty_scene.render.image_settings.file_format = "OPEN_EXR"
    empty_scene.render.motion_blur_shutter = SHUTTER

    def pixels(moment=FRAME, blur=False, samples=8):
        empty_scene.render.use_motion_blur = blur
        empty_scene.cycles.samples = samples
        empty_scene.cycles.seed = round(1000 * moment)  # moments share no noise
        empty_scene.frame_set(int(moment), subframe=moment - int(moment))
        empty_scene.render.filepath = str(tmp_path / "moment.exr")
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(empty_scene.render.filepath)
        result = np.array(image.pixels[:]).reshape(PIXELS, PIXELS, 4)[..., 0]
        bpy.data.images.remove(image)
        return result

    return pixels


def shining(pattern):
    """A material that shines with a pattern, which stays with the water: (nodes, links, st) → a socket."""
    material = bpy.data.materials.new("Pattern")
    if bpy.app.version < (5, 0):
        material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    coordinates = nodes.new("ShaderNodeAttribute")
    coordinates.attribute_name = "st"
    shine, out = nodes.new("ShaderNodeEmission"), nodes.new("ShaderNodeOutputMaterial")
    links.new(pattern(nodes, links, coordinates.outputs["Vector"]), shine.inputs["Strength"])
    links.new(shine.outputs["Emission"], out.inputs["Surface"])
    return material


def stripes(nodes, links, st):
    """Soft ones, 2 m apart."""
    wave = nodes.new("ShaderNodeTexWave")
    wave.inputs["Scale"].default_value = 94.0
    links.new(st, wave.inputs["Vector"])
    return wave.outputs["Color"]


def dot(nodes, links, st, sample):
    """One on a sample (row, column)."""
    away, small = nodes.new("ShaderNodeVectorMath"), nodes.new("ShaderNodeMath")
    away.operation, small.operation = "DISTANCE", "LESS_THAN"
    away.inputs[1].default_value = ((sample[1] + 0.5) / SAMPLES, (sample[0] + 0.5) / SAMPLES, 0.0)
    small.inputs[1].default_value = DOT / DOMAIN
    links.new(st, away.inputs[0])
    links.new(away.outputs["Value"], small.inputs[0])
    return small.outputs[0]


def test_blur_is_the_average_of_the_moments(ocean_object, core, bake, make_parameters, empty_scene, render):
    """Long waves, a second a frame: the water goes a stripe's width while its speed hardly turns."""
    layer = core.WaveLayer(wind_speed=20.0, fetch=300e3)
    parameters = make_parameters(
        fps=1, domain_size=DOMAIN, layers=(layer,), foam=core.Foam(coverage=0.0), start_frame=1
    )
    empty_scene.render.fps = 1
    material = shining(stripes)

    def add(method, source):
        sequence = bake(parameters, FRAME - 1, FRAME + 1, maps=ALL_MAPS) if source == "SEQUENCE" else None
        item = ocean_object.add(empty_scene, parameters, method, source, sequence)
        item.data.materials.append(material)
        return item

    item = add("NODES", "LIVE")
    shutter = FRAME + ((np.arange(MOMENTS) + 0.5) / MOMENTS - 0.5) * SHUTTER
    seen = np.mean([render(moment) for moment in shutter], axis=0)
    without = rms(render(samples=64) - seen)
    assert without > 0.1
    bpy.data.objects.remove(item)
    for method, source in WAYS:
        item = add(method, source)
        assert rms(render(blur=True, samples=64) - seen) < 0.25 * without, (method, source)
        bpy.data.objects.remove(item)


def test_a_dot_on_baked_water_is_as_long_a_streak_in_either_engine(
    ocean_object, core, bake, make_parameters, empty_scene, render
):
    """It is as long as the water goes by its velocity while the shutter is open."""
    layer = core.WaveLayer(wind_speed=20.0, fetch=300e3)
    parameters = make_parameters(
        fps=1, domain_size=DOMAIN, layers=(layer,), foam=core.Foam(coverage=0.0), start_frame=1
    )
    empty_scene.render.fps = 1
    sequence = bake(parameters, FRAME - 1, FRAME + 1, maps=ALL_MAPS)
    item = ocean_object.add(empty_scene, parameters, "NODES", "SEQUENCE", sequence)
    fields = core.Ocean(parameters).frame(FRAME, {"displacement", "velocity"})
    speed = np.hypot(fields.velocity[..., 0], fields.velocity[..., 1])
    sample = np.unravel_index(speed.argmax(), speed.shape)
    wanted = SHUTTER * speed[sample]
    item.data.materials.append(shining(partial(dot, sample=sample)))
    empty_scene.camera.location.xy = (
        np.array(sample[::-1]) * DOMAIN / SAMPLES + fields.displacement[sample][:2]
    )
    assert wanted > 4.0 * DOT
    lengths = {}
    for engine in ("CYCLES", *EEVEE_NAMES):
        try:
            empty_scene.render.engine = engine
        except TypeError:  # of another version
            continue
        empty_scene.eevee.motion_blur_steps = 4
        sharp, blurred = render(samples=16), render(blur=True, samples=64)
        lengths[engine] = np.sqrt(12.0 * (variance(blurred) - variance(sharp)))
    assert len(lengths) == 2
    for engine, length in lengths.items():
        assert length == pytest.approx(wanted, rel=0.1), engine


def variance(brightness):
    """Mean square distance of the light from its middle, m²; of a line of length L it is L²/12."""
    share = brightness / brightness.sum()
    place = np.stack(np.mgrid[:PIXELS, :PIXELS], axis=-1) * (WIDTH / PIXELS)
    middle = np.einsum("ij,ijk->k", share, place)
    return float(np.sum(share * np.sum((place - middle) ** 2, axis=-1)))


def rms(difference):
    return float(np.sqrt(np.mean(difference**2)))
