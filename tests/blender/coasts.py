# SPDX-License-Identifier: GPL-3.0-or-later
"""A sea over a slope, and what can be read of it."""

import bpy
import numpy as np
import pytest

SIDE = 200.0


def slope(name="Bed", hole=False):
    """A plane from 12 m below the water to 1 m above it, along +x."""
    xs = (0.0, 80.0, 120.0, SIDE) if hole else (0.0, SIDE)
    places = [(x, y, -12.0 + 0.065 * x) for x in xs for y in (0.0, SIDE)]
    faces = [(2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1) for i in range(len(xs) - 1) if not (hole and i == 1)]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(places, [], faces)
    item = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(item)
    return item


def fine_slope():
    """A slope of many faces, so that `wet` has vertices near the shore; the active object stays."""
    active, bed = bpy.context.view_layer.objects.active, slope()
    bpy.context.view_layer.objects.active = bed
    modifier = bed.modifiers.new("Fine", "SUBSURF")
    modifier.subdivision_type, modifier.levels = "SIMPLE", 6
    bpy.ops.object.modifier_apply(modifier=modifier.name)
    bpy.context.view_layer.objects.active = active
    return bed


@pytest.fixture
def calm(core):
    """A sea without a coast."""
    layer = core.WaveLayer(wind_speed=9.0, fetch=60e3)
    water = core.Water(depth=20.0)
    return core.OceanParameters(resolution=32, domain_size=SIDE, water=water, layers=(layer,))


@pytest.fixture
def ocean(empty_scene, ocean_object, calm):
    item = ocean_object.add(empty_scene, calm)
    bpy.context.view_layer.objects.active = item
    group = item.ocean_tweak.coast
    with item.ocean_tweak.quiet():
        group.rim, group.shortest_wavelength = 80.0, 40.0
    return item


@pytest.fixture
def coast_of(extension):
    return extension("scene.coast_surface").coast_of


@pytest.fixture
def coast(ocean, coast_of):
    """The mesh over a bed."""
    ocean.ocean_tweak.coast.bed = slope()
    bpy.ops.ocean.make_coast()
    return coast_of(ocean)


def values(mesh, name, components=1):
    attribute = mesh.attributes[name]
    found = np.empty(len(attribute.data) * components, np.float32)
    attribute.data.foreach_get("value" if components == 1 else "vector", found)
    return found.reshape(-1, components) if components > 1 else found
