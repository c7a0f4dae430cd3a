# SPDX-License-Identifier: GPL-3.0-or-later
"""Foam in the Solid view: which faces are white, that renders do not know of it, that it looks as water."""

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
    tint = water.node_tree.nodes.new("ShaderNodeCombineXYZ")  # and the structure
    tint.inputs[0].default_value = 0.4
    water.node_tree.links.new(tint.outputs[0], group.inputs["Backscatter"])
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
