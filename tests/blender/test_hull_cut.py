# SPDX-License-Identifier: GPL-3.0-or-later
"""Hulls are dry inside: rendered from above, in both engines, through copies, undo, files and deletion."""

import contextlib
import math

import bpy
import numpy as np
import pytest

from . import floats
from .test_velocity_blur import EEVEE_NAMES
from .test_wakes import new_hull

select, ocean = floats.select, floats.ocean
LENGTH, BEAM, DEPTH = 24.0, 8.0, 3.0
PIXELS, WIDTH = 96, 48.0  # of what is seen from above, m
WATER, WOOD, LAND = (0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)


def glowing(name, colour):
    """A material that looks the same in any light."""
    material = bpy.data.materials.new(name)
    if material.node_tree is None:  # a material has nodes from the start since Blender 5.0
        material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    glow, shown = nodes.new("ShaderNodeEmission"), nodes.new("ShaderNodeOutputMaterial")
    glow.inputs["Color"].default_value = (*colour, 1.0)
    material.node_tree.links.new(glow.outputs[0], shown.inputs["Surface"])
    return material


@pytest.fixture
def new_boat(empty_scene):
    """An open boat without thickness: pointed at both ends, flared, its origin at half its depth."""

    def make(name="Boat", is_decked=False, location=(25.0, 40.0, 0.0), turn=0.4):
        angle = np.linspace(0.0, 2.0 * math.pi, 65)[:-1]
        rings = [
            np.stack([s * LENGTH / 2 * np.cos(angle), s * BEAM / 2 * np.sin(angle), 0.0 * angle + z], axis=-1)
            for s, z in ((0.7, -DEPTH / 2), (0.9, 0.0), (1.0, DEPTH / 2))
        ]
        faces = [
            (64 * ring + i, 64 * ring + (i + 1) % 64, 64 * (ring + 1) + (i + 1) % 64, 64 * (ring + 1) + i)
            for ring in (0, 1)
            for i in range(64)
        ]
        faces += [tuple(range(64))] + ([tuple(range(128, 192))] if is_decked else [])
        mesh = bpy.data.meshes.new(name)
        mesh.from_pydata(np.concatenate(rings).tolist(), [], faces)
        mesh.materials.append(glowing("Wood", WOOD))
        item = bpy.data.objects.new(name, mesh)
        item.location, item.rotation_euler.z = location, turn
        empty_scene.collection.objects.link(item)
        bpy.context.view_layer.update()
        return item

    return make


@pytest.fixture
def water(ocean):
    ocean.data.materials.append(glowing("Sea", WATER))
    ocean.ocean_tweak.viewport_resolution = 32
    return ocean


@pytest.fixture
def seen_from_above(empty_scene, tmp_path):
    """Render what is below a camera high above an object: (PIXELS, PIXELS, 3), and x and y in m of each."""
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.data.type, camera.data.ortho_scale, camera.data.clip_end = "ORTHO", WIDTH, 1e4
    empty_scene.collection.objects.link(camera)
    empty_scene.camera = camera
    render = empty_scene.render
    render.engine = "CYCLES"
    empty_scene.cycles.samples, empty_scene.cycles.use_denoising = 1, False
    empty_scene.cycles.pixel_filter_type, empty_scene.cycles.filter_width = "BLACKMAN_HARRIS", 0.01
    render.filter_size = 0.01
    render.resolution_x = render.resolution_y = PIXELS
    render.image_settings.file_format = "OPEN_EXR"
    empty_scene.view_settings.view_transform = "Raw"

    def shoot(item):
        scene = bpy.context.scene  # a file may have been opened
        camera, render, place = scene.camera, scene.render, item.matrix_world.translation
        camera.location = (place.x, place.y, 200.0)
        render.filepath = str(tmp_path / "above.exr")
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(render.filepath, check_existing=False)
        pixels = np.array(image.pixels[:], np.float32).reshape(PIXELS, PIXELS, 4)[..., :3]
        bpy.data.images.remove(image)
        across = (np.arange(PIXELS) + 0.5) / PIXELS * WIDTH - WIDTH / 2
        x, y = np.meshgrid(place.x + across, place.y + across)
        return pixels, x, y

    return shoot


