# SPDX-License-Identifier: GPL-3.0-or-later
"""Whatever an artist types or a file holds, the ocean is shown or says why not, and no exception comes."""

import contextlib
import os
import random

import bpy
import numpy as np
import pytest

from tests.blender.conftest import stored

#: what would only cost time: these are tried with small values
LARGEST = {"resolution": 48, "viewport_resolution": 48, "mesh_resolution": 40, "repeats_x": 3, "repeats_y": 3}
LEFT_OUT = {"rna_type", "name", "is_ocean", "is_quiet", "source", "use_foam", "exact"}


def is_array(prop):
    return getattr(prop, "is_array", False)


def editable(group):
    """The properties of a group that a panel may show."""
    return [
        prop for prop in group.bl_rna.properties
        if prop.identifier not in LEFT_OUT and not (prop.is_hidden or prop.is_readonly or is_array(prop))
        and prop.type in ("FLOAT", "INT", "BOOLEAN", "ENUM")
    ]  # fmt: skip


def some_value(chance, prop):
    if prop.type == "BOOLEAN":
        return chance.random() < 0.5
    if prop.type == "ENUM" and prop.is_enum_flag:
        return {item.identifier for item in prop.enum_items if chance.random() < 0.5}
    if prop.type == "ENUM":
        return chance.choice(prop.enum_items.keys())
    low, high = prop.hard_min, min(prop.hard_max, LARGEST.get(prop.identifier, prop.hard_max))
    if prop.type == "INT":
        return chance.choice((low, high, chance.randint(low, high)))
    near = 10.0 ** chance.uniform(-3.0, 5.0)
    return chance.choice((low, min(high, 1e6), min(max(near, low), high), prop.default))


@pytest.fixture
def ocean(ocean_object, make_parameters, empty_scene):
    item = ocean_object.add(empty_scene, make_parameters())
    bpy.context.view_layer.objects.active = item
    item.ocean_tweak.use_foam = False  # it looks back over many surfaces, whatever is edited
    bpy.ops.ocean.layer_add()
    return item


@pytest.mark.filterwarnings("ignore::RuntimeWarning")  # of seas that no float32 can hold
@pytest.mark.parametrize(("patches", "edits"), [(0, 300), (3, 150)])
def test_random_edits_leave_no_exception(ocean, empty_scene, extension, patches, edits):
    chance = random.Random(2)
    settings = ocean.ocean_tweak
    while len(settings.patches) < patches:
        bpy.ops.ocean.patch_add()
        settings.patches[-1].resolution = 32
    groups = [settings, settings.water, settings.foam, settings.timing, *settings.layers, *settings.patches]
    told = shown = 0
    for number in range(edits):
        group = chance.choice(groups)
        prop = chance.choice(editable(group))
        setattr(group, prop.identifier, some_value(chance, prop))
        if number % 10 == 0:
            empty_scene.frame_set(chance.randint(-50, 5000))
        if settings.error:
            told += 1
            assert len(settings.error) > 10
            # a remedy is at hand: the default is a sea, and so are fewer samples
            setattr(group, prop.identifier, LARGEST.get(prop.identifier, prop.default))
        else:
            shown += 1
            mesh = ocean.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
            places = np.empty(3 * len(mesh.vertices), np.float32)
            mesh.vertices.foreach_get("co", places)
            assert np.all(np.isfinite(places)), (prop.identifier, number)
    assert shown > edits // 3
    assert told > 0
    settings.from_parameters(extension("core").OceanParameters(resolution=32), empty_scene)
    assert not settings.error


#: what an artist presses: operators by name with what they are told
PRESSES = [
    *(("layer_add", {"kind": kind}) for kind in ("WAVES", "WIND_FIELD", "IMAGE", "HERO_WAVE")),
    *((f"layer_{what}", {}) for what in ("remove", "duplicate", "solo")),
    *(("layer_move", {"direction": direction}) for direction in ("UP", "DOWN")),
    *((name, {}) for name in ("patch_add", "patch_remove", "one_patch", "use_water_material")),
    *(("apply_preset", {"key": key}) for key in ("open_sea", "harbour", "crossing_seas")),
    *(("match_sea_state", {"height": height, "period": 4.0}) for height in (0.0, 1.0, 6.0)),
]
EDITS = 1000 if os.environ.get("OCEAN_TWEAK_LONG_TESTS") else 100


def groups_of(settings):
    """All that the panels show of an ocean's settings now."""
    entries = [settings, settings.water, settings.foam, settings.timing, settings.usd, *settings.patches]
    for layer in settings.layers:
        entries += {id(layer): layer, id(layer.group): layer.group}.values()
    return entries + [entry.mask for entry in entries if hasattr(entry, "mask")]


def keep_small(settings):
    """Fewer samples than a preset or a dragged number may want: they would only cost time."""
    for group in (settings, *settings.patches, settings.foam, *(layer.group for layer in settings.layers)):
        for name, largest in SMALL.items():
            if getattr(group, name, 0) > largest:
                setattr(group, name, largest)


SMALL = {**LARGEST, "noise_resolution": 64, "columns": 8, "rows": 8, "origins": 2, "particles": 7}


