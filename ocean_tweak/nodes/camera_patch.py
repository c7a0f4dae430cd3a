# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry nodes that add one patch of a sea of several to a grid around the camera.

The grid carries the sums of the patches before: displacement, velocity, slopes with the variance that the
averages lack, and strain, all in the ocean's axes. A patch is read in its own space, averaged by its own
spacing, turned, and multiplied by its weight w, whose own change is a part of slopes and strains:
∂(w d) = w ∂d + d ∂w.
"""

from __future__ import annotations

from collections.abc import Callable

import bpy

from .averaged import AVERAGED
from .averages import CARRIED, OTHERS, SLOPES, cells, patch_carried
from .building import Builder, Plug, Socket, output
from .fields import alone, combined, coordinates, named_attribute, sample_index
from .names import DISPLACEMENT, VELOCITY
from .sample import OCEAN_INPUT, Spaces
from .surface import CELL, GRID_FACTS
from .versioned import GroupKind, node_group

_INPUTS = (
    Plug("Geometry", "NodeSocketGeometry", None, "The grid with the sums of the patches before"),
    OCEAN_INPUT,
    Plug("Patch", "NodeSocketObject", None, "One patch; without one nothing is added"),
    Plug(
        "Corner", "NodeSocketVector", None, "Its mesh's first vertex at rest, where the grid has its origin"
    ),
    Plug("Weights", "NodeSocketGeometry", None, "Points over the ocean's domain, x fastest"),
    Plug("Spacing", "NodeSocketVector", None, "Between these points"),
    Plug("Columns", "NodeSocketInt", 2, "Of them along x"),
    Plug("Rows", "NodeSocketInt", 2, "Of them along y"),
    Plug("Weight", "NodeSocketString", "", "Attribute of theirs that the patch is multiplied by"),
    Plug("Size", "NodeSocketFloat", 1.0, "Of the grid's cells where a vertex is"),
    Plug("Fade", "NodeSocketBool", True, "Average by the size of the cells"),
    Plug("Repeats", "NodeSocketBool", True, "Go on beyond the mesh; otherwise there is nothing of it"),
)
_OUTPUTS = (Plug("Geometry", "NodeSocketGeometry", None, "The grid with the sums of this one too"),)


def _build(tree: bpy.types.NodeTree) -> None:
    build = Builder(tree, _INPUTS, _OUTPUTS)
    ocean, patch = Spaces(build, build.given("Ocean")), Spaces(build, build.given("Patch"))
    facts = build.group(node_group(GRID_FACTS), {"Geometry": patch.mesh})
    position = output(build.add("GeometryNodeInputPosition"), "Position")
    in_ocean = build.vector("ADD", position, build.given("Corner"))
    in_patch = patch.point_of_ocean(ocean.point_of_asker(in_ocean))
    inputs = {name: output(facts, name) for name in ("Columns", "Rows", "Spacing")}
    place = build.vector("SUBTRACT", in_patch, output(facts, "Corner"))
    before = _sums_before(build, build.logic("OR", build.given("Repeats"), _is_over(build, place, inputs)))
    inputs |= {name: build.given(name) for name in ("Size", "Fade")}
    inputs |= {
        "Geometry": output(before, "Geometry"),
        "Surface": patch_carried(build, output(facts, "Geometry")),
        "Place": place,
    }
    grid = output(build.group(node_group(AVERAGED), inputs), "Geometry")

    def turned(direction: Socket | tuple[float, float, float]) -> Socket:
        return ocean.direction_of_ocean(patch.direction_of_asker(direction))

    for name, value in _turned(build, turned, before.outputs["Weight"]).items():
        grid = build.store(grid, name, build.vector("ADD", before.outputs[name], value), "FLOAT_VECTOR")
    count = build.add("GeometryNodeAttributeDomainSize", {"Geometry": output(facts, "Geometry")})
    is_there = build.compare("GREATER_THAN", output(count, "Point Count"), 0)
    build.finish(build.switch("GEOMETRY", is_there, build.given("Geometry"), grid))


def _is_over(build: Builder, place: Socket, facts: dict[str, Socket]) -> Socket:
    """Whether a place, from a mesh's first vertex, is over the mesh."""
    extent = build.vector("MULTIPLY", facts["Spacing"], cells(build, facts["Columns"], facts["Rows"]))
    from_middle = build.vector("SUBTRACT", build.vector("DIVIDE", place, extent), (0.5, 0.5, 0.5))
    x, y, _ = coordinates(build, alone(build, "ABSOLUTE", from_middle))
    return build.compare("LESS_EQUAL", build.math("MAXIMUM", x, y), 0.5, "FLOAT")


