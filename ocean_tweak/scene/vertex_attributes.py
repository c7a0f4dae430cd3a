# SPDX-License-Identifier: GPL-3.0-or-later
"""A live surface as attributes of the mesh's vertices, the fastest way to show it."""

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

# number of components → Blender's attribute type, and the name of its value property
_TYPES = {0: ("FLOAT", "value"), 2: ("FLOAT2", "vector"), 3: ("FLOAT_VECTOR", "vector")}
# attributes of an ocean's own mesh
_OF_OCEANS = tuple(channel for channel in CHANNELS.values() if channel.switch is not None)


def can_hold(mesh: bpy.types.Mesh, grid: Grid) -> bool:
    """Whether the mesh has a vertex per sample and can be written."""
    fits = grid.quads == grid.samples and len(mesh.vertices) == grid.vertices
    # changes to a linked mesh are silently discarded
    return fits and not mesh.is_editmode and mesh.library is None


def write(mesh: bpy.types.Mesh, values: Fields) -> None:
    """Write (rows+1, columns+1, …) fields to the vertices, and remove the surface's other attributes.

    values : by channel, in Blender units
    """
    remove(mesh, keep=values)
    for name, field in values.items():
        put(mesh, CHANNELS[name], field)
    mesh.update_tag()


def put(mesh: bpy.types.Mesh, channel: Channel, field: RealArray) -> None:
    """Write a channel's values, of any shape, to the vertices."""
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
    """Remove a surface's attributes, except those of some channels, as something else writes them."""
    if mesh.library is not None or mesh.is_editmode:
        return
    for channel in _OF_OCEANS:
        attribute = mesh.attributes.get(channel.attribute)
        if attribute is not None and channel.name not in keep and _is_ours(attribute, channel):
            mesh.attributes.remove(attribute)


def make_still(mesh: bpy.types.Mesh) -> None:
    """Remove the velocity of a mesh that no longer moves, which Cycles would use for motion blur."""
    remove(mesh, keep=CHANNELS.keys() - {"velocity"})


def _is_ours(attribute: bpy.types.Attribute, channel: Channel) -> bool:
    return (attribute.data_type, attribute.domain) == (_TYPES[channel.components][0], "POINT")
