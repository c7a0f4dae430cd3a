# SPDX-License-Identifier: GPL-3.0-or-later
"""Wakes in a bake: what a camera surface shows live, from files, with and without the extension."""

import json

import bpy
import numpy as np
import pytest

from . import camera_views, floats
from .camera_views import numbers
from .conftest import evaluated_mesh
from .other_blender import look
from .test_wakes import key, new_hull

# fixtures for every test here
camera, select = camera_views.camera, floats.select


@pytest.fixture
def shot(extension, core, ocean_object, make_parameters, camera, empty_scene, select, tmp_path, monkeypatch):
    """A ship ahead of a camera, in three frames of a saved file."""
    monkeypatch.delenv("OCEAN_TWEAK_CACHE", raising=False)
    empty_scene.frame_start, empty_scene.frame_end = 1, 3
    waves = core.WaveLayer(wind_speed=8.0, fetch=20e3)
    foam = core.Foam(half_life=0.5)
    parameters = make_parameters(domain_size=120.0, resolution=64, layers=(waves,), foam=foam)
    ocean = ocean_object.add(empty_scene, parameters)
    ocean.ocean_tweak.use_foam = False  # whose places, live, are the surface's vertices
    ship = new_hull(empty_scene)
    key(ship, {1: (0.0, 10.0, 0.0), 3: (0.7, 10.0, 0.0)})
    camera.location = (0.0, -20.0, 12.0)
    select(ship)
    bpy.ops.object.ocean_tweak_wake()
    surface = next(child for child in ocean.children if child.name.endswith("Camera Surface"))
    inputs = {"Finest Spacing": 1.0, "To Horizon": False, "Reach": 70.0, "Fade": False}
    extension("nodes.modifier_inputs").set_inputs(surface.modifiers[0], inputs)
    surface.update_tag()
    select(ocean)
    (tmp_path / "project").mkdir()
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "project" / "shot.blend"))
    return ocean, surface


def shown(surface, frame, name="position"):
    bpy.context.scene.frame_set(frame)
    bpy.context.view_layer.update()
    return numbers(evaluated_mesh(surface), name, 1 if name == "foam" else 3)


def area_of(ocean):
    return next(child for child in ocean.children if child.name.endswith("Area"))


def test_baked_wakes_are_the_live_ones(extension, shot, tmp_path):
    """Frames alone, backwards, and without the extension in a project that was moved."""
    ocean, surface = shot
    live = {frame: shown(surface, frame) for frame in (1, 2, 3)}
    wake = numbers(evaluated_mesh(area_of(ocean)), "displacement", 3)
    assert wake[:, 2].min() < -0.5
    assert bpy.ops.ocean.bake() == {"FINISHED"}
    assert ocean.ocean_tweak.source == "SEQUENCE"
    assert not len(area_of(ocean).data.vertices)
    for frame in (3, 1, 2):
        np.testing.assert_allclose(shown(surface, frame), live[frame], atol=1e-3)
    assert ocean.ocean_tweak.bake_differs == ""
    assert extension("scene.portability").needs_of(ocean) == ()
    bpy.ops.wm.save_mainfile(compress=True)  # which is not the default before 5.0
    assert (tmp_path / "project" / "shot.blend").stat().st_size < 2e6
    (tmp_path / "project").rename(tmp_path / "moved")
    seen, said = look(tmp_path / "moved" / "shot.blend", [surface.name, ocean.name], [3, 1], tmp_path)
    for frame in (1, 3):
        np.testing.assert_allclose(seen[f"{surface.name} viewport {frame}"], live[frame], atol=1e-3)
    assert "stand still" not in said


