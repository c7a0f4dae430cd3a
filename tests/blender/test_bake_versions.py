# SPDX-License-Identifier: GPL-3.0-or-later
"""Bakes of an ocean in a window: their sizes, the old ones deleted, images of old ones gone."""

import shutil

import bpy
import pytest

from .layouts import draw  # noqa: F401 - a fixture

UID = "0123abcd"


@pytest.fixture(scope="module")
def baked(extension, tmp_path_factory):
    """A cache with three bakes of a small sea, two frames each. Not to be changed."""
    cache = tmp_path_factory.mktemp("baked")
    for seed in (1, 2, 3):
        arguments = ["--set", "resolution=32", "--set", "domain_size=150", "--set", f"seed={seed}"]
        arguments += ["--frames", "1-2", "--maps", "disp,vel", "--workers", "1", "--name", "Ocean"]
        assert extension("cli").main(["bake", *arguments, "--uid", UID, "--out", str(cache)]) == 0
    return cache


@pytest.fixture
def versions(ocean, empty_scene, baked, tmp_path):
    """Folders of the three bakes in a cache of the ocean's own; the last one is shown."""
    empty_scene.frame_start, empty_scene.frame_end = 1, 2
    shutil.copytree(baked, tmp_path / "cache")
    ocean.ocean_tweak.cache_folder, ocean.ocean_tweak.uid = str(tmp_path / "cache"), UID
    folders = sorted(tmp_path.glob("cache/*/v*"))
    for folder in folders:
        assert bpy.ops.ocean.use_sequence(filepath=str(folder)) == {"FINISHED"}
    return folders


def size(folder):
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())


def sequences():
    return [image for image in bpy.data.images if image.source == "SEQUENCE"]


def test_what_is_on_disk_is_listed_and_the_next_bake_foreseen(versions, ocean, extension, draw):  # noqa: F811
    assert "ocean.delete_bake" not in draw(ocean)
    assert bpy.ops.ocean.look_at_bakes() == {"FINISHED"}
    listing = extension("scene.bake_versions").known(ocean)
    assert [version.folder for version in listing.versions] == versions
    assert [version.frames for version in listing.versions] == [2, 2, 2]
    assert [version.bytes for version in listing.versions] == list(map(size, versions))
    drawn = " ".join(draw(ocean))
    assert all(f"{folder.name[:4]}  {size(folder) / 1000:.3g} kB" in drawn for folder in versions)
    assert drawn.count("ocean.delete_bake") == 3  # two old ones, and both together
    assert "To Come about " in drawn
    assert " free" in drawn
    ocean.ocean_tweak.seed = 9
    assert "To Come" not in " ".join(draw(ocean))


def test_it_is_listed_when_a_bake_has_ended(versions, ocean, extension):
    ocean.ocean_tweak.seed = 9
    assert bpy.ops.ocean.bake() == {"FINISHED"}
    assert len(extension("scene.bake_versions").known(ocean).versions) == 4
    assert {"v004" in image.filepath for image in sequences()} == {True}


def test_images_of_bakes_that_nobody_shows_go(versions, ocean):
    names = {image.filepath for image in sequences()}
    assert {str(versions[2]) in name for name in names} == {True}


def test_images_that_somebody_else_reads_stay(versions, ocean):
    kept = ocean.ocean_tweak.sequence_maps.disp
    texture = bpy.data.textures.new("other", "IMAGE")
    texture.image = kept
    bpy.ops.ocean.use_sequence(filepath=str(versions[0]))
    assert kept in sequences()
    assert ocean.ocean_tweak.sequence_maps.disp != kept
    assert {str(versions[1]) in image.filepath for image in sequences()} == {False}


def test_an_old_version_is_deleted_and_the_shown_one_is_not(versions, ocean):
    assert bpy.ops.ocean.delete_bake("EXEC_DEFAULT", version=versions[0].name) == {"FINISHED"}
    assert [folder.exists() for folder in versions] == [False, True, True]
    with pytest.raises(RuntimeError, match=f"Ocean shows {versions[2].name}"):
        bpy.ops.ocean.delete_bake("EXEC_DEFAULT", version=versions[2].name)
    bpy.ops.ocean.delete_bake("EXEC_DEFAULT")
    assert [folder.exists() for folder in versions] == [False, False, True]
    assert ocean.ocean_tweak.sequence_maps.disp is not None


@pytest.mark.parametrize("name", ["../../..", "v001", "", ".."])
def test_only_versions_of_this_sea_are_deleted(versions, ocean, tmp_path, name):
    other = tmp_path / "cache" / "Another-12345678" / versions[0].name
    other.parent.mkdir()
    versions[0].rename(other)
    private = versions[1] / "private.txt"
    private.write_text("mine")
    if name:
        with pytest.raises(RuntimeError, match="has no bake"):
            bpy.ops.ocean.delete_bake("EXEC_DEFAULT", version=name)
        assert versions[1].exists()
    else:  # all that are not shown
        with pytest.raises(RuntimeError, match=r"left: private\.txt"):
            bpy.ops.ocean.delete_bake("EXEC_DEFAULT")
        assert {path.name for path in versions[1].iterdir() if path.is_file()} == {"bake.json", "private.txt"}
    assert other.exists()
    assert private.read_text() == "mine"


def test_a_version_that_another_ocean_shows_stays(versions, ocean, empty_scene):
    reader = ocean.copy()
    empty_scene.collection.objects.link(reader)
    reader.name = "Reader"
    bpy.ops.ocean.use_sequence(filepath=str(versions[0]))
    with pytest.raises(RuntimeError, match=f"Reader shows {versions[2].name}"):
        bpy.ops.ocean.delete_bake("EXEC_DEFAULT", version=versions[2].name)
    bpy.ops.ocean.delete_bake("EXEC_DEFAULT")
    assert [folder.exists() for folder in versions] == [True, False, True]


def test_a_version_that_is_being_baked_stays(versions, ocean, extension):
    locks = extension("export.cache.locks")
    with (
        locks.claimed(versions[0], (1, 2)),
        pytest.raises(RuntimeError, match=r"frame"),
    ):
        bpy.ops.ocean.delete_bake("EXEC_DEFAULT", version=versions[0].name)
    assert size(versions[0]) > 1000


def test_a_link_is_no_bake_of_the_oceans(versions, tmp_path, extension, ocean):
    """It may lead to a bake of somebody else, which is not deleted by way of it."""
    elsewhere = versions[0].rename(tmp_path / versions[0].name)
    versions[0].symlink_to(elsewhere)
    assert bpy.ops.ocean.look_at_bakes() == {"FINISHED"}
    listed = extension("scene.bake_versions").known(ocean).versions
    assert [version.folder for version in listed] == versions[1:]
    with pytest.raises(RuntimeError, match="has no bake"):
        bpy.ops.ocean.delete_bake(version=versions[0].name)
    assert bpy.ops.ocean.delete_bake() == {"FINISHED"}
    assert not versions[1].exists()
    assert len(list(elsewhere.glob("*.exr"))) == 4
