# SPDX-License-Identifier: GPL-3.0-or-later
"""How much foam a ready scene's camera sees is what the sea has there: rays through its pixels tell."""

import dataclasses

import bpy
import numpy as np
import pytest
from mathutils.bvhtree import BVHTree

from .conftest import sea_of

WIDE, HIGH = 128, 72
SAMPLES = 128
#: tiles on each side of the one below the camera
AROUND = 2
#: wind in m/s, foam as a share of what it leaves, and engine: 5 and 9 Bft
SHOTS = ((10.0, 5.0, "CYCLES"), (22.0, 3.0, "CYCLES"), (22.0, 3.0, "EEVEE"))


@pytest.fixture(params=SHOTS, ids=lambda shot: f"{shot[0]:.0f} m/s in {shot[2]}")
def seen(request, extension, empty_scene, monkeypatch):
    """The ready Fresh Breeze, or its camera before a storm, with foam enough to be counted; water shines by
    its foam alone.
    """
    wind, coverage, engine = request.param
    core, mood = extension("core"), extension("scene.moods").Mood
    original = mood.sea

    def sea(self, timing):
        calm = original(self, timing)
        layers = tuple(dataclasses.replace(layer, wind_speed=wind) for layer in calm.layers)
        return calm.replace(resolution=SAMPLES, layers=layers, foam=core.Foam(coverage=coverage))

    monkeypatch.setattr(mood, "sea", sea)
    assert bpy.ops.ocean.add_scene(mood="FRESH_BREEZE", engine=engine, use_buoy=False) == {"FINISHED"}
    ocean = next(item for item in empty_scene.objects if item.ocean_tweak.is_ocean)
    tree = ocean.active_material.node_tree
    group = next(node for node in tree.nodes if node.type == "GROUP")
    shown = tree.nodes.new("ShaderNodeEmission")
    tree.links.new(group.outputs["Foam"], shown.inputs["Color"])
    output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    for link in output.inputs["Surface"].links:
        tree.links.remove(link)
    tree.links.new(shown.outputs[0], output.inputs["Surface"])
    return ocean


def rendered(scene, path):
    """(HIGH, WIDE) what shines, from the lowest row of the picture."""
    render, cycles = scene.render, scene.cycles
    render.resolution_x, render.resolution_y, render.resolution_percentage = WIDE, HIGH, 100
    render.use_motion_blur, render.use_compositing = False, False
    render.image_settings.file_format, render.filepath = "OPEN_EXR", str(path)
    scene.view_settings.view_transform, scene.view_settings.exposure = "Raw", 0.0
    cycles.device, cycles.samples, cycles.use_denoising, cycles.max_bounces = "CPU", 8, False, 0
    scene.eevee.taa_render_samples, scene.eevee.use_raytracing = 8, False
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(render.filepath)
    pixels = np.empty(4 * WIDE * HIGH, np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels.reshape(HIGH, WIDE, 4)[..., 0].astype(np.float64)


def projected(core, ocean, scene):
    """(HIGH, WIDE) foam of the core's own surface that each pixel's middle sees, and its distance in m."""
    sea = sea_of(ocean)
    fields = core.Ocean(sea).frame(scene.frame_current, {"displacement", "foam"})
    camera = scene.camera.evaluated_get(bpy.context.evaluated_depsgraph_get())
    eye = camera.matrix_world.translation - ocean.matrix_world.translation
    n, side = sea.resolution, sea.domain_size
    first = [int(np.floor(eye[axis] / side)) - AROUND for axis in (0, 1)]
    count = n * (2 * AROUND + 1) + 1
    row, column = np.mgrid[:count, :count]
    points = fields.displacement[row % n, column % n].astype(np.float64)
    points[..., 0] += first[0] * side + column * side / n
    points[..., 1] += first[1] * side + row * side / n
    corner = (row * count + column)[:-1, :-1].reshape(-1, 1)
    faces = corner + np.array([0, 1, count + 1, count])
    tree = BVHTree.FromPolygons(points.reshape(-1, 3).tolist(), faces.tolist())
    right, top = camera.data.view_frame(scene=scene)[0].xy
    seen, away = np.zeros((HIGH, WIDE)), np.full((HIGH, WIDE), np.inf)
    depth = -camera.data.view_frame(scene=scene)[0].z
    turn = np.array(camera.matrix_world.to_3x3())
    for at in np.ndindex(HIGH, WIDE):
        v, u = (2.0 * (place + 0.5) / size - 1.0 for place, size in zip(at, (HIGH, WIDE), strict=True))
        _, _, face, distance = tree.ray_cast(eye, turn @ (u * right, v * top, -depth))
        if face is not None:
            i, j = divmod(faces[face, 0], count)
            seen[at] = np.mean(
                fields.foam[[i % n, i % n, (i + 1) % n, (i + 1) % n], [j % n, (j + 1) % n] * 2]
            )
            away[at] = distance
    return seen, away


def test_pixels_show_as_much_foam_as_the_field_through_the_same_camera(seen, core, empty_scene, tmp_path):
    empty_scene.frame_set(40)
    shown = rendered(empty_scene, tmp_path / "seen.exr")
    expected, away = projected(core, seen, empty_scene)
    near = away < AROUND * sea_of(seen).domain_size
    assert 0.25 < np.mean(near) < 0.9
    assert np.mean(expected[near]) > 0.02
    assert np.mean(shown[near]) == pytest.approx(np.mean(expected[near]), rel=0.25)
    # and it is where the field has it, though the material draws it as lace
    blocks = [
        np.where(near, field, 0.0).reshape(HIGH // 8, 8, WIDE // 8, 8).mean((1, 3)).ravel()
        for field in (shown, expected)
    ]
    assert np.corrcoef(*blocks)[0, 1] > 0.9
