# SPDX-License-Identifier: GPL-3.0-or-later
"""The water material against Fresnel's formula, the two-flow model and arithmetic, in rendered pixels."""

import math

import bpy
import numpy as np
import pytest

SIDE = 16  # pixels


@pytest.fixture
def water(extension):
    return extension("scene.water_material")


@pytest.fixture
def sea(empty_scene, water):
    """A flat square under a white sky, with the water material; without foam, ripples and haze."""
    mesh = bpy.data.meshes.new("Flat")
    mesh.from_pydata([(-500, -500, 0), (500, -500, 0), (500, 500, 0), (-500, 500, 0)], [], [(0, 1, 2, 3)])
    item = bpy.data.objects.new("Flat", mesh)
    empty_scene.collection.objects.link(item)
    material = water.water_material()
    water.assign(item, material)
    world = bpy.data.worlds.new("White")
    if world.node_tree is None:
        world.use_nodes = True
    background = next(node for node in world.node_tree.nodes if node.type == "BACKGROUND")
    background.inputs[0].default_value = (1.0, 1.0, 1.0, 1.0)
    empty_scene.world = world
    return item


@pytest.fixture
def inputs(sea):
    """The group's inputs, black water at first."""
    material = sea.active_material
    group = next(node for node in material.node_tree.nodes if node.type == "GROUP")
    group.inputs["Absorption"].default_value = (1e3, 1e3, 1e3, 1.0)
    group.inputs["Backscatter"].default_value = (0.0, 0.0, 0.0, 1.0)
    group.inputs["Gusts"].default_value = 0.0
    return group.inputs


@pytest.fixture
def seen(sea, empty_scene, tmp_path):
    """Mean linear colour of the water, seen at an angle in degrees from straight down."""
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.data.type, camera.data.ortho_scale = "ORTHO", 1.0
    empty_scene.collection.objects.link(camera)
    empty_scene.camera = camera
    empty_scene.render.engine = "CYCLES"
    empty_scene.cycles.device = "CPU"
    empty_scene.cycles.samples = 32
    empty_scene.cycles.use_denoising = False
    empty_scene.render.resolution_x = empty_scene.render.resolution_y = SIDE
    empty_scene.view_settings.view_transform = "Raw"
    empty_scene.render.image_settings.file_format = "OPEN_EXR"
    empty_scene.render.filepath = str(tmp_path / "seen.exr")

    def colour(angle=0.0, place=(0.0, 0.0)):
        camera.location = (
            place[0], place[1] - 50.0 * math.sin(math.radians(angle)), 50.0 * math.cos(math.radians(angle))
        )  # fmt: skip
        camera.rotation_euler = (math.radians(angle), 0.0, 0.0)
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(empty_scene.render.filepath)
        pixels = np.empty(4 * SIDE * SIDE, np.float32)
        image.pixels.foreach_get(pixels)
        bpy.data.images.remove(image)
        assert np.isfinite(pixels).all()
        return pixels.reshape(-1, 4)[:, :3].astype(np.float64).mean(axis=0)

    return colour


def fresnel(angle, n=1.333):
    """Unpolarised reflectance of a flat dielectric, Fresnel (1823)."""
    before = math.radians(angle)
    below = math.asin(math.sin(before) / n)
    across = (math.cos(before) - n * math.cos(below)) / (math.cos(before) + n * math.cos(below))
    along = (math.cos(below) - n * math.cos(before)) / (math.cos(below) + n * math.cos(before))
    return 0.5 * (across**2 + along**2)


def leaving(absorption, backscatter, depth=math.inf, bottom=0.0, returned=0.47):
    """What of the two-flow reflectance leaves the water."""
    deep = 0.33 * backscatter / (absorption + backscatter)
    below = deep + (bottom - deep) * math.exp(-2.0 * (absorption + backscatter) * depth)
    return (1.0 - returned) * below / (1.0 - returned * below)


def set_property(item, name, value):
    item[name] = value
    item.update_tag()


def add_foam(item, amount):
    attribute = item.data.attributes.get("foam") or item.data.attributes.new("foam", "FLOAT", "POINT")
    attribute.data.foreach_set("value", np.full(4, amount, np.float32))
    item.data.update()


def test_no_link_is_broken(sea):
    trees = [sea.active_material.node_tree, *bpy.data.node_groups]
    assert all(link.is_valid for tree in trees for link in tree.links)
    assert not [node.name for tree in trees for node in tree.nodes if node.bl_idname == "NodeUndefined"]


