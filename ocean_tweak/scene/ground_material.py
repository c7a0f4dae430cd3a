# SPDX-License-Identifier: GPL-3.0-or-later
"""The material of a coast's ground: sand, wet where waves ran of late, rock, and what grows above them."""

from __future__ import annotations

from typing import NamedTuple

import bpy

from ..nodes.names import WET
from ..nodes.shading import Shading, Socket

#: point attribute of the ground's mesh: 0 where it is sand, 1 where it is rock
ROCK = "rock"

_NAME = "Ocean Tweak Ground"
_SAND, _DARK_SAND, _WET_SAND = (0.47, 0.375, 0.26), (0.33, 0.25, 0.165), (0.12, 0.09, 0.062)
_WRACK = (0.045, 0.036, 0.022)
_ROCKS = ((0.055, 0.05, 0.046), (0.17, 0.145, 0.12), (0.105, 0.088, 0.07), (0.235, 0.205, 0.17))
#: how much of the difference between beds of rock the weather takes
_WEATHERED = 0.6
_LICHEN, _WEED = (0.24, 0.17, 0.06), (0.022, 0.026, 0.012)
_GRASS, _DRY_GRASS = (0.055, 0.075, 0.022), (0.16, 0.13, 0.055)
#: attribute between which sand goes from dry to wet; the edge is uneven by so much
_DRY, _DAMP, _UNEVEN = 0.05, 0.4, 0.5
#: heights in m: of the drift line of weed that high tides leave; up to which rock is dark; from which on
#: something grows
_DRIFT_LINE, _SPLASHED, _GREEN = 1.5, 1.6, (4.5, 7.5)


class _Place(NamedTuple):
    """Where a point of the ground is, and what differs there.

    position : m; height is its z, level the z of the face's normal
    fine, middle, coarse : noise around 0.5, of decimetres, metres and decametres
    wet, rock : 0…1
    """

    position: Socket
    height: Socket
    level: Socket
    fine: Socket
    middle: Socket
    coarse: Socket
    wet: Socket
    rock: Socket


def ground_material(scale: float) -> bpy.types.Material:
    """The material, made where there is none; scale is Blender units in a metre."""
    present = bpy.data.materials.get(_NAME)
    if present is not None:
        return present
    material = bpy.data.materials.new(_NAME)
    if material.node_tree is None:  # before Blender 5
        material.use_nodes = True
    shade = Shading(material.node_tree)
    place = _place(shade, scale)
    sand, smooth_sand, ripples = _sand(shade, place)
    stone, smooth_stone, relief = _stone(shade, place)
    green = _green(shade, place)
    grass = shade.mix_vectors(shade.smooth(place.middle, 0.4, 0.62), _DRY_GRASS, _GRASS)
    tufts = shade.noise(place.position, 3.5, Detail=6.0, Roughness=0.75)
    grass = shade.scale(grass, shade.smooth(tufts, 0.3, 0.7, 0.35, 1.5))
    colour = shade.mix_vectors(green, shade.mix_vectors(place.rock, sand, stone), grass)
    height = shade.mix(green, shade.mix(place.rock, ripples, relief), shade.math("MULTIPLY", tufts, 0.8))
    bump = shade.node("ShaderNodeBump", {"Height": height, "Distance": scale, "Strength": 1.0})
    roughness = shade.mix(green, shade.mix(place.rock, smooth_sand, smooth_stone), 0.95)
    inputs = {"Base Color": colour, "Roughness": roughness, "Normal": bump.outputs[0]}
    surface = shade.node("ShaderNodeBsdfPrincipled", inputs)
    shade.node("ShaderNodeOutputMaterial", {"Surface": surface.outputs[0]})
    return material


def _place(shade: Shading, scale: float) -> _Place:
    geometry = shade.node("ShaderNodeNewGeometry").outputs
    position = shade.scale(geometry["Position"], 1.0 / scale)
    fine, middle = shade.noise(position, 1.7, Detail=6.0), shade.noise(position, 0.28, Detail=5.0)
    told, uneven = shade.value(WET), shade.math("MULTIPLY", shade.math("SUBTRACT", fine, 0.5), _UNEVEN)
    ragged = shade.math("SUBTRACT", middle, 0.5)
    # even where it is all wet or all dry
    edge = shade.math("MULTIPLY", told, shade.math("SUBTRACT", 1.0, told))
    return _Place(
        position, shade.separate(position)[2], shade.separate(geometry["Normal"])[2], fine, middle,
        shade.noise(position, 0.05, Detail=4.0),
        shade.smooth(shade.math("MULTIPLY_ADD", uneven, edge, told), _DRY, _DAMP),
        shade.smooth(shade.math("MULTIPLY_ADD", ragged, 0.9, shade.value(ROCK)), 0.35, 0.6),
    )  # fmt: skip


