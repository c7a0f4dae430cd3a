# SPDX-License-Identifier: GPL-3.0-or-later
"""A navigation buoy: a turned body with a mast and a lamp, with its waterline at the origin.

Its paint and its hull have a wet band where the water has been.
"""

from __future__ import annotations

import bpy
import numpy as np

from ..nodes.contact import WET_BAND
from ..nodes.versioned import node_group

#: radius and height in m from below to above, with the number of the material of the band that follows
_PROFILE = (
    (0.0, -1.20, 1), (0.34, -1.16, 1), (0.52, -0.62, 1), (1.02, -0.42, 1), (1.10, -0.30, 1),
    (1.10, 0.06, 0), (1.10, 0.42, 0), (1.02, 0.52, 0), (0.50, 0.58, 0), (0.36, 0.66, 0), (0.19, 2.15, 2),
    (0.19, 2.20, 2), (0.30, 2.22, 2), (0.30, 2.27, 1), (0.13, 2.29, 3), (0.15, 2.36, 3), (0.15, 2.52, 3),
    (0.10, 2.62, 1), (0.0, 2.66, 1),
)  # fmt: skip
_SEGMENTS = 48
_KEY = "ocean_tweak_buoy"

#: of the hull at the waterline, and of its keel below that, m
DIAMETER, DRAFT = 2.2, 1.2

#: name, linear colour, roughness, light of its own
_MATERIALS = (
    ("Buoy Paint", (0.62, 0.045, 0.012), 0.38, 0.0),
    ("Buoy Hull", (0.018, 0.020, 0.022), 0.55, 0.0),
    ("Buoy Metal", (0.52, 0.52, 0.50), 0.42, 0.0),
    ("Buoy Lamp", (1.0, 0.62, 0.20), 0.2, 2.0),
)


def new_buoy(name: str, metres: float = 1.0) -> bpy.types.Object:
    """A buoy; in no collection yet.

    metres : in a Blender unit
    """
    mesh = bpy.data.meshes.new(name)
    positions, faces, materials = _lathe()
    mesh.from_pydata((positions / metres).tolist(), [], faces.tolist())
    mesh.polygons.foreach_set("material_index", materials)
    mesh.shade_smooth()
    if hasattr(mesh, "set_sharp_from_angle"):
        mesh.set_sharp_from_angle(angle=0.6)
    mesh.update()
    for values in _MATERIALS:
        mesh.materials.append(_material(*values))
    return bpy.data.objects.new(name, mesh)


def _lathe() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Vertices (rings·segments, 3) in m, quads, and the material of each."""
    profile = np.array(_PROFILE)
    angle = np.arange(_SEGMENTS) * (2.0 * np.pi / _SEGMENTS)
    ring = np.stack([np.cos(angle), np.sin(angle), np.zeros(_SEGMENTS)], axis=-1)
    positions = np.maximum(profile[:, 0, np.newaxis, np.newaxis], 1e-4) * ring
    positions[..., 2] = profile[:, 1, np.newaxis]
    number = np.arange(len(profile) * _SEGMENTS).reshape(len(profile), _SEGMENTS)
    following = np.roll(number, -1, axis=1)
    quads = np.stack([number[:-1], following[:-1], following[1:], number[1:]], axis=-1).reshape(-1, 4)
    return positions.reshape(-1, 3), quads, np.repeat(profile[:-1, 2].astype(np.int32), _SEGMENTS)


def _material(
    name: str, colour: tuple[float, float, float], roughness: float, light: float
) -> bpy.types.Material:
    for material in bpy.data.materials:
        if material.library is None and material.get(_KEY) == name:
            return material
    material = bpy.data.materials.new(name)
    if material.node_tree is None:  # a material has nodes from the start since Blender 5.0
        material.use_nodes = True
    shader = next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    wet = material.node_tree.nodes.new("ShaderNodeGroup")
    wet.node_tree, wet.location = node_group(WET_BAND), (shader.location.x - 240.0, shader.location.y)
    for name, socket, value in (
        ("Color", "Base Color", (*colour, 1.0)),
        ("Roughness", "Roughness", roughness),
    ):
        wet.inputs[name].default_value = value
        material.node_tree.links.new(wet.outputs[name], shader.inputs[socket])
    shader.inputs["Emission Color"].default_value = (*colour, 1.0)
    shader.inputs["Emission Strength"].default_value = light
    material.diffuse_color = (*colour, 1.0)
    material[_KEY] = name
    return material
