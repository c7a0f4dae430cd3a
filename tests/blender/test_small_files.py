# SPDX-License-Identifier: GPL-3.0-or-later
"""A .blend file holds settings, and of a live sea as much as a Blender without the extension shows."""

from pathlib import Path

import bpy
import numpy as np
import pytest

from . import camera_views
from .camera_views import numbers
from .conftest import evaluated_mesh
from .other_blender import look

camera = camera_views.camera


@pytest.fixture
def surrounded(extension, core, ocean_object, make_parameters, camera, empty_scene):
    """A live ocean of two patches, one masked, with foam that remembers and a surface around the camera."""
    camera.location = (71.3, 52.9, 2.0)
    layer = core.WaveLayer(wind_speed=8.0, fetch=20e3, mask=core.Mask(x=20.0, y=30.0, outer_radius=70.0))
    patches = (
        core.Patch(domain_size=150.0, shortest_wavelength=12.0, resolution=64),
        core.Patch(domain_size=20.0, longest_wavelength=12.0, shortest_wavelength=3.0, resolution=32),
    )
    other = core.WaveLayer(wind_speed=5.0, fetch=9e3, wind_direction=1.0)
    sea = make_parameters(layers=(layer, other), patches=patches, merged_resolution=32)
    ocean = ocean_object.add(empty_scene, sea)
    bpy.context.view_layer.objects.active = ocean
    surface = extension("scene.camera_surface").add_camera_surface(ocean, empty_scene, budget=5000)
    bpy.context.view_layer.update()
    return ocean, surface


def around(ocean):
    """Vertices of the meshes that surround the camera, by name."""
    hidden = [child for child in ocean.children if child.hide_select]
    return {child.name: numbers(child.data, "position", 3) for child in hidden}


def surface_on(ocean):
    mesh = ocean.data
    return {
        each.name: numbers(mesh, each.name, 3 if each.data_type == "FLOAT_VECTOR" else 1)
        for each in mesh.attributes
        if each.domain == "POINT" and each.data_type.startswith("FLOAT")
    }


def assert_equal(found, expected):
    assert found.keys() == expected.keys()
    for name, value in expected.items():
        np.testing.assert_array_equal(found[name], value, err_msg=name)


def test_the_ready_scene_to_the_horizon_is_a_few_megabytes(empty_scene, tmp_path):
    assert bpy.ops.ocean.add_scene(mood="HORIZON") == {"FINISHED"}
    path = tmp_path / "horizon.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path), compress=True)
    assert 1e6 < path.stat().st_size < 5e6
    bpy.ops.wm.save_as_mainfile(filepath=str(path), compress=False)
    assert path.stat().st_size < 25e6


def test_all_is_back_after_saving_and_opening(surrounded, tmp_path):
    ocean, surface = surrounded
    before, shown = around(ocean), numbers(evaluated_mesh(surface), "position", 3)
    own = surface_on(ocean)
    assert len(before) == 6  # both patches with their mask and without, the weights, the foam
    assert {"velocity", "custom_normal"} <= own.keys()
    path = tmp_path / "sea.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    assert_equal(surface_on(ocean), own)
    assert_equal(around(ocean), before)
    names = ocean.name, surface.name
    bpy.ops.wm.open_mainfile(filepath=str(path))
    ocean, surface = (bpy.data.objects[name] for name in names)
    assert_equal(around(ocean), before)
    assert_equal(surface_on(ocean), own)
    np.testing.assert_allclose(numbers(evaluated_mesh(surface), "position", 3), shown, atol=1e-4)


def test_linked_duplicates_keep_their_surface(ocean, tmp_path):
    """Until something changes one of them, they have one mesh."""
    own = surface_on(ocean)
    bpy.context.scene.collection.objects.link(ocean.copy())
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "sea.blend"))
    assert_equal(surface_on(ocean), own)


def test_a_save_that_fails_takes_nothing_away(surrounded, tmp_path):
    ocean, _ = surrounded
    own = surface_on(ocean)
    with pytest.raises(RuntimeError):
        bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "missing" / "sea.blend"))
    assert_equal(surface_on(ocean), own)


def test_all_is_back_after_undo(surrounded, window):
    ocean, _ = surrounded
    before, name = around(ocean), ocean.name
    with window.override():
        bpy.ops.ed.undo_push(message="as it is")
        ocean.ocean_tweak.choppiness = 0.3
        bpy.ops.ed.undo_push(message="less sharp")
        assert any(np.abs(around(ocean)[key] - value).max() > 1e-3 for key, value in before.items())
        assert bpy.ops.ed.undo() == {"FINISHED"}
    assert_equal(around(bpy.data.objects[name]), before)


def test_what_is_saved_without_handlers_is_small_too(surrounded, extension, tmp_path):
    """As Blender saves by itself; and nothing of it is missed when that file is opened."""
    ocean, _ = surrounded
    before, name = around(ocean), ocean.name
    with extension("scene.handlers").asleep():
        bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "auto.blend"))
        bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "auto.blend"))
        assert not around(bpy.data.objects[name])
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "auto.blend"))
    assert_equal(around(bpy.data.objects[name]), before)


def test_without_the_extension_the_merged_sea_is_shown(surrounded, extension, tmp_path):
    _, surface = surrounded
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "sea.blend"))
    seen, _ = look(Path(bpy.data.filepath), [surface.name], [1], tmp_path)
    patches = extension("nodes.camera_sum").PATCH_INPUTS
    nothing = dict.fromkeys((*patches, "Weights", extension("nodes.camera_surface").FOAM_INPUT))
    extension("nodes.modifier_inputs").set_inputs(surface.modifiers[0], nothing)
    surface.update_tag()
    merged = numbers(evaluated_mesh(surface), "position", 3)
    assert np.ptp(merged[:, 2]) > 0.1
    np.testing.assert_allclose(seen[f"{surface.name} viewport 1"], merged, atol=1e-3)


def test_patterns_of_the_water_are_stored_in_16_bits_without_loss(extension, empty_scene, tmp_path):
    images = extension("nodes.detail_image")
    makers = images.ripple_image, images.lace_image, images.billow_image, images.gust_image
    before = {image.name: np.array(image.pixels, np.float32) for image in (make() for make in makers)}
    for name, pixels in before.items():
        bpy.data.images[name].use_fake_user = True
        assert np.ptp(pixels.reshape(-1, 4)[:, 0]) > 0.5
        assert bpy.data.images[name].packed_file.size < 1.0 * pixels.size  # of 12 bytes for three channels
    path = tmp_path / "patterns.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    bpy.ops.wm.open_mainfile(filepath=str(path))
    assert_equal({name: np.array(bpy.data.images[name].pixels, np.float32) for name in before}, before)