@pytest.mark.parametrize("angle", [0.0, 45.0, 70.0, 80.0, 86.0])
def test_black_water_reflects_by_fresnel(inputs, seen, angle):
    assert seen(angle) == pytest.approx(np.full(3, fresnel(angle)), rel=0.04)


def test_rough_water_reflects_less_at_grazing_angles_and_no_less_from_above(inputs, sea, seen):
    flat, flat_above = seen(85.0)[0], seen(0.0)[0]
    set_property(sea, "ocean_tweak_slope_variance", 0.04)
    inputs["Ripples"].default_value = 0.0
    assert seen(85.0)[0] < 0.75 * flat
    assert seen(0.0)[0] == pytest.approx(flat_above, rel=0.15)


@pytest.mark.parametrize(
    ("absorption", "backscatter", "depth"),
    [(0.5, 0.5, 1e4), (0.05, 0.02, 1e4), (0.1, 0.0, 3.0), (0.02, 0.01, 9.0)],
)
def test_light_from_below_is_that_of_the_two_flow_model(inputs, seen, absorption, backscatter, depth):
    inputs["Absorption"].default_value = (absorption, 1e3, absorption, 1.0)
    inputs["Backscatter"].default_value = (backscatter, 0.0, backscatter, 1.0)
    inputs["Bottom Color"].default_value = (0.4, 0.4, 0.8, 1.0)
    inputs["Water Depth"].default_value = depth
    surface = fresnel(0.0)
    expected = [leaving(absorption, backscatter, depth, bottom) for bottom in (0.4, 0.4, 0.8)]
    expected[1] = 0.0
    shown = (seen() - surface) / (1.0 - surface)
    np.testing.assert_allclose(shown, expected, rtol=0.05, atol=2e-3)


def test_depth_is_the_ocean_s_own_unless_given(inputs, sea, seen):
    inputs["Absorption"].default_value = (0.1, 0.1, 0.1, 1.0)
    inputs["Bottom Color"].default_value = (0.5, 0.5, 0.5, 1.0)
    deep = seen()[0]
    set_property(sea, "ocean_tweak_water_depth", 1.0)
    shallow = seen()[0]
    assert shallow > deep + 0.1
    inputs["Water Depth"].default_value = 50.0
    assert seen()[0] == pytest.approx(deep, abs=2e-3)


def test_foam_is_bright_and_half_the_foam_covers_half(inputs, sea, seen, empty_scene):
    inputs["Bubbles"].default_value = 0.0
    empty_scene.camera.data.ortho_scale = 100.0
    none = seen()[0]
    levels = []
    for amount in (0.25, 0.5, 1.0):
        add_foam(sea, amount)
        levels.append(seen()[0])
    assert none < levels[0] < levels[1] < levels[2]
    assert levels[2] > 0.6
    assert (levels[1] - none) / (levels[2] - none) == pytest.approx(0.55, abs=0.17)


def test_haze_hides_far_water(inputs, seen):
    inputs["Haze Color"].default_value = (0.5, 0.25, 0.0, 1.0)
    bare = seen()
    inputs["Visibility"].default_value = 50.0  # the camera's distance: a fiftieth of the contrast is left
    np.testing.assert_allclose(seen(), 0.98 * np.array([0.5, 0.25, 0.0]) + 0.02 * bare, atol=2e-3)


@pytest.mark.parametrize("tilt", [0.0, 2.0, 15.0])
def test_a_ripple_that_mirrors_the_next_one_shows_the_sky_by_way_of_it(inputs, seen, tilt):
    """Seen from 10° above the horizon, one that leans away by 15° mirrors what is 20° below it: water, which
    mirrors the sky 20° above. The light turns by 30°, as at an angle of incidence of 75°; less of it is left.
    """
    inputs["Normal Map"].default_value = 0.0, math.sin(math.radians(tilt)), math.cos(math.radians(tilt))
    incidence, share = (80.0 + tilt, 1.0) if tilt < 5.0 else (75.0, 0.4)
    root = math.sqrt(share * fresnel(0.0))
    assert seen(80.0)[0] == pytest.approx(fresnel(incidence, (1.0 + root) / (1.0 - root)), rel=0.06)


