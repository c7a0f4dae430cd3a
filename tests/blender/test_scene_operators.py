# SPDX-License-Identifier: GPL-3.0-or-later
"""A whole scene at one press: what it makes, what it leaves alone, and that undo takes it back."""

import math
import os

import bpy
import numpy as np
import pytest
from bpy_extras.object_utils import world_to_camera_view
from mathutils import Vector


@pytest.fixture
def startup_scene(package):
    """The scene of Blender's own start-up file."""
    bpy.ops.wm.read_homefile(use_factory_startup=True)
    assert sorted(item.name for item in bpy.context.scene.objects) == ["Camera", "Cube", "Light"]
    return bpy.context.scene


def ocean_of(scene):
    return next(item for item in scene.objects if item.ocean_tweak.is_ocean)


def by_name(scene, start):
    return next(item for item in scene.objects if item.name.startswith(start))


@pytest.mark.parametrize("mood", ["CALM", "FRESH_BREEZE"])
def test_everything_is_there(quick, empty_scene, mood):
    assert bpy.ops.ocean.add_scene(mood=mood, engine="CYCLES") == {"FINISHED"}
    ocean, camera = ocean_of(empty_scene), empty_scene.camera
    assert ocean == bpy.context.active_object
    assert ocean.ocean_tweak.error == ""
    assert ocean.active_material.name.startswith("Ocean Tweak Water")
    assert ocean["ocean_tweak_slope_variance"] > 0.0
    assert empty_scene.world is not None
    assert [item.type for item in empty_scene.objects].count("LIGHT") == 1
    assert empty_scene.render.engine == "CYCLES"
    assert empty_scene.render.use_motion_blur
    assert empty_scene.frame_end > empty_scene.frame_start + 100
    # the camera sees the horizon in its frame
    looks = camera.matrix_world.to_quaternion() @ Vector((0.0, 0.0, -1.0))
    half = 0.5 * camera.data.angle_y
    assert abs(np.arcsin(looks.z)) < half
    evaluated = ocean.evaluated_get(bpy.context.evaluated_depsgraph_get())
    names = set(evaluated.data.attributes.keys())
    assert {"displacement", "foam", "st"} <= names


@pytest.mark.parametrize("mood", ["HORIZON", "STORM"])
def test_some_are_seas_of_patches_on_a_camera_surface(quick, empty_scene, mood):
    bpy.ops.ocean.add_scene(mood=mood, engine="CYCLES")
    ocean = ocean_of(empty_scene)
    assert ocean.ocean_tweak.error == ""
    assert len(ocean.ocean_tweak.patches) == 4
    names = [item.name for item in empty_scene.objects]
    assert any("Camera Surface" in name for name in names)
    assert not any(name.endswith("Horizon") for name in names)
    assert ocean.hide_render


@pytest.mark.parametrize("mood", ["CALM", "FRESH_BREEZE", "STORM", "HORIZON"])
def test_the_camera_is_above_the_water_and_sees_the_highest_wave(quick, empty_scene, extension, mood):
    """No other wave is in between, as far as 200 points along the line of sight tell."""
    bpy.ops.ocean.add_scene(mood=mood, engine="CYCLES", use_buoy=False)
    ocean, camera, core = ocean_of(empty_scene), empty_scene.camera, extension("core")
    parameters = ocean.ocean_tweak.to_parameters(empty_scene)
    sea = core.Ocean(parameters)
    place = np.array(camera.location - ocean.location)
    own = sea.height_at(place[0], place[1], 0.0)
    assert 0.5 * quick[mood].eye < place[2] - own < 2.0 * quick[mood].eye
    surface = sea.surface(0.0).displacement
    row, column = divmod(int(surface[..., 2].argmax()), len(surface))
    spacing = parameters.domain_size / len(surface)
    crest = spacing * np.array([column, row, 0]) + surface[row, column]
    # the nearest of its repetitions
    crest[:2] = (
        place[:2]
        + np.remainder(crest[:2] - place[:2] + 0.5 * parameters.domain_size, parameters.domain_size)
        - 0.5 * parameters.domain_size
    )
    seen = crest - place
    assert seen[1] > 0.0
    assert abs(seen[0]) < np.tan(0.5 * camera.data.angle_x) * seen[1]
    way = np.linspace(0.05, 0.6, 200)[:, np.newaxis]  # beyond begins the wave itself
    points = place + way * seen
    water = sea.height_at(points[:, 0], points[:, 1], 0.0)
    assert np.all(points[:, 2] > water)


