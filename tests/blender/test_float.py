# SPDX-License-Identifier: GPL-3.0-or-later
"""What floats follows the surface: instances, geometries and objects."""

import math

import bpy
import numpy as np
import pytest
from mathutils import Euler, Vector

from .conftest import DOMAIN
from .floats import sea_below
from .sheets import new_sheet, wave

CENTIMETRE, DEGREE = 0.01, 1.0
# rotation of the instances before they float
OWN = np.array(Euler((0.1, 0.0, 0.5)).to_matrix())
# slope of a wave, times its length over its height
STEEPEST = 2.0 * math.pi


@pytest.fixture
def floating(extension, empty_scene):
    return extension("scene.floating")


@pytest.fixture
def ocean(ocean_object, make_parameters, empty_scene):
    """A small sea that stands somewhere and is turned."""
    item = ocean_object.add(empty_scene, make_parameters())
    item.ocean_tweak.use_foam = False  # quicker
    item.location, item.rotation_euler.z = (12.0, -30.0, 2.0), 0.6
    bpy.context.view_layer.update()
    return item


@pytest.fixture
def new_object(empty_scene):
    def make(name, data=None, location=(0.0, 0.0, 0.0), turn=0.0):
        item = bpy.data.objects.new(name, data)
        item.location, item.rotation_euler.z = location, turn
        empty_scene.collection.objects.link(item)
        bpy.context.view_layer.update()
        return item

    return make


@pytest.fixture
def modified(extension):
    """Give an object the Float group."""

    def modify(item, **inputs):
        modifier = item.modifiers.new("Float", "NODES")
        modifier.node_group = extension("nodes.versioned").node_group(extension("nodes.floating").FLOAT)
        for name, value in inputs.items():
            extension("nodes.modifier_inputs").set_input(modifier, name.replace("_", " "), value)
        item.update_tag()
        bpy.context.view_layer.update()
        return item

    return modify


def angle(first, second):
    """Degrees between two directions."""
    return math.degrees(Vector(first).angle(Vector(second)))


def up(matrix):
    return np.array(matrix)[:3, 2]


KINDS = {
    "MESH": lambda: bpy.data.meshes.new("Hull"),
    "EMPTY": lambda: None,
    "CAMERA": lambda: bpy.data.cameras.new("Camera"),
    "LIGHT": lambda: bpy.data.lights.new("Light", "POINT"),
}


@pytest.mark.parametrize("kind", KINDS)
def test_an_object_follows_the_surface(floating, ocean, new_object, core, make_parameters, empty_scene, kind):
    item = new_object("Buoy", KINDS[kind](), (25.0, 40.0, 9.0), 0.7)
    item.scale = (2.0, 2.0, 2.0)
    floating.float_on(item, ocean)
    heights = []
    for frame in range(1, 49):
        empty_scene.frame_set(frame)
        point, normal = sea_below(core, ocean, make_parameters(), frame, (25.0, 40.0))
        assert np.linalg.norm(np.array(item.matrix_world)[:3, 3] - point) < CENTIMETRE
        assert angle(up(item.matrix_world), normal) < DEGREE
        # the shortest way from upright: no turn about the mast
        tilt = Vector((0.0, 0.0, 1.0)).rotation_difference(Vector(normal))
        heading = tilt.to_matrix() @ Euler((0.0, 0.0, 0.7)).to_matrix() @ Vector((1.0, 0.0, 0.0))
        assert angle(np.array(item.matrix_world)[:3, 0], heading) < DEGREE
        np.testing.assert_allclose(item.matrix_world.to_scale(), (2.0, 2.0, 2.0), atol=1e-4)
        heights.append(point[2])
    assert np.ptp(heights) > 0.5


