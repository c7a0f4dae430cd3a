# SPDX-License-Identifier: GPL-3.0-or-later
"""Camera, horizon and render settings of the example scenes."""

from __future__ import annotations

import contextlib
import math

import bpy


def tile(ocean, name, patch_size, rings):
    """Surround a patch with `rings` rings of instances of itself; returns the object that carries them.

    Instances share the patch's mesh, whatever moves it: they cost next to nothing.
    """
    span = range(-rings, rings + 1)
    points = [(i * patch_size, j * patch_size, 0.0) for i in span for j in span if (i, j) != (0, 0)]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(points, [], [])
    carrier = bpy.data.objects.new(name, mesh)
    modifier = carrier.modifiers.new("Tiles", "NODES")
    modifier.node_group = _tile_nodes(ocean)
    carrier.hide_viewport = True  # no graphics card draws a hundred million triangles at 24 frames a second
    return carrier


def _tile_nodes(ocean):
    tree = bpy.data.node_groups.new(f"Tiles of {ocean.name}", "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    start, end = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
    patch = tree.nodes.new("GeometryNodeObjectInfo")
    patch.inputs["Object"].default_value = ocean
    patch.inputs["As Instance"].default_value = True
    place = tree.nodes.new("GeometryNodeInstanceOnPoints")
    tree.links.new(start.outputs[0], place.inputs["Points"])
    tree.links.new(patch.outputs["Geometry"], place.inputs["Instance"])
    tree.links.new(place.outputs[0], end.inputs[0])
    return tree


def camera(name, position, azimuth, tilt, lens):
    """A camera at `position` m, looking along `azimuth` (from +x) and `tilt` (from the horizon), radians."""
    data = bpy.data.cameras.new(name)
    data.lens = lens
    data.clip_start, data.clip_end = 1.0, 1e5
    result = bpy.data.objects.new(name, data)
    result.location = position
    result.rotation_euler = (math.pi / 2.0 + tilt, 0.0, azimuth - math.pi / 2.0)
    return result


def before_the_highest_crest(elevation, patch_size, azimuth, distance, height):
    """A place from which the patch's highest wave is seen along `azimuth`, radians from +x.

    elevation : (N, N) array [y, x], m
    distance : m from the crest
    height : m above mean water; more where the sea itself is as high
    """
    samples = len(elevation)
    row, column = divmod(int(elevation.argmax()), samples)
    x = column * patch_size / samples - distance * math.cos(azimuth)
    y = row * patch_size / samples - distance * math.sin(azimuth)
    x, y = x % patch_size, y % patch_size
    below = elevation[int(y / patch_size * samples) % samples, int(x / patch_size * samples) % samples]
    return x, y, max(height, float(below) + 0.7 * height)


def render_settings(scene, width=960, height=540, samples=16):
    """Cycles on the processor: few samples, a denoiser where this Blender has one."""
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.resolution_percentage = 100
    scene.cycles.device = "CPU"
    scene.cycles.samples = samples
    scene.cycles.use_adaptive_sampling = True
    scene.cycles.adaptive_threshold = 0.02
    scene.cycles.adaptive_min_samples = 6
    scene.cycles.max_bounces = 2
    scene.cycles.caustics_reflective = scene.cycles.caustics_refractive = False
    scene.cycles.use_denoising = has_denoiser()
    if scene.cycles.use_denoising:
        scene.cycles.denoiser = "OPENIMAGEDENOISE"
        scene.cycles.denoising_prefilter = "FAST"
    with contextlib.suppress(TypeError):  # a studio's OCIO configuration may lack these
        scene.view_settings.view_transform = "AgX"
        scene.view_settings.look = "AgX - Medium High Contrast"


def has_denoiser():
    """Whether this Blender was built with Open Image Denoise."""
    import _cycles

    return bool(getattr(_cycles, "with_openimagedenoise", False))
