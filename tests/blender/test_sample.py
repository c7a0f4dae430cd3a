# SPDX-License-Identifier: GPL-3.0-or-later
"""Ocean Sample tells, at any position, what the core says of the surface there."""

import itertools
import math

import bpy
import numpy as np
import pytest
from mathutils import Matrix

from .conftest import DOMAIN, SAMPLES
from .sheets import new_sheet, wave

WAYS = tuple(itertools.product(("NODES", "DISPLACE"), ("LIVE", "SEQUENCE")))
OUTPUTS = {
    "Height": ("NodeSocketFloat", "FLOAT"),
    "Foam": ("NodeSocketFloat", "FLOAT"),
    "Normal": ("NodeSocketVector", "FLOAT_VECTOR"),
    "Velocity": ("NodeSocketVector", "FLOAT_VECTOR"),
    "Displacement": ("NodeSocketVector", "FLOAT_VECTOR"),
    "Point": ("NodeSocketVector", "FLOAT_VECTOR"),
}


def new_asker(extension, scene, points, ocean, at_rest=False):
    """An object that asks about an ocean at points of its own, and keeps the answers as attributes."""
    tree = bpy.data.node_groups.new("Ask", "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    begin, end = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
    asked = tree.nodes.new("GeometryNodeGroup")
    asked.node_tree = extension("nodes.versioned").node_group(extension("nodes.sample").SAMPLE)
    asked.inputs["Ocean"].default_value = ocean
    asked.inputs["At Rest"].default_value = at_rest
    geometry = begin.outputs[0]
    for name, (_, data_type) in OUTPUTS.items():
        kept = tree.nodes.new("GeometryNodeStoreNamedAttribute")
        kept.data_type = data_type
        kept.inputs["Name"].default_value = f"asked {name}"
        tree.links.new(geometry, kept.inputs[0])
        value = next(each for each in kept.inputs if each.name == "Value" and each.enabled)
        tree.links.new(asked.outputs[name], value)
        geometry = kept.outputs[0]
    tree.links.new(geometry, end.inputs[0])
    mesh = bpy.data.meshes.new("Asker")
    mesh.from_pydata([tuple(map(float, point)) for point in points], [], [])
    item = bpy.data.objects.new("Asker", mesh)
    scene.collection.objects.link(item)
    item.modifiers.new("Ask", "NODES").node_group = tree
    return item


def answers(mesh):
    """What an asker's evaluated mesh holds, by output."""
    result = {}
    for name in OUTPUTS:
        attribute = mesh.attributes[f"asked {name}"]
        is_vector = attribute.data_type == "FLOAT_VECTOR"
        flat = np.empty(len(attribute.data) * (3 if is_vector else 1), np.float32)
        attribute.data.foreach_get("vector" if is_vector else "value", flat)
        result[name] = flat.reshape(-1, 3) if is_vector else flat
    return result


def ask(item):
    return answers(item.evaluated_get(bpy.context.evaluated_depsgraph_get()).data)


@pytest.fixture
def asker(extension, empty_scene):
    return lambda *arguments, **named: new_asker(extension, empty_scene, *arguments, **named)


@pytest.fixture
def sheet(empty_scene):
    return lambda *arguments: new_sheet(empty_scene, *arguments)


def moved(item, location, turn):
    item.location = location
    item.rotation_euler.z = turn
    bpy.context.view_layer.update()
    return np.array(item.matrix_world)


def spread_points(count, reach):
    """Anywhere in and around the patch, and one on its corner."""
    numbers = np.random.default_rng(5)
    points = np.zeros((count, 3))
    points[1:, :2] = numbers.uniform(-reach, reach, (count - 1, 2))
    points[:, 2] = numbers.uniform(-3.0, 3.0, count)
    return points


def places_on(ocean, asker, points):
    """The points in the ocean's space, and the rotation and height from there to the asker's."""
    back = np.linalg.inv(asker) @ ocean
    inside = points @ np.linalg.inv(back)[:3, :3].T + np.linalg.inv(back)[:3, 3]
    return inside, back[:3, :3], back[2, 3]


@pytest.mark.parametrize(("method", "source"), WAYS)
def test_sample_is_the_core_s(asker, ocean_object, bake, core, make_parameters, empty_scene, method, source):
    parameters = make_parameters()
    sequence = bake(parameters, 1, 8) if source == "SEQUENCE" else None
    ocean = ocean_object.add(empty_scene, parameters, method, source, sequence)
    points = spread_points(400, 4 * DOMAIN)
    item = asker(points, ocean)
    ocean_matrix = moved(ocean, (20.0, -70.0, 4.0), 0.8)
    inside, turn, level = places_on(ocean_matrix, moved(item, (-5.0, 6.0, 1.0), -0.5), points)
    for frame in (1, 7):
        empty_scene.frame_set(frame)
        found = core.Ocean(parameters).points_at(inside[:, 0], inside[:, 1], parameters.timing.time(frame))
        told = ask(item)
        np.testing.assert_allclose(told["Height"], found.height + level, atol=1e-3)
        # at the edge between two quads either one's normal is right
        difference = np.linalg.norm(told["Normal"] - found.normal @ turn.T, axis=1)
        assert np.mean(difference < 1e-3) > 0.99
        gone = np.zeros((len(points), 3))
        gone[:, :2] = inside[:, :2] - found.rest
        gone[:, 2] = found.height
        np.testing.assert_allclose(told["Displacement"], gone @ turn.T, atol=2e-3)
        np.testing.assert_allclose(told["Point"][:, 2], told["Height"], atol=1e-4)
        np.testing.assert_allclose(told["Point"][:, :2], points[:, :2], atol=1e-3)


def test_a_storm(asker, ocean_object, core, make_parameters, empty_scene):
    layer = core.WaveLayer(wind_speed=28.0, fetch=700e3)
    parameters = make_parameters(resolution=64, domain_size=300.0, choppiness=1.0, layers=(layer,))
    ocean = ocean_object.add(empty_scene, parameters)
    points = spread_points(3000, 600.0)
    sea = core.Ocean(parameters)
    assert sea.statistics().significant_wave_height > 5.0
    told = ask(asker(points, ocean))
    np.testing.assert_allclose(told["Height"], sea.height_at(points[:, 0], points[:, 1], 0.0), atol=1e-3)


@pytest.mark.parametrize("choppiness", [1.8, 2.6])
def test_a_sea_that_nearly_folds(asker, ocean_object, core, make_parameters, empty_scene, choppiness):
    layer = core.WaveLayer(wind_speed=25.0, fetch=500e3)
    parameters = make_parameters(resolution=64, domain_size=100.0, choppiness=choppiness, layers=(layer,))
    sea = core.Ocean(parameters)
    fields = sea.surface(0.0, {"displacement", "min_eigenvalue"})
    assert np.min(fields.min_eigenvalue) < 0.5
    ocean = ocean_object.add(empty_scene, parameters)
    points = spread_points(4000, 100.0)
    found = sea.points_at(points[:, 0], points[:, 1], 0.0)
    cell = np.floor(found.rest / parameters.domain_size * 64).astype(int)
    around = [(cell + np.array([a, b])) % 64 for a in (0, 1) for b in (0, 1)]
    least = np.min([fields.min_eigenvalue[each[:, 1], each[:, 0]] for each in around], axis=0)
    difference = np.abs(ask(asker(points, ocean))["Height"] - found.height)
    assert difference[(least > 0.2) & found.found].max() < 1e-3


def test_at_rest_the_water_is_followed(asker, ocean_object, make_parameters, expected, empty_scene):
    parameters = make_parameters()
    ocean = ocean_object.add(empty_scene, parameters)
    step = DOMAIN / SAMPLES
    numbers = np.array([(0, 0), (3, 9), (31, 17), (32, 32)])
    points = np.array([(column * step, row * step, 0.0) for row, column in numbers])
    told = ask(asker(points, ocean, at_rest=True))
    samples = expected(parameters, 1)[numbers[:, 0], numbers[:, 1]]
    np.testing.assert_allclose(told["Point"], samples, atol=1e-4)
    np.testing.assert_allclose(told["Displacement"], samples - points, atol=1e-4)
    np.testing.assert_allclose(told["Height"], samples[:, 2], atol=1e-4)


def test_in_centimetres(asker, ocean_object, core, make_parameters, empty_scene):
    empty_scene.unit_settings.scale_length = 0.01
    parameters = make_parameters()
    ocean = ocean_object.add(empty_scene, parameters)
    points = spread_points(200, 100.0 * DOMAIN)
    found = core.Ocean(parameters).height_at(points[:, 0] / 100.0, points[:, 1] / 100.0, 0.0)
    np.testing.assert_allclose(ask(asker(points, ocean))["Height"] / 100.0, found, atol=2e-3)


def waves(n, size):
    """One wave along x."""
    return wave(n, 1, size / 40.0)


@pytest.mark.parametrize("repeats", [(1, 1), (3, 2)])
def test_foam_and_velocity_are_those_of_the_mesh(asker, sheet, repeats):
    attributes = {
        "foam": lambda rest: 0.5 + 0.5 * np.sin(2.0 * math.pi * rest[..., 1:2] / 8.0),
        "velocity": lambda rest: np.concatenate([rest[..., :1] * 0.0 + 2.0, rest[..., :2] * 0.0], axis=-1),
    }
    ocean = sheet(waves(16, 8.0), 8.0, attributes, repeats)
    ocean.rotation_euler.z = math.pi / 2
    # turned by a quarter, the ocean's y is the asker's -x
    told = ask(asker([(-2.0, 0.0, 0.0), (-2.25, 0.0, 0.0), (6.0, 0.0, 0.0), (-802.0, 0.0, 0.0)], ocean))
    below = (0.5 + 0.5 * math.sin(2.0 * math.pi * 2.5 / 8.0)) / 2 + 0.5
    np.testing.assert_allclose(told["Foam"], [1.0, below, 1.0, 1.0], atol=1e-4)
    np.testing.assert_allclose(told["Velocity"], [(0.0, 2.0, 0.0)] * 4, atol=1e-5)


def test_attributes_that_are_missing_are_zero(asker, sheet):
    told = ask(asker([(1.0, 2.0, 0.0)], sheet(waves(8, 8.0), 8.0)))
    assert told["Foam"] == 0.0
    np.testing.assert_array_equal(told["Velocity"], 0.0)


def test_a_tilted_asker_and_a_scaled_ocean(asker, sheet):
    """The surface is the same one, seen from elsewhere."""
    ocean = sheet(waves(32, 8.0), 8.0)
    ocean.location, ocean.scale = (1.0, 2.0, 3.0), (2.0, 3.0, 1.0)
    plain = ask(asker([(3.0, 4.0, 0.0)], ocean))
    item = asker([(0.0, 0.0, 0.0)], ocean)
    item.matrix_world = turn = Matrix.Rotation(0.7, 4, "X") @ Matrix.Rotation(0.4, 4, "Z")
    item.data.vertices[0].co = turn.inverted() @ Matrix.Translation((3.0, 4.0, 0.0)).translation
    told = ask(item)
    np.testing.assert_allclose(turn @ Matrix.Translation(told["Point"][0]).translation, plain["Point"][0],
                               atol=1e-5)  # fmt: skip
    np.testing.assert_allclose(np.array(turn)[:3, :3] @ told["Normal"][0], plain["Normal"][0], atol=1e-5)
    # a wave along x of height h: twice as long when scaled, as high
    x = (3.0 - 1.0) / 2.0
    slope = -(8.0 / 40.0) * (2.0 * math.pi / 8.0) * math.sin(2.0 * math.pi * x / 8.0) / 2.0
    assert plain["Normal"][0][0] == pytest.approx(-slope / math.hypot(1.0, slope), abs=0.02)


def flat(told):
    return (
        np.all(told["Height"] == 0.0)
        and np.all(told["Foam"] == 0.0)
        and np.allclose(told["Normal"], (0.0, 0.0, 1.0))
    )


def test_without_an_ocean_the_sea_is_flat(asker, ocean_object, make_parameters, empty_scene):
    points = spread_points(5, 10.0)
    assert flat(ask(asker(points, None)))
    cube = bpy.data.objects.new("Cube", bpy.data.meshes.new("Cube"))
    empty_scene.collection.objects.link(cube)
    assert flat(ask(asker(points, cube)))  # a mesh without vertices
    cube.data.from_pydata([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [], [(0, 1, 2, 3)])
    assert flat(ask(asker(points, cube)))
    assert flat(ask(asker(points, bpy.data.objects.new("Empty", None))))
    ocean = ocean_object.add(empty_scene, make_parameters())
    item = asker(points, ocean)
    assert not flat(ask(item))
    ocean.modifiers.new("Cut", "DECIMATE").ratio = 0.37  # no grid any more
    assert flat(ask(item))
    bpy.data.objects.remove(ocean)
    assert flat(ask(item))


def test_a_render_asks_the_sea_of_the_render(asker, ocean_object, core, make_parameters, empty_scene):
    parameters = make_parameters()
    ocean = ocean_object.add(empty_scene, parameters, viewport_resolution=16)
    points = spread_points(50, DOMAIN)
    item = asker(points, ocean)
    seen = {}

    class Probe(bpy.types.RenderEngine):
        bl_idname, bl_label = "OCEAN_TEST_ASKER", "Asker"

        def render(self, depsgraph):
            seen["render"] = answers(item.evaluated_get(depsgraph).data)["Height"]

    empty_scene.camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    empty_scene.collection.objects.link(empty_scene.camera)
    bpy.utils.register_class(Probe)
    empty_scene.render.engine = Probe.bl_idname
    empty_scene.render.resolution_x = empty_scene.render.resolution_y = 8
    try:
        empty_scene.frame_set(6)
        bpy.ops.render.render()
    finally:
        bpy.utils.unregister_class(Probe)
    for told, shown in (
        (seen["render"], parameters),
        (ask(item)["Height"], make_parameters(resolution=16)),
    ):
        found = core.Ocean(shown).height_at(points[:, 0], points[:, 1], shown.timing.time(6))
        np.testing.assert_allclose(told, found, atol=1e-3)
