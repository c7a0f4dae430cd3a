# SPDX-License-Identifier: GPL-3.0-or-later
"""Closed meshes from formulas, and their paint, for the floating objects of the ready scenes.

Every solid is a loft: rings of points, one after another, joined by quads and closed at both ends.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..nodes.contact import WET_BAND
from ..nodes.versioned import node_group

Array = NDArray[np.float64]
Numbers = NDArray[np.int32]

_KEY = "ocean_tweak_paint"
_SHARP = 0.6  # rad between two faces


@dataclass(frozen=True)
class Paint:
    """A plain surface.

    colour : linear
    light : that it gives of its own
    """

    name: str
    colour: tuple[float, float, float]
    roughness: float
    light: float = 0.0
    metallic: float = 0.0


@dataclass(frozen=True)
class Solid:
    """A closed mesh.

    vertices : (V, 3) in m
    faces : (F, 4) of their numbers, counter-clockwise from outside
    paints : (F,) number of each face's paint
    """

    vertices: Array
    faces: Numbers
    paints: Numbers

    def mirrored(self) -> Solid:
        """Its image on the other side of the plane y = 0."""
        return Solid(self.vertices * (1.0, -1.0, 1.0), self.faces[:, ::-1], self.paints)


def loft(rings: ArrayLike, paint: ArrayLike, is_closed: bool = False) -> Solid:
    """A solid through rings of points.

    rings : (n, m, 3) in m, m even; counter-clockwise around the way from ring to ring
    paint : number of a paint, or (n - 1, m) of the quads; each end is painted as the quads beside it
    is_closed : whether the last ring is joined to the first
    """
    points = np.asarray(rings, np.float64)
    count, around = points.shape[:2]
    number = np.arange(count * around, dtype=np.int32).reshape(count, around)
    first, second = (number, np.roll(number, -1, axis=0)) if is_closed else (number[:-1], number[1:])
    sides = np.stack([first, np.roll(first, -1, axis=1), np.roll(second, -1, axis=1), second], axis=-1)
    painted = np.broadcast_to(np.asarray(paint, np.int32), sides.shape[:2])
    faces, paints = [sides.reshape(-1, 4)], [painted.reshape(-1)]
    if not is_closed:
        # rungs between the two halves of a ring
        one, other = np.arange(around // 2 - 1), np.arange(around - 1, around // 2, -1)
        rungs = np.stack([one, one + 1, other - 1, other], axis=-1)
        faces += [number[0][rungs][:, ::-1], number[-1][rungs]]
        paints += [painted[0][one], painted[-1][one]]
    return Solid(points.reshape(-1, 3), np.concatenate(faces), np.concatenate(paints))


def lathe(
    profile: ArrayLike, paint: ArrayLike, segments: int, middle: ArrayLike = (0.0, 0.0, 0.0), axis: int = 2
) -> Solid:
    """A turned body.

    profile : (n, 2) of radius and height in m along the axis, from below to above
    paint : number of a paint, or (n - 1,) of the bands
    middle : where height 0 is, m
    axis : 0, 1 or 2 for x, y or z
    """
    radius, height = np.asarray(profile, np.float64).T
    angle = np.arange(segments) * (2.0 * np.pi / segments)
    rings = np.empty((len(radius), segments, 3))
    rings[..., (axis + 1) % 3] = radius[:, np.newaxis] * np.cos(angle)
    rings[..., (axis + 2) % 3] = radius[:, np.newaxis] * np.sin(angle)
    rings[..., axis] = height[:, np.newaxis]
    bands = np.asarray(paint)
    return loft(rings + np.asarray(middle), bands if bands.ndim == 0 else bands[:, np.newaxis])


def tube(
    path: ArrayLike, radius: ArrayLike, paint: int, segments: int = 12, is_closed: bool = False
) -> Solid:
    """A round bar along a path.

    path : (n, 3) in m
    radius : in m, or (n,) of them
    is_closed : whether it ends where it begins, as a ring does; the path does not repeat its first point
    """
    points = np.asarray(path, np.float64)
    if is_closed:
        way = np.roll(points, -1, axis=0) - np.roll(points, 1, axis=0)
    else:
        way = np.gradient(points, axis=0)
    way /= np.linalg.norm(way, axis=-1, keepdims=True)
    # beside it: across the direction that the path as a whole is farthest from
    beside = np.cross(way, np.eye(3)[np.abs(way).max(axis=0).argmin()])
    beside /= np.linalg.norm(beside, axis=-1, keepdims=True)
    angle = np.arange(segments) * (2.0 * np.pi / segments)
    turned = (
        np.cos(angle)[:, np.newaxis] * beside[:, np.newaxis]
        + np.sin(angle)[:, np.newaxis] * np.cross(way, beside)[:, np.newaxis]
    )
    width = np.broadcast_to(np.asarray(radius, np.float64), len(points))
    return loft(points[:, np.newaxis] + width[:, np.newaxis, np.newaxis] * turned, paint, is_closed)


def house(
    levels: Sequence[tuple[float, float, float, float]], paint: ArrayLike, bevel: float = 0.06
) -> Solid:
    """A box with bevelled edges, that may lean and taper.

    levels : height, back, front and half of the breadth in m, from below to above
    paint : as of `loft`, or (n - 1, 1) of the levels
    bevel : of its upright edges, m
    """
    rings = []
    for height, back, front, half in levels:
        corners = ((front, -half), (front, half), (back, half), (back, -half))
        ring = []
        for number, (x, y) in enumerate(corners):
            inward_x, inward_y = -bevel * np.sign(x - 0.5 * (back + front)), -bevel * np.sign(y)
            cut = [(x + inward_x, y), (x, y + inward_y)]
            ring += cut if number % 2 == 0 else cut[::-1]
        rings.append([(x, y, height) for x, y in ring])
    return loft(rings, paint)


def new_object(
    name: str, solids: Iterable[Solid], paints: Sequence[Paint], metres: float = 1.0
) -> bpy.types.Object:
    """An object of some solids, smooth with sharp edges; in no collection yet.

    metres : in a Blender unit
    """
    parts = list(solids)
    first = np.cumsum([0, *(len(part.vertices) for part in parts)])
    vertices = np.concatenate([part.vertices for part in parts]) / metres
    faces = np.concatenate([part.faces + start for part, start in zip(parts, first, strict=False)])
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices.tolist(), [], faces.tolist())
    mesh.polygons.foreach_set("material_index", np.concatenate([part.paints for part in parts]))
    mesh.shade_smooth()
    mesh.set_sharp_from_angle(angle=_SHARP)
    mesh.update()
    for paint in paints:
        mesh.materials.append(_material(paint))
    return bpy.data.objects.new(name, mesh)


def _material(paint: Paint) -> bpy.types.Material:
    """The material of a paint, which all that has it shares; with a wet band where the water has been."""
    for material in bpy.data.materials:
        if material.library is None and material.get(_KEY) == paint.name:
            return material
    material = bpy.data.materials.new(paint.name)
    if material.node_tree is None:  # a material has nodes from the start since Blender 5.0
        material.use_nodes = True
    shader = next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    wet = material.node_tree.nodes.new("ShaderNodeGroup")
    wet.node_tree, wet.location = node_group(WET_BAND), (shader.location.x - 240.0, shader.location.y)
    for name, socket, value in (
        ("Color", "Base Color", (*paint.colour, 1.0)),
        ("Roughness", "Roughness", paint.roughness),
    ):
        wet.inputs[name].default_value = value
        material.node_tree.links.new(wet.outputs[name], shader.inputs[socket])
    shader.inputs["Metallic"].default_value = paint.metallic
    shader.inputs["Emission Color"].default_value = (*paint.colour, 1.0)
    shader.inputs["Emission Strength"].default_value = paint.light
    material.diffuse_color = (*paint.colour, 1.0)
    material[_KEY] = paint.name
    return material