@pytest.mark.parametrize(("angle", "shown"), [(30.0, True), (70.0, False)])
def test_from_below_the_sky_is_seen_through_a_round_window(inputs, sea, seen, empty_scene, angle, shown):
    """Snell's: up to 48.6° from the normal for water of 1.333; beyond it the surface mirrors the deep."""
    sea.rotation_euler.x = tilt = math.radians(-10.0)
    world = empty_scene.world.node_tree
    direction = world.nodes.new("ShaderNodeTexCoord").outputs["Generated"]
    up = world.nodes.new("ShaderNodeSeparateXYZ")
    is_up = world.nodes.new("ShaderNodeMath")
    is_up.operation, is_up.inputs[1].default_value = "GREATER_THAN", 0.0
    background = next(node for node in world.nodes if node.type == "BACKGROUND")
    world.links.new(direction, up.inputs[0])
    world.links.new(up.outputs["Z"], is_up.inputs[0])
    world.links.new(is_up.outputs[0], background.inputs["Strength"])
    inputs["Transmission"].default_value = 1.0
    within = math.radians(angle) + tilt
    light = 1.0 - fresnel(math.degrees(math.asin(1.333 * math.sin(within)))) if shown else 0.0
    assert seen(180.0 - angle)[0] == pytest.approx(light, abs=0.06)


def test_a_normal_image_turns_the_surface(inputs, sea, seen):
    """Tilted away by 15°, water seen at 45° reflects as at 60°."""
    tilted = bpy.data.images.new("Normals", 4, 4, float_buffer=True, is_data=True)
    normal = (0.0, math.sin(math.radians(15.0)), math.cos(math.radians(15.0)), 1.0)
    tilted.pixels.foreach_set(np.tile(np.array(normal, np.float32), 16))
    tree = sea.active_material.node_tree
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image = tilted
    group = next(node for node in tree.nodes if node.type == "GROUP")
    tree.links.new(texture.outputs[0], group.inputs["Normal Map"])
    assert seen(45.0)[0] == pytest.approx(fresnel(60.0), rel=0.04)


def glow(inputs, seen, sun=(8.0, 8.0, 8.0)):
    """What the sun adds at a crest that leans towards the camera, in red, green and blue."""
    inputs["Sun Light"].default_value = (0.0, 0.0, 0.0, 1.0)
    without = seen(80.0)
    inputs["Sun Light"].default_value = (*sun, 1.0)
    return seen(80.0) - without


def left_in_wedge(absorption, longest):
    """What ways up to the longest, in m, leave of light in the mean, by Beer and Lambert."""
    way = (np.arange(1000) + 0.5) / 1000 * longest
    return np.exp(-np.outer(way, absorption)).mean(axis=0)


@pytest.fixture
def sharp_crest(sea, inputs):
    """The square as the front of a sharp crest, which rises by 0.3 away from the camera, along +y."""
    inputs["Absorption"].default_value = (0.345, 0.067, 0.040, 1.0)
    cusp = sea.data.attributes.new("cusp", "FLOAT", "POINT")
    cusp.data.foreach_set("value", np.full(4, 1.0, np.float32))
    for vertex in sea.data.vertices:
        vertex.co.z = 0.3 * vertex.co.y
    return np.array((0.345, 0.067, 0.040))


def test_a_crest_before_a_setting_sun_has_the_sun_s_colour(inputs, seen, sharp_crest):
    """And what water takes from it, which is more red than green; at this sun that leaves no green."""
    inputs["Sun Direction"].default_value = (0.0, math.cos(0.08), math.sin(0.08))
    sun = np.array((3.7, 1.8, 0.4))
    shown = glow(inputs, seen, sun)
    expected = sun * left_in_wedge(sharp_crest, 2.2)
    np.testing.assert_allclose(shown / shown[0], expected / expected[0], rtol=0.03)
    assert shown[0] > shown[1] > shown[2] > 0.0


def test_a_crest_shines_by_how_steeply_the_sun_meets_its_back(inputs, seen, sharp_crest):
    """The back is as steep as the front. Foam, which shines evenly, tells: its light goes as that cosine."""
    del sharp_crest
    inputs["Foam Map"].default_value, shown, expected = 1.0, [], []
    for high in (0.05, 0.15, 0.3):
        inputs["Sun Direction"].default_value = (0.0, math.cos(high), math.sin(high))
        shown.append(glow(inputs, seen)[1])
        # the share of the front that is turned away is the material's own smooth step over slopes
        leaning = math.sin(math.atan(0.3)) * math.cos(high)
        part = (leaning - 0.05) / 0.40
        expected.append(part * part * (3.0 - 2.0 * part) * math.sin(math.atan(0.3) + high))
    np.testing.assert_allclose(np.divide(shown, shown[0]), np.divide(expected, expected[0]), rtol=0.05)
    assert shown[0] < shown[1] < shown[2]