@pytest.mark.parametrize("cursor", [(0.0, 0.0, 0.0), (30.0, -70.0, 2.0)])
@pytest.mark.parametrize("mood", ["CALM", "FRESH_BREEZE", "STORM", "HORIZON"])
def test_what_is_added_next_is_in_the_picture(quick, empty_scene, extension, mood, cursor):
    """At the 3D cursor, the world's origin by default: near the middle of a picture as low as films have,
    on the water in the first frame, and with what lies on the water there not behind a wave."""
    empty_scene.cursor.location = cursor
    bpy.ops.ocean.add_scene(mood=mood, engine="CYCLES")
    ocean, camera, render = ocean_of(empty_scene), empty_scene.camera, empty_scene.render
    render.resolution_x, render.resolution_y = 1280, 540
    bpy.context.view_layer.update()
    x, y, depth = world_to_camera_view(empty_scene, camera, Vector(cursor))
    assert 0.3 < x < 0.7
    assert 0.02 < y < 0.98
    assert depth > 0.0
    parameters = ocean.ocean_tweak.to_parameters(empty_scene)
    sea = extension("core").Ocean(parameters)
    wave_height = sea.statistics().seed.significant_wave_height
    eye, point = (np.array(place) - np.array(ocean.location) for place in (camera.location, cursor))
    water = float(sea.height_at(*point[:2], 0.0))
    assert abs(water) < 0.5 * wave_height
    way = np.linspace(0.02, 0.98, 200)[:, np.newaxis]
    line = eye + way * ((*point[:2], max(water, 0.0)) - eye)
    assert np.all(line[:, 2] > sea.height_at(*line.T[:2], 0.0) - 0.05 * wave_height)
    assert point[:2].min() >= 0.0
    assert point[:2].max() <= parameters.domain_size


@pytest.mark.skipif("OCEAN_TWEAK_LONG_TESTS" not in os.environ, reason="EEVEE on a processor takes a minute")
def test_both_engines_see_a_storm_as_bright(quick, empty_scene, tmp_path):
    seen = []
    for engine in ("CYCLES", "EEVEE"):
        bpy.ops.ocean.add_scene(mood="STORM", engine=engine, use_buoy=False, use_new_scene=True)
        scene = bpy.context.scene
        scene.render.resolution_x, scene.render.resolution_y = 96, 40
        scene.render.use_motion_blur = False
        scene.cycles.samples = scene.eevee.taa_render_samples = 16
        scene.cycles.device, scene.cycles.use_denoising = "CPU", False
        scene.render.image_settings.file_format = "OPEN_EXR"
        scene.render.filepath = str(tmp_path / f"{engine}.exr")
        bpy.ops.render.render(write_still=True, scene=scene.name)
        image = bpy.data.images.load(scene.render.filepath)
        pixels = np.empty(4 * 96 * 40, np.float32)
        image.pixels.foreach_get(pixels)
        seen.append(float(pixels.reshape(-1, 4)[:, :3].mean()))
    assert seen[1] == pytest.approx(seen[0], rel=0.15)
    assert seen[0] > 0.02


@pytest.mark.parametrize("mood", ["FRESH_BREEZE", "STORM"])
def test_no_wave_goes_over_the_camera(quick, empty_scene, extension, mood):
    bpy.ops.ocean.add_scene(mood=mood, engine="CYCLES", use_buoy=False)
    ocean, camera = ocean_of(empty_scene), empty_scene.camera
    sea = extension("core").Ocean(ocean.ocean_tweak.to_parameters(empty_scene))
    x, y = (camera.location - ocean.location)[:2]
    above = []
    for frame in range(1, 241, 7):
        empty_scene.frame_set(frame)
        above.append(camera.matrix_world.translation.z - float(sea.height_at(x, y, (frame - 1) / 24)))
    assert min(above) > 0.2 * quick[mood].eye
    assert max(above) < 2.0 * quick[mood].eye


def test_the_buoy_floats(quick, empty_scene):
    bpy.ops.ocean.add_scene(mood="FRESH_BREEZE")
    buoy = by_name(empty_scene, "Buoy")
    heights = []
    for frame in (1, 20, 40):
        empty_scene.frame_set(frame)
        heights.append(buoy.evaluated_get(bpy.context.evaluated_depsgraph_get()).matrix_world.translation.z)
    assert np.ptp(heights) > 0.1
    assert max(np.abs(heights)) < 3.0
    mesh = buoy.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    wet = np.array([each.value for each in mesh.attributes["wet"].data])
    heights = np.array([vertex.co.z for vertex in mesh.vertices])
    assert wet[heights < -1.0].min() > 1.0  # below the water
    assert wet[heights > 2.0].max() < 0.0
    labels = {node.label for node in ocean_of(empty_scene).material_slots[0].material.node_tree.nodes}
    assert "Buoy Collar" in labels


