# SPDX-License-Identifier: GPL-3.0-or-later
"""The lines of a mesh or curve from which a mask measures, seen from above, in the ocean's axes."""

from __future__ import annotations

import json

import bpy
import numpy as np
from mathutils import Matrix
from numpy.typing import NDArray

#: whose shape has lines
KINDS = ("MESH", "CURVE")


def lines_of(item: bpy.types.Object, to_ocean: Matrix) -> NDArray[np.float32]:
    """(lines, 4) x and y of both ends of each edge, Blender units; of a curve, of the edges it is drawn with.

    Without modifiers, as one of them may read the sea, which depends on the mask.

    item : evaluated or original object
    """
    if item.type not in KINDS:
        return np.zeros((0, 4), np.float32)
    shape = item.original
    mesh = shape.data if item.type == "MESH" else shape.to_mesh()
    ends = np.empty(2 * len(mesh.edges), np.int32)
    mesh.edges.foreach_get("vertices", ends)
    places = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", places)
    if item.type != "MESH":
        shape.to_mesh_clear()
    matrix = np.array(to_ocean @ item.matrix_world)
    moved = places.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3]
    return moved[ends, :2].reshape(-1, 4).astype(np.float32)


def to_text(lines: NDArray[np.floating]) -> str:
    """Lines as exact text for a property."""
    return json.dumps(lines.tolist())


def from_text(text: str) -> NDArray[np.float64]:
    """(lines, 4) of `to_text`; none of a text that is damaged."""
    try:
        lines = np.array(json.loads(text or "[]"), np.float64)
    except (ValueError, RecursionError):
        lines = np.zeros((0, 4))
    return lines if lines.ndim == 2 and lines.shape[1] == 4 else np.zeros((0, 4))


def shifted(text: str, x: float, y: float) -> str:
    """The lines of a `to_text` text, shifted, in Blender units."""
    return to_text(from_text(text) + np.array((x, y, x, y))) if text else ""