def _sand(shade: Shading, place: _Place) -> tuple[Socket, Socket, Socket]:
    """Colour, roughness and relief in m: paler and darker banks, ripples of the wind, a drift line."""
    dry = shade.mix_vectors(shade.smooth(place.coarse, 0.35, 0.65), _DARK_SAND, _SAND)
    # scattered weed, in a line that wanders by half a metre of height
    line = shade.math("MULTIPLY_ADD", shade.math("SUBTRACT", place.middle, 0.5), 1.0, place.height)
    near = shade.smooth(
        shade.math("ABSOLUTE", shade.math("SUBTRACT", line, _DRIFT_LINE)), 0.03, 0.16, 1.0, 0.0
    )
    weed = shade.math("MULTIPLY", near, shade.smooth(place.fine, 0.5, 0.58, 0.0, 0.85))
    colour = shade.mix_vectors(weed, shade.mix_vectors(place.wet, dry, _WET_SAND), _WRACK)
    colour = shade.scale(colour, shade.math("MULTIPLY_ADD", place.fine, 0.5, 0.75))
    stretched = shade.vector("MULTIPLY", place.position, (1.0, 0.22, 1.0))
    ripples = shade.math("MULTIPLY", shade.noise(stretched, 4.0, Detail=2.0, Distortion=0.6), 0.05)
    # the wet film is even
    banks = shade.math(
        "MULTIPLY_ADD", place.middle, 0.25, shade.math("MULTIPLY_ADD", place.fine, 0.06, ripples)
    )
    relief = shade.math("MULTIPLY", banks, shade.mix(place.wet, 1.0, 0.03))
    return colour, shade.mix(place.wet, 0.9, 0.16), relief


def _stone(shade: Shading, place: _Place) -> tuple[Socket, Socket, Socket]:
    """Colour, roughness and relief in m: beds of different rock that dip, cracks, lichen, and weed below."""
    tilted = shade.number("DOT_PRODUCT", place.position, (0.07, 0.12, 0.21))
    folded = shade.math("MULTIPLY_ADD", place.middle, 1.1, shade.math("MULTIPLY", place.fine, 0.3))
    layer = shade.math(
        "FRACT", shade.math("MULTIPLY_ADD", place.coarse, 3.0, shade.math("ADD", folded, tilted))
    )
    beds = shade.ramp(layer, [(n / 3.999, rock) for n, rock in enumerate((*_ROCKS, _ROCKS[0]))])
    beds = shade.mix_vectors(_WEATHERED, beds, _ROCKS[1])
    bent = shade.vector(
        "ADD", place.position, shade.scale(shade.combine(place.fine, place.middle, place.middle), 6.0)
    )
    cracks = [
        shade.node(
            "ShaderNodeTexVoronoi", {"Vector": bent, "Scale": scale}, feature="DISTANCE_TO_EDGE"
        ).outputs["Distance"]
        for scale in (0.12, 0.5)
    ]  # fmt: skip
    wide, narrow = (shade.smooth(each, 0.0, width) for each, width in zip(cracks, (0.05, 0.06), strict=True))
    # cracked in places, and whole between them
    whole = shade.smooth(place.middle, 0.45, 0.6)
    worn = shade.math(
        "MULTIPLY", shade.mix(0.7, 1.0, wide), shade.math("MAXIMUM", whole, shade.mix(0.6, 1.0, narrow))
    )
    colour = shade.scale(beds, shade.math("MULTIPLY", worn, shade.math("MULTIPLY_ADD", place.fine, 0.9, 0.6)))
    high = shade.smooth(place.height, 2.5, 5.0)
    lichen = shade.math("MULTIPLY", high, shade.smooth(place.middle, 0.56, 0.68, 0.0, 0.6))
    colour = shade.mix_vectors(lichen, colour, _LICHEN)
    line = shade.math("MULTIPLY_ADD", shade.math("SUBTRACT", place.middle, 0.5), 2.4, place.height)
    splashed = shade.smooth(line, 0.6 * _SPLASHED, 1.5 * _SPLASHED, 1.0, 0.0)
    dark = shade.math("MAXIMUM", splashed, place.wet)
    colour = shade.mix_vectors(shade.math("MULTIPLY", dark, 0.8), colour, _WEED)
    steps = shade.math("MULTIPLY_ADD", layer, 0.16, shade.math("MULTIPLY", place.middle, 0.9))
    grain = shade.math("MULTIPLY_ADD", place.fine, 0.22, shade.math("MULTIPLY", worn, 0.3))
    return colour, shade.mix(dark, 0.85, 0.3), shade.math("ADD", steps, grain)


def _green(shade: Shading, place: _Place) -> Socket:
    """0…1, how much grows: on level ground above the reach of salt water, in patches on sand."""
    low, high = _GREEN
    uneven = shade.math("MULTIPLY_ADD", shade.math("SUBTRACT", place.middle, 0.5), 7.0, place.height)
    patches = shade.mix(
        place.rock, shade.smooth(place.middle, 0.44, 0.54), shade.smooth(place.fine, 0.3, 0.5)
    )
    level = shade.smooth(shade.math("MULTIPLY_ADD", place.fine, 0.2, place.level), 0.8, 0.98)
    return shade.math("MULTIPLY", shade.smooth(uneven, low, high), shade.math("MULTIPLY", patches, level))
