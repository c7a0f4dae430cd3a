# SPDX-License-Identifier: GPL-3.0-or-later
"""Foam in the Solid view: which faces are white, that renders do not know of it, that it looks as water."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest

from .sheets import new_sheet

CELLS, SIDE = 8, 24


@pytest.fixture
def solid(extension):
    return extension("scene.solid_foam")


@pytest.fixture
def water(extension):
    return extension("scene.water_material").water_material("STORM")


@pytest.fixture
def sheet(empty_scene, solid, water):
    """A flat square of 8 x 8 faces, with foam on the half where x is large."""
    foam = {"foam": lambda rest: np.where(rest[..., :1] > 49.0, 0.8, 0.1)}
    item = new_sheet(empty_scene, np.zeros((CELLS, CELLS, 3)), 100.0, foam)
    item.data.materials.append(water)
    return item


def evaluated_materials(item):
    """Name of each face's material, as the viewport has it."""
    mesh = item.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    return [mesh.materials[face.material_index] for face in mesh.polygons]


def test_white_is_where_foam_covers(sheet, solid, water):
    solid.show(sheet, water)
    found = evaluated_materials(sheet)
    white = [material.diffuse_color[0] > 0.8 for material in found]
    # foam of a face is the mean of its corners: from column 4 on it is over a half; the third has both ends
    assert white == [column >= 4 for _ in range(CELLS) for column in range(CELLS)]
    assert {material.original for material, is_white in zip(found, white, strict=True) if not is_white} == {
        water
    }
    assert water.diffuse_color[0] < 0.5
    assert [slot.material for slot in sheet.material_slots] == [water]  # the artist's slots are as they were


def test_a_second_time_nothing_is_made(sheet, solid, water):
    solid.show(sheet, water)
    before = len(sheet.modifiers), len(bpy.data.materials)
    solid.show(sheet, water)
    assert (len(sheet.modifiers), len(bpy.data.materials)) == before


def test_the_copy_is_no_water_to_choose(sheet, solid, water, extension):
    solid.show(sheet, water)
    assert extension("scene.water_material").water_material("STORM") == water


@pytest.fixture
def rendered(empty_scene, tmp_path):
    """Pixels of the sheet, seen obliquely in Cycles; the same numbers for the same scene."""
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.location, camera.rotation_euler = (50.0, -40.0, 30.0), (1.1, 0.0, 0.0)
    sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
    sun.rotation_euler = (0.8, 0.2, 0.0)
    for item in (camera, sun):
        empty_scene.collection.objects.link(item)
    empty_scene.camera = camera
    empty_scene.render.engine = "CYCLES"
    empty_scene.cycles.device, empty_scene.cycles.samples = "CPU", 4
    empty_scene.cycles.use_denoising = False
    empty_scene.render.resolution_x = empty_scene.render.resolution_y = SIDE
    empty_scene.view_settings.view_transform = "Raw"
    empty_scene.render.image_settings.file_format = "OPEN_EXR"
    empty_scene.render.filepath = str(tmp_path / "seen.exr")

    def pixels():
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(empty_scene.render.filepath)
        found = np.empty(4 * SIDE * SIDE, np.float32)
        image.pixels.foreach_get(found)
        bpy.data.images.remove(image)
        return found

    return pixels


def test_a_render_is_the_same_to_the_bit(sheet, solid, water, rendered):
    before = rendered()
    assert np.ptp(before) > 0.01
    solid.show(sheet, water)
    assert np.array_equal(rendered(), before)


def test_the_copy_looks_as_its_water_whatever_becomes_of_that(sheet, solid, water, rendered, extension):
    """As the viewport's own renders show both side by side."""
    solid.show(sheet, water)
    group = next(node for node in water.node_tree.nodes if node.type == "GROUP")
    group.inputs["Absorption"].default_value = (0.1, 0.9, 0.9, 1.0)  # a value
    nodes, links = water.node_tree.nodes, water.node_tree.links
    tint = nodes.new("ShaderNodeCombineXYZ")  # and the structure
    tint.inputs[0].default_value = 0.4
    links.new(tint.outputs[0], group.inputs["Backscatter"])
    extension("scene.water_material").light_by(water, bpy.data.objects["Sun"])  # drivers too
    solid.mend()
    group.inputs["Crest Light"].default_value = 0.1
    solid.mend()
    before = rendered()
    modifier = sheet.modifiers[0]
    modifier.show_render = True
    after = rendered()
    assert np.abs(after - before).max() < 1e-6
    group.inputs["Crest Light"].default_value = 1.0  # nobody mends: the copy is another one, and is seen
    group.inputs["Absorption"].default_value = (0.9, 0.1, 0.1, 1.0)
    assert np.abs(rendered() - after).max() > 1e-4


