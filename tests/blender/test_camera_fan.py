# SPDX-License-Identifier: GPL-3.0-or-later
"""The surface that a camera sees: dense in the picture, to its lower edge, with its foam."""

import math

import bpy
import numpy as np
import pytest
from mathutils import Vector
from mathutils.bvhtree import BVHTree

from . import camera_views
from .camera_views import numbers
from .conftest import evaluated_mesh

# fixtures for the tests here
camera, parameters = camera_views.camera, camera_views.foaming_patches

BUDGET = 20_000


@pytest.fixture
def shown(extension, ocean_object, parameters, empty_scene, camera):
    """An ocean away from the world's origin, turned, with a surface around the camera."""
    ocean = ocean_object.add(empty_scene, parameters)
    ocean.location, ocean.rotation_euler = (-40.0, 25.0, 0.0), (0.0, 0.0, 0.3)
    empty_scene.render.resolution_x, empty_scene.render.resolution_y = 1280, 540
    bpy.context.view_layer.update()
    item = extension("scene.camera_surface").add_camera_surface(ocean, empty_scene, budget=BUDGET)

    def look(height, tilt, turn=0.0, frame=9):
        camera.location.z, camera.data.lens = height, 28.0
        camera.rotation_euler = (0.5 * math.pi - tilt, 0.0, turn)
        bpy.context.view_layer.update()
        empty_scene.frame_set(frame)
        return item

    return look


def edge_of(camera, scene, share):
    """Unit vectors through the picture's edges that lie at a share of its height, from the lower one."""
    frame = camera.data.view_frame(scene=scene)
    low, high = (min(corner.y for corner in frame), max(corner.y for corner in frame))
    left, right = (min(corner.x for corner in frame), max(corner.x for corner in frame))
    depth = frame[0].z
    turn = camera.matrix_world.to_3x3()
    for x in np.linspace(left, right, 21):
        yield (turn @ Vector((x, low + share * (high - low), depth))).normalized()


@pytest.mark.parametrize(
    ("height", "tilt", "turn"),
    [(3.0, 0.1, 0.0), (15.0, 0.25, 2.0), (60.0, 0.21, 0.0), (300.0, 0.25, -2.5), (300.0, 0.9, 1.0)],
)
def test_water_covers_the_picture_to_its_lower_edge(shown, camera, empty_scene, height, tilt, turn):
    item = shown(height, tilt, turn)
    mesh = evaluated_mesh(item)
    tree = BVHTree.FromPolygons(
        numbers(mesh, "position", 3).tolist(), [tuple(p.vertices) for p in mesh.polygons]
    )
    to_item = item.matrix_world.inverted()
    eye = to_item @ camera.matrix_world.translation
    # of the picture's height: the edge itself, and what motion blur and filters see beyond it
    for share in (-0.03, 0.0, 0.2):
        for line in edge_of(camera, empty_scene, share):
            assert tree.ray_cast(eye, to_item.to_3x3() @ line)[0] is not None


def test_a_picture_from_the_air_has_its_vertices_where_it_looks(shown, camera, empty_scene):
    """Of as many vertices far more are in the picture than of a lattice around the camera."""
    item = shown(300.0, 0.25, -2.5)
    mesh = evaluated_mesh(item)
    to_camera = camera.matrix_world.inverted() @ item.matrix_world
    seen = np.array([to_camera @ Vector(place) for place in numbers(mesh, "position", 3)])
    frame = np.array(camera.data.view_frame(scene=empty_scene))
    inside = np.all(np.abs(seen[:, :2] / seen[:, 2:]) < np.abs(frame[0, :2] / frame[0, 2]), axis=1)
    inside &= seen[:, 2] < 0.0
    assert len(seen) <= BUDGET
    assert np.mean(inside) > 0.3
    assert len(mesh.polygons) > 0.9 * len(seen)
    up = [polygon.normal.z for polygon in mesh.polygons]
    assert np.mean(np.array(up) > 0.0) > 0.99


def test_its_foam_is_that_of_the_core_where_its_vertices_are(shown, extension, core, parameters):
    item = shown(60.0, 0.25)
    mesh = evaluated_mesh(item)
    rest = numbers(mesh, "position", 3) - numbers(mesh, "displacement", 3)
    foam, breaking = (numbers(mesh, name, 1)[:, 0] for name in ("foam", "breaking"))
    near = np.linalg.norm(rest[:, :2] - rest[np.argmax(breaking), :2], axis=1) < 25.0
    cusp = core.Ocean(parameters).surface(
        parameters.timing.time(9), {"cusp"}, on=core.Places(*rest[near, :2].T)
    ).cusp  # fmt: skip
    breaks = breaking[near] > 0.5
    assert np.count_nonzero(breaks) > 5
    assert np.median(cusp[breaks]) > np.quantile(cusp, 0.9)
    levels = extension("core.sea.foam_levels").FoamLevels(parameters)
    assert foam.min() >= 0.0
    assert np.median(foam) < 2.0 * levels.beyond.foam


def test_cameras_that_look_down_have_rings_and_all_others_a_fan(shown):
    def columns(item):
        (points,) = [child for child in item.parent.children if child.name.endswith("Foam")]
        return points.data.vertices[-1].co.y

    assert columns(shown(60.0, 0.25)) > 0.0
    assert columns(shown(6.0, 0.25)) > 0.0
    assert columns(shown(2.0, -0.1)) > 0.0
    assert columns(shown(60.0, 1.4)) == 0.0


def test_a_window_does_not_wait_for_a_fan(shown, extension, monkeypatch):
    monkeypatch.setattr(extension("scene.refinement"), "has_window", lambda: True)
    item = shown(60.0, 0.25)
    (points,) = [child for child in item.parent.children if child.name.endswith("Foam")]
    assert points.data.vertices[-1].co.y == 0.0
    bpy.ops.wm.read_homefile(use_empty=True)


def test_a_camera_that_turns_takes_the_fan_along(shown, camera, empty_scene):
    item = shown(60.0, 0.25)
    for frame, turn in ((9, 0.0), (10, 1.5)):
        camera.rotation_euler.z = turn
        camera.keyframe_insert("rotation_euler", frame=frame)
    empty_scene.frame_set(9)
    empty_scene.frame_set(10)
    rest = numbers(evaluated_mesh(item), "position", 3)
    away = np.array([item.matrix_world @ Vector(place) for place in rest])[:, :2]
    away -= np.array(camera.matrix_world.translation)[:2]
    ahead = np.array(camera.matrix_world.to_3x3() @ Vector((0.0, 0.0, -1.0)))[:2]
    cosine = away @ ahead / np.linalg.norm(away, axis=1) / np.linalg.norm(ahead)
    assert np.mean(cosine > math.cos(0.9)) > 0.7
