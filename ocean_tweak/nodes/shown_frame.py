# SPDX-License-Identifier: GPL-3.0-or-later
"""A node group for the file of an image sequence that the scene's frame shows."""

from __future__ import annotations

import bpy

from .building import Builder, Plug, output
from .versioned import GroupKind

#: name, socket type, default, description
FRAME_INPUTS = (
    ("First Frame", "NodeSocketInt", 1, "First file of the image sequence; held before it"),
    ("Last Frame", "NodeSocketInt", 1_048_574, "Last file of the image sequence; held after it"),
)


def _build(tree: bpy.types.NodeTree) -> None:
    outputs = (
        Plug("Frame", "NodeSocketInt", None, "The scene's whole frame, held at both ends"),
        Plug("Scene Frame", "NodeSocketInt", None, "The scene's whole frame"),
        Plug("Is Held", "NodeSocketBool", None, "Whether the two differ"),
    )
    build = Builder(tree, FRAME_INPUTS, outputs)
    time = build.add("GeometryNodeInputSceneTime")
    floor = build.add("FunctionNodeFloatToInt", {"Float": output(time, "Frame")}, rounding_mode="FLOOR")
    whole = output(floor, "Integer")
    # beyond the ends the image node gives zero without a word
    begun = build.integer("MAXIMUM", whole, build.given("First Frame"))
    held = build.integer("MINIMUM", begun, build.given("Last Frame"))
    is_held = build.compare("NOT_EQUAL", held, whole)
    build.finish_with({"Frame": held, "Scene Frame": whole, "Is Held": is_held})


SHOWN_FRAME = GroupKind("Ocean Tweak Frame", 1, _build)