def test_crests_before_a_low_sun_shine_green(inputs, sea, seen):
    """Only sharp ones, only where they stand between the eye and the sun; more green than blue than red."""
    inputs["Absorption"].default_value = (0.40, 0.105, 0.19, 1.0)
    cusp = sea.data.attributes.new("cusp", "FLOAT", "POINT")
    cusp.data.foreach_set("value", np.full(4, 0.27, np.float32))
    # the camera looks along +y: 17° of slope towards it
    for vertex in sea.data.vertices:
        vertex.co.z = 0.3 * vertex.co.y
    inputs["Sun Direction"].default_value = (0.0, 0.98, 0.2)
    red, green, blue = glow(inputs, seen)
    assert green > 1.15 * blue > 1.15**2 * red > 0.0
    assert green > 0.02
    inputs["Sun Direction"].default_value = (0.0, -0.98, 0.2)
    assert glow(inputs, seen).max() < 0.02 * green
    inputs["Sun Direction"].default_value = (0.0, 0.98, 0.2)
    sea.data.attributes["cusp"].data.foreach_set("value", np.full(4, 0.05, np.float32))
    sea.data.update()
    assert glow(inputs, seen).max() < 0.02 * green


def test_foam_on_the_shaded_side_of_a_crest_is_lit_through_it(inputs, sea, seen):
    """By what up to 2.2 m of water leave of the sun in the mean, and brighter than water is there."""
    absorption = np.array([0.40, 0.105, 0.19])
    inputs["Absorption"].default_value = (*absorption, 1.0)
    cusp = sea.data.attributes.new("cusp", "FLOAT", "POINT")
    cusp.data.foreach_set("value", np.full(4, 1.0, np.float32))
    for vertex in sea.data.vertices:
        vertex.co.z = 0.3 * vertex.co.y
    inputs["Sun Direction"].default_value = (0.0, 0.98, 0.2)
    of_water = glow(inputs, seen)
    add_foam(sea, 1.0)
    of_foam = glow(inputs, seen)
    colour = np.array(inputs["Foam Color"].default_value[:3])
    left = colour * left_in_wedge(absorption, 2.2)
    np.testing.assert_allclose(of_foam / of_foam[1], left / left[1], rtol=0.02)
    assert of_foam.min() > of_water.min()
    assert 0.05 < of_foam[1] / (8.0 * left[1] / math.pi) < 0.5  # no more than half gets through
    inputs["Sun Direction"].default_value = (0.0, -0.98, 0.2)
    assert glow(inputs, seen).max() < 0.02 * of_foam[1]


def test_the_lamp_lights_the_crests_wherever_it_turns(water, empty_scene, extension):
    sky = extension("scene.sky").Sky(math.radians(20.0), math.radians(30.0))
    sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
    extension("scene.sky_world").set_lamp(sun, sky.sun_irradiance, sky.sun_elevation, sky.sun_azimuth)
    empty_scene.collection.objects.link(sun)
    material = water.water_material()
    item = bpy.data.objects.new("Item", bpy.data.meshes.new("Item"))
    item.data.materials.append(material)
    empty_scene.collection.objects.link(item)
    for _ in range(2):  # a second time changes nothing
        water.light_by(material, sun)

    def given(label):
        shown = material.evaluated_get(bpy.context.evaluated_depsgraph_get())
        node = next(node for node in shown.node_tree.nodes if node.label == label)
        return [socket.default_value for socket in node.inputs]

    level = math.cos(math.radians(20.0))
    towards = (level * math.cos(math.radians(30.0)), 0.5 * level, math.sin(math.radians(20.0)))
    assert given("Sun Direction") == pytest.approx(towards, abs=1e-5)
    assert given("Sun Light") == pytest.approx(sky.sun_irradiance, rel=1e-4)
    sun.rotation_euler, sun.data.energy = (0.0, 0.0, 0.0), 3.0
    assert given("Sun Direction") == pytest.approx((0.0, 0.0, 1.0), abs=1e-6)
    assert max(given("Sun Light")) == pytest.approx(3.0)


