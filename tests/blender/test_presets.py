# SPDX-License-Identifier: GPL-3.0-or-later
"""Presets in Blender: taken, kept, renamed, deleted, imported and exported; a bad file changes nothing."""

import json
import random

import bpy
import pytest

from .conftest import sea_of


@pytest.fixture
def ocean(ocean_object, make_parameters, empty_scene):
    item = ocean_object.add(empty_scene, make_parameters(start_frame=101), viewport_resolution=32)
    bpy.context.view_layer.objects.active = item
    return item


@pytest.fixture
def own_folder(extension, tmp_path, monkeypatch):
    """The user's presets lie in an empty folder."""
    module = extension("scene.user_presets")
    monkeypatch.setattr(module, "user_folder", lambda _name: tmp_path)
    return tmp_path


def test_a_preset_is_the_sea_and_the_shot_keeps_its_timing(ocean, extension):
    assert bpy.ops.ocean.apply_preset(key="beaufort_05") == {"FINISHED"}
    preset = extension("core.parameters.presets").built_in()["beaufort_05"].parameters
    assert sea_of(ocean).layers[0].wind_speed == 9.4
    assert sea_of(ocean).timing.start_frame == 101
    assert sea_of(ocean).replace(timing=preset.timing) == preset


def test_a_preset_brings_its_layers(ocean, extension):
    presets = extension("core.parameters.presets").built_in()
    for key in ("crossing_seas", "beaufort_01"):
        assert bpy.ops.ocean.apply_preset(key=key) == {"FINISHED"}
        assert not ocean.ocean_tweak.error
        assert sea_of(ocean).layers == presets[key].parameters.layers


def test_undo_takes_a_preset_back(ocean, window):
    before = sea_of(ocean)
    name = ocean.name
    with window.override():
        bpy.ops.ed.undo_push(message="before")
        bpy.ops.ocean.apply_preset(key="harbour")
        assert sea_of(bpy.data.objects[name]) != before
        bpy.ops.ed.undo_push(message="applied")
        bpy.ops.ed.undo()
    assert sea_of(bpy.data.objects[name]) == before


def test_a_life_of_an_own_preset(ocean, own_folder, extension, tmp_path_factory):
    presets = extension("scene.user_presets")
    assert bpy.ops.ocean.save_preset(title="Bay at Dawn", text="Calm") == {"FINISHED"}
    assert [file.name for file in own_folder.iterdir()] == ["bay_at_dawn.json"]
    mine = sea_of(ocean)
    with pytest.raises(RuntimeError, match="another preset already"):
        bpy.ops.ocean.save_preset(title="Bay at Dawn")
    bpy.ops.ocean.apply_preset(key="harbour")
    assert bpy.ops.ocean.apply_preset(key="user:bay_at_dawn") == {"FINISHED"}
    assert sea_of(ocean) == mine

    assert bpy.ops.ocean.rename_preset(key="user:bay_at_dawn", title="Dusk é 2") == {"FINISHED"}
    (key,) = presets.own_presets()
    assert presets.own_presets()[key].title == "Dusk é 2"
    assert presets.own_presets()[key].description == "Calm"

    exported = tmp_path_factory.mktemp("out") / "dusk.json"
    assert bpy.ops.ocean.export_preset(filepath=str(exported), key=key) == {"FINISHED"}
    assert bpy.ops.ocean.delete_preset(key=key) == {"FINISHED"}
    assert not presets.own_presets()
    assert bpy.ops.ocean.import_preset(filepath=str(exported)) == {"FINISHED"}
    assert bpy.ops.ocean.apply_preset(key=key) == {"FINISHED"}
    assert sea_of(ocean) == mine


def test_presets_are_read_once_and_anew_after_a_change(ocean, own_folder, extension, monkeypatch):
    presets, read = extension("scene.user_presets"), []
    wanted = presets.read_preset
    monkeypatch.setattr(presets, "read_preset", lambda path: read.append(path.name) or wanted(path))
    bpy.ops.ocean.save_preset(title="Bay")
    for _ in range(3):
        assert list(presets.own_presets()) == ["user:bay"]
    assert read == ["bay.json"]
    text = (own_folder / "bay.json").read_text()
    (own_folder / "cove.json").write_text(text.replace("Bay", "Cove"))  # by another Blender
    assert [preset.title for preset in presets.own_presets().values()] == ["Bay", "Cove"]


@pytest.mark.parametrize("operator", ["rename_preset", "delete_preset"])
def test_presets_that_came_along_stay(own_folder, operator, empty_scene):
    with pytest.raises(RuntimeError, match="no preset of your own"):
        getattr(bpy.ops.ocean, operator)(key="gale")


def test_a_file_that_is_no_preset_is_left_out(own_folder, extension):
    (own_folder / "broken.json").write_text("{")
    (own_folder / "binary.json").write_bytes(b"\xff\xfe\x00")
    (own_folder / "large.json").write_text(" " * 300_000)
    assert extension("scene.user_presets").own_presets() == {}


def test_mutated_presets_never_half_apply(ocean, own_folder, extension, tmp_path_factory):
    """A file is read or refused; where it is refused, neither the folder nor the ocean changes."""
    chance = random.Random(11)
    texts = [preset.to_json() for preset in extension("core.parameters.presets").built_in().values()]
    file = tmp_path_factory.mktemp("in") / "mutated.json"
    before = sea_of(ocean)
    refused = 0
    for number in range(60):
        data = bytearray(chance.choice(texts).encode())
        if chance.random() < 0.5:  # digits alone: it may still be a sea
            places = [place for place, byte in enumerate(data) if chr(byte) in "3456789"]
            data[chance.choice(places)] = chance.choice(b"3456789")
        else:
            data[chance.randrange(len(data))] = chance.choice(b'0123456789 .-{"x\xff')
        file.write_bytes(data)
        count = len(list(own_folder.iterdir()))
        try:
            bpy.ops.ocean.import_preset(filepath=str(file), replace=True)
        except RuntimeError:
            refused += 1
            assert len(list(own_folder.iterdir())) == count, number
        assert sea_of(ocean) == before
    assert 20 < refused < 58
    for kept in own_folder.iterdir():
        json.loads(kept.read_text(encoding="utf-8"))
