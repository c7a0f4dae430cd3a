# SPDX-License-Identifier: GPL-3.0-or-later
"""A storm's sky: a layer of torn cloud, dark overhead, with a bright band where it opens at the horizon."""

from __future__ import annotations

import math

import bpy

from ocean_tweak.nodes.shading import Shading

#: linear scene colours, relative luminance; the ramp runs over sin(elevation)
OVERCAST = (
    (0.0, (0.56, 0.60, 0.63)),
    (0.05, (0.47, 0.52, 0.565)),
    (0.16, (0.27, 0.32, 0.37)),
    (0.42, (0.12, 0.15, 0.185)),
    (1.0, (0.085, 0.11, 0.14)),
)
GLOW = (1.0, 0.90, 0.76)


def storm_sky(name: str, glow_azimuth: float) -> bpy.types.World:
    """Return a new world; the clouds open at `glow_azimuth`, radians counter-clockwise from +x."""
    world = bpy.data.worlds.new(name)
    if world.node_tree is None:  # a world has nodes from the start since Blender 5.0
        world.use_nodes = True
    shading = Shading(world.node_tree)
    direction = shading.node("ShaderNodeTexCoord").outputs["Generated"]
    _, _, up = shading.separate(direction)
    above = shading.math("MAXIMUM", up, 0.0)

    gradient = shading.ramp(above, OVERCAST)
    facing = _facing(shading, direction, glow_azimuth)

    seen = shading.vector(
        "ADD",
        shading.scale(gradient, _clouds(shading, direction, above)),
        _glow(shading, facing, _ragged_edge(shading, direction, above)),
    )
    reflected = shading.vector("ADD", gradient, _glow(shading, facing, above))
    # rough water shows no cloud detail; only what the camera sees is worth the price of fractal noise
    is_seen = shading.node("ShaderNodeLightPath").outputs["Is Camera Ray"]
    backgrounds = [
        shading.node("ShaderNodeBackground", {"Color": colour}).outputs[0] for colour in (reflected, seen)
    ]
    mixed = shading.mix_shaders(is_seen, *backgrounds)
    output = shading.node("ShaderNodeOutputWorld")
    shading.tree.links.new(mixed, output.inputs["Surface"])
    world.cycles.sampling_method = "NONE"  # broad and soft: shadow rays would cost more than they give
    return world


def _clouds(shading, direction, above):
    """Brightness of the cloud layer around 1: noise on a plane overhead, drawn out towards the horizon."""
    x, y, _ = shading.separate(direction)
    away = shading.math("ADD", above, 0.09)
    plane = shading.combine(shading.math("DIVIDE", x, away), shading.math("DIVIDE", y, away))
    large = shading.noise(plane, 0.55, Detail=7.0, Roughness=0.56, Distortion=0.35)
    contrast = shading.smooth(above, 0.0, 0.12, 0.25, 1.0)
    shade = shading.smooth(large, 0.33, 0.70, -0.42, 0.50)
    return shading.math("ADD", shading.math("MULTIPLY", shade, contrast), 1.0)


def _facing(shading, direction, azimuth):
    """How much a direction points to where the clouds open, 0 … 1."""
    towards = (math.cos(azimuth), math.sin(azimuth), 0.0)
    facing = shading.number("DOT_PRODUCT", direction, towards)
    return shading.math("POWER", shading.math("MAXIMUM", facing, 0.0), 9.0)


def _ragged_edge(shading, direction, above):
    """Elevation, disturbed so that the light ends in shreds of cloud."""
    ragged = shading.noise(
        shading.vector("MULTIPLY", direction, (1.0, 1.0, 5.0)), 2.6, Detail=6.0, Roughness=0.6
    )
    return shading.math("ADD", above, shading.math("MULTIPLY_ADD", ragged, 0.16, -0.08))


def _glow(shading, facing, edge):
    """Light under the edge of the clouds: broad in azimuth, low."""
    low = shading.smooth(edge, 0.0, 0.20, 1.5, 0.0)
    return shading.scale(shading.combine(*GLOW), shading.math("MULTIPLY", facing, low))
