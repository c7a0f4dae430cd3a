# SPDX-License-Identifier: GPL-3.0-or-later
"""A live surface on the mesh's vertices: the quickest way to show it, and what shots read."""

from __future__ import annotations

from collections.abc import Mapping

import bpy
import numpy as np
from numpy.typing import NDArray

from ..nodes.names import POINT_TYPES, VELOCITY
from .grid_mesh import Grid

# the name of the numbers in Blender's attribute types
_VALUES = {"FLOAT_VECTOR": "vector", "FLOAT": "value"}


def can_hold(mesh: bpy.types.Mesh, grid: Grid) -> bool:
    """Whether the mesh has a vertex for each sample, and Blender lets them be written."""
    fits = grid.quads == grid.samples and len(mesh.vertices) == grid.vertices
    # what is written on a linked mesh is dropped without a word
    return fits and not mesh.is_editmode and mesh.library is None


def write(mesh: bpy.types.Mesh, values: Mapping[str, NDArray[np.float32]]) -> None:
    """Put (rows+1, columns+1, …) fields on the vertices; the other attributes of a surface go.

    values : by names in POINT_TYPES, in the units said there
    """
    remove(mesh, keep=values)
    for name, field in values.items():
        data_type = POINT_TYPES[name]
        attribute = mesh.attributes.get(name)
        if attribute is not None and not _is_ours(attribute):
            mesh.attributes.remove(attribute)
            attribute = None
        if attribute is None:
            attribute = mesh.attributes.new(name, data_type, "POINT")
        attribute.data.foreach_set(_VALUES[data_type], np.ascontiguousarray(field).reshape(-1))
    mesh.update_tag()


def remove(mesh: bpy.types.Mesh, keep: Mapping[str, object] | None = None) -> None:
    """Take a surface's attributes away where something else writes them."""
    if mesh.library is not None or mesh.is_editmode:
        return
    for name in POINT_TYPES:
        attribute = mesh.attributes.get(name)
        if attribute is not None and name not in (keep or {}) and _is_ours(attribute):
            mesh.attributes.remove(attribute)


def make_still(mesh: bpy.types.Mesh) -> None:
    """Take away what would blur a mesh that moves no more: Cycles goes by the attribute alone."""
    remove(mesh, keep=dict.fromkeys(name for name in POINT_TYPES if name != VELOCITY))


def _is_ours(attribute: bpy.types.Attribute) -> bool:
    return (attribute.data_type, attribute.domain) == (POINT_TYPES[attribute.name], "POINT")
