# SPDX-License-Identifier: GPL-3.0-or-later
"""A live surface on the mesh's vertices: the quickest way to show it, and what shots read."""

from __future__ import annotations

from collections.abc import Container, Mapping

import bpy
import numpy as np
from numpy.typing import NDArray

from ..core.numerics.interpolation import stretched
from ..core.synthesis.channels import CHANNELS, Channel
from .grid_mesh import Grid

RealArray = NDArray[np.float32]
#: by channel, [y, x]
Fields = Mapping[str, RealArray]

# by a channel's components, Blender's type of an attribute and its name for the numbers
_TYPES = {0: ("FLOAT", "value"), 2: ("FLOAT2", "vector"), 3: ("FLOAT_VECTOR", "vector")}
# what an ocean's own mesh may have
_OF_OCEANS = tuple(channel for channel in CHANNELS.values() if channel.switch is not None)


def can_hold(mesh: bpy.types.Mesh, grid: Grid) -> bool:
    """Whether the mesh has a vertex for each sample, and Blender lets them be written."""
    fits = grid.quads == grid.samples and len(mesh.vertices) == grid.vertices
    # what is written on a linked mesh is dropped without a word
    return fits and not mesh.is_editmode and mesh.library is None


def write(mesh: bpy.types.Mesh, values: Fields) -> None:
    """Put (rows+1, columns+1, …) fields on the vertices; the other attributes of a surface go.

    values : by channel, in Blender units
    """
    remove(mesh, keep=values)
    for name, field in values.items():
        put(mesh, CHANNELS[name], field)
    mesh.update_tag()


def put(mesh: bpy.types.Mesh, channel: Channel, field: RealArray) -> None:
    """Put a channel's numbers on the vertices, in whatever shape they are."""
    kind, numbers = _TYPES[channel.components]
    attribute = mesh.attributes.get(channel.attribute)
    if attribute is not None and not _is_ours(attribute, channel):
        mesh.attributes.remove(attribute)
        attribute = None
    if attribute is None:
        attribute = mesh.attributes.new(channel.attribute, kind, "POINT")
    attribute.data.foreach_set(numbers, np.ascontiguousarray(field).reshape(-1))


def read(mesh: bpy.types.Mesh) -> Fields:
    """The channels of a surface that the mesh has, (vertices, components) in Blender units."""
    found = {}
    for channel in _OF_OCEANS:
        attribute = mesh.attributes.get(channel.attribute)
        if attribute is not None and _is_ours(attribute, channel):
            field = np.empty((len(attribute.data), max(channel.components, 1)), np.float32)
            attribute.data.foreach_get(_TYPES[channel.components][1], field.reshape(-1))
            found[channel.name] = field
    return found


def resampled(closed: RealArray, samples: int) -> RealArray:
    """Bilinear values of an (n+1, n+1, …) field, its far edges included, as (samples+1, samples+1, …)."""
    # columns while there are few rows: what is left are whole rows, added in place
    return stretched(stretched(closed, 1, samples), 0, samples)


def tiled(closed: RealArray, repeats: tuple[int, int]) -> RealArray:
    """An (n+1, n+1, …) field side by side along x and y, neighbours sharing their edge."""
    for axis, count in ((1, repeats[0]), (0, repeats[1])):
        if count > 1:
            whole, edge = np.split(closed, [closed.shape[axis] - 1], axis)
            closed = np.concatenate([whole] * count + [edge], axis)
    return closed


def remove(mesh: bpy.types.Mesh, keep: Container[str] = ()) -> None:
    """Take a surface's attributes away where something else writes them, but those of some channels."""
    if mesh.library is not None or mesh.is_editmode:
        return
    for channel in _OF_OCEANS:
        attribute = mesh.attributes.get(channel.attribute)
        if attribute is not None and channel.name not in keep and _is_ours(attribute, channel):
            mesh.attributes.remove(attribute)


def make_still(mesh: bpy.types.Mesh) -> None:
    """Take away what would blur a mesh that moves no more: Cycles goes by the attribute alone."""
    remove(mesh, keep=CHANNELS.keys() - {"velocity"})


def _is_ours(attribute: bpy.types.Attribute, channel: Channel) -> bool:
    return (attribute.data_type, attribute.domain) == (_TYPES[channel.components][0], "POINT")
