# SPDX-License-Identifier: GPL-3.0-or-later
"""Patches side by side: the same sea again and again, and nobody sees where one ends."""

import bpy
import numpy as np
import pytest

from .conftest import DOMAIN, SAMPLES, evaluated_mesh
from .surfaces import ALL_MAPS, assert_alike, read, wanted

WAYS = [(method, source) for method in ("NODES", "DISPLACE") for source in ("LIVE", "SEQUENCE")]
SIDE = 3 * SAMPLES + 1


@pytest.fixture
def add(ocean_object, bake, empty_scene):
    def add_ocean(parameters, method, source, repeats, **more):
        sequence = bake(parameters, 1, 3, maps=ALL_MAPS) if source == "SEQUENCE" else None
        return ocean_object.add(empty_scene, parameters, method, source, sequence, repeats=repeats, **more)

    return add_ocean


def assert_seamless(found):
    """A vertex and those a patch further on carry the very same numbers."""
    for name in ("displacement", "velocity", "foam", "cusp", "normal"):
        first = found[name][: SAMPLES + 1, : SAMPLES + 1]
        for row in range(0, len(found[name]) - SAMPLES, SAMPLES):
            for column in range(0, found[name].shape[1] - SAMPLES, SAMPLES):
                again = found[name][row : row + SAMPLES + 1, column : column + SAMPLES + 1]
                np.testing.assert_array_equal(again, first)


@pytest.mark.parametrize(("method", "source"), WAYS)
def test_three_by_three_have_no_seam(add, core, make_parameters, empty_scene, method, source):
    parameters = make_parameters()
    item = add(parameters, method, source, (3, 3))
    empty_scene.frame_set(2)
    found = read(evaluated_mesh(item), SIDE, SIDE)
    assert_seamless(found)
    assert_alike(found, wanted(core, parameters, 2, repeats=(3, 3)))


@pytest.mark.parametrize(("method", "source"), WAYS)
def test_renders_repeat_too(add, core, make_parameters, empty_scene, rendering, method, source):
    parameters = make_parameters()
    item = add(parameters, method, source, (3, 2), viewport_resolution=16)
    empty_scene.frame_set(2)
    found = rendering(lambda mesh: read(mesh, 2 * SAMPLES + 1, SIDE))[item.name]
    assert_seamless(found)
    assert_alike(found, wanted(core, parameters, 2, repeats=(3, 2)))


@pytest.mark.parametrize("method", ["NODES", "DISPLACE"])
def test_more_and_fewer_patches_at_any_time(add, core, make_parameters, empty_scene, method):
    parameters = make_parameters()
    item = add(parameters, method, "LIVE", (1, 1))
    for repeats in ((2, 1), (1, 3), (1, 1)):
        item.ocean_tweak.repeats_x, item.ocean_tweak.repeats_y = repeats
        rows, columns = repeats[1] * SAMPLES + 1, repeats[0] * SAMPLES + 1
        expected = wanted(core, parameters, 1, repeats=repeats)
        assert_alike(read(evaluated_mesh(item), rows, columns), expected)
    assert not item.data.validate()


def test_sixty_four_patches_in_a_row_are_exact(add, make_parameters, empty_scene):
    """Where texture coordinates are largest, float32 has the fewest digits for what lies between texels."""
    item = add(make_parameters(), "DISPLACE", "LIVE", (64, 1))
    found = read(evaluated_mesh(item), SAMPLES + 1, 64 * SAMPLES + 1)["displacement"]
    np.testing.assert_array_equal(found[:, -1 - SAMPLES :], found[:, : SAMPLES + 1])


def test_a_grid_too_large_for_the_machine_is_refused(add, make_parameters, extension, monkeypatch):
    item = add(make_parameters(), "NODES", "LIVE", (1, 1))
    monkeypatch.setattr(extension("scene.plan"), "usable_memory", lambda: 2**23)
    item.ocean_tweak.repeats_x = 64
    assert "64 x 1 repeats of 32² quads need" in item.ocean_tweak.error
    item.ocean_tweak.repeats_x = 2
    assert item.ocean_tweak.error == ""


def test_a_picture_from_above_shows_no_seam(add, make_parameters, empty_scene, tmp_path):
    """Brightness steps from column to column at the seams as it does elsewhere; and so do rows."""
    patch = 32  # pixels
    item = add(make_parameters(), "NODES", "LIVE", (3, 3))
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.data.type, camera.data.ortho_scale = "ORTHO", 3 * DOMAIN
    camera.location = (1.5 * DOMAIN, 1.5 * DOMAIN, 90.0)
    sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
    sun.rotation_euler = (1.0, 0.3, 0.0)
    for each in (camera, sun):
        empty_scene.collection.objects.link(each)
    empty_scene.camera = camera
    empty_scene.render.engine, empty_scene.cycles.device = "CYCLES", "CPU"
    empty_scene.cycles.use_denoising = False
    empty_scene.cycles.samples = 16
    empty_scene.render.resolution_x = empty_scene.render.resolution_y = 3 * patch
    empty_scene.render.image_settings.file_format = "OPEN_EXR"
    empty_scene.render.filepath = str(tmp_path / "above.exr")
    empty_scene.frame_set(2)
    bpy.ops.render.render(write_still=True)
    assert item.ocean_tweak.error == ""
    image = bpy.data.images.load(str(tmp_path / "above.exr"))
    pixels = np.array(image.pixels[:]).reshape(3 * patch, 3 * patch, 4)[..., 0]
    assert np.ptp(pixels) > 0.1
    for picture in (pixels, pixels.T):
        steps = np.abs(np.diff(picture, axis=1)).mean(axis=0)
        seams = {patch - 1, 2 * patch - 1}  # between these pixels and the next
        elsewhere = [step for index, step in enumerate(steps) if index not in seams]
        assert max(steps[index] for index in seams) <= max(elsewhere)
        # and the patches are alike, but for their noise
        assert np.abs(picture[:, :patch] - picture[:, patch : 2 * patch]).mean() < 0.1 * np.ptp(pixels)
