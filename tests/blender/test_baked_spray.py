# SPDX-License-Identifier: GPL-3.0-or-later
"""Spray of an ocean that bakes make and nodes read: the points of the files, and what is said of files."""

import importlib
from types import SimpleNamespace

import bpy
import numpy as np
import pytest

from ocean_tweak.core import Ocean, Spray
from ocean_tweak.core.sea.spray import TileSpray

from .spray_points import SEA, made, points, spray_of


@pytest.fixture
def ocean(extension, empty_scene):
    return extension("scene.ocean_object").add(empty_scene, SEA)


@pytest.fixture
def baked(extension, ocean, empty_scene, tmp_path):
    """The ocean with frames 12 to 14 baked, of which 13 has no spray."""
    bake = importlib.import_module("ocean_tweak.cli").main
    sea = tmp_path / "sea.json"
    sea.write_text(ocean.ocean_tweak.to_parameters(empty_scene).to_json(), encoding="utf-8")
    assert bake(["bake", "--params", str(sea), "--frames", "12-14", "--out", str(tmp_path), "--spray"]) == 0
    (displacement,) = tmp_path.glob("*/*/*_disp.0012.exr")
    (displacement.parent / "spray" / "sea_spray.0013.ply").unlink()
    object_module = extension("scene.ocean_object")
    sequence = extension("scene.image_sequence").find_sequence(displacement)
    object_module.use_sequence(ocean, empty_scene, sequence)
    return ocean


def test_baked_points_are_those_of_the_files(baked, empty_scene, caplog):
    item = spray_of(baked)
    assert not item.is_runtime_data
    assert len(item.data.vertices) == 0
    for frame in (12, 14):
        empty_scene.frame_set(frame)
        expected = TileSpray(Ocean(SEA)).at((frame - 1) / 24.0, Spray())
        shown = expected.id % 2**24 <= 2**24 / 8  # in a window
        found = points(item)
        np.testing.assert_allclose(found["position"], expected.position[shown], atol=1e-4)
        np.testing.assert_allclose(found["velocity"], expected.velocity[shown], atol=1e-4)
        np.testing.assert_allclose(found["radius"], expected.radius[shown] * 8**0.5, rtol=1e-5)
    assert "spray" not in caplog.text


def test_a_frame_without_a_file_is_told_and_shows_the_one_before(baked, empty_scene, caplog):
    empty_scene.frame_set(12)
    before = points(spray_of(baked))["position"]
    empty_scene.frame_set(13)
    assert "spray.0013.ply is missing, and the spray of frame 12 is shown" in caplog.text
    np.testing.assert_array_equal(points(spray_of(baked))["position"], before)
    assert not baked.ocean_tweak.error


def test_baked_spray_is_kept_in_the_file_and_needs_no_extension(extension, baked, empty_scene, tmp_path):
    path = tmp_path / "shot.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    with extension("scene.handlers").asleep():
        bpy.ops.wm.open_mainfile(filepath=str(path))
        item = next(item for item in bpy.data.objects if item.name.endswith("Spray"))
        bpy.context.scene.frame_set(14)
        assert len(points(item)["radius"]) > 100


def test_files_are_looked_at_when_they_change_and_not_a_frame(extension, baked, empty_scene, monkeypatch):
    module, looks = extension("scene.baked_spray"), []
    whole = module.told_by_ply
    monkeypatch.setattr(module, "told_by_ply", lambda *given: looks.append(given) or whole(*given))
    for frame in (12, 14, 12):
        empty_scene.frame_set(frame)
    assert looks == []
    (folder,) = extension("scene.patch_points").files_of(baked.ocean_tweak)[2].glob("spray")
    for path in folder.iterdir():
        path.unlink()
    empty_scene.frame_set(14)
    assert extension("scene.spray").is_live(baked)
    assert len(points(spray_of(baked))["radius"]) > 100


def test_frames_of_spray_are_counted_by_themselves(extension, ocean, empty_scene, tmp_path, monkeypatch):
    module, counts = extension("scene.bake_process"), []
    whole = module.BakeProcess.take

    def take(self, said):
        whole(self, said)
        counts.append((self.phase, self.done, self.left))

    monkeypatch.setattr(module.BakeProcess, "take", take)
    ocean.ocean_tweak.cache_folder = str(tmp_path)
    shot = extension("scene.shots").shot_of(ocean, empty_scene, (12, 13))
    bake = module.start(ocean, shot, (12, 13))
    bake.wait()
    module.forget(bake)
    assert bake.is_complete, bake.error
    assert len(list(bake.folder.glob("spray/*.ply"))) == 2
    extension("scene.bake_versions").delete(ocean)  # with its spray
    assert not bake.folder.exists()
    each = [(0, 2), (1, 2), (2, 2)]
    assert list(dict.fromkeys(counts)) == [("", *count) for count in each] + [
        ("spray", *count) for count in each
    ]