def test_in_a_render_it_rides_the_sea_of_the_render(
    floating, ocean, new_object, core, make_parameters, empty_scene
):
    ocean.ocean_tweak.viewport_resolution = 16
    item = new_object("Buoy", None, (25.0, 40.0, 9.0))
    floating.float_on(item, ocean)
    seen = []

    class Probe(bpy.types.RenderEngine):
        bl_idname, bl_label = "OCEAN_TEST_BUOY", "Buoy"

        def render(self, depsgraph):
            seen.append(np.array(item.evaluated_get(depsgraph).matrix_world))
            seen.append([each.object.name for each in depsgraph.object_instances])

    empty_scene.camera = new_object("Camera", bpy.data.cameras.new("Camera"))
    bpy.utils.register_class(Probe)
    empty_scene.render.engine = Probe.bl_idname
    empty_scene.render.resolution_x = empty_scene.render.resolution_y = 8
    try:
        empty_scene.frame_set(6)
        bpy.ops.render.render()
    finally:
        bpy.utils.unregister_class(Probe)
    for matrix, shown in (
        (seen[0], make_parameters()),
        (item.matrix_world, make_parameters(resolution=16)),
    ):
        point, normal = sea_below(core, ocean, shown, 6, (25.0, 40.0))
        assert np.linalg.norm(np.array(matrix)[:3, 3] - point) < CENTIMETRE
        assert angle(up(matrix), normal) < DEGREE
    assert "Buoy Float" not in seen[1]


def test_back_where_it_was(floating, ocean, new_object, empty_scene):
    parent = new_object("Quay", None, (5.0, 6.0, 1.0), 0.3)
    item = new_object("Buoy", None, (3.0, 4.0, 2.0), 0.2)
    item.parent = parent
    bpy.context.view_layer.update()
    before, things = item.matrix_world.copy(), set(bpy.data.objects)
    floating.float_on(item, ocean)
    bpy.context.view_layer.update()
    assert (item.matrix_world.translation - before.translation).length > 0.1
    floating.sink(item)
    bpy.context.view_layer.update()
    assert item.matrix_world == before
    assert set(bpy.data.objects) == things
    assert len(bpy.data.meshes) == 1  # the ocean's


def test_an_animated_object_floats_along_its_way(floating, ocean, new_object, core, make_parameters,
                                                 empty_scene):  # fmt: skip
    item = new_object("Ship")
    for frame, x in ((1, 0.0), (11, 50.0)):
        item.location.x = x
        item.keyframe_insert("location", frame=frame)
    floating.float_on(item, ocean)
    for frame, x in ((1, 0.0), (6, 25.0), (11, 50.0)):
        empty_scene.frame_set(frame)
        point, _ = sea_below(core, ocean, make_parameters(), frame, (x, 0.0))
        np.testing.assert_allclose(item.matrix_world.translation, point, atol=CENTIMETRE)


def test_draft_tilt_and_drift(floating, ocean, new_object, core, make_parameters, empty_scene):
    item = new_object("Buoy", None, (10.0, 20.0, 0.0))
    point, normal = sea_below(core, ocean, make_parameters(), 1, (10.0, 20.0))
    carrier = floating.float_on(item, ocean, floating.Ride(draft=0.75))
    bpy.context.view_layer.update()
    np.testing.assert_allclose(item.matrix_world.translation, point - [0.0, 0.0, 0.75], atol=1e-3)
    whole = angle(normal, (0.0, 0.0, 1.0))
    assert whole > 2.0
    for tilt in (0.0, 0.5):
        floating.let_ride(carrier, ocean, floating.Ride(tilt=tilt))
        bpy.context.view_layer.update()
        assert angle(up(item.matrix_world), (0.0, 0.0, 1.0)) == pytest.approx(tilt * whole, abs=0.05)
    # the water that is at a sample when at rest is where the mesh's vertex is now
    step = DOMAIN / 32
    item.location = ocean.matrix_world @ Vector((5 * step, 7 * step, 0.0))
    floating.let_ride(carrier, ocean, floating.Ride(drift=1.0))
    bpy.context.view_layer.update()
    gone = core.Ocean(make_parameters()).surface(0.0).displacement[7, 5].astype(float)
    vertex = ocean.matrix_world @ Vector((5 * step + gone[0], 7 * step + gone[1], gone[2]))
    np.testing.assert_allclose(item.matrix_world.translation, vertex, atol=1e-3)
    assert math.hypot(*gone[:2]) > 0.1


