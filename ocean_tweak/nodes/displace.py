# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry nodes that move a grid by an attribute or by a displacement image.

The attribute is what a live sea in the viewport uses: that costs a third of sampling an image.
The image is for baked files, for a mesh that has not one vertex a sample, and for renders finer than the
viewport, which get a grid of their own. It holds metres, `Scale` makes Blender units of them. It is read at
the attribute `st`, which has the half texel in it already, or, on a mesh without one, at the position.
"""

from __future__ import annotations

from typing import Any

import bpy

from .building import Builder, Socket, output
from .grid import GRID, UV_MAP
from .versioned import GroupKind, node_group

#: displacement of each vertex in Blender units; any way to move the mesh leaves it on the result
ATTRIBUTE = "displacement"

#: the inputs besides the geometry: name, socket type, default, description
INPUTS: tuple[tuple[str, str, Any, str], ...] = (
    ("Use Attribute", "NodeSocketBool", False, f"Read the attribute {ATTRIBUTE} instead of the image"),
    ("Image", "NodeSocketImage", None, "Displacement in metres: red x, green y, blue z"),
    ("Domain Size", "NodeSocketFloat", 400.0, "Side of the patch that repeats, in Blender units"),
    ("Resolution", "NodeSocketInt", 512, "Samples along each side of the image"),
    ("Scale", "NodeSocketFloat", 1.0, "Blender units in a metre"),
    ("First Frame", "NodeSocketInt", 1, "First file of the image sequence; held before it"),
    ("Last Frame", "NodeSocketInt", 1_048_574, "Last file of the image sequence; held after it"),
    ("Render Quads", "NodeSocketInt", 0, "Side of the grid made for renders; 0 renders as in the viewport"),
    ("Render Image", "NodeSocketImage", None, "The image that moves the grid made for renders"),
    ("Render Resolution", "NodeSocketInt", 512, "Samples along each side of the render image"),
)


def _build(tree: bpy.types.NodeTree) -> None:
    build = Builder(tree, INPUTS)
    own_grid = _is_own_grid(build)
    geometry = output(build.input, "Geometry")
    grid = build.change(
        "GeometryNodeGroup",
        geometry,
        {
            "Size": output(build.input, "Domain Size"),
            "Quads": output(build.input, "Render Quads"),
            "Samples": output(build.input, "Render Resolution"),
        },
        node_tree=node_group(GRID),
    )
    stored = build.change(
        "GeometryNodeStoreNamedAttribute",
        build.switch("GEOMETRY", own_grid, geometry, grid),
        {"Name": ATTRIBUTE, "Value": _sampled(build, own_grid)},
        data_type="FLOAT_VECTOR",
        domain="POINT",
    )
    written = output(build.input, "Use Attribute")
    ready = build.math("NIMPLY", written, own_grid, "FunctionNodeBooleanMath")
    known = build.switch("GEOMETRY", ready, stored, geometry)
    offset = build.add("GeometryNodeInputNamedAttribute", {"Name": ATTRIBUTE}, data_type="FLOAT_VECTOR")
    build.finish(build.change("GeometryNodeSetPosition", known, {"Offset": output(offset, "Attribute")}))


def _is_own_grid(build: Builder) -> Socket:
    """Whether this is a render that wants another grid than the viewport."""
    is_viewport = output(build.add("GeometryNodeIsViewport"), "Is Viewport")
    wanted = build.add(
        "FunctionNodeCompare", {"A": output(build.input, "Render Quads"), "B": 0},
        data_type="INT", operation="GREATER_THAN",
    )  # fmt: skip
    return build.math("NIMPLY", output(wanted, "Result"), is_viewport, "FunctionNodeBooleanMath")


def _sampled(build: Builder, own_grid: Socket) -> Socket:
    """What the image says, in Blender units."""

    def chosen(kind: str, name: str) -> Socket:
        return build.switch(kind, own_grid, output(build.input, name), output(build.input, f"Render {name}"))

    texture = build.add(
        "GeometryNodeImageTexture",
        {
            "Image": chosen("IMAGE", "Image"),
            "Vector": _texture_coordinates(build, chosen("INT", "Resolution")),
            "Frame": _file_number(build),
        },
        interpolation="Linear",
        extension="REPEAT",
    )
    scale = output(build.input, "Scale")
    scaled = build.add(
        "ShaderNodeVectorMath", operation="SCALE", inputs={"Vector": output(texture, "Color"), "Scale": scale}
    )
    return output(scaled, "Vector")


def _texture_coordinates(build: Builder, resolution: Socket) -> Socket:
    """The attribute `st` where the mesh has it, otherwise position / domain size + ½ / resolution."""
    attribute = build.add("GeometryNodeInputNamedAttribute", {"Name": UV_MAP}, data_type="FLOAT_VECTOR")
    position = output(build.add("GeometryNodeInputPosition"), "Position")
    fraction = build.math("DIVIDE", position, output(build.input, "Domain Size"), "ShaderNodeVectorMath")
    half = build.math("DIVIDE", 0.5, resolution)
    centred = build.math("ADD", fraction, half, "ShaderNodeVectorMath")
    return build.switch("VECTOR", output(attribute, "Exists"), centred, output(attribute, "Attribute"))


def _file_number(build: Builder) -> Socket:
    """The scene's whole frame, held at both ends: beyond them the image node gives zero without a word."""
    time = build.add("GeometryNodeInputSceneTime")
    whole = build.add("FunctionNodeFloatToInt", {"Float": output(time, "Frame")}, rounding_mode="FLOOR")
    first, last = output(build.input, "First Frame"), output(build.input, "Last Frame")
    held = build.math("MAXIMUM", output(whole, "Integer"), first, "FunctionNodeIntegerMath")
    return build.math("MINIMUM", held, last, "FunctionNodeIntegerMath")


DISPLACE = GroupKind("Ocean Tweak Displace", 2, _build)
