# SPDX-License-Identifier: GPL-3.0-or-later
"""Saved, duplicated, undone, switched over, broken and mended."""

import bpy
import numpy as np
import pytest

from .conftest import DOMAIN, SAMPLES

TOLERANCE = 1e-4  # m


@pytest.fixture
def add(ocean_object, empty_scene):
    return lambda parameters, *more, **named: ocean_object.add(empty_scene, parameters, *more, **named)


@pytest.mark.parametrize("method", ["NODES", "DISPLACE"])
@pytest.mark.parametrize("source", ["LIVE", "SEQUENCE"])
def test_saved_and_opened_again(add, bake, make_parameters, expected, evaluated, tmp_path, method, source):
    parameters = make_parameters()
    add(parameters, method, source, bake(parameters, 1, 24) if source == "SEQUENCE" else None)
    file = str(tmp_path / "shot.blend")
    bpy.ops.wm.save_as_mainfile(filepath=file)
    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.ops.wm.open_mainfile(filepath=file)
    item, scene = bpy.data.objects["Ocean"], bpy.context.scene
    np.testing.assert_allclose(evaluated(item), expected(parameters, 1), atol=TOLERANCE)
    for frame in (24, 2):
        scene.frame_set(frame)
        np.testing.assert_allclose(evaluated(item), expected(parameters, frame), atol=TOLERANCE)


@pytest.mark.parametrize("method", ["NODES", "DISPLACE"])
@pytest.mark.parametrize("linked_mesh", [False, True])
def test_a_duplicate_is_a_sea_of_its_own(
    add, make_parameters, expected, evaluated, empty_scene, method, linked_mesh
):
    first, changed = make_parameters(), make_parameters(seed=8, domain_size=90.0)
    item = add(first, method)
    twin = item.copy()
    if not linked_mesh:
        twin.data = item.data.copy()
    empty_scene.collection.objects.link(twin)
    twin.ocean_tweak.from_parameters(changed, empty_scene)
    for frame in (1, 4):
        empty_scene.frame_set(frame)
        np.testing.assert_allclose(evaluated(item), expected(first, frame), atol=TOLERANCE)
        np.testing.assert_allclose(evaluated(twin), expected(changed, frame), atol=TOLERANCE)


def test_changing_the_original_leaves_its_duplicate(add, make_parameters, expected, evaluated, empty_scene):
    parameters = make_parameters()
    item = add(parameters, "DISPLACE")
    twin = item.copy()
    empty_scene.collection.objects.link(twin)
    empty_scene.frame_set(2)
    item.ocean_tweak.seed = 9
    np.testing.assert_allclose(evaluated(twin), expected(parameters, 2), atol=TOLERANCE)
    np.testing.assert_allclose(evaluated(item), expected(make_parameters(seed=9), 2), atol=TOLERANCE)


def test_two_seas_of_different_size(add, make_parameters, expected, evaluated, empty_scene):
    seas = [make_parameters(), make_parameters(seed=2, resolution=64, domain_size=300.0, wind_direction=2.0)]
    items = [add(sea) for sea in seas]
    empty_scene.frame_set(6)
    for item, sea in zip(items, seas, strict=True):
        np.testing.assert_allclose(evaluated(item), expected(sea, 6), atol=TOLERANCE)


@pytest.mark.parametrize("method", ["NODES", "DISPLACE"])
def test_undo_and_redo(add, make_parameters, expected, evaluated, window, method):
    before, after = make_parameters(), make_parameters(resolution=2 * SAMPLES, seed=3)
    item = add(before, method)
    with window.override():
        bpy.ops.ed.undo_push(message="added")
        item.ocean_tweak.from_parameters(after, bpy.context.scene)
        bpy.ops.ed.undo_push(message="changed")
        bpy.ops.ed.undo()
        item = bpy.data.objects["Ocean"]
        np.testing.assert_allclose(evaluated(item), expected(before, 1), atol=TOLERANCE)
        bpy.context.scene.frame_set(7)
        np.testing.assert_allclose(evaluated(item), expected(before, 7), atol=TOLERANCE)
        bpy.ops.ed.redo()
        item = bpy.data.objects["Ocean"]
        frame = bpy.context.scene.frame_current
        np.testing.assert_allclose(evaluated(item), expected(after, frame), atol=TOLERANCE)


