# SPDX-License-Identifier: GPL-3.0-or-later
"""What floats sits as deep as it should, is wet where the water was, and has a collar in the water."""

import math

import bpy
import numpy as np
import pytest

from . import afloat, floats
from .afloat import AT, update
from .conftest import evaluated_mesh
from .floats import sea_below

# fixtures for every test here
ocean, disc, select = afloat.ocean, afloat.disc, floats.select

CENTIMETRE = 0.01
BOX = (2.0, 6.0, 3.0)  # m
DRAFT = 2.0 / 3.0  # m, of that box


@pytest.fixture
def new_box(empty_scene):
    """A box whose origin is in a corner below."""

    def make(location=(*AT, 9.0), size=BOX, name="Box"):
        mesh = bpy.data.meshes.new(name)
        x, y, z = size
        corners = [(i * x, j * y, k * z) for k in (0, 1) for j in (0, 1) for i in (0, 1)]
        sides = [(0, 1, 5, 4), (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4, 6), (0, 2, 3, 1), (4, 5, 7, 6)]
        mesh.from_pydata(corners, [], sides)
        item = bpy.data.objects.new(name, mesh)
        item.location = location
        empty_scene.collection.objects.link(item)
        bpy.context.view_layer.update()
        return item

    return make


def collars(ocean):
    """The objects that have a collar in the ocean's material."""
    nodes = ocean.material_slots[0].material.node_tree.nodes
    groups = [node for node in nodes if node.type == "GROUP" and "Collar" in node.node_tree.name]
    return [group.inputs["Vector"].links[0].from_node.object for group in groups]


def test_the_draft_comes_from_the_size(extension, ocean, new_box, select):
    """A third of the beam, as of ships; of what is flat, half of the height."""
    floating = extension("scene.floating")
    rides = []
    for size in (BOX, (3.0, 3.0, 0.2)):
        item = new_box(size=size)
        item.rotation_euler = (math.pi / 2, 0.0, 0.4)  # from a program with y upwards
        item.data.transform(item.rotation_euler.to_matrix().to_4x4().inverted() @ turned(0.4))
        select(item)
        assert bpy.ops.object.ocean_tweak_float() == {"FINISHED"}
        rides.append(floating.ride_of(floating.carrier_of(item))[1])
    assert rides[0].draft == pytest.approx(DRAFT, abs=1e-5)
    assert rides[0].waterline == pytest.approx(2.0, abs=1e-5)
    assert rides[1].draft == pytest.approx(0.1, abs=1e-5)
    assert rides[0].keel == pytest.approx(0.0, abs=1e-5)


def turned(angle):
    from mathutils import Matrix

    return Matrix.Rotation(angle, 4, "Z")


def test_what_has_no_size_floats_at_its_origin(extension, ocean, select, empty_scene):
    item = bpy.data.objects.new("Empty", None)
    empty_scene.collection.objects.link(item)
    select(item)
    bpy.ops.object.ocean_tweak_float()
    floating = extension("scene.floating")
    assert floating.ride_of(floating.carrier_of(item))[1] == floating.Ride()
    assert collars(ocean) == []


def test_a_script_s_numbers_go_before_the_size(extension, ocean, new_box, select):
    floating = extension("scene.floating")
    item = new_box()
    select(item)
    bpy.ops.object.ocean_tweak_float(draft=0.25)
    ride = floating.ride_of(floating.carrier_of(item))[1]
    assert (ride.draft, ride.waterline) == pytest.approx((0.25, 2.0))
    bpy.ops.object.ocean_tweak_float(ride="CUSTOM")
    ride = floating.ride_of(floating.carrier_of(item))[1]
    assert (ride.draft, ride.waterline) == (0.0, 0.0)


