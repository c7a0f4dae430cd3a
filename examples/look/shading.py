# SPDX-License-Identifier: GPL-3.0-or-later
"""Shader trees written as expressions: every helper adds one node and returns its output socket."""

from __future__ import annotations


class Shading:
    """Adds nodes to one tree. A value given to a helper is a socket or a constant."""

    def __init__(self, tree):
        self.tree = tree
        self.tree.nodes.clear()

    def node(self, kind, inputs=None, **settings):
        """Add a node of the type `ShaderNode<kind>` with its settings, and link or set its inputs."""
        node = self.tree.nodes.new(f"ShaderNode{kind}")
        for name, value in settings.items():
            setattr(node, name, value)
        for key, value in (inputs or {}).items():
            if hasattr(value, "is_linked"):
                self.tree.links.new(value, node.inputs[key])
            else:
                node.inputs[key].default_value = value
        return node

    def math(self, operation, *values, clamp=False):
        """Scalar arithmetic."""
        node = self.node("Math", dict(enumerate(values)), operation=operation, use_clamp=clamp)
        return node.outputs[0]

    def vector(self, operation, *values, output="Vector"):
        """Vector arithmetic; DOT_PRODUCT and LENGTH want `output="Value"`."""
        node = self.node("VectorMath", dict(enumerate(values)), operation=operation)
        return node.outputs[output]

    def scale(self, vector, factor):
        """Vector times scalar."""
        return self.node("VectorMath", {0: vector, "Scale": factor}, operation="SCALE").outputs[0]

    def separate(self, vector):
        """The x, y and z of a vector."""
        return tuple(self.node("SeparateXYZ", {0: vector}).outputs)

    def combine(self, x, y, z=0.0):
        """A vector from x, y and z."""
        return self.node("CombineXYZ", {0: x, 1: y, 2: z}).outputs[0]

    def smooth(self, value, start, end, to_start=0.0, to_end=1.0):
        """Smooth step of `value` from `start` to `end`, remapped to `to_start` … `to_end`."""
        inputs = {0: value, 1: start, 2: end, 3: to_start, 4: to_end}
        return self.node("MapRange", inputs, interpolation_type="SMOOTHSTEP").outputs[0]

    def noise(self, position, scale, detail=4.0, roughness=0.5, distortion=0.0):
        """Fractal noise around 0.5."""
        inputs = {
            "Vector": position, "Scale": scale, "Detail": detail,
            "Roughness": roughness, "Distortion": distortion,
        }  # fmt: skip
        return self.node("TexNoise", inputs, noise_dimensions="3D").outputs[0]

    def ramp(self, factor, stops):
        """Colour of a ramp; `stops` is a sequence of (position, (r, g, b))."""
        node = self.node("ValToRGB", {0: factor})
        node.color_ramp.interpolation = "EASE"
        elements = node.color_ramp.elements
        while len(elements) < len(stops):
            elements.new(1.0)
        for element, (position, colour) in zip(elements, stops, strict=True):
            element.position = position
            element.color = (*colour, 1.0)
        return node.outputs[0]
