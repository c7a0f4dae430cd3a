# SPDX-License-Identifier: GPL-3.0-or-later
"""Where waves end in the viewport of a ready scene: right below the horizon of its camera, or beside it."""

import bpy
import numpy as np
import pytest

PIECES = 200  # of each side


def squares(ocean):
    """(squares, 4, 3) corners in the world of the ocean and its copies, as the viewport shows them."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    size = ocean.ocean_tweak.domain_size
    corners = np.array([(0, 0, 0, 1), (size, 0, 0, 1), (size, size, 0, 1), (0, size, 0, 1)], float)
    return np.array(
        [
            (corners @ np.array(each.matrix_world).T)[:, :3]
            for each in depsgraph.object_instances
            if each.object.original == ocean
        ]
    )


def outline(places):
    """Points along the sides of the rectangle around some places."""
    (left, lower, _), (right, upper, _) = places.min(axis=0), places.max(axis=0)
    t = np.linspace(0.0, 1.0, PIECES)
    x, y = left + t * (right - left), lower + t * (upper - lower)
    sides = [(x, lower), (x, upper), (left, y), (right, y)]
    return np.concatenate([np.stack(np.broadcast_arrays(*side, 0.0), axis=-1) for side in sides])


def boundary(item):
    """Where the faces of a mesh end, in the world, as the viewport shows it."""
    mesh = item.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    places = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", places)
    edges = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("edge_index", edges)
    ends = np.empty(2 * len(mesh.edges), np.int32)
    mesh.edges.foreach_get("vertices", ends)
    single = np.bincount(edges, minlength=len(mesh.edges)) == 1
    found = places.reshape(-1, 3)[np.unique(ends.reshape(-1, 2)[single])]
    matrix = np.array(item.matrix_world)
    return found @ matrix[:3, :3].T + matrix[:3, 3]


def below_horizon(camera, places):
    """How far below the horizon places are in the picture, as a share of its height; those in it alone."""
    matrix = np.array(camera.matrix_world)
    local = (places - matrix[:3, 3]) @ matrix[:3, :3]
    local = local[local[:, 2] < -0.1]
    half_x = np.tan(0.5 * camera.data.angle_x)
    half_y = half_x * 9.0 / 16.0
    x, y = local[:, 0] / -local[:, 2] / half_x, local[:, 1] / -local[:, 2] / half_y
    forward = -matrix[:3, 2]
    level = np.tan(-np.arcsin(forward[2])) / half_y  # of the horizon
    inside = (np.abs(x) < 1.0) & (np.abs(y) < 1.0)
    return 0.5 * (level - y[inside])


@pytest.mark.parametrize("mood", ["CALM", "FRESH_BREEZE", "STORM", "HORIZON"])
def test_no_edge_shows_before_the_horizon(quick, empty_scene, mood):
    bpy.ops.ocean.add_scene(mood=mood, engine="CYCLES", use_buoy=False)
    bpy.context.view_layer.update()
    ocean = next(item for item in empty_scene.objects if item.ocean_tweak.is_ocean)
    surface = next((item for item in empty_scene.objects if "Camera Surface" in item.name), None)
    if surface is None:
        found = squares(ocean)
        assert len(found) == 9
        edge = outline(found.reshape(-1, 3))
    else:
        edge = boundary(surface)
        assert len(edge) > 20
    below = below_horizon(empty_scene.camera, edge)
    assert below.max(initial=0.0) < 0.03


def test_copies_are_left_to_renders_where_the_viewport_is_fine(ocean, empty_scene, extension):
    ocean.ocean_tweak.viewport_resolution = 1024
    parameters = ocean.ocean_tweak.to_parameters(empty_scene)
    extension("scene.surroundings").add_horizon(ocean, parameters, empty_scene, empty_scene.collection, 2)
    bpy.context.view_layer.update()
    assert len(squares(ocean)) == 1
