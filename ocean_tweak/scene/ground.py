# SPDX-License-Identifier: GPL-3.0-or-later
"""The ground of ready scenes with a coast: a mesh of bed and land. Its materials are in `ground_material`."""

from __future__ import annotations

from collections.abc import Callable

import bpy
import numpy as np
from numpy.typing import NDArray

from ..core.numerics.interpolation import between, smoothstep
from ..core.waves.coast.beds import BEDS, SIDE
from .ground_material import ROCK, ground_material
from .relief import rock as rock_relief

Array = NDArray[np.float64]

#: cells along each side of the mesh
_CELLS = 512
#: beds that are stone from side to side: on others it is where the ground is steep, and some metres around
_OF_STONE = {"HARBOUR", "ISLET"}
#: z of the normal of what is sand, and how far below that all is rock
_LEVEL, _STEEPER = 0.955, 0.07
#: how far rock reaches from where it is steep, m
_AROUND = 9
#: between which heights above the water rock's relief begins, m, and how far all of it stands out
_BEGINS, _WHOLE, _STANDS = 0.03, 0.8, 1.2
#: cells of rock that is seen from near, m, and where it is, from and to x and y, m
_FINE = 0.4
_SEEN = {"ISLET": ((190.0, 310.0), (182.0, 330.0)), "BEACH": ((225.0, 400.0), (384.0, 508.0))}


def add_ground(scene_name: str, bed: str, collection: bpy.types.Collection, scale: float) -> bpy.types.Object:
    """A mesh of one of the beds to begin with, its corner x = y = 0 at the origin.

    Under water it is the bed; its land has crags where it is rock.

    scale : Blender units in a metre
    """
    x, y = np.meshgrid(*(_along(*fine) for fine in _SEEN.get(bed, ((0.0, 0.0), (0.0, 0.0)))))
    height = BEDS[bed](x, y)
    rock = np.ones_like(height) if bed in _OF_STONE else _steep(BEDS[bed], x, y)
    if bed != "HARBOUR":  # what is built is even
        height = height + rock * _relief(x, y, height)
    return land(scene_name, np.stack((x, y, height), axis=-1), rock, collection, scale)


def land(
    name: str, places: Array, rock: Array, collection: bpy.types.Collection, scale: float
) -> bpy.types.Object:
    """A mesh of quads with the ground's material.

    places : (rows, columns, 3) x, y and height, m; x grows along columns and y along rows
    rock : (rows, columns) 0…1, what of it is rock
    scale : Blender units in a metre
    """
    number = np.arange(rock.size, dtype=np.int32).reshape(rock.shape)
    corners = np.stack((number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]), axis=-1)
    mesh = bpy.data.meshes.new(name)
    mesh.vertices.add(rock.size)
    mesh.vertices.foreach_set("co", (places * scale).astype(np.float32).reshape(-1))
    mesh.loops.add(corners.size)
    mesh.loops.foreach_set("vertex_index", corners.reshape(-1))
    mesh.polygons.add(corners.size // 4)
    mesh.polygons.foreach_set("loop_start", np.arange(0, corners.size, 4, dtype=np.int32))
    mesh.update(calc_edges=True)
    mesh.shade_smooth()
    attribute = mesh.attributes.new(ROCK, "FLOAT", "POINT")
    attribute.data.foreach_set("value", rock.astype(np.float32).reshape(-1))
    item = bpy.data.objects.new(name, mesh)
    mesh.materials.append(ground_material(scale))
    collection.objects.link(item)
    return item


def _steep(bed: Callable[[Array, Array], Array], x: Array, y: Array) -> Array:
    """0…1, rock where ground is steep and around it."""
    along = np.linspace(0.0, SIDE, _CELLS + 1)
    height = bed(*np.meshgrid(along, along))
    along_y, along_x = np.gradient(height, SIDE / _CELLS)
    normal = 1.0 / np.sqrt(1.0 + along_x**2 + along_y**2)
    rock = smoothstep((_LEVEL - normal) / _STEEPER) * (height > -1.0)
    wide = np.maximum(rock, _mean(rock, round(_AROUND * _CELLS / SIDE)) * 2.0)
    place = between(y * (_CELLS / SIDE), x * (_CELLS / SIDE), wide.shape)
    return np.asarray(place.read(np.minimum(wide, 1.0)))


def _mean(field: Array, reach: int) -> Array:
    """Mean over a square of so many samples to each side; at the edges, over what there is of it repeated."""
    for axis in (0, 1):
        wide = np.pad(field, [(reach + 1, reach) if each == axis else (0, 0) for each in (0, 1)], "edge")
        total = np.cumsum(wide, axis=axis)
        high, low = (np.take(total, np.arange(n, n + field.shape[axis]), axis) for n in (2 * reach + 1, 0))
        field = (high - low) / (2 * reach + 1)
    return field


def _relief(x: Array, y: Array, height: Array) -> Array:
    """m that rock stands out above the bed's formula, or falls short of it: none under water."""
    total = rock_relief(x, y, height) + _STANDS
    # land stays land
    return smoothstep((height - _BEGINS) / (_WHOLE - _BEGINS)) * np.maximum(
        total, -0.6 * np.maximum(height, 0.0)
    )


def _along(first: float, last: float) -> Array:
    """m, lines of the mesh from 0 to SIDE: close together from first to last."""
    within = round((last - first) / _FINE)
    before = round((_CELLS - within) * first / (SIDE - last + first))
    return np.interp(np.arange(_CELLS + 1), (0, before, before + within, _CELLS), (0.0, first, last, SIDE))