def test_a_changed_property_shows_at_once(add, make_parameters, expected, evaluated):
    item = add(make_parameters())
    settings = item.ocean_tweak
    settings.domain_size, settings.seed, settings.choppiness = 200.0, 11, 0.5
    changed = make_parameters(domain_size=200.0, seed=11, choppiness=0.5)
    np.testing.assert_allclose(evaluated(item), expected(changed, 1), atol=TOLERANCE)


def test_another_unit_scale_shows_on_the_next_frame(add, make_parameters, evaluated, expected, empty_scene):
    item = add(make_parameters())
    empty_scene.unit_settings.scale_length = 0.5
    empty_scene.frame_set(3)
    layer = make_parameters().layers[0]
    smaller = make_parameters(
        domain_size=DOMAIN / 2,
        layers=(type(layer)(wind_speed=5.5, fetch=40e3, wind_direction=0.4),),
        water=type(make_parameters().water)(depth=100.0),
    )
    np.testing.assert_allclose(evaluated(item), expected(smaller, 3, 0.5), atol=TOLERANCE)


def test_source_and_method_can_be_switched(add, bake, ocean_object, make_parameters, expected, evaluated):
    parameters = make_parameters()
    item = add(parameters)
    scene = bpy.context.scene
    below = item.modifiers.new("Below", "TRIANGULATE")
    ocean_object.use_sequence(item, scene, bake(parameters, 1, 3))
    for method, source in (
        ("DISPLACE", "LIVE"),
        ("DISPLACE", "SEQUENCE"),
        ("NODES", "SEQUENCE"),
        ("NODES", "LIVE"),
    ):
        item.ocean_tweak.method, item.ocean_tweak.source = method, source
        scene.frame_set(1)
        scene.frame_set(2)
        np.testing.assert_allclose(evaluated(item), expected(parameters, 2), atol=TOLERANCE)
        own = {"NODES": ["NODES"], "DISPLACE": ["DISPLACE", "NODES"]}[method]
        assert [modifier.type for modifier in item.modifiers] == [*own, "TRIANGULATE"]
    assert below.name in item.modifiers


def test_a_bad_value_is_shown_and_playback_goes_on(add, make_parameters, expected, evaluated, empty_scene):
    good = make_parameters(seed=2)
    item, other = add(make_parameters()), add(good)
    item.ocean_tweak.resolution = 33
    assert item.ocean_tweak.error == "resolution = 33: must be an even number from 16 to 8192"
    assert item.ocean_tweak.statistics == ""
    empty_scene.frame_set(5)
    np.testing.assert_allclose(evaluated(other), expected(good, 5), atol=TOLERANCE)
    item.ocean_tweak.resolution = 32
    assert item.ocean_tweak.error == ""
    np.testing.assert_allclose(evaluated(item), expected(make_parameters(), 5), atol=TOLERANCE)


@pytest.mark.parametrize(
    ("name", "value", "said"),
    [("resolution", 33, "resolution = 33: must be an even number"), ("domain_size", 0.0, "domain_size = 0.0"),
     ("domain_size", float("inf"), "domain_size"), ("domain_size", float("nan"), "domain_size")],
)  # fmt: skip
def test_each_bad_value_names_its_field(add, make_parameters, empty_scene, name, value, said):
    settings = add(make_parameters()).ocean_tweak
    setattr(settings, name, value)
    empty_scene.frame_set(2)
    if getattr(settings, name) == value or value != value:  # Blender may have clamped it into the range
        assert said in settings.error


def test_too_little_memory_is_shown(add, make_parameters, core, empty_scene, monkeypatch):
    settings = add(make_parameters()).ocean_tweak
    with monkeypatch.context() as little:
        little.setattr(core.Ocean, "surface", lambda *a, **k: (_ for _ in ()).throw(MemoryError))
        for frame in (2, 3):
            empty_scene.frame_set(frame)
            assert "memory" in settings.error
    empty_scene.frame_set(3)
    assert settings.error == ""