def test_a_bake_without_the_spray_that_is_on_needs_the_extension(extension, baked, empty_scene):
    needs_of, spray = extension("scene.portability").needs_of, extension("scene.spray")
    assert needs_of(baked) == ()
    (folder,) = extension("scene.patch_points").files_of(baked.ocean_tweak)[2].glob("spray")
    for path in folder.glob("*.ply"):
        path.unlink()
    empty_scene.frame_set(14)
    assert spray.is_live(baked)
    (need,) = needs_of(baked)
    assert need.text == "Ocean has spray, which its bake has not: bake it again"
    baked.ocean_tweak.use_spray = False
    assert needs_of(baked) == ()


@pytest.mark.parametrize(("name", "value"), [("amount", 2.0), ("life", 1.0)])
def test_spray_of_an_older_bake_is_told_and_shown(baked, empty_scene, caplog, name, value):
    empty_scene.frame_set(14)
    before = points(spray_of(baked))
    setattr(baked.ocean_tweak.spray, name, value)
    was = getattr(Spray(), name)
    assert f"its spray was baked with a {name} of {was:g}, and the settings have {value:g}" in caplog.text
    for key, values in points(spray_of(baked)).items():
        np.testing.assert_array_equal(values, before[key])
    assert not baked.ocean_tweak.error


def test_spray_of_another_version_is_told_and_shown(extension, baked, empty_scene, monkeypatch, caplog):
    monkeypatch.setattr(extension("core.data.formats"), "SPRAY", 99)
    extension("scene.baked_spray")._baked_in.cache_clear()
    empty_scene.frame_set(14)
    assert "its spray was baked by another version" in caplog.text
    assert len(points(spray_of(baked))["radius"]) > 10


def test_the_farm_s_render_reads_spray_where_the_bake_is_now(extension, baked, tmp_path):
    script, modifier = extension("export.farm.render_baked"), spray_of(baked).modifiers[0]
    folder = tmp_path / "farm"
    (tmp_path / "farm/spray").mkdir(parents=True)
    here = SimpleNamespace(name="sea", folder=folder)
    with pytest.raises(script.RenderError, match=r"sea_spray\.0012\.ply is missing: Ocean Spray reads spray"):
        script.show_points(modifier, here, [12])
    (folder / "spray/sea_spray.0012.ply").touch()
    assert script.show_points(modifier, here, [12])
    files = extension("nodes.modifier_inputs").get_input(modifier, "Files")
    assert files == str(folder / "spray/sea_spray.")
    assert not script.show_points(modifier, SimpleNamespace(name="other", folder=folder), [12])


def test_usd_of_the_panel_has_it(extension, ocean, empty_scene, monkeypatch):
    module, told = extension("scene.usd"), []
    monkeypatch.setattr(module.CommandProcess, "__init__", lambda _, name, words, *__: told.append(words))
    shot = extension("scene.shots").shot_of(ocean, empty_scene, (1,))
    ocean.ocean_tweak.spray.amount = 0.5
    for bake in (None, "folder"):
        monkeypatch.setattr(module, "used_bake", lambda _, given=bake: given)
        for is_on in (True, False):
            ocean.ocean_tweak.use_spray = is_on
            module.UsdExport(ocean, shot, (1,))
            words = told.pop()
            assert ("--spray" in words) is is_on
            assert ("--set=spray.amount=0.5" in words) is (is_on and bake is not None)


@pytest.mark.parametrize("subframe", [0.25, -0.4])
def test_baked_points_go_on_by_their_velocity_between_frames(baked, empty_scene, subframe):
    """As both engines look at them for motion blur: EEVEE at other frames, where it pairs points by order."""
    empty_scene.frame_set(14)
    whole = points(spray_of(baked))
    empty_scene.frame_set(14 if subframe > 0.0 else 13, subframe=subframe % 1.0)
    between = points(spray_of(baked))
    moved = whole["position"] + whole["velocity"] * subframe / 24.0
    assert np.linalg.norm(moved - whole["position"], axis=1).max() > 0.05
    np.testing.assert_allclose(between["position"], moved, atol=1e-4)
    np.testing.assert_array_equal(between["velocity"], whole["velocity"])


def test_the_next_bake_is_foreseen_with_its_spray(extension, ocean, empty_scene, tmp_path):
    module, bytes_of = extension("scene.bake_versions"), {}
    ocean.ocean_tweak.cache_folder = str(tmp_path)
    empty_scene.frame_start, empty_scene.frame_end = 12, 13
    for is_on in (True, False):
        ocean.ocean_tweak.use_spray = is_on
        module.foresee(ocean, empty_scene)
        bytes_of[is_on] = module.known(ocean).to_come.bytes
    in_the_air = np.mean([len(made((frame - 1) / 24.0).age) for frame in (12, 13)])
    assert bytes_of[True] - bytes_of[False] == pytest.approx(2 * 40 * in_the_air, rel=0.5)  # gusts vary
