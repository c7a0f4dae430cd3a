# SPDX-License-Identifier: GPL-3.0-or-later
"""A shot that version 0.1.0 saved looks as it did there.

`tests/former` has what is read back under other names; here is a whole shot as that release left it, made by
it in Blender 4.5, with the positions that it showed: a live sea of three kinds of waves whose wind is keyed,
under a mask that a keyed object moves; a buoy on it; an ocean of baked images; a preset of the user's.
"""

import shutil
from pathlib import Path

import bpy
import numpy as np
import pytest

from .conftest import sea_of, vertices

RELEASE = Path(__file__).parents[1] / "data" / "0.1.0"
TOLERANCE = 1e-4  # m; two versions of NumPy differ in the last bits of a float32


@pytest.fixture
def shot(package, tmp_path):
    """The file, opened where nothing can write into the kept one."""
    folder = Path(shutil.copytree(RELEASE, tmp_path / "shot"))
    bpy.ops.wm.open_mainfile(filepath=str(folder / "shot.blend"))
    return folder


@pytest.fixture
def shown():
    with np.load(RELEASE / "shown.npz") as data:
        return dict(data)


def assert_looks_as_it_did(shown):
    for frame in (3, 1):
        bpy.context.scene.frame_set(frame)
        for name in ("Live", "Baked"):
            item = bpy.data.objects[name]
            assert item.ocean_tweak.error == ""
            wanted = shown[f"{name}-{frame}"]
            assert np.ptp(wanted[..., 2]) > 0.5
            np.testing.assert_allclose(vertices(item)[::4, ::4], wanted, atol=TOLERANCE)
        buoy = bpy.data.objects["Buoy"].evaluated_get(bpy.context.evaluated_depsgraph_get())
        np.testing.assert_allclose(buoy.matrix_world, shown[f"Buoy-{frame}"], atol=TOLERANCE)


def test_every_frame_is_what_it_was(shot, shown):
    assert_looks_as_it_did(shown)


def test_saved_by_this_version_it_is_the_same_shot(shot, shown):
    bpy.ops.wm.save_mainfile()
    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.ops.wm.open_mainfile(filepath=str(shot / "shot.blend"))
    assert_looks_as_it_did(shown)


def test_its_shot_is_the_one_that_it_wrote(shot, extension):
    scene = bpy.context.scene
    live = bpy.data.objects["Live"]
    wanted = extension("export.sea_files").read_sea(RELEASE / "sea.json")
    found = extension("scene.shots").shot_of(live, scene, range(1, 4))
    assert found.to_dict() == wanted.to_dict()


def test_its_bake_is_complete_and_stays(shot):
    """Baking again finds every frame, and writes none."""
    bpy.context.view_layer.objects.active = bpy.data.objects["Baked"]
    images = {path: path.stat().st_mtime_ns for path in shot.glob("cache/*/*/*.exr")}
    assert len(images) == 3 * 5
    assert bpy.ops.ocean.bake() == {"FINISHED"}
    assert {path: path.stat().st_mtime_ns for path in shot.glob("cache/*/*/*.exr")} == images


def test_its_preset_is_one(shot, extension, monkeypatch):
    module = extension("scene.user_presets")
    monkeypatch.setattr(module, "user_folder", lambda _name: shot / "presets")
    (key,) = module.own_presets()
    live = bpy.data.objects["Live"]
    before = sea_of(live)
    live.ocean_tweak.layers[2].hero_wave.crest_height = 0.1
    bpy.context.view_layer.objects.active = live
    assert bpy.ops.ocean.apply_preset(key=key) == {"FINISHED"}
    assert sea_of(live).layers == before.layers
    assert live.ocean_tweak.preset == "Rocky Bay"
