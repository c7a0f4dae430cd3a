# SPDX-License-Identifier: GPL-3.0-or-later
"""A buoy beside an ocean, and where it must ride."""

import math

import bpy
import numpy as np
import pytest
from mathutils import Vector

FRAMES = (1, 48)
CENTIMETRE, DEGREE = 0.01, 1.0


@pytest.fixture
def select(empty_scene):
    """Select these objects and no others; the first one is active."""

    def choose(*items):
        for item in empty_scene.objects:
            item.select_set(item in items)
        bpy.context.view_layer.objects.active = items[0] if items else None
        bpy.context.view_layer.update()

    return choose


@pytest.fixture
def ocean(ocean_object, make_parameters, empty_scene):
    empty_scene.frame_start, empty_scene.frame_end = FRAMES
    item = ocean_object.add(empty_scene, make_parameters(), viewport_resolution=16)
    item.ocean_tweak.use_foam = False  # quicker
    item.location, item.rotation_euler.z = (12.0, -30.0, 2.0), 0.6
    return item


@pytest.fixture
def buoy(empty_scene):
    item = bpy.data.objects.new("Buoy", None)
    item.location = (25.0, 40.0, 9.0)
    empty_scene.collection.objects.link(item)
    return item


def sea_below(core, ocean, parameters, frame, place):
    """The point of the surface above a place in the world, and its normal there."""
    matrix = np.array(ocean.matrix_world)
    inside = np.linalg.inv(matrix) @ [*place[:2], 0.0, 1.0]
    found = core.Ocean(parameters).points_at(inside[0], inside[1], parameters.timing.time(frame))
    point = matrix @ [inside[0], inside[1], float(found.height), 1.0]
    return point[:3], matrix[:3, :3] @ found.normal


def assert_rides(item, core, ocean, parameters, frame, shown=None):
    point, normal = sea_below(core, ocean, parameters, shown or frame, (25.0, 40.0))
    matrix = np.array(item.matrix_world)
    assert np.linalg.norm(matrix[:3, 3] - point) < CENTIMETRE
    assert math.degrees(Vector(matrix[:3, 2]).angle(Vector(normal))) < DEGREE