def _sums_before(build: Builder, is_there: Socket) -> bpy.types.Node:
    """Keeps the sums and the weight, whose names are used anew.

    is_there : whether there is a patch where a vertex is
    """
    node = build.add("GeometryNodeCaptureAttribute", {"Geometry": build.given("Geometry")}, domain="POINT")
    values = {name: output(named_attribute(build, name, "FLOAT_VECTOR"), "Attribute") for name in CARRIED}
    for name, value in values.items():
        node.capture_items.new("VECTOR", name)
        build.tree.links.new(value, node.inputs[name])
    node.capture_items.new("VECTOR", "Weight")
    weight = build.switch("VECTOR", is_there, (0.0, 0.0, 0.0), _weight(build))
    build.tree.links.new(weight, node.inputs["Weight"])
    return node


def _weight(build: Builder) -> Socket:
    """At the vertex, with its changes along x and y; 1 where there is no such attribute."""
    points = build.given("Weights")
    attribute = build.add("GeometryNodeInputNamedAttribute", data_type="FLOAT")
    build.tree.links.new(build.given("Weight"), attribute.inputs["Name"])
    position = output(build.add("GeometryNodeInputPosition"), "Position")
    inputs = {
        "Value": output(attribute, "Attribute"),
        "Place": build.vector("DIVIDE", position, build.given("Spacing")),
        "Geometry": points,
        **{name: build.given(name) for name in ("Columns", "Rows")},
    }
    cell = build.group(node_group(CELL), inputs)
    there, by_x, by_y = (
        coordinates(build, output(cell, name))[0] for name in ("Value", "Along X", "Along Y")
    )
    step_x, step_y, _ = coordinates(build, build.given("Spacing"))
    changes = (build.math("DIVIDE", change, step) for change, step in ((by_x, step_x), (by_y, step_y)))
    known = sample_index(build, points, output(attribute, "Exists"), 0, "BOOLEAN")
    return build.switch("VECTOR", known, (1.0, 0.0, 0.0), combined(build, there, *changes))


def _turned(
    build: Builder, turned: Callable[[Socket | tuple[float, float, float]], Socket], weight: Socket
) -> dict[str, Socket]:
    """What was read, in the ocean's axes and multiplied: vectors R v, strain R G Rᵀ.

    In the order in which it can be stored: the displacement is a part of what stands before it.
    """

    def told(name: str) -> Socket:
        return output(named_attribute(build, name, "FLOAT_VECTOR"), "Attribute")

    def product(a: Socket, b: Socket) -> Socket:
        return build.math("MULTIPLY", a, b)

    weight, by_x, by_y = coordinates(build, weight)
    displacement = turned(told(DISPLACEMENT))
    dx, dy, dz = coordinates(build, displacement)
    x, y, squares = coordinates(build, told(SLOPES))
    slope = build.scaled(turned(combined(build, x, y)), weight)
    slope = build.vector("ADD", slope, build.scaled(combined(build, by_x, by_y), dz))
    slope_x, slope_y, _ = coordinates(build, slope)
    held = build.math("ADD", *(build.math("MULTIPLY", part, part) for part in (x, y)))
    lost = build.math("MAXIMUM", build.math("SUBTRACT", squares, held), 0.0)
    lost = build.math("MULTIPLY", lost, build.math("MULTIPLY", weight, weight))
    shear = build.math("MULTIPLY", build.math("ADD", product(dx, by_y), product(dy, by_x)), 0.5)
    strain = build.scaled(_turned_strain(build, told(OTHERS), turned((1.0, 0.0, 0.0))), weight)
    return {
        SLOPES: combined(build, slope_x, slope_y, lost),
        OTHERS: build.vector("ADD", strain, combined(build, product(dx, by_x), product(dy, by_y), shear)),
        VELOCITY: build.scaled(turned(told(VELOCITY)), weight),
        DISPLACEMENT: build.scaled(displacement, weight),
    }


def _turned_strain(build: Builder, strain: Socket, axis: Socket) -> Socket:
    """R G Rᵀ of (Gxx, Gyy, Gxy) by the angle of an axis: half the difference and the shear turn twice."""
    xx, yy, xy = coordinates(build, strain)
    cosine, sine, _ = coordinates(build, alone(build, "NORMALIZE", axis))

    def product(a: Socket, b: Socket) -> Socket:
        return build.math("MULTIPLY", a, b)

    twice = build.math("SUBTRACT", product(cosine, cosine), product(sine, sine))
    both = build.math("MULTIPLY", product(cosine, sine), 2.0)
    mean = build.math("MULTIPLY", build.math("ADD", xx, yy), 0.5)
    half = build.math("MULTIPLY", build.math("SUBTRACT", xx, yy), 0.5)
    turned_half = build.math("SUBTRACT", product(half, twice), product(xy, both))
    shear = build.math("ADD", product(half, both), product(xy, twice))
    return combined(
        build, build.math("ADD", mean, turned_half), build.math("SUBTRACT", mean, turned_half), shear
    )


CAMERA_PATCH = GroupKind("Ocean Tweak Camera Patch", 3, _build)
