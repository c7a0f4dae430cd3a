# SPDX-License-Identifier: GPL-3.0-or-later
"""The shader group "Ocean Tweak Spray Look": spume and drops that scatter light, and mist with soft rims.

Each particle stands for many drops. Light comes off them as off foam, and through them where the sun stands
behind. The farther they are in haze, the more they have its colour. They hide as much as in clear air: light
that goes on through hundreds of them is ended in black.
"""

from __future__ import annotations

import bpy

from ..core.spray.drops import DROPLET, MIST
from .building import Panel, Plug
from .shading import VISIBILITY, Shading
from .spray import DENSITY, KIND
from .versioned import GroupKind

#: of the light that comes off a particle, what has come through it
_THROUGH = 0.45
#: how much softer spume and mist are towards their rims than a ball of even density
_RIM = 2.0

_PANELS = (
    Panel(
        "Spray",
        (
            ("Color", "NodeSocketColor", (0.92, 0.93, 0.94, 1.0), "Of spume and mist"),
            ("Drops", "NodeSocketFloat", 0.9, "Opacity of single drops in their middle"),
            ("Spume", "NodeSocketFloat", 0.45, "Opacity of a piece of a sheet of spume in its middle"),
            ("Mist", "NodeSocketFloat", 0.07, "Opacity of new mist in its middle"),
            ("Visibility", "NodeSocketFloat", 0.0, "In the air, in metres; 0 for clear air"),
            ("Haze Color", "NodeSocketColor", (0.6, 0.65, 0.7, 1.0), "The sky's at the horizon"),
        ),
    ),
)


def _build(tree: bpy.types.NodeTree) -> None:
    shade = Shading(tree)
    given = shade.interface((Plug("Surface", "NodeSocketShader", None, ""),), _PANELS).outputs
    geometry = shade.node("ShaderNodeNewGeometry").outputs
    facing = shade.number("DOT_PRODUCT", geometry["Normal"], geometry["Incoming"])
    facing = shade.math("ABSOLUTE", facing)
    kind = shade.value(KIND)
    is_mist, is_drop = (shade.math("COMPARE", kind, float(each), 0.5) for each in (MIST, DROPLET))
    soft = shade.math("POWER", facing, _RIM)
    mist = shade.math("MULTIPLY", given["Mist"], shade.math("MULTIPLY", shade.value(DENSITY), soft))
    sheet = shade.math("MULTIPLY", given["Spume"], soft)
    spume = shade.mix(is_drop, sheet, shade.math("MULTIPLY", given["Drops"], facing))
    path = shade.math(
        "DIVIDE",
        shade.math("MULTIPLY", shade.node("ShaderNodeCameraData").outputs["View Distance"], -VISIBILITY),
        shade.math("MAXIMUM", given["Visibility"], 1e-3),
    )
    is_hazy = shade.math("GREATER_THAN", given["Visibility"], 0.0)
    haze = shade.math("MULTIPLY", is_hazy, shade.math("SUBTRACT", 1.0, shade.math("EXPONENT", path)))
    haze = shade.math("MULTIPLY", haze, shade.node("ShaderNodeLightPath").outputs[0])
    opacity = shade.math("MINIMUM", shade.mix(is_mist, spume, mist), 1.0)
    off = shade.node("ShaderNodeBsdfDiffuse", {0: given["Color"]}).outputs[0]
    through = shade.node("ShaderNodeBsdfTranslucent", {0: given["Color"]}).outputs[0]
    air = shade.node("ShaderNodeEmission", {0: given["Haze Color"], 1: 1.0}).outputs[0]
    clear = shade.node("ShaderNodeBsdfTransparent").outputs[0]
    seen = shade.mix_shaders(haze, shade.mix_shaders(_THROUGH, off, through), air)
    shade.finish({"Surface": shade.mix_shaders(opacity, clear, seen)})


SPRAY_LOOK = GroupKind("Ocean Tweak Spray Look", 6, _build, "ShaderNodeTree")
