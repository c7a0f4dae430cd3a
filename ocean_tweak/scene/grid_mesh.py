# SPDX-License-Identifier: GPL-3.0-or-later
"""The flat grid that the waves move: quads over one patch, anchored at the object's origin."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

from ..nodes.displace import ATTRIBUTE
from ..nodes.grid import UV_MAP

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

    @property
    def vertices(self) -> int:
        """How many there are."""
        return (self.quads + 1) ** 2

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
        first = _numbers(self.quads, row)[:, :-1].reshape(-1, 1)
        return first + np.array([0, 1, row + 1, row], np.int32)

    def edges(self) -> NDArray[np.int32]:
        """(2·quads·(quads+1), 2) int32: vertices of each edge, first those along x, then those along y."""
        vertex = _numbers(self.quads + 1, self.quads + 1)
        along_x = np.stack([vertex[:, :-1], vertex[:, 1:]], axis=-1)
        along_y = np.stack([vertex[:-1], vertex[1:]], axis=-1)
        return np.concatenate([along_x.reshape(-1, 2), along_y.reshape(-1, 2)])

    def corner_edges(self) -> NDArray[np.int32]:
        """(quads², 4) int32: the edge from each corner of a quad to its next one."""
        along_x = _numbers(self.quads + 1, self.quads)
        along_y = along_x.size + _numbers(self.quads, self.quads + 1)
        sides = [along_x[:-1], along_y[:, 1:], along_x[1:], along_y[:, :-1]]
        return np.stack(sides, axis=-1).reshape(-1, 4)

    def texture_coordinates(self) -> NDArray[np.float32]:
        """((quads+1)², 2) float32: x/size + ½/samples, the centres of the texels that hold the samples.

        The last column reads 1 + ½/samples, which a repeating image gives the sample of the first one.
        """
        side = np.arange(self.quads + 1) / self.quads + 0.5 / self.samples
        u, v = np.meshgrid(side, side)
        return np.stack([u, v], axis=-1).astype(np.float32).reshape(-1, 2)


def _numbers(rows: int, columns: int) -> NDArray[np.int32]:
    return np.arange(rows * columns, dtype=np.int32).reshape(rows, columns)


def is_current(mesh: bpy.types.Mesh, grid: Grid) -> bool:
    """Whether the mesh was made as this grid. What was edited on it since does not count."""
    return bool(mesh.get(_KEY) == grid.tag)


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
    # told rather than calculated: Blender needs longer to find the edges than for all the rest
    for name, values in (
        (".edge_verts", edges),
        (".corner_vert", corners),
        (".corner_edge", grid.corner_edges()),
    ):
        mesh.attributes[name].data.foreach_set("value", values.reshape(-1))
    mesh.polygons.foreach_set("loop_start", np.arange(0, corners.size, 4, dtype=np.int32))
    mesh.update()
    mesh.shade_smooth()
    uv_map = mesh.uv_layers.new(name=UV_MAP, do_init=False)
    uv_map.uv.foreach_set("vector", grid.texture_coordinates()[corners.reshape(-1)].reshape(-1))


def can_hold_displacement(mesh: bpy.types.Mesh, grid: Grid) -> bool:
    """Whether the mesh has a vertex for each sample, and Blender lets them be written."""
    fits = grid.quads == grid.samples and len(mesh.vertices) == grid.vertices
    # what is written on a linked mesh is dropped without a word
    return fits and not mesh.is_editmode and mesh.library is None


def write_displacement(mesh: bpy.types.Mesh, displacement: NDArray[np.float32]) -> None:
    """Put a (quads+1, quads+1, 3) field in Blender units on the vertices, as an attribute."""
    attribute = _displacement(mesh)
    if attribute is None:
        taken = mesh.attributes.get(ATTRIBUTE)
        if taken is not None:
            mesh.attributes.remove(taken)
        attribute = mesh.attributes.new(ATTRIBUTE, "FLOAT_VECTOR", "POINT")
    attribute.data.foreach_set("vector", displacement.reshape(-1))
    mesh.update_tag()


def remove_displacement(mesh: bpy.types.Mesh) -> None:
    """Take the attribute away where something else moves the mesh."""
    attribute = _displacement(mesh)
    if attribute is not None and mesh.library is None and not mesh.is_editmode:
        mesh.attributes.remove(attribute)


def _displacement(mesh: bpy.types.Mesh) -> bpy.types.Attribute | None:
    attribute = mesh.attributes.get(ATTRIBUTE)
    if attribute is None or (attribute.data_type, attribute.domain) != ("FLOAT_VECTOR", "POINT"):
        return None
    return attribute
