# SPDX-License-Identifier: GPL-3.0-or-later
"""The asset library: written, listed, read again, taken out."""

import math

import bpy
import numpy as np
import pytest

NAMES = {"Ocean Tweak", "Ocean Sample", "Float on Ocean", "Ocean Tweak Water", "Ocean Tweak Wet Band"}


@pytest.fixture
def library(extension, empty_scene, tmp_path, monkeypatch):
    module = extension("scene.asset_library")
    monkeypatch.setattr(module, "user_folder", lambda _name: tmp_path)
    yield module
    module.remove()


def test_assets_are_written_and_listed(library, tmp_path):
    before = {*bpy.data.node_groups.keys(), *bpy.data.materials.keys()}
    assert bpy.ops.ocean.install_assets() == {"FINISHED"}
    assert {*bpy.data.node_groups.keys(), *bpy.data.materials.keys()} == before
    assert library.is_installed()
    with bpy.data.libraries.load(str(tmp_path / "ocean_tweak.blend"), assets_only=True) as (found, taken):
        assert set(found.node_groups) == NAMES
        assert len(found.materials) >= 2
        taken.node_groups = list(NAMES)
        taken.materials = list(found.materials)
    lines = (tmp_path / "blender_assets.cats.txt").read_text(encoding="utf-8").splitlines()
    catalogues = {line.partition(":")[0] for line in lines if line and line[0] != "#" and ":" in line}
    assert "VERSION 1" in lines
    pictures = set()
    for block in (*taken.node_groups, *taken.materials):
        assert block.asset_data.description
        assert block.asset_data.catalog_id in catalogues
        pixels = np.empty(4 * math.prod(block.preview.image_size), np.float32)
        block.preview.image_pixels_float.foreach_get(pixels)
        assert len(pixels) > 4 * 128**2
        pictures.add(pixels.tobytes())
    # the groups of the ocean and of its material have one picture
    assert len(pictures) == len(taken.node_groups) + len(taken.materials) - 1


def test_what_the_file_has_stays_as_it_is(library, ocean_object, make_parameters, empty_scene):
    item = ocean_object.add(empty_scene, make_parameters())
    group = item.modifiers[0].node_group
    bpy.ops.ocean.install_assets()
    bpy.ops.ocean.install_assets()
    assert item.modifiers[0].node_group == group
    assert group.asset_data is None
    listed = [one.name for one in bpy.context.preferences.filepaths.asset_libraries]
    assert listed.count("Ocean Tweak") == 1


def test_a_folder_that_cannot_be_written_is_said(library, tmp_path, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setattr(library, "user_folder", lambda _name: tmp_path / "file")
    with pytest.raises(RuntimeError, match="file"):
        bpy.ops.ocean.install_assets()
    assert not library.is_installed()


def test_disabling_takes_the_library_out(library, extension):
    bpy.ops.ocean.install_assets()
    registration = extension("registration")
    registration.unregister()
    try:
        assert not library.is_installed()
    finally:
        registration.register("bl_ext.test")
