# SPDX-License-Identifier: GPL-3.0-or-later
"""Fresh foam raises the surface: a roll of white water on the crest, thrown forward.

Only a surface around a camera shows it. Floating objects and height queries use the water beneath.
"""

from __future__ import annotations

import bpy

from .building import Builder, Plug, Socket, output
from .fields import alone, combined, coordinates
from .versioned import GroupKind

#: forward offset of the roll, relative to its height
_FORWARD = 0.7
#: strength of breaking at which it has its full height; it grows smoothly from 0
_WHOLE = 0.7
#: unevenness, kept low, as a single lump would look like a spike and finer detail is left to shading
_UNEVEN = 2.2

_INPUTS = (
    Plug("Displacement", "NodeSocketVector", None, "Of the water, in the ocean's axes"),
    Plug("Velocity", "NodeSocketVector", None, "Of the water, in the ocean's axes"),
    Plug("Breaking", "NodeSocketFloat", 0.0, "How strongly the crest breaks, 0 to 1"),
    Plug("Height", "NodeSocketFloat", 0.0, "Of the foam in the mean, as a share of the crest's elevation"),
    Plug("Lump", "NodeSocketFloat", 1.0, "Length of the lumps of foam, in Blender units"),
)
_OUTPUTS = (Plug("Offset", "NodeSocketVector", None, "Of the surface, in the ocean's axes"),)


def _build(tree: bpy.types.NodeTree) -> None:
    build = Builder(tree, _INPUTS, _OUTPUTS)
    _, _, elevation = coordinates(build, build.given("Displacement"))
    crest = build.math("MAXIMUM", elevation, 0.0)
    whole = build.math("MINIMUM", build.math("DIVIDE", build.given("Breaking"), _WHOLE), 1.0)
    rising = build.math("MULTIPLY", whole, whole)
    mean = build.math("MULTIPLY", build.math("MULTIPLY", crest, build.given("Height")), rising)
    height = build.math("MULTIPLY", mean, _lumps(build))
    x, y, _ = coordinates(build, build.given("Velocity"))
    ahead = build.scaled(alone(build, "NORMALIZE", combined(build, x, y, 0.0)), _FORWARD)
    up = build.vector("ADD", ahead, (0.0, 0.0, 1.0))
    build.finish_with({"Offset": build.scaled(up, height)})


def _lumps(build: Builder) -> Socket:
    """Factor around 1; a function of the rest position, so lumps move with the water."""
    position = output(build.add("GeometryNodeInputPosition"), "Position")
    place = build.vector("DIVIDE", position, combined(build, *(build.given("Lump"),) * 3))
    noise = build.add("ShaderNodeTexNoise", {"Vector": place, "Scale": 1.0, "Detail": 0.5})
    off = build.math("MULTIPLY", build.math("SUBTRACT", noise.outputs[0], 0.5), _UNEVEN)
    return build.math("MAXIMUM", build.math("ADD", off, 1.0), 0.0)


FOAM_PILE = GroupKind("Ocean Tweak Foam Pile", 3, _build)