@pytest.mark.filterwarnings("ignore::RuntimeWarning")  # of seas that no float32 can hold
def test_random_edits_and_presses_print_no_traceback(ocean, empty_scene, extension, capfd):
    """Blender prints what an update or an operator raises, and goes on."""
    chance = random.Random(21)
    settings, shown = ocean.ocean_tweak, 0
    for number in range(EDITS):
        if chance.random() < 0.3:
            name, told = chance.choice(PRESSES)
            operator, what = getattr(bpy.ops.ocean, name), name
            with settings.quiet(), contextlib.suppress(RuntimeError):  # it refuses, and says why
                if operator.poll():
                    operator(**told)
            settings.use_foam = False
            keep_small(settings)
        else:
            group = chance.choice(groups_of(settings))
            prop = chance.choice(editable(group))
            what = prop.identifier
            value = some_value(chance, prop)
            setattr(group, what, min(value, SMALL[what]) if what in SMALL else value)
        if number % 7 == 0:
            empty_scene.frame_set(chance.randint(-50, 5000))
        said = capfd.readouterr()
        assert "Traceback" not in said.out + said.err, (number, what, said.err)
        shown += not settings.error
        if settings.error:
            assert len(settings.error) > 10, (number, what)
            with contextlib.suppress(RuntimeError):
                bpy.ops.ocean.apply_preset(key="open_sea")
            keep_small(settings)
    assert shown > EDITS // 3
    settings.from_parameters(extension("core").OceanParameters(resolution=32), empty_scene)
    assert not settings.error


@pytest.mark.parametrize("index", [-5, 900])
def test_an_index_beyond_a_list_means_its_nearest_entry(ocean, empty_scene, index):
    nearest = 0 if index < 0 else -1
    settings = ocean.ocean_tweak
    settings.resolution = 48  # which hold a hero wave and its copy
    kinds = ("WAVES", "WIND_FIELD", "IMAGE", "HERO_WAVE")
    for kind in kinds:
        bpy.ops.ocean.layer_add(kind=kind)

    def active_is(name):
        stored(ocean)[name] = index
        assert getattr(settings, name) == index

    for operator, added in (("layer_solo", 0), ("layer_duplicate", 1), ("layer_remove", -1)):
        count = len(settings.layers)
        active_is("active_layer")
        expected = settings.layers[nearest].kind
        assert getattr(bpy.ops.ocean, operator)() == {"FINISHED"}
        assert len(settings.layers) == count + added
        assert [layer.kind for layer in settings.layers].count(expected) > 0
    for kind in kinds:
        active_is("active_layer")
        assert bpy.ops.ocean.layer_add(kind=kind) == {"FINISHED"}
    assert [not layer.group.muted for layer in settings.layers].count(True) >= len(kinds)
    for direction in ("UP", "DOWN"):
        active_is("active_layer")
        bpy.ops.ocean.layer_move(direction=direction)
    active_is("active_layer")
    bpy.ops.ocean.reload_image.poll()
    bpy.ops.ocean.record_wind.poll()
    with pytest.raises(RuntimeError, match=r"mask|mesh"):
        bpy.ops.ocean.read_weights()
    bpy.ops.ocean.patch_add()
    bpy.ops.ocean.patch_add()
    count = len(settings.patches)
    active_is("active_patch")
    assert bpy.ops.ocean.patch_remove() == {"FINISHED"}
    assert settings.active_patch == (0 if index < 0 else count - 2)  # the one before takes over


def test_what_a_file_holds_beyond_its_ranges_is_replaced_when_it_is_opened(
    ocean, tmp_path, caplog, empty_scene
):
    raw = stored(ocean)
    beyond = {
        "active_layer": -5,
        "viewport_resolution": 10**8,
        "repeats_x": -3,
        "method": 77,
        "dispersion": -1,
    }
    for name, value in beyond.items():
        raw[name] = value
    raw["layers"][0]["kind"] = 99
    raw["layers"][1]["swell"] = float("nan")
    raw["foam"]["half_life"] = 1e30
    file = str(tmp_path / "stranger.blend")
    bpy.ops.wm.save_as_mainfile(filepath=file)
    bpy.ops.wm.open_mainfile(filepath=file)
    item = next(each for each in bpy.data.objects if each.ocean_tweak.is_ocean)
    settings = item.ocean_tweak
    assert settings.error == ""
    assert (settings.active_layer, settings.viewport_resolution, settings.repeats_x) == (0, 8192, 1)
    assert (settings.method, settings.dispersion, settings.layers[0].kind) == ("NODES", "CAPILLARY", "WAVES")
    assert settings.layers[1].swell == pytest.approx(0.3)
    assert settings.foam.half_life == 60.0
    (told,) = (record.getMessage() for record in caplog.records if "invalid values" in record.getMessage())
    assert all(name in told for name in (*beyond, "layers.0.kind", "layers.1.swell", "foam.half_life"))
    assert told.startswith(item.name)
    caplog.clear()
    bpy.ops.wm.save_as_mainfile(filepath=file)
    bpy.ops.wm.open_mainfile(filepath=file)
    assert "invalid values" not in caplog.text


@pytest.mark.parametrize("text", ["{", "[]", "[" * 100_000, "1"])
def test_damaged_numbers_of_a_file_are_told(ocean, empty_scene, text):
    layer = ocean.ocean_tweak.layers[0]
    layer.exact = text
    with pytest.raises(ValueError, match=r"exact = .* is damaged in this file"):
        ocean.ocean_tweak.to_parameters(empty_scene)
    empty_scene.frame_set(empty_scene.frame_current + 1)
    assert "is damaged in this file" in ocean.ocean_tweak.error


@pytest.mark.parametrize("text", ["[1", "{}", "7"])
def test_derived_texts_of_a_file_are_not_believed(ocean, extension, text):
    """In a window they are drawn before they are made anew."""
    names = ("statistics", "baked_sea", "bake_differs")
    for name in names:
        setattr(ocean.ocean_tweak, name, text)
    extension("scene.stored_values").mend_all()
    assert [getattr(ocean.ocean_tweak, name) for name in names] == ["", "", ""]
