# SPDX-License-Identifier: GPL-3.0-or-later
"""Creates nodes and links by name."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple, TypeAlias

import bpy

Socket: TypeAlias = bpy.types.NodeSocket
#: a value for a node's input: another node's output, or a constant
Input = Any


class Plug(NamedTuple):
    """A socket of a group's interface."""

    name: str
    socket_type: str
    default: Any
    description: str
    hidden: bool = False


class Panel(NamedTuple):
    """Inputs grouped in a panel of the modifier."""

    name: str
    inputs: tuple[Plug | tuple[str, str, Any, str], ...]


class Builder:
    """Fills one node tree.

    tree : an empty geometry node tree
    inputs : besides the geometry: name, socket type, default, description, or a panel of such
    outputs : of a group without geometry; a group with geometry outputs only that
    """

    def __init__(
        self,
        tree: bpy.types.NodeTree,
        inputs: Iterable[Plug | Panel | tuple[str, str, Any, str]],
        outputs: Iterable[Plug] = (),
    ) -> None:
        self.tree = tree
        plugs = [*outputs]
        if not plugs:
            tree.is_modifier = True
            plugs.append(Plug("Geometry", "NodeSocketGeometry", None, ""))
            self._add_plug(plugs[0], "OUTPUT", None)
            self._add_plug(plugs[0], "INPUT", None)
        else:
            for plug in plugs:
                self._add_plug(plug, "OUTPUT", None)
        for entry in inputs:
            panel = None
            if isinstance(entry, Panel):
                panel = tree.interface.new_panel(entry.name)
            for values in entry.inputs if isinstance(entry, Panel) else (entry,):
                self._add_plug(Plug(*values), "INPUT", panel)
        self.input = self.add("NodeGroupInput")

    def _add_plug(self, plug: Plug, direction: str, panel: bpy.types.NodeTreeInterfacePanel | None) -> None:
        socket = self.tree.interface.new_socket(
            plug.name, description=plug.description, in_out=direction, socket_type=plug.socket_type,
            parent=panel,
        )  # fmt: skip
        if plug.default is not None:
            socket.default_value = plug.default
        socket.hide_in_modifier = plug.hidden

    def add(self, kind: str, inputs: dict[str, Input] | None = None, **settings: Any) -> bpy.types.Node:
        """Add a node with settings, and with values or links for its inputs by name."""
        node = self.tree.nodes.new(kind)
        for name, value in settings.items():
            setattr(node, name, value)
        for name, value in (inputs or {}).items():
            self._connect(_visible(node.inputs, name), value)
        return node

    def change(
        self, kind: str, geometry: Socket, inputs: dict[str, Input] | None = None, **settings: Any
    ) -> Socket:
        """The output geometry of a node that changes one; the socket's name depends on node and version."""
        node = self.add(kind, inputs, **settings)
        self.tree.links.new(geometry, node.inputs[0])
        return node.outputs[0]

    def store(
        self, geometry: Socket, name: str, value: Input, data_type: str, domain: str = "POINT"
    ) -> Socket:
        """The geometry with an attribute."""
        return self.change(
            "GeometryNodeStoreNamedAttribute", geometry, {"Name": name, "Value": value},
            data_type=data_type, domain=domain,
        )  # fmt: skip

    def math(self, operation: str, first: Input, second: Input, kind: str = "ShaderNodeMath") -> Socket:
        """The output of a node with two operands: Math, Vector Math, Integer Math or Boolean Math."""
        node = self.add(kind, operation=operation)
        operands = [socket for socket in node.inputs if socket.enabled]
        for socket, value in zip(operands, (first, second), strict=False):
            self._connect(socket, value)
        return next(socket for socket in node.outputs if socket.enabled)

    def integer(self, operation: str, first: Input, second: Input) -> Socket:
        """Integer Math."""
        return self.math(operation, first, second, "FunctionNodeIntegerMath")

    def vector(self, operation: str, first: Input, second: Input) -> Socket:
        """Vector Math with two vectors."""
        return self.math(operation, first, second, "ShaderNodeVectorMath")

    def scaled(self, vector: Socket, scale: Input) -> Socket:
        """A vector times a number."""
        node = self.add("ShaderNodeVectorMath", {"Vector": vector, "Scale": scale}, operation="SCALE")
        return output(node, "Vector")

    def logic(self, operation: str, first: Input, second: Input) -> Socket:
        """Boolean Math."""
        return self.math(operation, first, second, "FunctionNodeBooleanMath")

    def compare(self, operation: str, first: Input, second: Input, data_type: str = "INT") -> Socket:
        """Compare two numbers."""
        inputs = {"A": first, "B": second}
        node = self.add("FunctionNodeCompare", inputs, data_type=data_type, operation=operation)
        return output(node, "Result")

    def switch(self, input_type: str, switch: Input, false: Input, true: Input) -> Socket:
        """One of two values; if the condition is the same everywhere, only that one is computed."""
        inputs = {"Switch": switch, "False": false, "True": true}
        return self.add("GeometryNodeSwitch", inputs, input_type=input_type).outputs["Output"]

    def group(self, tree: bpy.types.NodeTree, inputs: dict[str, Input]) -> bpy.types.Node:
        """Another group as a node."""
        # its sockets exist only when it has its tree
        return self.add("GeometryNodeGroup", inputs, node_tree=tree)

    def given(self, name: str) -> Socket:
        """An input of this group."""
        return output(self.input, name)

    def finish(self, geometry: Socket) -> None:
        """Make this the group's result."""
        self.finish_with({"Geometry": geometry})

    def finish_with(self, values: dict[str, Input]) -> None:
        """Make these the group's results, by their names."""
        self.add("NodeGroupOutput", values)

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
