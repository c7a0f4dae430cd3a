# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry nodes that move a grid by a displacement image.

The image holds metres; `Scale` makes Blender units of them. It is read at the attribute `st`, which has
the half texel in it already, or, on a mesh without one, at the position.
"""

from __future__ import annotations

from typing import Any

import bpy

from .versioned import GroupKind

UV_MAP = "st"

#: the inputs besides the geometry: name, socket type, default, description
INPUTS: tuple[tuple[str, str, Any, str], ...] = (
    ("Image", "NodeSocketImage", None, "Displacement in metres: red x, green y, blue z"),
    ("Domain Size", "NodeSocketFloat", 400.0, "Side of the patch that repeats, in Blender units"),
    ("Resolution", "NodeSocketInt", 512, "Samples along each side of the image"),
    ("Scale", "NodeSocketFloat", 1.0, "Blender units in a metre"),
    ("First Frame", "NodeSocketInt", 1, "First file of the image sequence; held before it"),
    ("Last Frame", "NodeSocketInt", 1_048_574, "Last file of the image sequence; held after it"),
)


def _build(tree: bpy.types.NodeTree) -> None:
    tree.is_modifier = True
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    tree.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    for name, socket_type, default, description in INPUTS:
        socket = tree.interface.new_socket(
            name, in_out="INPUT", socket_type=socket_type, description=description
        )
        if default is not None:
            socket.default_value = default
    source = _node(tree, "NodeGroupInput", -900, 0)
    texture = _node(tree, "GeometryNodeImageTexture", 150, -100, interpolation="Linear", extension="REPEAT")
    _link(tree, source, "Image", texture, "Image")
    tree.links.new(_sample_position(tree, source), texture.inputs["Vector"])
    tree.links.new(_file_number(tree, source), texture.inputs["Frame"])
    scaled = _node(tree, "ShaderNodeVectorMath", 400, -100, operation="SCALE")
    _link(tree, texture, "Color", scaled, "Vector")
    _link(tree, source, "Scale", scaled, "Scale")
    moved = _node(tree, "GeometryNodeSetPosition", 600, 0)
    _link(tree, source, "Geometry", moved, "Geometry")
    _link(tree, scaled, "Vector", moved, "Offset")
    _link(tree, moved, "Geometry", _node(tree, "NodeGroupOutput", 800, 0), "Geometry")


def _sample_position(tree: bpy.types.NodeTree, source: bpy.types.Node) -> bpy.types.NodeSocket:
    """The attribute `st` where the mesh has it, otherwise position / domain size + ½ / resolution."""
    attribute = _node(tree, "GeometryNodeInputNamedAttribute", -350, -100, data_type="FLOAT_VECTOR")
    attribute.inputs["Name"].default_value = UV_MAP
    position = _node(tree, "GeometryNodeInputPosition", -900, -400)
    fraction = _node(tree, "ShaderNodeVectorMath", -650, -400, operation="DIVIDE")
    tree.links.new(position.outputs["Position"], fraction.inputs[0])
    tree.links.new(source.outputs["Domain Size"], fraction.inputs[1])
    half = _node(tree, "ShaderNodeMath", -650, -600, operation="DIVIDE")
    half.inputs[0].default_value = 0.5
    tree.links.new(source.outputs["Resolution"], half.inputs[1])
    centred = _node(tree, "ShaderNodeVectorMath", -350, -400, operation="ADD")
    tree.links.new(fraction.outputs["Vector"], centred.inputs[0])
    tree.links.new(half.outputs["Value"], centred.inputs[1])
    switch = _node(tree, "GeometryNodeSwitch", -100, -200, input_type="VECTOR")
    _link(tree, attribute, "Exists", switch, "Switch")
    _link(tree, attribute, "Attribute", switch, "True")
    _link(tree, centred, "Vector", switch, "False")
    return switch.outputs["Output"]


def _file_number(tree: bpy.types.NodeTree, source: bpy.types.Node) -> bpy.types.NodeSocket:
    """The scene's whole frame, held at both ends: beyond them the image node gives zero without a word."""
    time = _node(tree, "GeometryNodeInputSceneTime", -650, 350)
    whole = _node(tree, "FunctionNodeFloatToInt", -450, 350, rounding_mode="FLOOR")
    _link(tree, time, "Frame", whole, "Float")
    frame = whole.outputs["Integer"]
    for column, (operation, bound) in enumerate((("MAXIMUM", "First Frame"), ("MINIMUM", "Last Frame"))):
        held = _node(tree, "FunctionNodeIntegerMath", -250 + 200 * column, 350, operation=operation)
        tree.links.new(frame, held.inputs[0])
        tree.links.new(source.outputs[bound], held.inputs[1])
        frame = held.outputs["Value"]
    return frame


def _node(tree: bpy.types.NodeTree, kind: str, x: float, y: float, **settings: Any) -> bpy.types.Node:
    node = tree.nodes.new(kind)
    node.location = (x, y)
    for name, value in settings.items():
        setattr(node, name, value)
    return node


def _link(
    tree: bpy.types.NodeTree, source: bpy.types.Node, output: str, target: bpy.types.Node, socket: str
) -> None:
    # several sockets of a node can have the same name: only the enabled one is visible
    start = next(s for s in source.outputs if s.name == output and s.enabled)
    end = next(s for s in target.inputs if s.name == socket and s.enabled)
    tree.links.new(start, end)


DISPLACE = GroupKind("Ocean Tweak Displace", 1, _build)
