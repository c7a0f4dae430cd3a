# SPDX-License-Identifier: GPL-3.0-or-later
"""Ocean Sample: geometry nodes that return height, normal, foam and motion of an ocean above any position.

They read the ocean's evaluated mesh, so they work for live and baked seas, in the viewport and in renders.
The ocean and the sampling object may be anywhere: results are in the sampling object's space.
"""

from __future__ import annotations

from functools import cached_property

import bpy

from .building import Builder, Plug, Socket, output
from .fields import alone, coordinates
from .surface import SURFACE
from .versioned import GroupKind, node_group

OCEAN_INPUT = Plug("Ocean", "NodeSocketObject", None, "The ocean; without one the sea is flat")

INPUTS = (
    OCEAN_INPUT,
    Plug("Position", "NodeSocketVector", None, "Where to look: the surface right above or below it"),
    Plug(
        "At Rest", "NodeSocketBool", False,
        "Treat the position as that of water at rest, and return where this water is now",
    ),
)  # fmt: skip

OUTPUTS = (
    Plug("Height", "NodeSocketFloat", None, "Of the surface, in the space of the object that asks"),
    Plug("Normal", "NodeSocketVector", None, "Of the surface, of length 1"),
    Plug("Foam", "NodeSocketFloat", None, "0 to 1; 0 where the ocean makes no foam"),
    Plug("Velocity", "NodeSocketVector", None, "Of the water, per second; 0 where the ocean makes none"),
    Plug("Displacement", "NodeSocketVector", None, "Of the water that is there, from where it is at rest"),
    Plug("Point", "NodeSocketVector", None, "On the surface, above or below the position"),
)


class Spaces:
    """The ocean's mesh, and conversions between its space and that of the sampling object ("asker")."""

    def __init__(self, build: Builder, ocean: Socket) -> None:
        self._build = build
        self._ocean = ocean
        placed = build.add("GeometryNodeObjectInfo", {"Object": ocean}, transform_space="RELATIVE")
        #: from the ocean's space to the asker's
        self.transform = output(placed, "Transform")
        inverse = build.add("FunctionNodeInvertMatrix", {"Matrix": self.transform})
        self._inverse = output(inverse, "Matrix")

    @cached_property
    def mesh(self) -> Socket:
        """The mesh in the ocean's own space, as transforming it would copy it."""
        inputs = {"Object": self._ocean}
        own = self._build.add("GeometryNodeObjectInfo", inputs, transform_space="ORIGINAL")
        return output(own, "Geometry")

    def point_of_ocean(self, position: Socket) -> Socket:
        """The asker's position in the ocean's space."""
        inputs = {"Vector": position, "Transform": self._inverse}
        return output(self._build.add("FunctionNodeTransformPoint", inputs), "Vector")

    def point_of_asker(self, position: Socket) -> Socket:
        """The ocean's position in the asker's space."""
        inputs = {"Vector": position, "Transform": self.transform}
        return output(self._build.add("FunctionNodeTransformPoint", inputs), "Vector")

    def size_of_ocean(self, direction: tuple[float, float, float]) -> Socket:
        """Length of the asker's unit in the ocean's space."""
        return alone(self._build, "LENGTH", self.direction_of_ocean(direction))

    def direction_of_asker(self, direction: Socket | tuple[float, float, float]) -> Socket:
        """The ocean's direction in the asker's space."""
        inputs = {"Direction": direction, "Transform": self.transform}
        return output(self._build.add("FunctionNodeTransformDirection", inputs), "Direction")

    def direction_of_ocean(self, direction: Socket | tuple[float, float, float]) -> Socket:
        """The asker's direction in the ocean's space."""
        inputs = {"Direction": direction, "Transform": self._inverse}
        return output(self._build.add("FunctionNodeTransformDirection", inputs), "Direction")

    def normal_of_asker(
        self,
        along_x: Socket | tuple[float, float, float] = (1.0, 0.0, 0.0),
        along_y: Socket | tuple[float, float, float] = (0.0, 1.0, 0.0),
    ) -> Socket:
        """The unit normal, in the asker's space, of a surface with these tangents in the ocean's space.

        It points to the side of the ocean's z axis, even if the surface has folded or the ocean is mirrored.
        Without tangents, that of the sea at rest.
        """
        build = self._build
        tangents = self.direction_of_asker(along_x), self.direction_of_asker(along_y)
        normal = alone(build, "NORMALIZE", build.vector("CROSS_PRODUCT", *tangents))
        up = self.direction_of_asker((0.0, 0.0, 1.0))
        side = build.math("SIGN", build.vector("DOT_PRODUCT", normal, up), None)
        return build.scaled(normal, side)


def _build(tree: bpy.types.NodeTree) -> None:
    build = Builder(tree, INPUTS, OUTPUTS)
    position = next(
        item for item in tree.interface.items_tree if (item.name, item.in_out) == ("Position", "INPUT")
    )
    position.default_input = "POSITION"
    position.hide_value = True
    spaces = Spaces(build, build.given("Ocean"))
    surface = build.group(
        node_group(SURFACE),
        {
            "Geometry": spaces.mesh,
            "Position": spaces.point_of_ocean(build.given("Position")),
            "At Rest": build.given("At Rest"),
        },
    )
    point = spaces.point_of_asker(output(surface, "Point"))
    build.finish_with(
        {
            "Height": coordinates(build, point)[2],
            "Normal": spaces.normal_of_asker(output(surface, "Along X"), output(surface, "Along Y")),
            "Foam": output(surface, "Foam"),
            "Velocity": spaces.direction_of_asker(output(surface, "Velocity")),
            "Displacement": spaces.direction_of_asker(output(surface, "Displacement")),
            "Point": point,
        }
    )


SAMPLE = GroupKind("Ocean Sample", 1, _build)