def test_in_centimetres(floating, ocean_object, new_object, core, make_parameters, empty_scene):
    empty_scene.unit_settings.scale_length = 0.01
    ocean = ocean_object.add(empty_scene, make_parameters())
    item = new_object("Buoy", None, (1000.0, 2000.0, 0.0))
    floating.float_on(item, ocean, floating.Ride(waterline=1.0))
    empty_scene.frame_set(9)
    parameters = make_parameters()
    height = core.Ocean(parameters).height_at(10.0, 20.0, parameters.timing.time(9))
    assert item.matrix_world.translation.z / 100.0 == pytest.approx(float(height), abs=CENTIMETRE)


def test_when_the_carrier_goes_the_object_stays_where_it_is_without(floating, ocean, new_object, empty_scene):
    item = new_object("Buoy", None, (10.0, 20.0, 5.0))
    carrier = floating.float_on(item, ocean)
    bpy.data.objects.remove(carrier)
    empty_scene.frame_set(4)
    assert floating.carrier_of(item) is None
    floating.float_on(item, ocean)
    floating.sink(item)
    bpy.context.view_layer.update()
    np.testing.assert_allclose(item.matrix_world.translation, (10.0, 20.0, 5.0))


def test_what_cannot_float(floating, ocean, new_object, empty_scene):
    with pytest.raises(floating.FloatError, match="Ocean cannot float on Ocean"):
        floating.float_on(ocean, ocean)
    item = new_object("Buoy")
    with pytest.raises(floating.FloatError, match="Buoy cannot float on Buoy"):
        floating.float_on(item, item)
    ocean.parent = item
    with pytest.raises(floating.FloatError, match="Buoy carries Ocean"):
        floating.float_on(item, ocean)
    assert not item.constraints


def boats(extension, new_object, modified, places, **inputs):
    """Instances of a cube at places, on the sea by the Float group."""
    mesh = bpy.data.meshes.new("Points")
    mesh.from_pydata([tuple(place) for place in places], [], [])
    boat = new_object("Boat", bpy.data.meshes.new("Boat"))
    boat.data.from_pydata([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [], [(0, 1, 2)])
    item = new_object("Fleet", mesh)
    tree = bpy.data.node_groups.new("Fleet", "GeometryNodeTree")
    for direction in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=direction, socket_type="NodeSocketGeometry")
    begin, end = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
    spread = tree.nodes.new("GeometryNodeInstanceOnPoints")
    info = tree.nodes.new("GeometryNodeObjectInfo")
    info.inputs["Object"].default_value = boat
    info.inputs["As Instance"].default_value = True
    spread.inputs["Rotation"].default_value = (0.1, 0.0, 0.5)
    spread.inputs["Scale"].default_value = (3.0, 2.0, 1.0)
    tree.links.new(begin.outputs[0], spread.inputs["Points"])
    tree.links.new(info.outputs["Geometry"], spread.inputs["Instance"])
    tree.links.new(spread.outputs[0], end.inputs[0])
    item.modifiers.new("Fleet", "NODES").node_group = tree
    return modified(item, **inputs)


def instances(item):
    depsgraph = bpy.context.evaluated_depsgraph_get()
    return [
        np.array(each.matrix_world)
        for each in depsgraph.object_instances
        if each.is_instance and each.parent.original == item
    ]


@pytest.mark.parametrize("frame", [1, 20])
def test_each_instance_rides(
    extension, ocean, new_object, modified, core, make_parameters, empty_scene, frame
):
    numbers = np.random.default_rng(2)
    places = np.zeros((30, 3))
    places[:, :2] = numbers.uniform(-300.0, 300.0, (30, 2))
    fleet = boats(extension, new_object, modified, places, Ocean=ocean)
    fleet.location = (1.0, 2.0, 3.0)
    empty_scene.frame_set(frame)
    seen = instances(fleet)
    assert len(seen) == 30
    for place, matrix in zip(places, seen, strict=True):
        point, normal = sea_below(core, ocean, make_parameters(), frame, place + np.array([1.0, 2.0, 0.0]))
        np.testing.assert_allclose(matrix[:3, 3], point, atol=CENTIMETRE)
        tilt = np.array(Vector((0.0, 0.0, 1.0)).rotation_difference(Vector(normal)).to_matrix())
        np.testing.assert_allclose(matrix[:3, :3], tilt @ OWN * (3.0, 2.0, 1.0), atol=0.01)