def test_a_bug_is_not_hidden(add, make_parameters, core, extension, empty_scene, monkeypatch):
    add(make_parameters())
    extension("core.numerics.memo").MEMO.drop()
    monkeypatch.setattr(core.Ocean, "surface", lambda *a, **k: {}["missing"])
    with pytest.raises(KeyError):
        extension("scene.scene_handlers").refresh_on_frame_change(empty_scene)


def test_sea_in_an_instanced_collection_moves(
    ocean_object, make_parameters, expected, evaluated, empty_scene
):
    hidden = bpy.data.collections.new("Hidden")
    item = ocean_object.add(empty_scene, make_parameters(), collection=hidden)
    empty = bpy.data.objects.new("Instance", None)
    empty.instance_type, empty.instance_collection = "COLLECTION", hidden
    empty_scene.collection.objects.link(empty)
    empty_scene.frame_set(8)
    heights = []
    for instance in bpy.context.evaluated_depsgraph_get().object_instances:
        if instance.is_instance and instance.object.original == item:
            heights.append([vertex.co.z for vertex in instance.object.data.vertices[:5]])
    np.testing.assert_allclose(heights, [expected(make_parameters(), 8)[0, :5, 2]], atol=TOLERANCE)


def test_statistics_are_the_core_s(add, make_parameters, core):
    import json

    parameters = make_parameters()
    settings = add(parameters).ocean_tweak
    assert json.loads(settings.statistics) == json.loads(
        json.dumps(core.Ocean(parameters).statistics().to_dict())
    )


def test_stale_node_group_is_not_used(add, make_parameters, expected, evaluated, extension):
    kind = extension("nodes.ocean").ocean_group(1)
    stale = bpy.data.node_groups.new(kind.name, "GeometryNodeTree")
    stale["ocean_tweak_group"] = f"{kind.name} 0"
    item, other = add(make_parameters()), add(make_parameters())
    groups = {modifier.node_group for each in (item, other) for modifier in each.modifiers}
    assert len(groups) == 1
    assert stale not in groups
    np.testing.assert_allclose(evaluated(item), expected(make_parameters(), 1), atol=TOLERANCE)


def texels(image):
    flat = np.empty(4 * image.size[0] * image.size[1], np.float32)
    image.pixels.foreach_get(flat)
    return flat.reshape(image.size[1], image.size[0], 4)[..., :3]


def test_materials_can_hold_on_to_the_live_image(add, make_parameters, core, empty_scene):
    item = add(make_parameters(), "DISPLACE")
    image = item.ocean_tweak.live_maps.disp
    item.data.materials.append(bpy.data.materials.new("Water"))
    if bpy.app.version < (5, 0):
        item.data.materials[0].use_nodes = True
    item.data.materials[0].node_tree.nodes.new("ShaderNodeTexImage").image = image
    item.ocean_tweak.resolution = 64
    assert item.ocean_tweak.live_maps.disp == image
    # geometry nodes do without the image, the material does not
    item.ocean_tweak.method = "NODES"
    empty_scene.frame_set(5)
    surface = core.Ocean(make_parameters(resolution=64)).frame(5).displacement
    np.testing.assert_allclose(texels(image), surface, atol=TOLERANCE)
    assert tuple(image.size) == (64, 64)
    assert item.data.materials[0].name == "Water"


def test_a_live_image_that_was_packed_lives_on(add, make_parameters, expected, evaluated, empty_scene):
    item = add(make_parameters(), "DISPLACE")
    image = item.ocean_tweak.live_maps.disp
    image.pack()  # as Blender does when it saves modified images
    assert image.source == "FILE"
    empty_scene.frame_set(3)
    np.testing.assert_allclose(evaluated(item), expected(make_parameters(), 3), atol=TOLERANCE)
    image.pack()
    larger = make_parameters(resolution=64)
    item.ocean_tweak.from_parameters(larger, empty_scene)
    np.testing.assert_allclose(evaluated(item), expected(larger, 3), atol=TOLERANCE)
    assert image.packed_file is None
    assert image.colorspace_settings.is_data
