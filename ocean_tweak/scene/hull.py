# SPDX-License-Identifier: GPL-3.0-or-later
"""Size and shape of a floating object: its bounds, from which the draft follows, and its waterline."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Matrix, Quaternion
from numpy.typing import NDArray

Array = NDArray[np.float64]
Numbers = NDArray[np.int32]

#: a middling ship: big container ships have four drafts of beam, deeply laden ones little more than two
_BEAM_OF_DRAFT = 3.0
_FULLEST = 8.0
#: points of a waterline, fewer of which tell no shape
_LEAST_POINTS = 6


@dataclass(frozen=True)
class Waterline:
    """Where the water's surface cuts a hull, as a superellipse; Blender units, in the hull's upright axes.

    middle : x and y
    half_length, half_beam : along x and y
    fullness : exponent: 1 is a rhombus, 2 an ellipse, more a box
    """

    middle: tuple[float, float]
    half_length: float
    half_beam: float
    fullness: float


@dataclass(frozen=True)
class Hull:
    """What of an object, and of its children, is to float.

    Its upright axes have z upwards and the object's own heading; the object's origin is theirs.

    scale : of the object's own coordinates
    tilt : from these, scaled, to the upright axes
    vertices : (N, 3) in the upright axes, Blender units
    edges : (M, 2) of their numbers
    triangles : (L, 3) of their numbers
    """

    scale: tuple[float, float, float]
    tilt: Quaternion
    vertices: Array
    edges: Numbers
    triangles: Numbers

    @property
    def keel(self) -> float:
        """How far below the origin the lowest point is."""
        return float(-self.vertices[:, 2].min())

    @property
    def beam(self) -> float:
        """The smaller one of the two horizontal sizes."""
        return float(np.ptp(self.vertices[:, :2], axis=0).min())

    @property
    def length(self) -> float:
        """The larger one of the two horizontal sizes."""
        return float(np.ptp(self.vertices[:, :2], axis=0).max())

    @property
    def is_along_y(self) -> bool:
        """Whether the larger one is that along y."""
        across, along = np.ptp(self.vertices[:, :2], axis=0)
        return bool(along > across)

    @property
    def draft(self) -> float:
        """Default draft: a third of its beam, at most half of its height."""
        return min(self.beam / _BEAM_OF_DRAFT, 0.5 * float(np.ptp(self.vertices[:, 2])))

    def waterline(self, level: float) -> Waterline | None:
        """Its waterline where water stands at a height above the origin; None where none cuts it."""
        above = self.vertices[:, 2] - level
        points = self._cut(above)
        if len(points) < _LEAST_POINTS:
            return None
        low, high = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        if not np.all(half > 0.0):
            return None
        return Waterline(tuple(middle), *half, _fullness(np.abs(points[:, :2] - middle) / half))

    def is_cut(self, level: float) -> bool:
        """Whether water cuts it that stands at a height above the origin."""
        return len(self._cut(self.vertices[:, 2] - level)) > 0

    def below(self, level: float) -> tuple[Array, Array]:
        """The least and the greatest x and y of what is under water that stands at a height above the origin.

        Something must be.
        """
        above = self.vertices[:, 2] - level
        points = np.concatenate((self.vertices[above <= 0.0], self._cut(above)))[:, :2]
        return points.min(axis=0), points.max(axis=0)

    def _cut(self, above: Array) -> Array:
        """(points, 3) where edges pass 0 of the height above something that their vertices have."""
        first, second = above[self.edges].T
        cut = self.edges[first * second < 0.0]
        first, second = above[cut].T
        share = (first / (first - second))[:, np.newaxis]
        return self.vertices[cut[:, 0]] * (1.0 - share) + self.vertices[cut[:, 1]] * share


def hull_of(
    item: bpy.types.Object, upright: Matrix, depsgraph: bpy.types.Depsgraph | None = None
) -> Hull | None:
    """An object's hull; None for one without any vertices, of its own or of its children.

    upright : the object's place in the world where it does not float
    depsgraph : that has evaluated its modifiers; None takes its mesh without them
    """
    parts = [_mesh(part, item, depsgraph) for part in (item, *item.children_recursive)]
    parts = [part for part in parts if len(part[0])]
    if not parts:
        return None
    first = np.cumsum([0, *(len(vertices) for vertices, _, _ in parts)])
    vertices = np.concatenate([vertices for vertices, _, _ in parts])
    edges, triangles = (
        np.concatenate([part[of] + before for part, before in zip(parts, first, strict=False)])
        for of in (1, 2)
    )
    _, turned, _ = upright.decompose()
    scale = item.matrix_world.to_scale()
    heading = Quaternion((turned.w, 0.0, 0.0, turned.z))
    tilt = heading.normalized().inverted() @ turned if heading.magnitude > 1e-6 else turned
    matrix = np.array(tilt.to_matrix()) * np.array(scale)
    return Hull(tuple(scale), tilt, vertices @ matrix.T, edges, triangles)


def meshes_of(item: bpy.types.Object) -> Iterator[bpy.types.Object]:
    """The object and its children, as far as they are meshes that are rendered."""
    return (part for part in (item, *item.children_recursive) if part.type == "MESH" and not part.hide_render)


def _mesh(
    part: bpy.types.Object, item: bpy.types.Object, depsgraph: bpy.types.Depsgraph | None
) -> tuple[Array, Numbers, Numbers]:
    """Vertices, edges and triangles of an object's mesh, in the coordinates of another."""
    if part not in meshes_of(item):
        return np.empty((0, 3)), np.empty((0, 2), np.int32), np.empty((0, 3), np.int32)
    mesh = part.data if depsgraph is None else part.evaluated_get(depsgraph).data
    flat = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", flat)
    matrix = np.array(item.matrix_world.inverted_safe() @ part.matrix_world)
    vertices = flat.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3]
    mesh.calc_loop_triangles()
    return vertices, _numbers(mesh.edges, 2), _numbers(mesh.loop_triangles, 3)


def _numbers(elements: bpy.types.bpy_prop_collection, count: int) -> Numbers:
    """(elements, count) numbers of their vertices."""
    flat = np.empty(count * len(elements), np.int32)
    elements.foreach_get("vertices", flat)
    return flat.reshape(-1, count)


def _fullness(points: Array) -> float:
    """The exponent n for which u^n + v^n is nearest to 1 on (N, 2) points of the outline."""
    exponents = np.linspace(1.0, _FULLEST, 71)
    form = np.sum(points[np.newaxis] ** exponents[:, np.newaxis, np.newaxis], axis=-1)
    off = np.abs(form ** (1.0 / exponents[:, np.newaxis]) - 1.0).mean(axis=1)
    return float(exponents[off.argmin()])
