# SPDX-License-Identifier: GPL-3.0-or-later
"""Presets in Blender: taken, kept, renamed, deleted, imported and exported; a bad file changes nothing."""

import json
import random

import bpy
import numpy as np
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


def test_the_harbour_has_a_breakwater_that_leaves_a_fifth_of_the_waves(ocean, core, empty_scene):
    """Its lines are drawn, and beside them the sea is lower than far away."""
    assert bpy.ops.ocean.apply_preset(key="harbour") == {"FINISHED"}
    assert not ocean.ocean_tweak.error
    mask = ocean.ocean_tweak.mask
    assert (mask.source, mask.measured_from, mask.object) == ("DISTANCE", "SHAPE", None)
    sea = sea_of(ocean)
    assert sea.mask.lines.values.size == 2 * 4
    heights = np.stack(
        [core.Ocean(sea).surface(time).displacement[..., 2] for time in np.arange(0.0, 60.0, 3.0)]
    )
    x0, y0, x1, y1 = sea.mask.lines.values.reshape(-1, 4)[0]
    step = sea.domain_size / sea.resolution
    beside = heights[:, round(0.5 * (y0 + y1) / step), round(0.5 * (x0 + x1) / step)]
    # between the copies of the breakwater, as far from all as possible
    far = heights[:, round(0.9 * sea.domain_size / step), round(0.05 * sea.domain_size / step)]
    assert beside.std() == pytest.approx(0.2 * far.std(), rel=0.5)


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
    assert {file.name for file in own_folder.iterdir()} == {"bay_at_dawn.json", "bay_at_dawn.png"}
    assert ocean.ocean_tweak.preset == "Bay at Dawn"
    mine = sea_of(ocean)
    with pytest.raises(RuntimeError, match="already the name of another preset"):
        bpy.ops.ocean.save_preset(title="Bay at Dawn")
    bpy.ops.ocean.apply_preset(key="harbour")
    assert bpy.ops.ocean.apply_preset(key="user:bay_at_dawn") == {"FINISHED"}
    assert sea_of(ocean) == mine

    assert bpy.ops.ocean.rename_preset(key="user:bay_at_dawn", title="Dusk é 2") == {"FINISHED"}
    (key,) = presets.own_presets()
    assert presets.own_presets()[key].title == "Dusk é 2"
    assert presets.own_presets()[key].description == "Calm"
    assert [file.name for file in own_folder.glob("*.png")] == [presets.picture_of(key).name]

    exported = tmp_path_factory.mktemp("out") / "dusk.json"
    assert bpy.ops.ocean.export_preset(filepath=str(exported), key=key) == {"FINISHED"}
    assert bpy.ops.ocean.delete_preset(key=key) == {"FINISHED"}
    assert not presets.own_presets()
    assert not list(own_folder.iterdir())
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
    with pytest.raises(RuntimeError, match="You have no preset with the key"):
        getattr(bpy.ops.ocean, operator)(key="gale")


def test_a_file_that_is_no_preset_is_left_out(own_folder, extension):
    (own_folder / "broken.json").write_text("{")
    (own_folder / "binary.json").write_bytes(b"\xff\xfe\x00")
    (own_folder / "large.json").write_text(" " * 300_000)
    assert extension("scene.user_presets").own_presets() == {}


def test_mutated_presets_never_half_apply(ocean, own_folder, extension, tmp_path_factory, monkeypatch):
    """A file is read or refused; where it is refused, neither the folder nor the ocean changes."""
    monkeypatch.setattr(extension("scene.user_presets"), "_draw", lambda *_: None)  # pictures take their time
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


def test_the_picture_of_an_own_preset_is_of_its_sea(ocean, own_folder, extension, make_parameters):
    """A sky over water; in a storm both are darker and greyer than in a breeze, and waves are higher."""
    view = extension("scene.sea_picture").SeaView
    layer = make_parameters().layers[0]
    pictures = {}
    for wind in (6.0, 26.0):
        layers = (layer.changed(definition="WIND", wind_speed=wind),)
        pictures[wind] = view(make_parameters(layers=layers)).picture()
        assert pictures[wind].shape == (192, 192, 4)
        sky, water = pictures[wind][-40:, :, :3], pictures[wind][:60, :, :3]
        assert sky.mean() > 1.2 * water.mean()
    blue = {wind: (picture[-40:, :, 2] - picture[-40:, :, 0]).mean() for wind, picture in pictures.items()}
    assert blue[6.0] > 2.0 * blue[26.0]
    assert bpy.ops.ocean.save_preset(title="Grey Day") == {"FINISHED"}
    image = bpy.data.images.load(str(extension("scene.user_presets").picture_of("user:grey_day")))
    assert tuple(image.size) == (192, 192)


def test_a_new_preset_is_offered_a_name_that_is_free(ocean, own_folder, extension):
    names = []
    for _ in range(2):
        names.append(extension("ui.preset_operators").free_title())
        assert bpy.ops.ocean.save_preset(title=names[-1]) == {"FINISHED"}
    assert names == ["My Sea", "My Sea 2"]


def test_names_under_pictures_are_not_cut(extension, own_folder, empty_scene):
    """Seven buttons wide, a picture has room for 23 letters."""
    items = list(extension("ui.previews")._items(None, bpy.context))
    assert len(items) > 20
    again = extension("ui.previews")._items(None, bpy.context)
    assert all(one[1] is other[1] for one, other in zip(items, again, strict=True))  # kept for Blender
    assert [name for _, name, *_ in items if len(name) > 23] == []