def test_the_file_is_opened_again_and_wakes_go_on_between_frames(extension, shot, tmp_path):
    ocean, surface = shot
    assert bpy.ops.ocean.bake() == {"FINISHED"}
    before, names = shown(surface, 2), (ocean.name, surface.name)
    bpy.ops.wm.save_mainfile()
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "project" / "shot.blend"))
    ocean, surface = map(bpy.data.objects.get, names)
    np.testing.assert_array_equal(shown(surface, 2), before)
    area, scene = area_of(ocean), bpy.context.scene
    rest = numbers(evaluated_mesh(area), "displacement", 3)
    velocity = numbers(evaluated_mesh(area), "velocity", 3)
    scene.frame_set(2, subframe=0.25)
    later = numbers(evaluated_mesh(area), "displacement", 3)
    np.testing.assert_allclose(later - rest, velocity * 0.25 / 24.0, atol=1e-5)
    assert np.abs(later - rest).max() > 0.005


def test_foam_of_hulls_is_in_the_bake(extension, shot):
    """Without the extension there are no rings of foam around the camera."""
    ocean, surface = shot
    ocean.ocean_tweak.use_foam = True
    assert bpy.ops.ocean.bake() == {"FINISHED"}
    bpy.context.scene.frame_set(2)
    set_inputs = extension("nodes.modifier_inputs").set_inputs
    set_inputs(surface.modifiers[0], {"Foam": None})
    surface.update_tag()
    bpy.context.view_layer.update()
    mesh = evaluated_mesh(surface)
    places, foam = numbers(mesh, "position", 3), numbers(mesh, "foam", 1).ravel()
    astern = (abs(places[:, 1] - 10.0) < 2.0) & (places[:, 0] > -30.0) & (places[:, 0] < -11.0)
    beside = (abs(places[:, 1] + 20.0) < 10.0) & (abs(places[:, 0]) < 20.0)
    assert foam[astern].mean() > 0.2 + foam[beside].mean()


def test_its_layer_muted_differs_and_live_again_it_is_live(extension, shot):
    ocean, surface = shot
    live = shown(surface, 2)
    waves = shown(area_of(ocean), 2, "displacement")
    assert bpy.ops.ocean.bake() == {"FINISHED"}
    wake = next(layer.wake for layer in ocean.ocean_tweak.layers if layer.kind == "WAKE")
    wake.muted = True
    bpy.context.view_layer.update()
    assert "muted" in ocean.ocean_tweak.bake_differs
    # the bake is what is shown
    np.testing.assert_allclose(shown(area_of(ocean), 2, "displacement"), waves, atol=1e-5)
    wake.muted = False
    ocean.ocean_tweak.source = "LIVE"
    np.testing.assert_allclose(shown(surface, 2), live, atol=1e-4)
    assert len(area_of(ocean).data.vertices)


def test_a_camera_that_rests_has_one_place(extension, shot, camera, empty_scene):
    """So that more frames belong to the same bake, and one that moves the places of its frames."""
    ocean, _ = shot
    shots = extension("scene.shots")
    key(camera, {1: (0.0, -20.0, 12.0), 3: (9.0, -20.0, 12.0)})
    moving = shots.bake_shot_of(ocean, empty_scene, (1, 2, 3)).around
    assert moving.first_frame == 1
    assert len(moving.corners) == 3
    gone = np.diff([x for x, _ in moving.corners])
    assert gone.sum() == pytest.approx(9.0, abs=2.0)
    camera.animation_data_clear()
    few, many = (shots.bake_shot_of(ocean, empty_scene, frames) for frames in ((1, 2), (1, 2, 3)))
    assert few == many
    assert len(few.around.corners) == 1


def test_the_next_bake_is_foreseen_with_its_wakes(extension, shot, empty_scene):
    ocean, _ = shot
    versions = extension("scene.bake_versions")
    versions.foresee(ocean, empty_scene)
    told = versions.known(ocean).to_come.bytes
    assert bpy.ops.ocean.bake() == {"FINISHED"}
    versions.look(ocean)
    (version,) = versions.known(ocean).versions
    assert 0.8 * version.bytes < told < 1.3 * version.bytes + 60_000
    job = json.loads((version.folder / "bake.json").read_text())
    assert "wakes" in job["maps"]
    assert len(list(version.folder.glob("*_wakes.*.ply"))) == 3
