# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes and links, made by name."""

from __future__ import annotations

from typing import Any

import bpy

Socket = bpy.types.NodeSocket
#: what a node's input can be given: another node's output, or a value
Input = Any


class Builder:
    """Fills one node tree.

    tree : an empty geometry node tree
    inputs : besides the geometry: name, socket type, default, description
    """

    def __init__(self, tree: bpy.types.NodeTree, inputs: tuple[tuple[str, str, Any, str], ...]) -> None:
        self.tree = tree
        self._column = 0
        tree.is_modifier = True
        tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
        tree.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
        for name, socket_type, default, description in inputs:
            socket = tree.interface.new_socket(
                name, in_out="INPUT", socket_type=socket_type, description=description
            )
            if default is not None:
                socket.default_value = default
        self.input = self.add("NodeGroupInput")

    def add(self, kind: str, inputs: dict[str, Input] | None = None, **settings: Any) -> bpy.types.Node:
        """A node with its settings, and with values or links on its inputs by their names."""
        node = self.tree.nodes.new(kind)
        node.location = (200 * self._column, -40 * (self._column % 8))
        self._column += 1
        for name, value in settings.items():
            setattr(node, name, value)
        for name, value in (inputs or {}).items():
            self._connect(_visible(node.inputs, name), value)
        return node

    def change(
        self, kind: str, geometry: Socket, inputs: dict[str, Input] | None = None, **settings: Any
    ) -> Socket:
        """The geometry behind a node that changes one; nodes and versions call its socket differently."""
        node = self.add(kind, inputs, **settings)
        self.tree.links.new(geometry, node.inputs[0])
        return node.outputs[0]

    def math(self, operation: str, first: Input, second: Input, kind: str = "ShaderNodeMath") -> Socket:
        """The result of a node with two operands: Math, Vector Math, Integer Math or Boolean Math."""
        node = self.add(kind, operation=operation)
        operands = [socket for socket in node.inputs if socket.enabled]
        for socket, value in zip(operands, (first, second), strict=False):
            self._connect(socket, value)
        return next(socket for socket in node.outputs if socket.enabled)

    def switch(self, input_type: str, switch: Input, false: Input, true: Input) -> Socket:
        """One of two values; where the condition is one for all, only that one is computed."""
        inputs = {"Switch": switch, "False": false, "True": true}
        return self.add("GeometryNodeSwitch", inputs, input_type=input_type).outputs["Output"]

    def finish(self, geometry: Socket) -> None:
        """Make this the group's result."""
        self.add("NodeGroupOutput", {"Geometry": geometry})

    def _connect(self, socket: Socket, value: Input) -> None:
        if isinstance(value, bpy.types.NodeSocket):
            self.tree.links.new(value, socket)
        else:
            socket.default_value = value


def output(node: bpy.types.Node, name: str) -> Socket:
    """A node's output by its name."""
    return _visible(node.outputs, name)


def _visible(sockets: bpy.types.bpy_prop_collection, name: str) -> Socket:
    # several sockets of a node can have the same name: only the enabled one is visible
    return next(socket for socket in sockets if socket.name == name and socket.enabled)
