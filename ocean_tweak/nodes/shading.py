# SPDX-License-Identifier: GPL-3.0-or-later
"""Shader trees written as expressions: every helper adds one node and returns its output socket.

Sockets are addressed by index where their names differ between Blender 4.5 and 5.x.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import bpy

from .building import Panel, Plug, Socket

#: a socket, or the value of one
Value = Any

Triple = tuple[Socket, Socket, Socket]

#: optical depth at the visibility of the air, at which 2 % of the contrast remains (Koschmieder 1924)
VISIBILITY = 3.912


class Shading:
    """Adds nodes to one shader tree: a group's, a material's or a world's."""

    def __init__(self, tree: bpy.types.NodeTree) -> None:
        tree.nodes.clear()
        self.tree = tree

    def interface(self, outputs: Iterable[Plug], panels: Iterable[Panel]) -> bpy.types.Node:
        """Give a group its sockets; returns the node that holds its inputs."""
        for plug in outputs:
            self.tree.interface.new_socket(
                plug.name, in_out="OUTPUT", socket_type=plug.socket_type, description=plug.description
            )
        for panel in panels:
            parent = self.tree.interface.new_panel(panel.name)
            for values in panel.inputs:
                self._add_input(Plug(*values), parent)
        return self.node("NodeGroupInput")

    def _add_input(self, plug: Plug, parent: bpy.types.NodeTreeInterfacePanel) -> None:
        socket = self.tree.interface.new_socket(
            plug.name, description=plug.description, in_out="INPUT", socket_type=plug.socket_type,
            parent=parent,
        )  # fmt: skip
        if plug.default is not None:  # a shader has none
            socket.default_value = plug.default
        if plug.socket_type == "NodeSocketFloat":
            socket.min_value = min(0.0, plug.default)
        if plug.socket_type == "NodeSocketVector":
            socket.hide_value = True

    def node(self, kind: str, inputs: dict[Any, Value] | None = None, **settings: Any) -> bpy.types.Node:
        """A node with its settings, and with links or values on its inputs, by name or number."""
        node = self.tree.nodes.new(kind)
        for name, value in settings.items():
            setattr(node, name, value)
        for key, value in (inputs or {}).items():
            if isinstance(value, bpy.types.NodeSocket):
                self.tree.links.new(value, node.inputs[key])
            else:
                node.inputs[key].default_value = value
        return node

    def math(self, operation: str, *values: Value, clamp: bool = False) -> Socket:
        """Scalar arithmetic."""
        inputs = dict(enumerate(values))
        return self.node("ShaderNodeMath", inputs, operation=operation, use_clamp=clamp).outputs[0]

    def vector(self, operation: str, *values: Value) -> Socket:
        """Vector arithmetic that gives a vector."""
        return self.node("ShaderNodeVectorMath", dict(enumerate(values)), operation=operation).outputs[0]

    def number(self, operation: str, *values: Value) -> Socket:
        """Vector arithmetic that gives a number: DOT_PRODUCT, LENGTH, DISTANCE."""
        node = self.node("ShaderNodeVectorMath", dict(enumerate(values)), operation=operation)
        return node.outputs["Value"]

    def scale(self, vector: Value, factor: Value) -> Socket:
        """Vector times scalar."""
        return self.node("ShaderNodeVectorMath", {0: vector, "Scale": factor}, operation="SCALE").outputs[0]

    def separate(self, vector: Socket) -> Triple:
        """The x, y and z of a vector."""
        return tuple(self.node("ShaderNodeSeparateXYZ", {0: vector}).outputs)

    def combine(self, x: Value, y: Value, z: Value = 0.0) -> Socket:
        """A vector from x, y and z."""
        return self.node("ShaderNodeCombineXYZ", {0: x, 1: y, 2: z}).outputs[0]

    def smooth(self, value: Value, start: Value, end: Value, low: Value = 0.0, high: Value = 1.0) -> Socket:
        """Smooth step of `value` from `start` to `end`, remapped to `low` … `high`."""
        inputs = {0: value, 1: start, 2: end, 3: low, 4: high}
        return self.node("ShaderNodeMapRange", inputs, interpolation_type="SMOOTHSTEP").outputs[0]

    def mix(self, factor: Value, first: Value, second: Value) -> Socket:
        """Number between two numbers."""
        return self.node("ShaderNodeMix", {0: factor, 2: first, 3: second}, data_type="FLOAT").outputs[0]

    def mix_vectors(self, factor: Value, first: Value, second: Value) -> Socket:
        """Vector, or colour, between two."""
        inputs = {0: factor, 4: first, 5: second}
        return self.node("ShaderNodeMix", inputs, data_type="VECTOR").outputs[1]

    def mix_shaders(self, factor: Value, first: Socket, second: Socket) -> Socket:
        """Mix two shaders."""
        return self.node("ShaderNodeMixShader", {0: factor, 1: first, 2: second}).outputs[0]

    def attribute(self, name: str, of: str = "GEOMETRY") -> bpy.types.Node:
        """An attribute of the geometry, or with "OBJECT" a custom property; zero if there is none."""
        return self.node("ShaderNodeAttribute", attribute_type=of, attribute_name=name)

    def value(self, name: str, of: str = "GEOMETRY") -> Socket:
        """A number from an attribute."""
        return self.attribute(name, of).outputs[2]

    def noise(self, position: Socket, scale: Value, **inputs: Value) -> Socket:
        """Fractal noise around 0.5."""
        values = {"Vector": position, "Scale": scale, **inputs}
        return self.node("ShaderNodeTexNoise", values, noise_dimensions="3D").outputs[0]

    def ramp(
        self,
        factor: Socket,
        stops: Sequence[tuple[float, tuple[float, float, float]]],
        interpolation: str = "EASE",
    ) -> Socket:
        """Colour of a ramp; `stops` are positions 0…1 with linear colours."""
        node = self.node("ShaderNodeValToRGB", {0: factor})
        node.color_ramp.interpolation = interpolation
        elements = node.color_ramp.elements
        while len(elements) < len(stops):
            elements.new(1.0)
        for element, (position, colour) in zip(elements, stops, strict=True):
            element.position = position
            element.color = (*colour, 1.0)
        return node.outputs[0]

    def finish(self, values: dict[str, Socket]) -> None:
        """Make these the group's results, by their names."""
        self.node("NodeGroupOutput", values)
