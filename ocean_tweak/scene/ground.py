# SPDX-License-Identifier: GPL-3.0-or-later
"""The ground of ready scenes with a coast: a mesh of bed and land, its sand and its rock."""

from __future__ import annotations

import bpy
import numpy as np

from ..core.waves.coast.beds import BEDS, SIDE
from ..nodes.names import WET
from ..nodes.shading import Shading, Socket

_SAND, _WET_SAND, _ROCK = (0.46, 0.36, 0.24, 1.0), (0.17, 0.125, 0.08, 1.0), (0.075, 0.068, 0.06, 1.0)
#: z of the normal of what is rock, and of what is sand
_STEEP = (0.86, 0.94)
#: cells along each side of the mesh
_CELLS = 512
#: attribute between which sand goes from dry to wet; the edge is uneven by so much
_DRY, _WET, _UNEVEN = 0.05, 0.4, 0.5


def add_ground(scene_name: str, bed: str, collection: bpy.types.Collection, scale: float) -> bpy.types.Object:
    """A mesh of one of the beds to begin with, its corner x = y = 0 at the origin.

    scale : Blender units in a metre
    """
    along = np.linspace(0.0, SIDE, _CELLS + 1)
    x, y = np.meshgrid(along, along)
    places = np.stack((x, y, BEDS[bed](x, y)), axis=-1).reshape(-1, 3) * scale
    number = np.arange((_CELLS + 1) ** 2, dtype=np.int32).reshape(_CELLS + 1, _CELLS + 1)
    corners = np.stack((number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]), axis=-1)
    mesh = bpy.data.meshes.new(scene_name)
    mesh.vertices.add(len(places))
    mesh.vertices.foreach_set("co", places.astype(np.float32).reshape(-1))
    mesh.loops.add(corners.size)
    mesh.loops.foreach_set("vertex_index", corners.reshape(-1))
    mesh.polygons.add(corners.size // 4)
    mesh.polygons.foreach_set("loop_start", np.arange(0, corners.size, 4, dtype=np.int32))
    mesh.update(calc_edges=True)
    mesh.shade_smooth()
    item = bpy.data.objects.new(scene_name, mesh)
    mesh.materials.append(_material(scale))
    collection.objects.link(item)
    return item


def _material(scale: float) -> bpy.types.Material:
    """Sand, wet near the waterline, and rock where the ground is steep."""
    name = "Ocean Tweak Ground"
    present = bpy.data.materials.get(name)
    if present is not None:
        return present
    material = bpy.data.materials.new(name)
    if material.node_tree is None:  # before Blender 5
        material.use_nodes = True
    shade = Shading(material.node_tree)
    material.node_tree.nodes.clear()
    surface = shade.node("ShaderNodeBsdfPrincipled")
    shade.node("ShaderNodeOutputMaterial", {"Surface": surface.outputs[0]})
    geometry = shade.node("ShaderNodeNewGeometry").outputs
    place = geometry["Position"]
    fine, coarse = shade.noise(place, 1.7 / scale, Detail=5.0), shade.noise(place, 0.06 / scale, Detail=4.0)
    told = shade.value(WET)
    uneven = shade.math("MULTIPLY", shade.math("SUBTRACT", fine, 0.5), _UNEVEN)
    # even where it is all wet or all dry
    edge = shade.math("MULTIPLY", told, shade.math("SUBTRACT", 1.0, told))
    wet = shade.smooth(shade.math("MULTIPLY_ADD", uneven, edge, told), _DRY, _WET)
    grain = shade.math("MULTIPLY_ADD", fine, 0.35, 0.95)
    sand = shade.scale(shade.mix_vectors(wet, _SAND[:3], _WET_SAND[:3]), grain)
    steep = shade.math("MULTIPLY_ADD", fine, 0.18, shade.separate(geometry["True Normal"])[2])
    rock = shade.smooth(steep, _STEEP[0], _STEEP[1], 1.0, 0.0)
    stone = shade.scale(_ROCK[:3], shade.math("MULTIPLY_ADD", coarse, 1.6, shade.math("ADD", grain, 0.3)))
    _set(material, surface, "Base Color", shade.mix_vectors(rock, sand, stone))
    dry = shade.mix(rock, 0.95, 0.85)
    _set(material, surface, "Roughness", shade.mix(wet, dry, 0.38))
    bump = shade.node("ShaderNodeBump", {"Height": shade.math("ADD", fine, coarse), "Distance": 0.3 * scale})
    material.node_tree.links.new(shade.mix(rock, 0.25, 1.0), bump.inputs["Strength"])
    _set(material, surface, "Normal", bump.outputs[0])
    return material


def _set(material: bpy.types.Material, node: bpy.types.Node, name: str, value: Socket) -> None:
    material.node_tree.links.new(value, node.inputs[name])