def test_copies_and_flat_water_reach_the_horizon(quick, empty_scene):
    bpy.ops.ocean.add_scene(mood="FRESH_BREEZE", use_buoy=False)
    horizon, ocean = by_name(empty_scene, "Ocean Horizon"), ocean_of(empty_scene)
    horizon.modifiers[0].show_viewport = True
    evaluated = horizon.evaluated_get(bpy.context.evaluated_depsgraph_get())
    corners = np.array([vertex.co for vertex in evaluated.data.vertices])
    assert np.abs(corners).max() == pytest.approx(30e3)
    assert len(evaluated.data.polygons) == 8
    # with a ring of copies in the viewport, the hole is three times as wide as the ocean
    inner = corners[np.abs(corners).max(axis=1) < 20e3]
    np.testing.assert_allclose(
        [inner.min(axis=0), inner.max(axis=0)], [(-400, -400, 0), (800, 800, 0)], atol=1e-2
    )
    assert all(polygon.normal.z > 0.99 for polygon in evaluated.data.polygons)
    used = {evaluated.data.materials[polygon.material_index].name for polygon in evaluated.data.polygons}
    assert used == {ocean.active_material.name}


def test_the_horizon_follows_the_ocean(extension, quick, empty_scene):
    """It has all the waves as roughness, the ocean only those that its mesh cannot hold."""
    bpy.ops.ocean.add_scene(mood="FRESH_BREEZE", use_buoy=False)
    horizon, ocean = by_name(empty_scene, "Ocean Horizon"), ocean_of(empty_scene)
    assert horizon["ocean_tweak_slope_variance"] > ocean["ocean_tweak_slope_variance"]
    before = horizon["ocean_tweak_slope_variance"]
    sea = ocean.ocean_tweak.to_parameters(empty_scene)
    calmer = sea.replace(layers=(extension("core").WaveLayer(wind_speed=4.0),), domain_size=300.0)
    extension("scene.water_material").describe(ocean, calmer, empty_scene)
    assert horizon["ocean_tweak_slope_variance"] < before
    assert horizon["ocean_tweak_domain_size"] == ocean["ocean_tweak_domain_size"] == 300.0


def test_what_a_scene_has_stays(quick, empty_scene):
    camera = bpy.data.objects.new("Mine", bpy.data.cameras.new("Mine"))
    empty_scene.collection.objects.link(camera)
    empty_scene.camera, empty_scene.world = camera, bpy.data.worlds.new("My World")
    if empty_scene.world.node_tree is None:
        empty_scene.world.use_nodes = True
    background = next(node for node in empty_scene.world.node_tree.nodes if node.type == "BACKGROUND")
    background.inputs[0].default_value = (0.9, 0.2, 0.1, 1.0)
    empty_scene.frame_end = 77
    bpy.ops.ocean.add_scene(mood="CALM")
    assert empty_scene.camera == camera
    assert empty_scene.world.name == "My World"
    assert empty_scene.frame_end == 77
    bpy.ops.ocean.add_scene(mood="CALM", use_new_camera=True, use_new_world=True)
    assert empty_scene.camera != camera
    assert empty_scene.world.name == "Calm Sky"
    assert "My World" in bpy.data.worlds


@pytest.mark.parametrize("gone", [(), ("Cube",), ("Camera", "Light")])
def test_what_the_startup_file_brought_goes(quick, startup_scene, gone, capfd):
    left = [name for name in ("Camera", "Cube", "Light") if name not in gone]
    for name in gone:
        bpy.data.objects.remove(bpy.data.objects[name])
    bpy.ops.ocean.add_scene(mood="CALM", use_buoy=False)
    assert not set(left) & {item.name for item in startup_scene.objects}
    for name, blocks in (("Cube", bpy.data.meshes), ("Light", bpy.data.lights), ("Camera", bpy.data.cameras)):
        assert (name in blocks) == (name in gone)  # what was there before without a user is not ours
    assert startup_scene.camera.name == "Ocean Camera"
    assert startup_scene.world.name == "Calm Sky"
    assert startup_scene.frame_end == 240
    (said,) = (line for line in capfd.readouterr().out.splitlines() if "the start-up file's" in line)
    assert all((name in said.partition("the start-up file's")[2]) == (name in left) for name in left)


