# SPDX-License-Identifier: GPL-3.0-or-later
"""The flat grid that the waves move: quads over one patch, anchored at the object's origin."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

from ..nodes.displace import UV_MAP

_KEY = "ocean_tweak_grid"


@dataclass(frozen=True)
class Grid:
    """What determines the mesh.

    size : side in Blender units
    quads : along each side
    samples : along each side of the image that will move it
    """

    size: float
    quads: int
    samples: int

    @property
    def tag(self) -> str:
        """What stands in the mesh's custom property."""
        return f"{self.size!r} {self.quads} {self.samples}"

    def positions(self) -> NDArray[np.float32]:
        """((quads+1)², 3) float32, Blender units: x fastest, from 0 to `size`."""
        side = np.arange(self.quads + 1) * (self.size / self.quads)
        result = np.zeros((self.quads + 1, self.quads + 1, 3), np.float32)
        result[..., 0] = side[np.newaxis, :]
        result[..., 1] = side[:, np.newaxis]
        return result.reshape(-1, 3)

    def corners(self) -> NDArray[np.int32]:
        """(quads², 4) int32: vertices of each quad, counter-clockwise from above."""
        row = self.quads + 1
        first = (np.arange(self.quads)[:, np.newaxis] * row + np.arange(self.quads)).reshape(-1, 1)
        return (first + np.array([0, 1, row + 1, row])).astype(np.int32)

    def texture_coordinates(self) -> NDArray[np.float32]:
        """((quads+1)², 2) float32: x/size + ½/samples, the centres of the texels that hold the samples.

        The last column reads 1 + ½/samples, which a repeating image gives the sample of the first one.
        """
        side = np.arange(self.quads + 1) / self.quads + 0.5 / self.samples
        u, v = np.meshgrid(side, side)
        return np.stack([u, v], axis=-1).astype(np.float32).reshape(-1, 2)


def is_current(mesh: bpy.types.Mesh, grid: Grid) -> bool:
    """Whether the mesh was made as this grid. What was edited on it since does not count."""
    return bool(mesh.get(_KEY) == grid.tag)


def fill(mesh: bpy.types.Mesh, grid: Grid) -> None:
    """Make the mesh this grid; materials stay."""
    corners = grid.corners()
    mesh.clear_geometry()
    mesh.vertices.add((grid.quads + 1) ** 2)
    mesh.loops.add(corners.size)
    mesh.polygons.add(len(corners))
    mesh.attributes["position"].data.foreach_set("vector", grid.positions().reshape(-1))
    mesh.loops.foreach_set("vertex_index", corners.reshape(-1))
    mesh.polygons.foreach_set("loop_start", np.arange(0, corners.size, 4, dtype=np.int32))
    mesh.update(calc_edges=True)
    mesh.shade_smooth()
    uv_map = mesh.uv_layers.new(name=UV_MAP, do_init=False)
    uv_map.uv.foreach_set("vector", grid.texture_coordinates()[corners.reshape(-1)].reshape(-1))
    mesh[_KEY] = grid.tag
    mesh.update_tag()
