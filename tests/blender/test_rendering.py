# SPDX-License-Identifier: GPL-3.0-or-later
"""Rendered frames show the frame's own sea, also between whole frames and from linked files."""

import bpy
import numpy as np
import pytest

TOLERANCE = 1e-4  # m


@pytest.fixture
def render(empty_scene, tmp_path):
    """Render the scene from above with Cycles in a size that takes no time; returns the pixels."""
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.location = (75.0, 75.0, 90.0)
    sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
    sun.rotation_euler = (1.2, 0.3, 0.0)
    for item in (camera, sun):
        empty_scene.collection.objects.link(item)
    empty_scene.camera = camera
    empty_scene.render.engine = "CYCLES"
    empty_scene.cycles.samples = 1
    empty_scene.cycles.device = "CPU"
    empty_scene.render.resolution_x = empty_scene.render.resolution_y = 32
    empty_scene.render.image_settings.file_format = "PNG"

    def pixels(frame):
        empty_scene.frame_set(frame)
        empty_scene.render.filepath = str(tmp_path / f"{frame}.png")
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(empty_scene.render.filepath)
        return np.array(image.pixels[:]).reshape(32, 32, 4)[..., :3]

    return pixels


@pytest.mark.parametrize("method", ["NODES", "DISPLACE"])
@pytest.mark.parametrize("source", ["LIVE", "SEQUENCE"])
def test_frames_differ_and_can_be_repeated(
    ocean_object, bake, make_parameters, empty_scene, render, method, source
):
    sequence = bake(make_parameters(), 1, 24) if source == "SEQUENCE" else None
    ocean_object.add(empty_scene, make_parameters(), method, source, sequence)
    first, last, again = render(1), render(24), render(1)
    assert np.abs(first - last).max() > 0.02
    np.testing.assert_array_equal(first, again)


def test_motion_blur_reads_between_frames(
    ocean_object, core, make_parameters, empty_scene, render, monkeypatch
):
    ocean_object.add(empty_scene, make_parameters())
    empty_scene.render.use_motion_blur = True
    seconds = set()
    original = core.Ocean.surface
    monkeypatch.setattr(
        core.Ocean,
        "surface",
        lambda self, time, *rest, **named: (
            seconds.add(float(time) * 24) or original(self, time, *rest, **named)
        ),
    )
    render(3)
    assert min(seconds) < 2.0 < max(seconds)
    assert empty_scene.render.use_lock_interface


def test_linked_and_overridden_oceans_move(
    ocean_object, make_parameters, expected, evaluated, empty_scene, tmp_path
):
    sea, other = make_parameters(), make_parameters(seed=4, domain_size=90.0)
    for method in ("NODES", "DISPLACE"):
        ocean_object.add(empty_scene, sea, method, name=method)
    file = str(tmp_path / "library.blend")
    bpy.ops.wm.save_as_mainfile(filepath=file)
    bpy.ops.wm.read_homefile(use_empty=True)
    scene = bpy.context.scene
    with bpy.data.libraries.load(file, link=True) as (_, wanted):
        wanted.objects = ["NODES", "DISPLACE"]
    for item in wanted.objects:
        scene.collection.objects.link(item)
    scene.frame_set(5)
    for item in wanted.objects:
        np.testing.assert_allclose(evaluated(item), expected(sea, 5), atol=TOLERANCE)
    override = wanted.objects[0].override_create(remap_local_usages=True)
    override.ocean_tweak.from_parameters(other, scene)
    scene.frame_set(6)
    np.testing.assert_allclose(evaluated(override), expected(other, 6), atol=TOLERANCE)
    np.testing.assert_allclose(evaluated(wanted.objects[1]), expected(sea, 6), atol=TOLERANCE)
    layers = (other.layers[0], type(other.layers[0])())
    with pytest.raises(ValueError, match="keeps its 1 wave layer, this sea has 2 wave layers"):
        override.ocean_tweak.from_parameters(other.replace(layers=layers), scene)
    shot = str(tmp_path / "shot.blend")
    bpy.ops.wm.save_as_mainfile(filepath=shot)
    bpy.ops.wm.open_mainfile(filepath=shot)
    bpy.context.scene.frame_set(9)
    override = next(item for item in bpy.data.objects if item.override_library)
    np.testing.assert_allclose(evaluated(override), expected(other, 9), atol=TOLERANCE)