def on_new_material(cube):
    cube.data.materials[0] = bpy.data.materials.new("Mine")


def on_red_material(cube):
    nodes = cube.data.materials[0].node_tree.nodes
    nodes["Principled BSDF"].inputs["Base Color"].default_value = (1.0, 0.0, 0.0, 1.0)


TOUCHES = {
    "moved cube": lambda o: setattr(o["Cube"], "location", (0.0, 0.0, 3.0)),
    "scaled cube": lambda o: setattr(o["Cube"], "scale", (0.5, 0.5, 0.5)),
    "renamed cube": lambda o: setattr(o["Cube"], "name", "Ship"),
    "edited cube": lambda o: setattr(o["Cube"].data.vertices[0], "co", (1.0, 1.0, 2.0)),
    "subdivided cube": lambda o: o["Cube"].modifiers.new("Smooth", "SUBSURF"),
    "keyed cube": lambda o: o["Cube"].keyframe_insert("location", frame=1),
    "cube of another material": lambda o: on_new_material(o["Cube"]),
    "red cube": lambda o: on_red_material(o["Cube"]),
    "moved camera": lambda o: setattr(o["Camera"], "location", (0.0, -5.0, 3.0)),
    "turned camera": lambda o: setattr(o["Camera"], "rotation_euler", (1.2, 0.0, 0.8)),
    "longer lens": lambda o: setattr(o["Camera"].data, "lens", 85.0),
    "brighter light": lambda o: setattr(o["Light"].data, "energy", 500.0),
    "another object": lambda o: bpy.ops.mesh.primitive_cone_add(),
}


def test_a_changed_scene_is_somebodys(extension, package):
    untouched_objects = extension("scene.startup_file").untouched_objects
    for name, touch in TOUCHES.items():
        bpy.ops.wm.read_homefile(use_factory_startup=True)
        scene = bpy.context.scene
        assert len(untouched_objects(scene)) == 3
        touch(scene.objects)
        bpy.context.view_layer.update()
        assert untouched_objects(scene) == [], name


def test_what_somebody_changed_stays_and_the_remedy_is_said(quick, startup_scene, capfd):
    startup_scene.objects["Cube"].location.z = 3.0
    before = {item.name: np.array(item.matrix_basis) for item in startup_scene.objects}
    bpy.ops.ocean.add_scene(mood="CALM", use_buoy=False)
    for name, matrix in before.items():
        np.testing.assert_array_equal(np.array(startup_scene.objects[name].matrix_basis), matrix)
    assert startup_scene.camera.name == "Camera"
    assert (
        "the scene looks through Camera: to see the sea, select Ocean Camera and press Ctrl Numpad 0"
        in capfd.readouterr().out
    )


def test_undo_brings_the_startup_file_back(quick, startup_scene, window):
    with window.override():
        bpy.ops.ed.undo_push(message="Before")
        bpy.ops.ocean.add_scene(mood="CALM")
        bpy.ops.ed.undo_push(message="Ocean Scene")
        bpy.ops.ed.undo()
    scene = bpy.context.scene
    assert sorted(item.name for item in scene.objects) == ["Camera", "Cube", "Light"]
    assert scene.camera.name == "Camera"
    assert [material.name for material in scene.objects["Cube"].data.materials] == ["Material"]
    assert scene.world.name == "World"


def test_a_scene_of_its_own_leaves_the_old_one_alone(quick, empty_scene):
    empty_scene.unit_settings.scale_length = 0.5
    before = (empty_scene.render.engine, empty_scene.render.use_motion_blur, len(empty_scene.objects))
    bpy.ops.ocean.add_scene(mood="CALM", use_new_scene=True)
    assert (empty_scene.render.engine, empty_scene.render.use_motion_blur, len(empty_scene.objects)) == before
    made = next(scene for scene in bpy.data.scenes if scene != empty_scene)
    assert made.camera is not None
    assert made.unit_settings.scale_length == 0.5


def test_eevee_by_the_name_of_this_version(quick, empty_scene):
    bpy.ops.ocean.add_scene(mood="CALM", engine="EEVEE")
    assert empty_scene.render.engine in ("BLENDER_EEVEE", "BLENDER_EEVEE_NEXT")


