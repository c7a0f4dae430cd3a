# SPDX-License-Identifier: GPL-3.0-or-later
"""Weights that were painted on a mesh, as seen from above the ocean: an image over its domain."""

from __future__ import annotations

import bpy
import numpy as np
from mathutils import Vector
from mathutils.bvhtree import BVHTree
from numpy.typing import NDArray

from ..core import Raster
from .settings import OceanObjectError, settings_of
from .view_layers import evaluated, taking_part

Array = NDArray[np.float64]


def weights_seen(
    ocean: bpy.types.Object, mesh: bpy.types.Object | None, group: str, scene: bpy.types.Scene, samples: int
) -> Raster:
    """(samples, samples) weights of the highest face over or under each place of the domain; 0 beside it.

    mesh : as its modifiers leave it, wherever it stands and whatever hides it
    group : name of its vertex group

    Raises OceanObjectError for a mesh or group that is not there, or not over the domain.
    """
    if mesh is None or mesh.type != "MESH":
        raise OceanObjectError("Choose a mesh that has the weights")
    if group not in mesh.vertex_groups:
        there = ", ".join(item.name for item in mesh.vertex_groups) or "none"
        raise OceanObjectError(f"{mesh.name} has no vertex group {group!r}: it has {there}")
    with taking_part(scene, mesh, geometry=True):
        made = mesh.evaluated_get(evaluated(scene))
        data = made.to_mesh()
        try:
            weight = _weights(data, mesh.vertex_groups[group].index)
            data.transform(ocean.matrix_world.inverted_safe() @ made.matrix_world)
            data.calc_loop_triangles()
            corners, places = _arrays(data)
        finally:
            made.to_mesh_clear()
    seen = _seen(corners, places, weight, settings_of(ocean).domain_size, samples)
    if not np.isfinite(seen).any():
        raise OceanObjectError(
            f"{mesh.name} is neither over nor under the patch of {ocean.name}: move it there"
        )
    return Raster(np.nan_to_num(seen, nan=0.0), f"{mesh.name} {group}")


def _weights(mesh: bpy.types.Mesh, index: int) -> Array:
    """Of each vertex; 0 where it is not in the group."""
    found = [
        next((entry.weight for entry in vertex.groups if entry.group == index), 0.0)
        for vertex in mesh.vertices
    ]
    return np.array(found)


def _arrays(mesh: bpy.types.Mesh) -> tuple[NDArray[np.int32], NDArray[np.float32]]:
    """(triangles, 3) vertices of each, and (vertices, 3) places."""
    corners = np.empty(3 * len(mesh.loop_triangles), np.int32)
    mesh.loop_triangles.foreach_get("vertices", corners)
    places = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", places)
    return corners.reshape(-1, 3), places.reshape(-1, 3)


def _seen(
    corners: NDArray[np.int32], places: NDArray[np.float32], weight: Array, size: float, samples: int
) -> Array:
    """(samples, samples) weight at the middle of each cell [y, x]; not a number beside the mesh."""
    result = np.full((samples, samples), np.nan)
    if not len(corners):
        return result
    tree = BVHTree.FromPolygons(places.tolist(), corners.tolist(), all_triangles=True)
    top, down = float(places[:, 2].max()) + 1.0, Vector((0.0, 0.0, -1.0))
    middle = (np.arange(samples) + 0.5) * (size / samples)
    hits = [
        (row, column, number)
        for row, y in enumerate(middle)
        for column, x in enumerate(middle)
        if (number := tree.ray_cast(Vector((x, y, top)), down)[2]) is not None
    ]
    if not hits:
        return result
    rows, columns, numbers = np.array(hits).T
    a, b, c = (places[corners[numbers, corner], :2].astype(np.float64) for corner in range(3))
    at = np.stack((middle[columns], middle[rows]), axis=-1)
    whole = _cross(b - a, c - a)
    share_b, share_c = _cross(at - a, c - a) / whole, _cross(b - a, at - a) / whole
    shares = np.clip(np.stack((1.0 - share_b - share_c, share_b, share_c)), 0.0, 1.0)
    result[rows, columns] = np.sum(shares.T * weight[corners[numbers]], axis=1)
    return result


def _cross(first: Array, second: Array) -> Array:
    return first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