@pytest.mark.parametrize("unit", [1.0, 0.1])
def test_its_lowest_point_is_a_draft_below_the_water(
    extension, ocean_object, make_parameters, new_box, core, empty_scene, unit
):
    empty_scene.unit_settings.scale_length = unit
    ocean = ocean_object.add(empty_scene, make_parameters())
    place = np.array(AT) / unit
    item = new_box((*place, 0.0), np.array(BOX) / unit)
    floating = extension("scene.floating")
    ride = floating.Ride(draft=DRAFT / unit, tilt=0.0)
    floating.float_on(item, ocean, ride)
    heights = []
    for frame in (1, 9, 17):
        empty_scene.frame_set(frame)
        lowest = min((item.matrix_world @ vertex.co).z for vertex in item.data.vertices) * unit
        sea = core.Ocean(make_parameters())
        heights.append(float(sea.height_at(*AT, make_parameters().timing.time(frame))))
        assert heights[-1] - lowest == pytest.approx(DRAFT, abs=CENTIMETRE)
    assert np.ptp(heights) > 0.2


def test_a_broad_hull_has_its_draft_in_the_mean(extension, ocean, disc, core, make_parameters, empty_scene):
    """Over its waterline, where water is on average as high above the keel as the draft says."""
    item, floating = disc(), extension("scene.floating")
    for vertex in item.data.vertices:
        vertex.co.xy *= 4.0
    ride = floating.Ride(waterline=8.0, draft=0.3, keel=0.5)
    floating.float_on(item, ocean, ride)
    around = np.random.default_rng(3).uniform(-4.0, 4.0, (4000, 2))
    around = around[np.hypot(*around.T) < 4.0] + AT
    for frame in (1, 9, 17):
        empty_scene.frame_set(frame)
        time = make_parameters().timing.time(frame)
        mean = float(np.mean(core.Ocean(make_parameters()).height_at(*around.T, time)))
        keel = item.matrix_world.translation.z - 0.5
        assert mean - keel == pytest.approx(0.3, abs=2 * CENTIMETRE)


def test_a_mesh_knows_where_it_is_wet(extension, ocean, disc, core, make_parameters, empty_scene):
    item, floating = disc(), extension("scene.floating")
    floating.float_on(item, ocean, floating.Ride(draft=0.5, keel=0.5), is_wet=True)
    inputs = {"Wet Band": 0.2, "Slop": 0.4}
    extension("nodes.modifier_inputs").set_inputs(item.modifiers[-1], inputs)
    for frame in (1, 12):
        empty_scene.frame_set(frame)
        mesh = evaluated_mesh(item)
        wet = [value.value for value in mesh.attributes["wet"].data]
        for vertex, found in zip(mesh.vertices, wet, strict=True):
            place = item.matrix_world @ vertex.co
            point, _ = sea_below(core, ocean, make_parameters(), frame, place)
            assert found == pytest.approx(1.0 - (place.z - point[2]) / 0.2, abs=0.05)
        slop = [value.value for value in mesh.attributes["slop"].data]
        assert slop == pytest.approx([0.4] * len(mesh.vertices))


def test_collars_come_and_go_with_the_objects(extension, ocean, disc, select, empty_scene, window):
    nodes = ocean.material_slots[0].material.node_tree.nodes
    before = sorted(node.name for node in nodes)
    item = disc()
    select(item)
    bpy.ops.object.ocean_tweak_float()
    assert collars(ocean) == [item]
    other = disc("Other")
    select(other)
    bpy.ops.object.ocean_tweak_float()
    assert set(collars(ocean)) == {item, other}
    select(other)
    with window.override():
        bpy.ops.object.duplicate()
        update()
        copy = bpy.context.view_layer.objects.active
        assert set(collars(ocean)) == {item, other, copy}
        bpy.ops.object.delete()
        update()
    assert set(collars(ocean)) == {item, other}
    select(item)
    bpy.ops.object.ocean_tweak_float_remove()
    assert collars(ocean) == [other]
    assert len(item.modifiers) == 0
    select(other)
    bpy.ops.object.ocean_tweak_contact(use_contact=False)
    assert collars(ocean) == []
    assert sorted(node.name for node in nodes) == before


def test_what_a_file_says_of_contact_may_be_anything(extension, ocean, disc):
    item = disc()
    for told in (None, "Ocean", 3, item):
        item["ocean_tweak_waterline"] = "deep"
        if told is not None:
            item["ocean_tweak_contact"] = told
        extension("scene.contact").refresh()
        item["ocean_tweak_waterline"] = 0.0
        extension("scene.contact").refresh()
    assert collars(ocean) == []


