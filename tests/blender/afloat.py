# SPDX-License-Identifier: GPL-3.0-or-later
"""Something to float on a sea that has the water material."""

import math

import bpy
import numpy as np
import pytest

AT = (25.0, 40.0)


@pytest.fixture
def ocean(ocean_object, make_parameters, empty_scene, extension):
    """A small sea with the water material, the active object."""
    item = ocean_object.add(empty_scene, make_parameters())
    item.ocean_tweak.use_foam = False  # quicker
    bpy.context.view_layer.objects.active = item
    assert bpy.ops.ocean.use_water_material() == {"FINISHED"}
    return item


@pytest.fixture
def disc(empty_scene):
    """A buoy of 2 m across with its waterline half way up, at the origin."""

    def make(name="Disc"):
        angle = np.arange(32) * (2.0 * math.pi / 32)
        ring = np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=-1)
        half = np.array((0.0, 0.0, 0.5))
        places = np.concatenate([ring - half, ring + half])
        sides = [(i, (i + 1) % 32, 32 + (i + 1) % 32, 32 + i) for i in range(32)]
        mesh = bpy.data.meshes.new(name)
        mesh.from_pydata(places.tolist(), [], [*sides, range(32), range(32, 64)])
        item = bpy.data.objects.new(name, mesh)
        item.location = (*AT, 0.0)
        empty_scene.collection.objects.link(item)
        bpy.context.view_layer.update()
        return item

    return make


def update():
    bpy.context.view_layer.update()
