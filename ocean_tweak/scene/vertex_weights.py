# SPDX-License-Identifier: GPL-3.0-or-later
"""Projects painted weights of a mesh from above to an image over the ocean's domain."""

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


_BLOCK = 4096  # rays of a step


class WeightsReading:
    """A projection in steps, which can be cancelled; it changes nothing.

    `finish` gives (samples, samples) weights of the highest face over or under each place of the domain, 0
    beside it, after `advance` was called once for each of `steps`.

    mesh : evaluated with its modifiers, wherever it is, even if hidden
    group : name of its vertex group

    Raises OceanObjectError for a missing mesh or group.
    """

    def __init__(
        self,
        ocean: bpy.types.Object,
        mesh: bpy.types.Object | None,
        group: str,
        scene: bpy.types.Scene,
        samples: int,
    ) -> None:
        if mesh is None or mesh.type != "MESH":
            raise OceanObjectError("Choose a mesh with the weights")
        if group not in mesh.vertex_groups:
            there = ", ".join(item.name for item in mesh.vertex_groups) or "none"
            raise OceanObjectError(f"{mesh.name} has no vertex group {group!r}: it has {there}")
        self._ocean, self._mesh, self._group, self._scene = ocean, mesh, group, scene
        self._seen = np.full((samples, samples), np.nan)
        self._rows = max(1, _BLOCK // samples)
        # the mesh as numbers, the tree of its faces, and blocks of rows
        self.steps, self.done = 2 + -(-samples // self._rows), 0

    def advance(self) -> None:
        """Do one step."""
        if self.done == 0:
            self._look()
        elif self.done == 1:
            self._tree = _tree_of(self._corners, self._places)
        else:
            first = (self.done - 2) * self._rows
            rows = range(first, min(first + self._rows, len(self._seen)))
            size = settings_of(self._ocean).domain_size
            _see(self._seen, rows, self._tree, self._corners, self._places, self._weight, size)
        self.done += 1

    def finish(self) -> Raster:
        """The weights. Raises OceanObjectError for a mesh that is not over or under the domain."""
        if not np.isfinite(self._seen).any():
            raise OceanObjectError(
                f"{self._mesh.name} is neither above nor below the patch of {self._ocean.name}: move it there"
            )
        return Raster(np.nan_to_num(self._seen, nan=0.0), f"{self._mesh.name} {self._group}")

    def cancel(self) -> None:
        """Nothing was changed."""

    def abandon(self) -> None:
        """Nothing runs in the background."""

    def _look(self) -> None:
        with taking_part(self._scene, self._mesh, geometry=True):
            made = self._mesh.evaluated_get(evaluated(self._scene))
            data = made.to_mesh()
            try:
                self._weight = _weights(data, self._mesh.vertex_groups[self._group].index)
                data.transform(self._ocean.matrix_world.inverted_safe() @ made.matrix_world)
                data.calc_loop_triangles()
                self._corners, self._places = _arrays(data)
            finally:
                made.to_mesh_clear()


def weights_seen(reading: WeightsReading) -> Raster:
    """The weights of a projection, all at once. Raises the errors of `finish`."""
    while reading.done < reading.steps:
        reading.advance()
    return reading.finish()


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


def _tree_of(corners: NDArray[np.int32], places: NDArray[np.float32]) -> BVHTree | None:
    if not len(corners):
        return None
    return BVHTree.FromPolygons(places.tolist(), corners.tolist(), all_triangles=True)


def _see(
    seen: Array,
    rows: range,
    tree: BVHTree | None,
    corners: NDArray[np.int32],
    places: NDArray[np.float32],
    weight: Array,
    size: float,
) -> None:
    """Fill some rows of (samples, samples) with the weights at cell centres, 0 beside the mesh."""
    if tree is None:
        return
    top, down = float(places[:, 2].max()) + 1.0, Vector((0.0, 0.0, -1.0))
    middle = (np.arange(len(seen)) + 0.5) * (size / len(seen))
    hits = [
        (row, column, number)
        for row in rows
        for column, x in enumerate(middle)
        if (number := tree.ray_cast(Vector((x, middle[row], top)), down)[2]) is not None
    ]
    if not hits:
        return
    numbered, columns, numbers = np.array(hits).T
    a, b, c = (places[corners[numbers, corner], :2].astype(np.float64) for corner in range(3))
    at = np.stack((middle[columns], middle[numbered]), axis=-1)
    whole = _cross(b - a, c - a)
    share_b, share_c = _cross(at - a, c - a) / whole, _cross(b - a, at - a) / whole
    shares = np.clip(np.stack((1.0 - share_b - share_c, share_b, share_c)), 0.0, 1.0)
    seen[numbered, columns] = np.sum(shares.T * weight[corners[numbers]], axis=1)


def _cross(first: Array, second: Array) -> Array:
    return first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
