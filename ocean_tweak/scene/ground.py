# SPDX-License-Identifier: GPL-3.0-or-later
"""The ground of ready scenes with a coast: a mesh of bed and land. Its materials are in `ground_material`."""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from ..core.numerics.interpolation import between, smoothstep
from ..core.numerics.random import hash_cells, uniform
from ..core.waves.coast.beds import BEDS, SIDE
from .ground_material import ROCK, ground_material

Array = NDArray[np.float64]

#: cells along each side of the mesh
_CELLS = 512
#: beds that are stone from side to side: on others it is where the ground is steep, and some metres around
_OF_STONE = {"HARBOUR", "ISLET"}
#: z of the normal of what is sand, and how far below that all is rock
_LEVEL, _STEEPER = 0.955, 0.07
#: how far rock reaches from where it is steep, m
_AROUND = 9
#: length and height of rock's crags, m; and between which heights above the water they begin, m
_CRAGS = ((21.0, 1.5), (9.0, 1.1), (4.5, 0.7))
_CRAGS_BEGIN, _CRAGS_WHOLE = 0.1, 2.0


def add_ground(scene_name: str, bed: str, collection: bpy.types.Collection, scale: float) -> bpy.types.Object:
    """A mesh of one of the beds to begin with, its corner x = y = 0 at the origin.

    Under water it is the bed; its land has crags where it is rock.

    scale : Blender units in a metre
    """
    along = np.linspace(0.0, SIDE, _CELLS + 1)
    x, y = np.meshgrid(along, along)
    height = BEDS[bed](x, y)
    rock = np.ones_like(height) if bed in _OF_STONE else _steep(height)
    if bed != "HARBOUR":  # what is built is even
        height = height + rock * _crags(x, y, height)
    places = np.stack((x, y, height), axis=-1).reshape(-1, 3) * scale
    number = np.arange((_CELLS + 1) ** 2, dtype=np.int32).reshape(_CELLS + 1, _CELLS + 1)
    corners = np.stack((number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]), axis=-1)
    mesh = bpy.data.meshes.new(scene_name)
    mesh.vertices.add(len(places))
    mesh.vertices.foreach_set("co", places.astype(np.float32).reshape(-1))
    mesh.loops.add(corners.size)
    mesh.loops.foreach_set("vertex_index", corners.reshape(-1))
    mesh.polygons.add(corners.size // 4)
    mesh.polygons.foreach_set("loop_start", np.arange(0, corners.size, 4, dtype=np.int32))
    mesh.update(calc_edges=True)
    mesh.shade_smooth()
    attribute = mesh.attributes.new(ROCK, "FLOAT", "POINT")
    attribute.data.foreach_set("value", rock.astype(np.float32).reshape(-1))
    item = bpy.data.objects.new(scene_name, mesh)
    mesh.materials.append(ground_material(scale))
    collection.objects.link(item)
    return item


def _steep(height: Array) -> Array:
    """0…1, rock where ground is steep and around it."""
    along_y, along_x = np.gradient(height, SIDE / _CELLS)
    normal = 1.0 / np.sqrt(1.0 + along_x**2 + along_y**2)
    rock = smoothstep((_LEVEL - normal) / _STEEPER) * (height > -1.0)
    wide = np.maximum(rock, _mean(rock, round(_AROUND * _CELLS / SIDE)) * 2.0)
    return np.minimum(wide, 1.0)


def _mean(field: Array, reach: int) -> Array:
    """Mean over a square of so many samples to each side; at the edges, over what there is of it repeated."""
    for axis in (0, 1):
        wide = np.pad(field, [(reach + 1, reach) if each == axis else (0, 0) for each in (0, 1)], "edge")
        total = np.cumsum(wide, axis=axis)
        high, low = (np.take(total, np.arange(n, n + field.shape[axis]), axis) for n in (2 * reach + 1, 0))
        field = (high - low) / (2 * reach + 1)
    return field


def _crags(x: Array, y: Array, height: Array) -> Array:
    """m that rock stands out above the bed's formula, or falls short of it: none under water."""
    total = np.zeros_like(height)
    for number, (length, size) in enumerate(_CRAGS):
        total += size * (0.6 - np.abs(2.0 * _lattice(x / length, y / length, number) - 1.0) * 1.4)
    # land stays land
    return smoothstep((height - _CRAGS_BEGIN) / (_CRAGS_WHOLE - _CRAGS_BEGIN)) * np.maximum(
        total, -0.6 * np.maximum(height, 0.0)
    )


def _lattice(x: Array, y: Array, seed: int) -> Array:
    """0…1, random at integers and smooth in between."""
    columns = np.arange(int(x.max()) + 2, dtype=np.int64)
    rows = np.arange(int(y.max()) + 2, dtype=np.int64)
    values = uniform(hash_cells(columns[np.newaxis], rows[:, np.newaxis], seed), 0)
    place = between(y, x, values.shape)
    return np.asarray(place._replace(u=smoothstep(place.u), v=smoothstep(place.v)).read(values))
