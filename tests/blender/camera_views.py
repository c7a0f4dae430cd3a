# SPDX-License-Identifier: GPL-3.0-or-later
"""What tests of the surface around the camera share: a camera, such surfaces, and what can be read there."""

import bpy
import numpy as np
import pytest
from mathutils import Vector
from mathutils.bvhtree import BVHTree

from .conftest import evaluated_mesh
from .sheets import new_sheet

BUDGET = 6000


@pytest.fixture
def camera(empty_scene):
    item = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    item.location = (31.3, -17.2, 6.0)
    empty_scene.collection.objects.link(item)
    empty_scene.camera = item
    return item


@pytest.fixture
def foaming_patches(core, make_parameters):
    """A sea of two patches, one of them turned, with much foam that is soon gone."""
    layer = core.WaveLayer(wind_speed=12.0, fetch=8e3, wind_direction=0.4)
    patches = (
        core.Patch(domain_size=120.0, shortest_wavelength=12.0, resolution=40),
        core.Patch(
            domain_size=31.0, longest_wavelength=12.0, shortest_wavelength=3.0, rotation=0.9, resolution=48
        ),
    )
    return make_parameters(layers=(layer,), patches=patches, foam=core.Foam(half_life=0.3, coverage=4.0))


@pytest.fixture
def around(extension, empty_scene):
    """A surface of its own around the camera, with inputs by name."""

    def make(ocean, **inputs):
        item = bpy.data.objects.new("Around", bpy.data.meshes.new("Around"))
        empty_scene.collection.objects.link(item)
        modifier = item.modifiers.new("Around", "NODES")
        kind = extension("nodes.camera_surface").CAMERA_SURFACE
        modifier.node_group = extension("nodes.versioned").node_group(kind)
        values = {name.replace("_", " ").title(): value for name, value in inputs.items()}
        set_inputs = extension("nodes.modifier_inputs").set_inputs
        set_inputs(modifier, {"Ocean": ocean, "Vertex Budget": BUDGET, **values})
        return item

    return make


@pytest.fixture
def sheet(empty_scene):
    return lambda field, size, **named: new_sheet(empty_scene, field, size, **named)


def flat_sheet(sheet):
    return sheet(np.zeros((8, 8, 3)), 8.0)


def numbers(mesh, name, count):
    """(vertices, count): a point attribute."""
    flat = np.empty(len(mesh.vertices) * count, np.float32)
    mesh.attributes[name].data.foreach_get("vector" if count > 1 else "value", flat)
    return flat.reshape(-1, count).astype(np.float64)


def places(item):
    return numbers(evaluated_mesh(item), "position", 3)


def moved_to(item, *place):
    item.location = place
    bpy.context.view_layer.update()


def away(points, camera):
    """The larger of the distances along x and y."""
    return np.abs(points[:, :2] - np.array(camera.location)[:2]).max(axis=1)


def coarseness(mesh):
    """Cells from the middle of a level to its edge: a level's edge is as long as 2m of its cells."""
    faces_of = faces_along_edges(mesh)
    return int(np.count_nonzero(faces_of == 1)) // 8


def faces_along_edges(mesh):
    edges = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("edge_index", edges)
    return np.bincount(edges, minlength=len(mesh.edges))


def heights(item, points):
    """Of the surface above or below points (x, y), straight down."""
    return _below(BVHTree.FromObject(item, bpy.context.evaluated_depsgraph_get()), points)


def heights_of(mesh, points):
    """As `heights`, of a mesh in world space, such as a render's."""
    return _below(
        BVHTree.FromPolygons(numbers(mesh, "position", 3), [face.vertices[:] for face in mesh.polygons]),
        points,
    )


def _below(tree, points):
    down = Vector((0.0, 0.0, -1.0))
    return np.array([tree.ray_cast(Vector((x, y, 100.0)), down)[0].z for x, y in points])