def test_the_copy_follows_what_is_within_the_water_s_nodes(sheet, solid, water, rendered):
    """An image and how it is read, stops of a color ramp and points of a curve, each of which is seen."""
    solid.show(sheet, water)
    group = next(node for node in water.node_tree.nodes if node.type == "GROUP")
    nodes, links = water.node_tree.nodes, water.node_tree.links
    group.inputs["Absorption"].default_value = (0.5, 0.5, 0.5, 1.0)
    tint = nodes.new("ShaderNodeCombineXYZ")
    kinds = ("TexImage", "ValToRGB", "FloatCurve")
    picture, ramp, curve = (nodes.new(f"ShaderNode{kind}") for kind in kinds)
    for number, node in enumerate((picture, ramp, curve)):
        links.new(node.outputs[0], tint.inputs[number])
    links.new(tint.outputs[0], group.inputs["Backscatter"])
    links.new(nodes.new("ShaderNodeTexCoord").outputs["Generated"], picture.inputs[0])
    ramp.inputs[0].default_value = 0.5
    white = bpy.data.images.new("White", 4, 4)
    white.generated_color = (1.0, 1.0, 1.0, 1.0)

    def give_image():
        picture.image = white

    def turn_image():
        picture.extension, picture.texture_mapping.translation = "CLIP", (3.0, 0.0, 0.0)

    def move_stop():
        ramp.color_ramp.elements[1].position = 0.55

    def move_point():
        curve.mapping.curves[0].points[1].location = (1.0, 0.1)
        curve.mapping.update()

    solid.mend()
    modifier = sheet.modifiers[0]
    for change in (give_image, turn_image, move_stop, move_point):
        change()
        modifier.show_render = False
        wanted = rendered()
        modifier.show_render = True
        assert np.abs(rendered() - wanted).max() > 1e-4, change  # the former copy
        solid.mend()
        assert np.abs(rendered() - wanted).max() < 1e-6, change


@pytest.mark.parametrize("other", [True, False])
def test_another_material_in_the_slot_is_copied_instead(sheet, solid, water, other):
    solid.show(sheet, water)
    sheet.material_slots[0].material = new = bpy.data.materials.new("Ink") if other else None
    solid.mend()
    found = evaluated_materials(sheet)[-1]
    assert (found and found.original.name) == (f"Ink {sheet.modifiers[0].name}" if other else None)
    if other:
        assert new.diffuse_color[0] < found.diffuse_color[0]


def test_another_material_of_a_camera_surface_too(solid, extension, ocean):
    get_input = extension("nodes.modifier_inputs").get_input
    water = extension("scene.water_material").water_material()
    ocean.data.materials.append(water)
    surface = extension("scene.camera_surface").add_camera_surface(ocean, bpy.context.scene)
    around, foam = (
        next(each for each in surface.modifiers if name in each.name) for name in ("Camera", "Foam")
    )
    assert get_input(foam, solid.MATERIAL_INPUT).name.startswith(water.name)
    ink = bpy.data.materials.new("Ink")
    extension("nodes.modifier_inputs").set_inputs(around, {"Material": ink})
    solid.mend()
    assert get_input(foam, solid.MATERIAL_INPUT).name.startswith("Ink")


@pytest.mark.parametrize("kind", ["MATERIAL", "OBJECT", "MESH"])
def test_a_window_looks_after_what_an_artist_changes(solid, monkeypatch, kind):
    """A material in a slot of the mesh, of the object, or in a modifier tells of one of these."""
    timers = SimpleNamespace(is_registered=lambda _: False, register=lambda what, **_: asked.append(what))
    app = SimpleNamespace(background=False, timers=timers)
    monkeypatch.setattr(solid, "bpy", SimpleNamespace(app=app))
    asked = []
    solid.follow(SimpleNamespace(id_type_updated=lambda what: what == "SCENE"))
    assert not asked
    solid.follow(SimpleNamespace(id_type_updated=lambda what: what == kind))
    assert asked == [solid.mend]


def test_what_is_mended_is_mended_once(sheet, solid, water):
    solid.show(sheet, water)
    copies = {material for material in bpy.data.materials if material != water}
    water.node_tree.nodes.new("ShaderNodeValue")
    solid.mend()
    assert len(bpy.data.materials) == len(copies) + 1
    made = next(material for material in bpy.data.materials if material != water)
    assert sum(node.type == "VALUE" for node in made.node_tree.nodes) == sum(
        node.type == "VALUE" for node in water.node_tree.nodes
    )
    solid.mend()
    assert made == next(material for material in bpy.data.materials if material != water)
    assert evaluated_materials(sheet)[-1].original == made
