# SPDX-License-Identifier: GPL-3.0-or-later
"""Helper nodes for points and vector arithmetic."""

from __future__ import annotations

import bpy

from .building import Builder, Input, Socket, output


def named_attribute(build: Builder, name: str, data_type: str) -> bpy.types.Node:
    """The node that reads an attribute; 0 if there is none."""
    return build.add("GeometryNodeInputNamedAttribute", {"Name": name}, data_type=data_type)


def sample_index(build: Builder, geometry: Socket, value: Socket, index: Input, data_type: str) -> Socket:
    """The value of a point by its index; 0 if there is none."""
    node = build.add(
        "GeometryNodeSampleIndex", data_type=data_type, domain="POINT",
    )  # fmt: skip
    # its sockets depend on the type
    for name, given in (("Geometry", geometry), ("Value", value), ("Index", index)):
        connect(build, next(each for each in node.inputs if each.name == name and each.enabled), given)
    return output(node, "Value")


def connect(build: Builder, socket: Socket, value: Input) -> None:
    """Link a value to an input, or set it."""
    if isinstance(value, bpy.types.NodeSocket):
        build.tree.links.new(value, socket)
    else:
        socket.default_value = value


def coordinates(build: Builder, vector: Socket) -> tuple[Socket, Socket, Socket]:
    """x, y and z."""
    node = build.add("ShaderNodeSeparateXYZ", {"Vector": vector})
    return output(node, "X"), output(node, "Y"), output(node, "Z")


def combined(build: Builder, x: Input, y: Input, z: Input = 0.0) -> Socket:
    """The vector (x, y, z)."""
    return output(build.add("ShaderNodeCombineXYZ", {"X": x, "Y": y, "Z": z}), "Vector")


def whole_number(build: Builder, value: Socket, rounding: str) -> Socket:
    """A number rounded to an integer; `rounding` is FLOOR or ROUND."""
    node = build.add("FunctionNodeFloatToInt", {"Float": value}, rounding_mode=rounding)
    return output(node, "Integer")


def alone(build: Builder, operation: str, value: Socket, kind: str = "ShaderNodeVectorMath") -> Socket:
    """The output of a node with one operand."""
    return build.math(operation, value, None, kind)


def mixed(build: Builder, first: Socket, second: Socket, share: Socket) -> Socket:
    """Linear interpolation of two vectors, not clamped."""
    node = build.add("ShaderNodeMix", data_type="VECTOR", clamp_factor=False)
    for name, value in (("Factor", share), ("A", first), ("B", second)):
        connect(build, next(each for each in node.inputs if each.name == name and each.enabled), value)
    return output(node, "Result")