def test_in_centimetres_everything_is_a_hundred_times_as_large(quick, empty_scene):
    empty_scene.unit_settings.scale_length = 0.01
    bpy.ops.ocean.add_scene(mood="FRESH_BREEZE")
    ocean, buoy = ocean_of(empty_scene), by_name(empty_scene, "Buoy")
    ahead = world_to_camera_view(empty_scene, empty_scene.camera, Vector())
    assert ahead.z > 500.0  # the world's origin is before the camera, metres away
    assert 0.0 < ahead.y < 1.0
    assert ocean["ocean_tweak_metres_per_unit"] == pytest.approx(0.01)
    assert ocean["ocean_tweak_domain_size"] == pytest.approx(400.0)
    assert buoy.dimensions.x == pytest.approx(220.0, rel=1e-3)
    assert 200.0 < empty_scene.camera.location.z < 1000.0


def test_undo_takes_it_back(quick, empty_scene, window):
    with window.override():
        bpy.ops.ed.undo_push(message="Before")
        bpy.ops.ocean.add_scene(mood="CALM")
        bpy.ops.ed.undo_push(message="Ocean Scene")  # a window does this for operators with UNDO
        assert len(bpy.context.scene.objects) > 4
        bpy.ops.ed.undo()
        assert not bpy.context.scene.objects
        assert bpy.context.scene.camera is None
    assert "UNDO" in bpy.types.OCEAN_OT_add_scene.bl_options


def test_water_for_an_ocean(quick, ocean_object, make_parameters, empty_scene):
    assert not bpy.ops.ocean.use_water_material.poll()
    item = ocean_object.add(empty_scene, make_parameters())
    bpy.context.view_layer.objects.active = item
    assert bpy.ops.ocean.use_water_material(water="COASTAL") == {"FINISHED"}
    assert item.active_material.name == "Ocean Tweak Water Coastal"
    assert item["ocean_tweak_domain_size"] == 150.0
    bpy.ops.ocean.use_water_material(water="OCEANIC")
    assert [slot.material.name for slot in item.material_slots] == ["Ocean Tweak Water"]


def test_an_unknown_mood_is_refused(extension, empty_scene):
    stage = extension("scene.surroundings")
    with pytest.raises(ValueError, match="mood = 'HAPPY'"):
        stage.build(empty_scene, "HAPPY", stage.Wishes())
    assert not empty_scene.objects


def luminance_of(file):
    """(rows, columns) 0…1 of a picture as it is shown, row 0 at its top; and its (…, 3) colours."""
    image = bpy.data.images.load(str(file))
    columns, rows = image.size
    pixels = np.empty(4 * columns * rows, np.float32)
    image.pixels.foreach_get(pixels)
    colours = pixels.reshape(rows, columns, 4)[::-1, :, :3]
    return colours @ np.array([0.2126, 0.7152, 0.0722], np.float32), colours


def test_the_first_picture_is_a_sea(startup_scene, tmp_path):
    """Start-up file, Ocean Scene, F12: sky above, sea below, the horizon where the camera's tilt puts it."""
    bpy.ops.ocean.add_scene()
    render, cycles, camera = startup_scene.render, startup_scene.cycles, startup_scene.camera
    render.resolution_x, render.resolution_y, render.filepath = 160, 90, str(tmp_path / "first.png")
    cycles.samples, cycles.seed, cycles.device, cycles.use_denoising = 4, 1, "CPU", False
    bpy.ops.render.render(write_still=True)
    shown, colours = luminance_of(tmp_path / "first.png")

    tilt = 0.5 * math.pi - camera.rotation_euler.x
    horizon = 90.0 * (0.5 - 0.5 * math.tan(tilt) / math.tan(0.5 * camera.data.angle_y))
    sky, sea = shown[: int(horizon) - 2], shown[int(horizon) + 3 :]
    assert 0.4 < sky.mean() < 0.85
    assert 0.05 < sea.mean() < 0.4
    # in each column, from the top, the first row that is darker than midway between the two
    begins = (shown < 0.5 * (sky[-8:].mean() + sea.mean())).argmax(axis=0)
    thirds = [np.median(part) for part in np.array_split(begins, 3)]
    assert thirds == pytest.approx([horizon] * 3, abs=1.5)
    # waves, not a plane: what neighbours 4 pixels apart differ by; and neither black nor burnt out
    assert np.abs(sea[:, 4:] - sea[:, :-4]).mean() > 0.02
    assert np.mean(shown < 0.02) < 0.01
    assert np.mean(shown > 0.97) < 0.01
    below = colours[int(horizon) + 3 :]
    assert np.mean(below[..., 2] > below[..., 0] + 0.02) > 0.85, "the sea is not blue"