def shares(item, pixels, x, y, inner):
    """Of water among the pixels over an object's plan, drawn in by some m, and beyond it."""
    to_item = np.array(item.matrix_world.inverted())
    # what is seen of the rim from above; a hull that heels is a little narrower
    u, v = (to_item[row, 0] * x + to_item[row, 1] * y + to_item[row, 3] for row in (0, 1))
    within = np.hypot(u / (0.9 * LENGTH / 2 - inner), v / (0.9 * BEAM / 2 - inner)) < 1.0
    beyond = np.hypot(u / (LENGTH / 2 + 1.5), v / (BEAM / 2 + 1.5)) > 1.0
    is_water = pixels[..., 2] > 0.5
    return is_water[within].mean(), is_water[beyond].mean()


def cut(*items, **settings):
    for item in items:
        item.select_set(True)
    return bpy.ops.object.ocean_tweak_cut_out(**settings)


def test_a_hull_is_dry_at_24_frames_of_a_storm(water, new_boat, select, seen_from_above, empty_scene, capfd):
    boat = new_boat()
    select(boat)
    assert bpy.ops.object.ocean_tweak_float(ride="SHIP", use_contact=False) == {"FINISHED"}
    empty_scene.frame_set(3)
    wet, sea = shares(boat, *seen_from_above(boat), 0.0)
    assert wet > 0.2  # there was water in it
    assert sea > 0.99
    assert cut() == {"FINISHED"}
    cell = water.ocean_tweak.domain_size / water.ocean_tweak.resolution
    for frame in range(1, 48, 2):
        empty_scene.frame_set(frame)
        dry, sea = shares(boat, *seen_from_above(boat), min(cell, 0.5))
        assert dry == 0.0, frame
        assert sea > 0.99
    assert "ependency cycle" not in "".join(capfd.readouterr())


def test_the_hole_is_the_waterline(water, new_boat, select, seen_from_above):
    """An ellipse of 0.9 of the rim's half axes about the boat's origin, in calm water."""
    water.ocean_tweak.layers[0].wind_speed = 0.5
    boat = new_boat(location=(25.0, 40.0, water.location.z))
    select(boat)
    assert cut() == {"FINISHED"}
    boat.visible_camera = False
    pixels, x, y = seen_from_above(boat)
    hole = pixels[..., 2] < 0.5
    to_item = np.array(boat.matrix_world.inverted())
    u, v = (to_item[row, 0] * x + to_item[row, 1] * y + to_item[row, 3] for row in (0, 1))
    np.testing.assert_allclose((u[hole].mean(), v[hole].mean()), 0.0, atol=0.1)
    area = math.pi / 4 * 0.9 * LENGTH * 0.9 * BEAM
    assert hole.sum() * (WIDTH / PIXELS) ** 2 == pytest.approx(area, rel=0.05)


def test_eevee_cuts_it_too(water, new_boat, select, seen_from_above, empty_scene):
    boat = new_boat()
    select(boat)
    bpy.ops.object.ocean_tweak_float(ride="SHIP", use_contact=False)
    cut()
    empty_scene.frame_set(5)
    for engine in EEVEE_NAMES:
        with contextlib.suppress(TypeError):  # the name in another version
            empty_scene.render.engine = engine
    empty_scene.eevee.taa_render_samples = 1
    dry, sea = shares(boat, *seen_from_above(boat), 0.5)
    assert dry == 0.0
    assert sea > 0.99


def hulls(ocean):
    """The objects that are cut out of the ocean's material, in order."""
    nodes = ocean.material_slots[0].material.node_tree.nodes
    return [node.object for node in nodes if node.type == "TEX_COORD"]


