# SPDX-License-Identifier: GPL-3.0-or-later
"""Shadows of broken cloud on the water: a layer overhead that takes the sunlight and is not seen itself."""

from __future__ import annotations

from typing import Any, NamedTuple

import bpy
from extension import Extension

#: m, of the layer above the sea and from its middle to its edges: a low sun shines in from far aside
_HEIGHT, _REACH = 1200.0, 25e3
#: of the noise between which a cloud goes over into a gap
_EDGE = 0.05


class CloudShadows(NamedTuple):
    """Broken cloud.

    size : of clouds and gaps together, m
    threshold : of the noise, 0…1, above which the sun shines; 0.5 for half of the sea
    left : of the sunlight in the shadow
    """

    size: float
    threshold: float = 0.5
    left: float = 0.1


def add(extension: Extension, scene: bpy.types.Scene, clouds: CloudShadows) -> bpy.types.Object:
    """Lay cloud over a scene in metres."""
    mesh = bpy.data.meshes.new("Cloud Shadows")
    corners = [(x * _REACH, y * _REACH, _HEIGHT) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    mesh.from_pydata(corners, [], [(0, 1, 2, 3)])
    mesh.materials.append(_material(extension, clouds))
    item = bpy.data.objects.new("Cloud Shadows", mesh)
    scene.collection.objects.link(item)
    for rays in ("camera", "diffuse", "glossy", "transmission"):
        setattr(item, f"visible_{rays}", False)
    return item


def _material(extension: Extension, clouds: CloudShadows) -> bpy.types.Material:
    material = bpy.data.materials.new("Cloud Shadows")
    if material.node_tree is None:  # a material has nodes from the start since Blender 5.0
        material.use_nodes = True
    shade: Any = extension.module("nodes.shading").Shading(material.node_tree)
    place = shade.node("ShaderNodeNewGeometry").outputs["Position"]
    noise = shade.noise(place, 1.0 / clouds.size, Detail=4.0, Roughness=0.5)
    low, high = clouds.threshold - _EDGE, clouds.threshold + _EDGE
    light = shade.smooth(noise, low, high, clouds.left, 1.0)
    clear = shade.node("ShaderNodeBsdfTransparent", {0: shade.combine(light, light, light)})
    shown = shade.node("ShaderNodeOutputMaterial")
    shade.tree.links.new(clear.outputs[0], shown.inputs["Surface"])
    extension.module("nodes.versioned").lay_out(shade.tree)
    return material
