# SPDX-License-Identifier: GPL-3.0-or-later
"""Paths in a .blend file: a project is moved, copied, linked and opened elsewhere, and shows its bake."""

import ntpath
import os
import shutil
from pathlib import Path
from types import SimpleNamespace

import bpy
import numpy as np
import pytest

from .other_blender import look

TOLERANCE = 2e-3  # m; images keep 2⁻¹⁶ of their values


@pytest.fixture
def paths(extension):
    return extension("scene.stored_paths")


@pytest.fixture
def desk(empty_scene, tmp_path, monkeypatch):
    """The folder of a saved file with two frames."""
    monkeypatch.delenv("OCEAN_TWEAK_CACHE", raising=False)
    folder = tmp_path / "desk"
    folder.mkdir()
    empty_scene.frame_start, empty_scene.frame_end = 1, 2
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "shot.blend"))
    return folder


def add_and_bake(ocean_object, parameters, method="NODES"):
    item = ocean_object.add(bpy.context.scene, parameters, method, name=method.title())
    item.ocean_tweak.use_foam = item.ocean_tweak.use_velocity = item.ocean_tweak.use_normals = False
    bpy.context.view_layer.objects.active = item
    assert bpy.ops.ocean.bake() == {"FINISHED"}
    return item


def test_a_moved_copied_or_linked_project_shows_its_bake(
    desk, ocean_object, make_parameters, expected, tmp_path
):
    for method in ("NODES", "DISPLACE"):
        add_and_bake(ocean_object, make_parameters(), method)
    bpy.ops.wm.save_mainfile()
    bpy.ops.wm.read_homefile(use_empty=True)
    copy, moved, link = tmp_path / "a" / "b" / "copy", tmp_path / "farm", tmp_path / "link"
    shutil.copytree(desk, copy)
    desk.rename(moved)
    link.symlink_to(copy, target_is_directory=True)
    heights = expected(make_parameters(), 2)[..., 2].ravel()
    for place in (moved, link):
        seen, _ = look(place / "shot.blend", ["Nodes", "Displace"], [2], tmp_path)
        for name in ("Nodes viewport 2", "Nodes render 2", "Displace viewport 2", "Displace render 2"):
            np.testing.assert_allclose(seen[name][:, 2], heights, atol=TOLERANCE, err_msg=f"{place} {name}")


@pytest.mark.parametrize(
    ("typed", "kept"),
    [
        ("//water\\cache\\", "//water/cache"),
        ("//..\\cache", "//../cache"),
        ("{desk}/water/", "//water"),
        ("{desk}/../desk/water", "//water"),
        ("{desk}/..", "//.."),
        ("water", "//water"),
        ("//", "//"),
        ("~/water", "~/water"),
    ],
)
def test_a_path_is_kept_relative_to_the_file(desk, ocean_object, make_parameters, process, typed, kept):
    settings = ocean_object.add(bpy.context.scene, make_parameters()).ocean_tweak
    settings.cache_folder = settings.usd.file = typed.format(desk=desk)
    assert settings.cache_folder == settings.usd.file == kept
    place = Path(os.path.normpath(kept.replace("//", f"{desk}/").replace("~", str(Path.home()))))
    assert process.usd_file(settings.id_data) == place


@pytest.fixture
def process(extension):
    return extension("scene.usd")


@pytest.mark.skipif(os.name == "nt", reason="there it is a path like others")
@pytest.mark.parametrize("typed", ["D:\\water", "d:/water", "\\\\server\\share\\water"])
def test_drives_and_servers_of_windows_are_refused_in_words(
    desk, ocean_object, make_parameters, process, typed
):
    item = ocean_object.add(bpy.context.scene, make_parameters())
    bpy.context.view_layer.objects.active = item
    item.ocean_tweak.cache_folder = item.ocean_tweak.usd.file = typed
    assert item.ocean_tweak.cache_folder == typed
    said = r"is a Windows path.*choose it again"
    with pytest.raises(RuntimeError, match=said):
        bpy.ops.ocean.bake()
    with pytest.raises(ValueError, match=said):
        process.usd_file(item)
    assert [path.name for path in desk.iterdir()] == ["shot.blend"]


def test_on_windows_drives_part_and_backslashes_join(paths, monkeypatch):
    """As Windows itself reckons."""
    monkeypatch.setattr(
        paths, "os", SimpleNamespace(name="nt", path=ntpath, curdir=".", pardir="..", sep="\\")
    )
    monkeypatch.setattr(paths, "is_foreign", lambda path: False)
    shots = r"D:\work\shots"
    assert paths.relative(r"D:\work\water\cache", shots) == "//../water/cache"
    assert paths.relative(r"d:\WORK\shots\cache", shots) == "//cache"
    assert paths.relative(r"E:\cache", shots) == r"E:\cache"
    assert paths.relative(r"\\server\share\cache", shots) == r"\\server\share\cache"
    assert paths.relative(r"\\server\share\a\cache", r"\\server\share\a") == "//cache"
    assert paths.relative("//..\\water", shots) == "//../water"


def test_a_link_is_not_replaced_by_what_it_leads_to(desk, ocean_object, make_parameters, tmp_path):
    """Neither that of the project's folder nor one inside of it; and both names of a folder are one."""
    link, disk = tmp_path / "link", tmp_path / "disk"
    link.symlink_to(desk, target_is_directory=True)
    disk.mkdir()
    (desk / "cache").symlink_to(disk, target_is_directory=True)
    bpy.ops.wm.open_mainfile(filepath=str(link / "shot.blend"))
    item = add_and_bake(ocean_object, make_parameters())
    assert item.ocean_tweak.sequence_maps.disp.filepath.startswith("//cache/")
    assert list(disk.glob("*/v*/bake.json"))
    item.ocean_tweak.cache_folder = str(desk / "water")
    assert item.ocean_tweak.cache_folder == "//water"


