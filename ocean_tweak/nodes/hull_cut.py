# SPDX-License-Identifier: GPL-3.0-or-later
"""Cut Out Hull: a part of the water's material that makes water transparent inside a hull.

The hull is known by the coordinates of its object and by its plan (`core.sea.hull_plan`), stored in an image.
No mesh reads another, so there is no dependency cycle and nothing to compute per frame, and every mesh that
shows the water is cut, in either engine, at the resolution of the render.

The image holds the levels on top of each other. The four channels of a texel are the distances at four
neighbours, so that the shader interpolates by itself: the filters of renderers would mix levels wherever the
look-up jumps from one to the next.
"""

from __future__ import annotations

import bpy

from .building import Panel, Plug, Socket
from .shading import Shading
from .versioned import GroupKind

#: inputs of a cut: whether its hull is hidden in renders and in windows, and which of the two is shown
HIDDEN, HIDDEN_IN_WINDOW, IN_WINDOW = "Hidden", "Hidden In Window", "In Window"

#: what a distance of 0 is in the image, whose values are 0 to 1
EDGE = 0.5

PLACE_INPUTS = (
    ("Vector", "NodeSocketVector", (0.0, 0.0, 0.0), "The water's place in the coordinates of the hull"),
    ("Rotation", "NodeSocketVector", (0.0, 0.0, 0.0), "Makes it stand upright"),
    ("Scale", "NodeSocketVector", (1.0, 1.0, 1.0), "Of the hull"),
    ("Low", "NodeSocketVector", (0.0, 0.0, 0.0), "Middle of the first texel of its plan, at the first level"),
    ("Step", "NodeSocketVector", (1.0, 1.0, 1.0), "From texel to texel, and from level to level"),
    ("Count", "NodeSocketVector", (2.0, 2.0, 2.0), "Of texels along x and y, and of levels"),
)
_PLACE_OUTPUTS = (
    Plug("Lower", "NodeSocketVector", None, "Where the plan is looked up at the lower of two levels"),
    Plug("Upper", "NodeSocketVector", None, "And at the upper one"),
    Plug("Share", "NodeSocketVector", None, "Of the farther one of two neighbours along each axis"),
    Plug("Is Above", "NodeSocketFloat", None, "Whether it is above the keel, and there is a hull at all"),
)
_CUT_INPUTS = (
    ("Shader", "NodeSocketShader", None, "Of the water"),
    ("Lower", "NodeSocketColor", (1.0, 1.0, 1.0, 1.0), "Three distances at the lower level"),
    ("Lower Last", "NodeSocketFloat", 1.0, "The fourth one"),
    ("Upper", "NodeSocketColor", (1.0, 1.0, 1.0, 1.0), "Three distances at the upper level"),
    ("Upper Last", "NodeSocketFloat", 1.0, "The fourth one"),
    ("Share", "NodeSocketVector", (0.0, 0.0, 0.0), "Of the farther one of two neighbours along each axis"),
    ("Is Above", "NodeSocketFloat", 0.0, "Whether it is above the keel"),
    (HIDDEN, "NodeSocketFloat", 0.0, "Whether renders do not show the hull"),
    (HIDDEN_IN_WINDOW, "NodeSocketFloat", 0.0, "Whether windows do not show it"),
    (IN_WINDOW, "NodeSocketFloat", 0.0, "Whether a window is shown, and no render"),
)


def _build_place(tree: bpy.types.NodeTree) -> None:
    shade = Shading(tree)
    given = shade.interface(_PLACE_OUTPUTS, (Panel("Hull", PLACE_INPUTS),)).outputs
    mapped = {name: given[name] for name in ("Vector", "Rotation", "Scale")}
    upright = shade.node("ShaderNodeMapping", mapped, vector_type="POINT").outputs[0]
    place = shade.vector("DIVIDE", shade.vector("SUBTRACT", upright, given["Low"]), given["Step"])
    last = shade.vector("SUBTRACT", given["Count"], (1.0, 1.0, 1.0))
    # beyond the plan, and above its last level, it is as at its edge
    within = shade.vector("MINIMUM", shade.vector("MAXIMUM", place, (0.0, 0.0, 0.0)), last)
    floor = shade.node("ShaderNodeVectorMath", {0: within}, operation="FLOOR").outputs[0]
    near = shade.vector("MINIMUM", floor, shade.vector("SUBTRACT", last, (1.0, 1.0, 1.0)))
    column, row, level = shade.separate(near)
    columns, rows, levels = shade.separate(given["Count"])
    right = shade.math("DIVIDE", shade.math("ADD", column, 0.5), columns)
    up = shade.math("DIVIDE", shade.math("ADD", row, 0.5), rows)
    lower, upper = (
        shade.combine(right, shade.math("DIVIDE", shade.math("ADD", up, each), levels))
        for each in (level, shade.math("ADD", level, 1.0))
    )
    # where the object was deleted, Blender gives the water's own coordinates
    own = shade.node("ShaderNodeTexCoord").outputs["Object"]
    is_there = shade.math("GREATER_THAN", shade.number("DISTANCE", own, given["Vector"]), 1e-4)
    is_above = shade.math("GREATER_THAN", shade.separate(place)[2], 0.0)
    shade.finish(
        {
            "Lower": lower,
            "Upper": upper,
            "Share": shade.vector("SUBTRACT", within, near),
            "Is Above": shade.math("MULTIPLY", is_there, is_above),
        }
    )


def _build_cut(tree: bpy.types.NodeTree) -> None:
    shade = Shading(tree)
    outputs = (Plug("Shader", "NodeSocketShader", None, "Link to the material's Surface"),)
    given = shade.interface(outputs, (Panel("Cut", _CUT_INPUTS),)).outputs
    right, up, above = shade.separate(given["Share"])
    at_levels = []
    for name in ("Lower", "Upper"):
        first, second, third = shade.separate(given[name])
        near, far = shade.mix(right, first, second), shade.mix(right, third, given[f"{name} Last"])
        at_levels.append(shade.mix(up, near, far))
    is_within = shade.math("LESS_THAN", shade.mix(above, *at_levels), EDGE)
    clear: Socket = shade.node("ShaderNodeBsdfTransparent").outputs[0]
    is_hidden = shade.mix(given[IN_WINDOW], given[HIDDEN], given[HIDDEN_IN_WINDOW])
    is_shown = shade.math("SUBTRACT", 1.0, is_hidden)
    inside = shade.math("MULTIPLY", shade.math("MULTIPLY", is_within, given["Is Above"]), is_shown)
    shade.finish({"Shader": shade.mix_shaders(inside, given["Shader"], clear)})


HULL_PLACE = GroupKind("Ocean Tweak Hull Place", 1, _build_place, "ShaderNodeTree")
HULL_CUT = GroupKind("Ocean Tweak Hull Cut", 2, _build_cut, "ShaderNodeTree")