def test_undo_takes_the_collar_back(ocean, disc, select, window):
    item = disc()
    select(item)
    with window.override():
        bpy.ops.ed.undo_push(message="before")
        bpy.ops.object.ocean_tweak_float()
        bpy.ops.ed.undo_push(message="after")
        assert len(collars(ocean)) == 1
        bpy.ops.ed.undo()
    ocean = bpy.data.objects["Ocean"]
    assert collars(ocean) == []
    assert len(bpy.data.objects["Disc"].modifiers) == 0


def test_what_a_user_linked_stays(ocean, disc, select):
    tree = ocean.material_slots[0].material.node_tree
    water = next(node for node in tree.nodes if node.type == "GROUP")
    own = tree.nodes.new("ShaderNodeValue")
    tree.links.new(own.outputs[0], water.inputs["Foam Map"])
    item = disc()
    select(item)
    bpy.ops.object.ocean_tweak_float()
    collar = water.inputs["Foam Map"].links[0].from_node
    assert collar.inputs["Foam Map"].links[0].from_node == own
    bpy.ops.object.ocean_tweak_float_remove()
    assert water.inputs["Foam Map"].links[0].from_node == own


def test_another_water_has_it_too_and_a_library_takes_no_object_along(
    extension, ocean, disc, select, tmp_path
):
    item = disc()
    select(item)
    bpy.ops.object.ocean_tweak_float()
    (collar,) = extension("scene.contact").collars_of(item)
    collar.inputs["Foam"].default_value = 0.33
    with extension("scene.contact").set_aside():
        assert collars(ocean) == []
    (collar,) = extension("scene.contact").collars_of(item)
    assert collar.inputs["Foam"].default_value == pytest.approx(0.33)
    bpy.context.view_layer.objects.active = ocean
    assert bpy.ops.ocean.use_water_material(water="STORM") == {"FINISHED"}
    assert collars(ocean) == [item]


def test_baked_floats_keep_it(extension, ocean, disc, select, empty_scene):
    item = disc()
    select(item)
    bpy.ops.object.ocean_tweak_float()
    bpy.ops.object.ocean_tweak_float_bake(frame_start=1, frame_end=3)
    assert extension("scene.floating").carrier_of(item) is None
    assert collars(ocean) == [item]
    assert extension("scene.contact").modifier_of(item) is not None
    other = disc("Other")
    select(other)
    bpy.ops.object.ocean_tweak_float_bake(frame_start=1, frame_end=3)
    assert set(collars(ocean)) == {item, other}
    select(item)
    bpy.ops.object.ocean_tweak_float_remove()
    assert collars(ocean) == [other]


def test_nothing_depends_on_itself(extension, ocean, disc, select, empty_scene, capfd):
    item = disc()
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    empty_scene.collection.objects.link(camera)
    empty_scene.camera = camera
    camera.parent = item
    extension("scene.camera_surface").add_camera_surface(ocean, empty_scene, budget=5000)
    select(item)
    bpy.ops.object.ocean_tweak_float()
    update()
    for frame in (2, 3):
        empty_scene.frame_set(frame)
    captured = capfd.readouterr()
    assert "cycle" not in (captured.out + captured.err).lower()


def test_strong_winds_wet_more_of_a_hull(extension, ocean, disc, select):
    told = []
    for speed in (2.0, 8.0, 20.0):
        ocean.ocean_tweak.layers[0].wind_speed = speed
        item = disc()
        select(item)
        bpy.ops.object.ocean_tweak_float()
        inputs = extension("nodes.modifier_inputs").all_inputs(extension("scene.contact").modifier_of(item))
        told.append((inputs["Wet Band"], inputs["Slop"]))
        bpy.data.objects.remove(item)
        update()
    bands, slops = zip(*told, strict=True)
    assert bands[0] < bands[1] < bands[2] < 1.0
    assert slops[0] == 0.0 < slops[1] < slops[2] == 1.0


def test_it_is_told_where_the_water_does_not_reach(ocean, disc, select):
    item = disc()
    item.location.z = 30.0
    update()
    select(item)
    with pytest.raises(RuntimeError, match="does not cut Disc: move it into the water"):
        bpy.ops.object.ocean_tweak_contact()
    item.location.z = 0.0
    update()
    assert bpy.ops.object.ocean_tweak_contact() == {"FINISHED"}
    assert collars(ocean) == [item]