def test_sun_comes_through_a_break_in_closed_cloud(extension):
    sky = extension("scene.sky").Sky
    clear = np.array(sky(math.radians(14.0), 0.0).sun_irradiance)
    for overcast, sunlight, share in ((0.95, 0.0, 0.0025), (0.95, 0.7, 0.7), (0.2, 0.1, 0.64)):
        found = sky(math.radians(14.0), 0.0, overcast=overcast, sunlight=sunlight).sun_irradiance
        assert found == pytest.approx(share * clear, rel=1e-6)


def test_a_pixel_is_the_camera_s(water, empty_scene):
    material = water.water_material()
    item = bpy.data.objects.new("Item", bpy.data.meshes.new("Item"))
    item.data.materials.append(material)
    empty_scene.collection.objects.link(item)

    def angle():
        shown = material.evaluated_get(bpy.context.evaluated_depsgraph_get())
        node = next(node for node in shown.node_tree.nodes if node.label == "Pixel Angle")
        return node.outputs[0].default_value

    empty_scene.render.resolution_x, empty_scene.render.resolution_percentage = 1000, 50
    assert angle() == pytest.approx(36.0 / 50.0 / 500.0)  # no camera: as a new one
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    empty_scene.collection.objects.link(camera)
    empty_scene.camera, camera.data.lens = camera, 200.0
    assert angle() == pytest.approx(36.0 / 200.0 / 500.0)


def test_foam_stays_white_whatever_its_age_and_however_far(inputs, sea, seen, empty_scene):
    """Its mean colour: relief, rims and creases neither near nor far take more than a twentieth of it."""
    for link in inputs["Pixel Angle"].links:
        sea.active_material.node_tree.links.remove(link)
    inputs["Bubbles"].default_value = 0.0
    empty_scene.camera.data.ortho_scale = 40.0
    for name in ("foam", "foam_age", "breaking"):
        sea.data.attributes.new(name, "FLOAT", "POINT")
    for age, breaking in ((0.0, 1.0), (3.0, 0.0)):
        for name, value in (("foam", 0.7), ("foam_age", age), ("breaking", breaking)):
            sea.data.attributes[name].data.foreach_set("value", np.full(4, value, np.float32))
        sea.data.update()
        shown = []
        for angle in (0.0, 1.0):  # patterns as they are, and far below a pixel
            inputs["Pixel Angle"].default_value = angle
            shown.append(seen()[0])
        assert shown[0] == pytest.approx(shown[1], rel=0.05)
        assert shown[1] > 0.45


def test_old_foam_is_a_film(inputs, sea, seen, empty_scene):
    """Over their life whitecaps throw back 0.4 of what fresh foam does, ± 0.2 (Koepke 1984)."""
    for link in inputs["Pixel Angle"].links:
        sea.active_material.node_tree.links.remove(link)
    inputs["Bubbles"].default_value, inputs["Pixel Angle"].default_value = 0.0, 0.0
    empty_scene.camera.data.ortho_scale = 40.0
    none = seen()[0]
    for name in ("foam", "foam_age", "breaking"):
        sea.data.attributes.new(name, "FLOAT", "POINT")
    shown = []
    for age, breaking in ((0.0, 1.0), (0.0, 0.0), (4.0, 0.0), (20.0, 0.0)):
        for name, value in (("foam", 0.7), ("foam_age", age), ("breaking", breaking)):
            sea.data.attributes[name].data.foreach_set("value", np.full(4, value, np.float32))
        sea.data.update()
        shown.append(seen()[0] - none)
    assert shown[0] > shown[1] > shown[3]
    assert shown[2] > shown[3]
    assert shown[3] / shown[0] == pytest.approx(0.4, abs=0.2)


