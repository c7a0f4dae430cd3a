# SPDX-License-Identifier: GPL-3.0-or-later
"""The flat grid that the waves move: quads over patches side by side, anchored at the object's origin."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

from ..nodes.names import TEXTURE_COORDINATES

_KEY = "ocean_tweak_grid"


@dataclass(frozen=True)
class Grid:
    """The parameters of the mesh.

    size : side of one patch in Blender units
    quads : along each side of one patch
    samples : along each side of the image that will move it
    repeats : patches side by side along x and y
    """

    size: float
    quads: int
    samples: int
    repeats: tuple[int, int] = (1, 1)

    @property
    def tag(self) -> str:
        """The value of the mesh's custom property."""
        return f"{self.size!r} {self.quads} {self.samples} {self.repeats[0]} {self.repeats[1]}"

    @property
    def columns(self) -> int:
        """Quads along x."""
        return self.quads * self.repeats[0]

    @property
    def rows(self) -> int:
        """Quads along y."""
        return self.quads * self.repeats[1]

    @property
    def vertices(self) -> int:
        """Number of vertices."""
        return (self.columns + 1) * (self.rows + 1)

    def positions(self) -> NDArray[np.float32]:
        """(vertices, 3) float32, Blender units: x fastest, from 0 to repeats × `size`."""
        result = np.zeros((self.rows + 1, self.columns + 1, 3), np.float32)
        step = self.size / self.quads
        result[..., 0] = np.arange(self.columns + 1) * step
        result[..., 1] = (np.arange(self.rows + 1) * step)[:, np.newaxis]
        return result.reshape(-1, 3)

    def corners(self) -> NDArray[np.int32]:
        """(quads, 4) int32: vertices of each quad, counter-clockwise from above."""
        row = self.columns + 1
        first = _numbers(self.rows, row)[:, :-1].reshape(-1, 1)
        return first + np.array([0, 1, row + 1, row], np.int32)

    def edges(self) -> NDArray[np.int32]:
        """(edges, 2) int32: vertices of each edge, first those along x, then those along y."""
        vertex = _numbers(self.rows + 1, self.columns + 1)
        along_x = np.stack([vertex[:, :-1], vertex[:, 1:]], axis=-1)
        along_y = np.stack([vertex[:-1], vertex[1:]], axis=-1)
        return np.concatenate([along_x.reshape(-1, 2), along_y.reshape(-1, 2)])

    def corner_edges(self) -> NDArray[np.int32]:
        """(quads, 4) int32: the edge from each corner of a quad to its next one."""
        along_x = _numbers(self.rows + 1, self.columns)
        along_y = along_x.size + _numbers(self.rows, self.columns + 1)
        sides = [along_x[:-1], along_y[:, 1:], along_x[1:], along_y[:, :-1]]
        return np.stack(sides, axis=-1).reshape(-1, 4)

    def texture_coordinates(self) -> NDArray[np.float32]:
        """(vertices, 2) float32: x/size + ½/samples, the centres of the texels that hold the samples.

        They go on over the repeats: the last column of the first patch reads 1 + ½/samples, which a repeating
        image gives the sample of the first one.
        """
        x, y = (np.arange(count + 1) / self.quads + 0.5 / self.samples for count in (self.columns, self.rows))
        return np.stack(np.meshgrid(x, y), axis=-1).astype(np.float32).reshape(-1, 2)


def _numbers(rows: int, columns: int) -> NDArray[np.int32]:
    return np.arange(rows * columns, dtype=np.int32).reshape(rows, columns)


def is_current(mesh: bpy.types.Mesh, grid: Grid) -> bool:
    """Whether the mesh was created as this grid; later edits are ignored."""
    return bool(mesh.get(_KEY) == grid.tag)


def shown_size(mesh: bpy.types.Mesh) -> float:
    """Side of a patch of the mesh's grid in Blender units; 0 if it is not a grid."""
    return float(str(mesh.get(_KEY, "0")).split()[0])


def release(mesh: bpy.types.Mesh) -> None:
    """Unmark a mesh as a grid of ours: an ocean that shares it gets another one."""
    if _KEY in mesh:
        del mesh[_KEY]


def fill(mesh: bpy.types.Mesh, grid: Grid) -> None:
    """Make the mesh this grid; materials stay."""
    other_size = str(mesh.get(_KEY)).split()[1:] == grid.tag.split()[1:]
    if not (other_size and len(mesh.vertices) == grid.vertices):
        _fill_topology(mesh, grid)
    mesh.attributes["position"].data.foreach_set("vector", grid.positions().reshape(-1))
    mesh[_KEY] = grid.tag
    mesh.update_tag()


def _fill_topology(mesh: bpy.types.Mesh, grid: Grid) -> None:
    corners, edges = grid.corners(), grid.edges()
    mesh.clear_geometry()
    mesh.vertices.add(grid.vertices)
    mesh.edges.add(len(edges))
    mesh.loops.add(corners.size)
    mesh.polygons.add(len(corners))
    # set explicitly, as Blender takes longer to compute the edges than for everything else
    for name, values in (
        (".edge_verts", edges),
        (".corner_vert", corners),
        (".corner_edge", grid.corner_edges()),
    ):
        mesh.attributes[name].data.foreach_set("value", values.reshape(-1))
    mesh.polygons.foreach_set("loop_start", np.arange(0, corners.size, 4, dtype=np.int32))
    mesh.update()
    mesh.shade_smooth()
    uv_map = mesh.uv_layers.new(name=TEXTURE_COORDINATES, do_init=False)
    uv_map.uv.foreach_set("vector", grid.texture_coordinates()[corners.reshape(-1)].reshape(-1))