def test_copies_are_cut_out_and_what_is_deleted_leaves_nothing(water, new_boat, select, empty_scene):
    nodes = water.material_slots[0].material.node_tree.nodes
    before = {node.name for node in nodes}
    boat = new_boat()
    select(boat)
    cut()
    assert hulls(water) == [boat]
    copy = boat.copy()
    empty_scene.collection.objects.link(copy)
    bpy.context.view_layer.update()
    assert hulls(water) == [boat, copy]
    select(boat)
    bpy.ops.object.delete()
    bpy.context.view_layer.update()
    assert hulls(water) == [copy]
    select(copy)
    assert cut(use_cut=False) == {"FINISHED"}
    assert {node.name for node in nodes} == before
    assert nodes[0].outputs[0].links[0].to_node == nodes[1]


def test_letting_water_in_leaves_no_image(water, new_boat, select):
    select(new_boat())
    for _ in range(2):  # cut out anew, it has a new plan
        cut()
        assert [image.name for image in bpy.data.images if "Hull" in image.name] == ["Boat Hull"]
    cut(use_cut=False)
    assert not [image for image in bpy.data.images if "Hull" in image.name]


def test_a_deleted_ocean_lets_go(extension, water, new_boat, select, empty_scene):
    boat = new_boat()
    select(boat)
    cut()
    select(water)
    bpy.ops.object.delete()
    bpy.context.view_layer.update()
    assert not extension("scene.hull_cut").is_cut(boat)


def test_a_file_without_the_extension_keeps_it_cut(
    extension, water, new_boat, select, seen_from_above, empty_scene, tmp_path
):
    boat = new_boat()
    select(boat)
    cut()
    file = str(tmp_path / "boat.blend")
    bpy.ops.wm.save_as_mainfile(filepath=file)
    with extension("scene.handlers").asleep():
        bpy.ops.wm.open_mainfile(filepath=file)
        image = bpy.data.images["Boat Hull"]
        assert image.packed_file
        assert image.is_float
        cells = np.array(image.pixels[:]).reshape(-1, 4)
        assert cells.min() == 0.0  # inside
        assert cells.max() == 1.0
        assert hulls(bpy.data.objects["Ocean"]) == [bpy.data.objects["Boat"]]
        dry, sea = shares(bpy.data.objects["Boat"], *seen_from_above(bpy.data.objects["Boat"]), 0.5)
    assert dry == 0.0
    assert sea > 0.99


def test_a_scaled_tilted_hull_with_a_deck(water, new_boat, select, seen_from_above, empty_scene):
    """From a program with y upwards, half as large; a crest stands on the deck of a decked one."""
    from mathutils import Matrix

    boat = new_boat(is_decked=True)
    boat.data.transform(Matrix.Rotation(-math.pi / 2, 4, "X") @ Matrix.Scale(2.0, 4))
    boat.rotation_euler, boat.scale = (math.pi / 2, 0.0, 0.4), (0.5, 0.5, 0.5)
    bpy.context.view_layer.update()
    select(boat)
    cut()
    empty_scene.frame_set(1)
    water.scale.z = 1e-3  # calm
    water.location.z = 0.0
    boat.location.z = 0.6
    bpy.context.view_layer.update()
    place = hulls(water)
    assert place == [boat]
    boat.visible_camera = False
    pixels, x, y = seen_from_above(boat)
    flat = boat.matrix_world.translation
    u = (x - flat.x) * math.cos(0.4) + (y - flat.y) * math.sin(0.4)
    v = (y - flat.y) * math.cos(0.4) - (x - flat.x) * math.sin(0.4)
    # 0.6 m below its middle: from 0.7 to 0.9 of the rim over half its depth
    part = 0.9 - 0.2 * 0.6 / (DEPTH / 2)
    inside = np.hypot(u / (part * LENGTH / 2), v / (part * BEAM / 2))
    is_water = pixels[..., 2] > 0.5
    assert not is_water[inside < 0.95].any()
    assert is_water[inside > 1.05].all()
    boat.location.z = -2.0  # under water, which is above the deck
    bpy.context.view_layer.update()
    assert (seen_from_above(boat)[0][..., 2] > 0.5).all()