def test_as_one_the_instances_keep_their_places(
    extension, ocean, new_object, modified, core, make_parameters
):
    places = np.array([(0.0, 0.0, 1.0), (4.0, 0.0, 1.0)])
    fleet = boats(extension, new_object, modified, places, Ocean=ocean, As_One=True)
    point, normal = sea_below(core, ocean, make_parameters(), 1, (0.0, 0.0))
    tilt = np.array(Vector((0.0, 0.0, 1.0)).rotation_difference(Vector(normal)).to_matrix())
    for place, matrix in zip(places, instances(fleet), strict=True):
        np.testing.assert_allclose(matrix[:3, 3], point + tilt @ place, atol=CENTIMETRE)


def test_a_geometry_rides_as_one(ocean, new_object, modified, core, make_parameters):
    mesh = bpy.data.meshes.new("Hull")
    corners = [(-1.0, 0.0, 0.0), (1.0, 0.0, 0.5), (0.0, 2.0, 0.0)]
    mesh.from_pydata(corners, [], [(0, 1, 2)])
    item = modified(new_object("Hull", mesh, (40.0, 50.0, 6.0), 0.9), Ocean=ocean)
    point, normal = sea_below(core, ocean, make_parameters(), 1, (40.0, 50.0))
    tilt = np.array(Vector((0.0, 0.0, 1.0)).rotation_difference(Vector(normal)).to_matrix())
    heading = np.array(Euler((0.0, 0.0, 0.9)).to_matrix())
    moved = item.evaluated_get(bpy.context.evaluated_depsgraph_get())
    for corner, vertex in zip(corners, moved.data.vertices, strict=True):
        np.testing.assert_allclose(
            item.matrix_world @ vertex.co, point + tilt @ heading @ corner, atol=CENTIMETRE
        )


@pytest.mark.parametrize(("length", "passes"), [(10.0, False), (100.0, True)])
def test_a_hull_feels_only_waves_longer_than_itself(
    extension, new_object, modified, empty_scene, length, passes
):
    size, height, hull = 200.0, 0.5, 10.0
    sheet = new_sheet(empty_scene, wave(256, round(size / length), height), size)
    places = np.zeros((9, 3))
    places[:, 0] = 50.0 + np.linspace(0.0, length, 9)
    places[:, 1] = 70.0
    fleet = boats(extension, new_object, modified, places, Ocean=sheet, Waterline=hull)
    heights, slopes = [], []
    for place, matrix in zip(places, instances(fleet), strict=True):
        tilt = matrix[:3, :3] @ np.linalg.inv(OWN * (3.0, 2.0, 1.0))
        heights.append(matrix[2, 3])
        slopes.append(-tilt[0, 2] / tilt[2, 2])
        level, slope = least_squares(place[0], hull, height, length)
        assert heights[-1] == pytest.approx(level, abs=0.02 * height)
        assert slopes[-1] == pytest.approx(slope, abs=0.03 * STEEPEST * height / length)
    share = 0.97 if passes else 0.0
    most = 1.0 if passes else 0.2
    assert share <= np.ptp(heights) / (2.0 * height) <= most + 1e-3
    assert (np.max(slopes) > 0.9 * STEEPEST * height / length) == passes


def least_squares(x, hull, height, length):
    """Height and slope of the plane through a wave along x over a disc, on a fine grid of points."""
    grid = np.stack(np.meshgrid(*[np.linspace(-1.0, 1.0, 81)] * 2), axis=-1).reshape(-1, 2) * hull / 2
    disc = grid[np.hypot(*grid.T) <= hull / 2]
    z = height * np.cos(2.0 * math.pi * (x + disc[:, 0]) / length)
    (level, slope, _), *_ = np.linalg.lstsq(np.c_[np.ones(len(disc)), disc], z, rcond=None)
    return level, slope