def test_describe_says_what_the_sea_is_and_only_once(ocean_object, water, make_parameters, core, empty_scene):
    parameters = make_parameters(domain_size=200.0, resolution=64, water=core.Water(depth=12.0))
    item = ocean_object.add(empty_scene, parameters)
    water.describe(item, parameters)
    values = {name: item[name] for name in item.keys() if name.startswith("ocean_tweak_")}  # noqa: SIM118
    assert values["ocean_tweak_domain_size"] == 200.0
    assert values["ocean_tweak_sample_spacing"] == 3.125
    assert values["ocean_tweak_water_depth"] == 12.0
    assert values["ocean_tweak_wind_direction"] == pytest.approx(0.4)
    assert 0.005 < values["ocean_tweak_slope_variance"] < 0.05
    assert values["ocean_tweak_metres_per_unit"] == 1.0
    updates = []

    def watch(_scene, depsgraph):
        updates.extend(update.id.name for update in depsgraph.updates)

    bpy.context.view_layer.update()
    bpy.app.handlers.depsgraph_update_post.append(watch)
    try:
        water.describe(item, parameters)
        bpy.context.view_layer.update()
    finally:
        bpy.app.handlers.depsgraph_update_post.remove(watch)
    assert item.name not in updates
    empty_scene.unit_settings.scale_length = 0.01
    water.describe(item, parameters)
    assert item["ocean_tweak_metres_per_unit"] == pytest.approx(0.01)


def test_one_material_serves_all_and_a_changed_one_stays(water, empty_scene):
    first = water.water_material()
    group = next(node for node in first.node_tree.nodes if node.type == "GROUP")
    group.inputs["Foam Amount"].default_value = 0.3
    assert water.water_material() == first
    assert group.inputs["Foam Amount"].default_value == pytest.approx(0.3)
    assert water.water_material("COASTAL") != first
    # a group from another version goes, its inputs stay
    group.node_tree["ocean_tweak_group"] = "Ocean Tweak Water 0"
    old = group.node_tree
    water.water_material()
    assert group.node_tree != old
    assert group.inputs["Foam Amount"].default_value == pytest.approx(0.3)


def test_seconds_run_with_the_frame_rate(water, empty_scene):
    material = water.water_material()
    empty_scene.render.fps, empty_scene.render.fps_base = 25, 1.0
    item = bpy.data.objects.new("Item", bpy.data.meshes.new("Item"))
    item.data.materials.append(material)
    empty_scene.collection.objects.link(item)
    empty_scene.frame_set(50)
    shown = material.evaluated_get(bpy.context.evaluated_depsgraph_get())
    seconds = next(node for node in shown.node_tree.nodes if node.label == "Seconds")
    assert seconds.outputs[0].default_value == pytest.approx(2.0)


def test_the_colour_of_the_water_is_what_its_coefficients_give_back(water, empty_scene):
    """R = 0.33 b/(a + b), of which 0.53 R/(1 - 0.47 R) comes out, as the shader has it."""
    material = water.water_material()
    inputs = water.water_node(material).inputs
    before = [tuple(inputs[name].default_value) for name in ("Absorption", "Backscatter")]
    below = 0.33 * 0.0022 / (0.067 + 0.0022)
    brightest = 0.195  # of light from above, which the panel shows as white
    shown = 0.53 * below / (1.0 - 0.47 * below) / brightest
    assert material.ocean_tweak_water_colour[1] == pytest.approx(shown, rel=1e-4)
    wanted = (0.02, 0.11, 0.09)
    material.ocean_tweak_water_colour = [part / brightest for part in wanted]
    assert material.ocean_tweak_water_colour[:] == pytest.approx([part / brightest for part in wanted], 1e-4)
    for channel, colour in enumerate(wanted):
        a, b = (inputs[name].default_value[channel] for name in ("Absorption", "Backscatter"))
        below = 0.33 * b / (a + b)
        assert 0.53 * below / (1.0 - 0.47 * below) == pytest.approx(colour, rel=1e-4)
        assert a * b == pytest.approx(before[0][channel] * before[1][channel], rel=1e-3)
    material.ocean_tweak_water_colour = (0.0, 1.0, 0.5)  # black and snow are no water
    assert all(0.0 < part <= 1.0 + 1e-5 for part in material.ocean_tweak_water_colour)
    assert not water.water_node(bpy.data.materials.new("Paint"))


def test_water_is_bright_enough_for_the_solid_view(water, empty_scene):
    material = water.water_material()
    assert min(material.diffuse_color[1:3]) > 0.3
    material.diffuse_color = (0.02, 0.08, 0.12, 1.0)  # as it was made before
    assert water.water_material() == material
    assert min(material.diffuse_color[1:3]) > 0.3
    material.diffuse_color = (0.5, 0.1, 0.1, 1.0)  # the user's own
    water.water_material()
    assert material.diffuse_color[:3] == pytest.approx((0.5, 0.1, 0.1))