def test_what_encloses_nothing_and_linked_things_are_refused(water, select, empty_scene):
    mesh = bpy.data.meshes.new("Raft")
    mesh.from_pydata([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [], [(0, 1, 2, 3)])
    raft, empty = bpy.data.objects.new("Raft", mesh), bpy.data.objects.new("Empty", None)
    for item in (raft, empty):
        empty_scene.collection.objects.link(item)
    for item, text in (
        (raft, "Raft cannot be cut out of the water: the hull encloses nothing"),
        (empty, "no faces"),
    ):
        select(item)
        with pytest.raises(RuntimeError, match=text):
            cut()
    assert hulls(water) == []


def test_what_is_above_the_water_is_told_and_cut_out_when_it_comes_down(
    water, new_boat, select, seen_from_above, capfd
):
    boat = new_boat(location=(25.0, 40.0, 30.0))
    select(boat)
    assert cut() == {"FINISHED"}
    assert "does not cut Boat" in "".join(capfd.readouterr())
    boat.location.z = water.location.z
    bpy.context.view_layer.update()
    dry, _ = shares(boat, *seen_from_above(boat), 0.5)
    assert dry == 0.0


def test_a_box_in_the_water_is_not_told_to_go_there(water, select, empty_scene, capfd):
    """Four of its edges pass the surface, too few for the shape of a waterline."""
    box = new_hull(empty_scene, "Box")
    box.location.z = water.location.z
    select(box)
    assert cut() == {"FINISHED"}
    assert "does not cut" not in "".join(capfd.readouterr())


def test_undo_and_redo(extension, water, new_boat, select, window):
    cuts = extension("scene.hull_cut")
    select(new_boat())
    with window.override():
        bpy.ops.ed.undo_push(message="before")
        cut()
        bpy.ops.ed.undo_push(message="cut")
        bpy.ops.ed.undo()
        boat, sea = (bpy.data.objects[name] for name in ("Boat", "Ocean"))
        assert not cuts.is_cut(boat)
        assert hulls(sea) == []
        bpy.ops.ed.redo()
        boat, sea = (bpy.data.objects[name] for name in ("Boat", "Ocean"))
        assert cuts.is_cut(boat)
        assert hulls(sea) == [boat]
        assert np.ptp(boat["ocean_tweak_cut_plan"].pixels[:]) == 1.0


def test_an_ocean_without_material_is_told(ocean, new_boat, select, capfd):
    select(new_boat())
    assert cut() == {"FINISHED"}
    assert "has no material" in "".join(capfd.readouterr())


def test_broken_links_are_mended(extension, water, new_boat, select):
    boat = new_boat()
    select(boat)
    cut()
    tree = water.material_slots[0].material.node_tree
    tree.nodes.remove(next(node for node in tree.nodes if node.type == "TEX_IMAGE"))
    extension("scene.hull_cut").refresh()
    assert hulls(water).count(boat) >= 1
    assert len([node for node in tree.nodes if node.type == "TEX_IMAGE"]) == 2


def test_a_hull_that_is_not_rendered_leaves_the_water_whole(
    water, new_boat, select, seen_from_above, empty_scene, capfd
):
    """Keyed too; where only windows hide it, renders go on to cut it out."""
    boat = new_boat()
    select(boat)
    assert cut(boat) == {"FINISHED"}
    hidden, shown = [], []
    boat.hide_viewport = True
    for hides, found in ((True, hidden), (False, shown)):
        boat.hide_render = hides
        pixels, x, y = seen_from_above(boat)
        found.append(shares(boat, pixels, x, y, 0.5)[0])
    boat.hide_viewport = False
    for frame, hides in ((1, False), (5, True)):
        boat.hide_render = hides
        boat.keyframe_insert("hide_render", frame=frame)
    for frame, found in ((1, shown), (5, hidden)):
        empty_scene.frame_set(frame)
        pixels, x, y = seen_from_above(boat)
        found.append(shares(boat, pixels, x, y, 0.5)[0])
    assert hidden == [1.0, 1.0]
    assert shown == [0.0, 0.0]
    assert "Dependency cycle" not in capfd.readouterr().err


def test_a_window_and_a_saved_file_follow_the_visibility_of_their_own(
    extension, water, new_boat, select, empty_scene, tmp_path
):
    boat = new_boat()
    select(boat)
    cut(boat)

    def told(name):
        tree = water.evaluated_get(bpy.context.evaluated_depsgraph_get()).material_slots[0].material.node_tree
        (group,) = [node for node in tree.nodes if name in node.inputs]
        return group.inputs[name].default_value

    for in_render, in_window in ((False, True), (True, False), (True, True)):
        boat.hide_render, boat.hide_viewport = in_render, in_window
        bpy.context.view_layer.update()
        assert (told("Hidden"), told("Hidden In Window")) == (float(in_render), float(in_window))
    assert told("In Window") == 1.0
    file = str(tmp_path / "boat.blend")
    bpy.ops.wm.save_as_mainfile(filepath=file)
    assert told("In Window") == 1.0
    with extension("scene.handlers").asleep():
        bpy.ops.wm.open_mainfile(filepath=file)
        tree = bpy.data.materials["Sea"].node_tree
        (group,) = [node for node in tree.nodes if "In Window" in node.inputs]
        assert group.inputs["In Window"].default_value == 0.0


def test_a_hull_of_parts_is_cut_out_while_any_is_shown(water, new_boat, select, empty_scene):
    boat, tender = new_boat(), new_boat("Tender")
    tender.parent = boat
    select(boat)
    cut(boat)
    tree = water.data.materials[0].node_tree
    told = []
    for hides in ((True, False), (False, True), (True, True)):
        boat.hide_render, tender.hide_render = boat.hide_viewport, tender.hide_viewport = hides
        bpy.context.view_layer.update()
        evaluated = water.evaluated_get(bpy.context.evaluated_depsgraph_get()).material_slots[0].material
        (group,) = [node for node in evaluated.node_tree.nodes if "Hidden" in node.inputs]
        told.append([group.inputs[name].default_value for name in ("Hidden", "Hidden In Window")])
    assert told == [[0.0, 0.0], [0.0, 0.0], [1.0, 1.0]]
    boat.hide_viewport = tender.hide_viewport = False
    select(boat)  # what is hidden is deselected
    assert len(tree.animation_data.drivers) == 1
    bpy.ops.object.ocean_tweak_cut_out(use_cut=False)
    assert not tree.animation_data or not tree.animation_data.drivers


def test_a_hull_of_a_former_file_follows_its_visibility(water, new_boat, select, empty_scene, tmp_path):
    """Its cut has no driver."""
    boat = new_boat()
    select(boat)
    cut()
    water.data.materials[0].node_tree.animation_data_clear()
    file = str(tmp_path / "former.blend")
    bpy.ops.wm.save_as_mainfile(filepath=file)
    bpy.ops.wm.open_mainfile(filepath=file)
    (driver,) = bpy.data.materials["Sea"].node_tree.animation_data.drivers
    assert driver.driver.variables[0].targets[0].id == bpy.data.objects["Boat"]


def test_water_below_a_keel_and_of_a_hull_that_is_gone_is_whole(
    extension, water, new_boat, select, seen_from_above, empty_scene
):
    """A boat in the air cuts nothing; without its object, the water's own coordinates would be its place."""
    empty_scene.frame_set(1)
    boat = new_boat()
    select(boat)
    cut()
    boat.visible_camera = False
    boat.location.z = 40.0
    bpy.context.view_layer.update()
    assert (seen_from_above(boat)[0][..., 2] > 0.5).all()
    tree = water.data.materials[0].node_tree
    (own,) = [node for node in tree.nodes if node.type == "TEX_COORD"]
    water.scale.z = 1e-3
    boat.location.z = water.location.z
    bpy.context.view_layer.update()
    assert not (seen_from_above(boat)[0][..., 2] > 0.5).all()
    boat.location.x, boat.location.y = water.location.x + 4.0, water.location.y + 2.0
    boat.hide_render = True
    bpy.context.view_layer.update()
    whole = (seen_from_above(boat)[0][..., 2] > 0.5).mean()
    boat.hide_render = False
    with extension("scene.handlers").asleep():  # where nobody mends it
        own.object = None
        assert (seen_from_above(boat)[0][..., 2] > 0.5).mean() == pytest.approx(whole, abs=0.002)
