# SPDX-License-Identifier: GPL-3.0-or-later
"""Depths of a mesh that is the bed of the sea, looked down at from above."""

from __future__ import annotations

import math
from typing import NamedTuple

import bpy
import numpy as np
from mathutils import Vector
from mathutils.bvhtree import BVHTree

from ..core import Raster
from .settings import OceanObjectError
from .view_layers import evaluated, taking_part

#: samples along the longer side
_SAMPLES = 257


class Bed(NamedTuple):
    """Depths over the square grid that a mesh covers.

    depth : m
    spacing : of its samples, m
    x, y : of the first one in the ocean's space, m
    """

    depth: Raster
    spacing: float
    x: float
    y: float


def read_bed(
    ocean: bpy.types.Object, mesh: bpy.types.Object | None, scene: bpy.types.Scene, scale: float
) -> Bed:
    """The bed that a mesh is, as its modifiers leave it; holes in it are filled from their sides.

    scale : Blender units in a metre

    Raises OceanObjectError for a mesh without faces, that lies edgewise, or was deleted.
    """
    if mesh is None or mesh.type != "MESH":
        raise OceanObjectError("Choose a mesh as Sea Bed: the ground under the water, and the land behind it")
    if not mesh.users_collection:  # as Blender leaves what is still read
        raise OceanObjectError(f"{mesh.name} was deleted: choose another mesh as Sea Bed")
    tree, low, high = _tree(ocean, mesh, scene)
    longest = max(high.x - low.x, high.y - low.y)
    if not min(high.x - low.x, high.y - low.y) > 0.0:
        raise OceanObjectError(f"{mesh.name} covers nothing, seen from above: choose a mesh of the ground")
    step = longest / (_SAMPLES - 1)
    rows, columns = (max(2, math.floor(side / step + 1e-6) + 1) for side in (high.y - low.y, high.x - low.x))
    depth = np.full((rows, columns), np.nan)
    above, down = high.z + 1.0, Vector((0.0, 0.0, -1.0))
    for row in range(rows):
        for column in range(columns):
            # a hair inside: a ray along the outermost edge may miss it
            x = min(max(low.x + column * step, low.x + 1e-4 * step), high.x - 1e-4 * step)
            y = min(max(low.y + row * step, low.y + 1e-4 * step), high.y - 1e-4 * step)
            hit = tree.ray_cast(Vector((x, y, above)), down)[0]
            if hit is not None:
                depth[row, column] = -hit.z / scale
    if not np.isfinite(depth).any():
        raise OceanObjectError(f"{mesh.name} covers nothing, seen from above: choose a mesh of the ground")
    name = f"{mesh.name} depth"
    return Bed(Raster(_filled(depth), name), step / scale, low.x / scale, low.y / scale)


def _tree(
    ocean: bpy.types.Object, mesh: bpy.types.Object, scene: bpy.types.Scene
) -> tuple[BVHTree, Vector, Vector]:
    """The faces in the ocean's space, and the corners of the box around them."""
    with taking_part(scene, mesh, geometry=True):
        made = mesh.evaluated_get(evaluated(scene))
        data = made.to_mesh()
        try:
            data.transform(ocean.matrix_world.inverted_safe() @ made.matrix_world)
            data.calc_loop_triangles()
            places = np.empty(3 * len(data.vertices), np.float32)
            data.vertices.foreach_get("co", places)
            corners = np.empty(3 * len(data.loop_triangles), np.int32)
            data.loop_triangles.foreach_get("vertices", corners)
        finally:
            made.to_mesh_clear()
    if not corners.size:
        raise OceanObjectError(f"{mesh.name} has no faces: choose a mesh of the ground")
    places = places.reshape(-1, 3)
    tree = BVHTree.FromPolygons(places.tolist(), corners.reshape(-1, 3).tolist(), all_triangles=True)
    return tree, Vector(places.min(axis=0).tolist()), Vector(places.max(axis=0).tolist())


def _filled(depth: np.ndarray) -> np.ndarray:
    """Holes filled from their sides, a sample at a time."""
    while True:
        holes = np.isnan(depth)
        if not holes.any():
            return depth
        wide = np.pad(depth, 1, constant_values=np.nan)
        sides = np.stack([wide[:-2, 1:-1], wide[2:, 1:-1], wide[1:-1, :-2], wide[1:-1, 2:]])
        count = np.isfinite(sides).sum(axis=0)
        mean = np.where(np.isfinite(sides), sides, 0.0).sum(axis=0) / np.maximum(count, 1)
        depth = np.where(holes & (count > 0), mean, depth)