def kept_paths(item):
    settings = item.ocean_tweak
    texts = settings.cache_folder, settings.usd.file, settings.sequence_maps.disp.filepath
    return [os.path.normpath(bpy.path.abspath(text)) for text in texts]


def test_the_first_save_makes_paths_relative(
    empty_scene, ocean_object, make_parameters, bake, tmp_path, monkeypatch
):
    empty_scene.frame_start, empty_scene.frame_end = 1, 2
    item = ocean_object.add(
        empty_scene, make_parameters(), source="SEQUENCE", sequence=bake(make_parameters(), 1, 2)
    )
    settings = item.ocean_tweak
    settings.cache_folder, settings.usd.file = str(tmp_path / "water"), str(tmp_path / "sea.usd")
    before = kept_paths(item)
    assert settings.cache_folder == before[0]
    file = str(tmp_path / "shot.blend")
    bpy.ops.wm.save_as_mainfile(filepath=file, relative_remap=False)
    bpy.ops.wm.open_mainfile(filepath=file)
    settings = bpy.data.objects["Ocean"].ocean_tweak
    assert (settings.cache_folder, settings.usd.file) == ("//water", "//sea.usd")
    assert settings.sequence_maps.disp.filepath == "//frames/sea_disp.0001.exr"


@pytest.fixture
def item(desk, ocean_object, make_parameters):
    item = add_and_bake(ocean_object, make_parameters())
    item.ocean_tweak.cache_folder, item.ocean_tweak.usd.file = "//water", "//..\\usd\\sea.usd"
    # what somebody set while the file had its place
    item.ocean_tweak.sequence_maps.disp.filepath = kept_paths(item)[2]
    return item


def test_saved_elsewhere_all_paths_lead_where_they_led(item, tmp_path):
    before, name = kept_paths(item), item.name
    other = tmp_path / "deep" / "er" / "shot.blend"
    other.parent.mkdir(parents=True)
    bpy.ops.wm.save_as_mainfile(filepath=str(other))
    for _ in range(2):
        settings = bpy.data.objects[name].ocean_tweak
        assert settings.cache_folder == "//../../desk/water"
        assert settings.sequence_maps.disp.filepath.startswith("//../../desk/cache/")
        assert kept_paths(settings.id_data) == before
        bpy.ops.wm.open_mainfile(filepath=str(other))


def test_a_copy_elsewhere_leaves_the_open_file_as_it_is(item, desk, tmp_path):
    bpy.ops.wm.save_mainfile()
    before, texts = kept_paths(item), item.ocean_tweak.cache_folder
    name, other = item.name, tmp_path / "copy.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(other), copy=True)
    assert (item.ocean_tweak.cache_folder, kept_paths(item)) == (texts, before)
    assert Path(bpy.data.filepath).parent == desk
    bpy.ops.wm.open_mainfile(filepath=str(other))
    assert kept_paths(bpy.data.objects[name]) == before
    assert bpy.data.objects[name].ocean_tweak.cache_folder == "//desk/water"


def test_what_could_not_be_saved_has_its_paths_back(item, tmp_path):
    before = kept_paths(item)
    with pytest.raises(RuntimeError):
        bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "nowhere" / "shot.blend"))
    assert kept_paths(item) == before
    assert item.ocean_tweak.cache_folder == "//water"


@pytest.mark.parametrize("is_saved", [True, False])
def test_appended_paths_lead_where_they_led(item, desk, tmp_path, is_saved):
    bpy.ops.wm.save_mainfile()
    before, name = kept_paths(item), item.name
    bpy.ops.wm.read_homefile(use_empty=True)
    if is_saved:
        (tmp_path / "deep" / "er").mkdir(parents=True)
        bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "deep" / "er" / "shot.blend"))
    with bpy.data.libraries.load(str(desk / "shot.blend")) as (_, wanted):
        wanted.objects = [name]
    (appended,) = wanted.objects
    assert kept_paths(appended) == before
    assert appended.ocean_tweak.cache_folder == ("//../../desk/water" if is_saved else str(desk / "water"))


def moved_elsewhere(desk):
    bpy.ops.wm.read_homefile(use_empty=True)
    farm = desk.parent / "far" / "away"
    farm.parent.mkdir()
    desk.rename(farm)
    bpy.ops.wm.open_mainfile(filepath=str(farm / "shot.blend"))
    bpy.context.scene.frame_set(2)
    return bpy.data.objects["Nodes"]


def test_a_bake_that_came_along_is_found_in_the_cache(
    item, extension, desk, expected, evaluated, make_parameters
):
    """An older file, whose images have the path of another place."""
    item.ocean_tweak.cache_folder = "//cache"
    with extension("scene.handlers").asleep():
        bpy.ops.wm.save_mainfile()
    assert Path(item.ocean_tweak.sequence_maps.disp.filepath).is_absolute()
    shown = evaluated(moved_elsewhere(desk))
    np.testing.assert_allclose(shown, expected(make_parameters(), 2), atol=TOLERANCE)


def test_a_bake_in_the_environments_cache_is_found_from_elsewhere(
    desk, ocean_object, expected, evaluated, make_parameters, tmp_path, monkeypatch
):
    monkeypatch.setenv("OCEAN_TWEAK_CACHE", str(tmp_path / "water"))
    add_and_bake(ocean_object, make_parameters())
    bpy.ops.wm.save_mainfile()
    assert list((tmp_path / "water").glob("*/v*/bake.json"))
    shown = evaluated(moved_elsewhere(desk))
    np.testing.assert_allclose(shown, expected(make_parameters(), 2), atol=TOLERANCE)
