# SPDX-License-Identifier: GPL-3.0-or-later
"""Sea water seen from the air, in metres.

The geometry holds the waves down to two of its samples. What is shorter is drawn in two ways that add up
to the mean square slope of a wind-roughened sea: as a bump map of ripples where they are larger than a pixel,
and as roughness beyond.
"""

from __future__ import annotations

import math

import bpy

from ocean_tweak.nodes.shading import Shading

BODY = (0.006, 0.034, 0.042)  # light that comes back out of deep water
CREST = (0.012, 0.052, 0.050)  # light that has passed through a crest
IOR = 1.333


def storm_water(name, ripples, patch_size, haze_colour, visibility):
    """Return a new material for a patch of sea with a UV map.

    ripples : `ripples.Ripples`, the waves shorter than the geometry's samples
    patch_size : side of the patch in m, which the UV map spans from 0 to 1
    haze_colour : linear colour of the air at the horizon
    visibility : distance in m at which 2 % of the contrast is left
    """
    material = bpy.data.materials.new(name)
    if material.node_tree is None:  # a material has nodes from the start since Blender 5.0
        material.use_nodes = True
    shading = Shading(material.node_tree)
    distance = shading.node("ShaderNodeCameraData").outputs["View Distance"]
    _, _, height = shading.separate(shading.node("ShaderNodeNewGeometry").outputs["Position"])

    inputs = {
        "Base Color": (*BODY, 1.0),
        "IOR": IOR,
        "Roughness": _roughness(shading, distance),
        "Normal": _ripple_normal(shading, ripples, patch_size, distance),
        "Emission Color": (*CREST, 1.0),
        "Emission Strength": shading.math("MULTIPLY", shading.smooth(height, 1.0, 13.0), 0.35),
    }
    water = shading.node("ShaderNodeBsdfPrincipled", inputs).outputs[0]
    air = shading.node("ShaderNodeEmission", {"Color": (*haze_colour, 1.0), "Strength": 1.0}).outputs[0]
    mixed = shading.mix_shaders(_haze(shading, distance, visibility), water, air)
    output = shading.node("ShaderNodeOutputMaterial")
    shading.tree.links.new(mixed, output.inputs["Surface"])
    # or Cycles sorts a hundred million triangles into a tree of lamps
    material.cycles.emission_sampling = "NONE"
    return material


def _haze(shading, distance, visibility):
    """Share of the air in what the camera sees, 1 - exp(-3.9 d / visibility) (Koschmieder 1924)."""
    thickness = shading.math("MULTIPLY", distance, -math.log(50.0) / visibility)
    haze = shading.math("SUBTRACT", 1.0, shading.math("EXPONENT", thickness))
    return shading.math("MULTIPLY", haze, shading.node("ShaderNodeLightPath").outputs["Is Camera Ray"])


def _roughness(shading, distance):
    """Blender's roughness, the square root of GGX's alpha: the ripples that are smaller than a pixel."""
    return shading.smooth(distance, 20.0, 400.0, 0.20, 0.42)


def _ripple_normal(shading, ripples, patch_size, distance):
    """Shading normal: the ripple map laid twice over the patch, turned and stretched to hide its tiles."""
    rest = _rest_position(shading, patch_size)
    heights = [_layer(shading, ripples, rest, stretch, turn) for stretch, turn in ((1.0, 0.0), (1.618, 0.35))]
    nearness = shading.smooth(distance, 40.0, 400.0, 1.0, 0.0)
    bump = {"Height": shading.math("ADD", *heights), "Distance": 1.0, "Strength": nearness}
    return shading.node("ShaderNodeBump", bump).outputs[0]


def _layer(shading, ripples, rest, stretch, turn):
    """Heights of one layer, m. It travels with the wind, at the speed of its typical ripple in deep water."""
    size = stretch * ripples.size
    mapping = shading.node(
        "ShaderNodeMapping", {"Vector": rest, "Rotation": (0.0, 0.0, turn), "Scale": (1.0 / size,) * 3}
    )
    speed = math.sqrt(9.81 * stretch * ripples.typical_length / (2.0 * math.pi))
    for axis, share in ((0, math.cos(turn)), (1, math.sin(turn))):
        # an expression as simple as this one is evaluated without Python, so in a file nobody has trusted yet
        driver = mapping.inputs["Location"].driver_add("default_value", axis).driver
        driver.expression = f"frame * {-share * speed / (size * ripples.fps):.8f}"
    texture = shading.node(
        "ShaderNodeTexImage", {"Vector": mapping.outputs[0]}, image=ripples.image, interpolation="Cubic"
    )
    red = shading.node("ShaderNodeSeparateColor", {0: texture.outputs[0]}).outputs[0]
    return shading.math("MULTIPLY", red, stretch / math.sqrt(2.0))


def _rest_position(shading, patch_size):
    """Where the water was before it was displaced, m: ripples ride on waves, and go on from tile to tile."""
    uv = shading.node("ShaderNodeUVMap").outputs[0]
    tile = shading.node("ShaderNodeObjectInfo").outputs["Location"]
    return shading.vector("ADD", shading.scale(uv, patch_size), tile)
