# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry nodes that add one of several patches to the sums for a grid around the camera.

Inputs are the sums of the previous patches at each vertex: displacement, velocity, slopes with the variance
lost by averaging, and strain, all in the ocean's axes. They are fields, so all patches are evaluated at once.
A patch is sampled in its own space, averaged by its own spacing, rotated, and multiplied by its weight w,
whose derivatives enter slopes and strains: ∂(w d) = w ∂d + d ∂w.
"""

from __future__ import annotations

from collections.abc import Callable

import bpy

from .averaged import AVERAGED, READ, SOCKETS
from .averages import CARRIED, cells, patch_averages
from .building import Builder, Plug, Socket, output
from .fields import alone, combined, coordinates, sample_index
from .names import DISPLACEMENT, OTHERS, SLOPES, VELOCITY
from .rest_grid import CELL, GRID_FACTS
from .sample import OCEAN_INPUT, Spaces
from .versioned import GroupKind, node_group

_INPUTS = (
    *(Plug(plug.name, plug.socket_type, None, "Sum of the patches before") for plug in READ),
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
_OUTPUTS = tuple(Plug(plug.name, plug.socket_type, None, "Sum with this patch") for plug in READ)

#: by the names of CARRIED
Values = dict[str, Socket]


def _build(tree: bpy.types.NodeTree) -> None:
    build = Builder(tree, _INPUTS, _OUTPUTS)
    ocean, patch = Spaces(build, build.given("Ocean")), Spaces(build, build.given("Patch"))
    facts = build.group(node_group(GRID_FACTS), {"Geometry": patch.mesh})
    position = output(build.add("GeometryNodeInputPosition"), "Position")
    in_ocean = build.vector("ADD", position, build.given("Corner"))
    in_patch = patch.point_of_ocean(ocean.point_of_asker(in_ocean))
    place = build.vector("SUBTRACT", in_patch, output(facts, "Corner"))
    counts = {name: output(facts, name) for name in ("Columns", "Rows")}
    fade = {"Fade": build.given("Fade")}
    averages, levels = patch_averages(build, output(facts, "Geometry"), counts, fade)
    inputs = {"Averages": averages, "Levels": levels}
    lies = {**counts, "Spacing": output(facts, "Spacing")}
    at = {"Place": place, "Size": build.given("Size")}
    read = build.group(node_group(AVERAGED), {**inputs, **lies, **at, **fade})

    def turned(direction: Socket | tuple[float, float, float]) -> Socket:
        return ocean.direction_of_ocean(patch.direction_of_asker(direction))

    whole = _turned(build, turned, {name: output(read, socket) for name, socket in SOCKETS.items()})
    is_weighted, weight = _weight(build)
    is_bounded = build.logic("NOT", build.given("Repeats"), None)
    over = build.switch("FLOAT", is_over(build, place, lies), 0.0, 1.0)
    bounded = {name: build.scaled(value, over) for name, value in whole.items()}
    whole = {name: build.switch("VECTOR", is_bounded, whole[name], bounded[name]) for name in CARRIED}
    weighted = weighted_by(build, whole, weight)
    count = build.add("GeometryNodeAttributeDomainSize", {"Geometry": output(facts, "Geometry")})
    is_there = build.compare("GREATER_THAN", output(count, "Point Count"), 0)
    sums = {}
    for name, socket in SOCKETS.items():
        before = build.given(socket)
        value = build.switch("VECTOR", is_weighted, whole[name], weighted[name])
        sums[socket] = build.switch("VECTOR", is_there, before, build.vector("ADD", before, value))
    build.finish_with(sums)


def is_over(build: Builder, place: Socket, facts: dict[str, Socket]) -> Socket:
    """Whether a place, relative to a mesh's first vertex, is within the mesh."""
    extent = build.vector("MULTIPLY", facts["Spacing"], cells(build, facts["Columns"], facts["Rows"]))
    from_middle = build.vector("SUBTRACT", build.vector("DIVIDE", place, extent), (0.5, 0.5, 0.5))
    x, y, _ = coordinates(build, alone(build, "ABSOLUTE", from_middle))
    return build.compare("LESS_EQUAL", build.math("MAXIMUM", x, y), 0.5, "FLOAT")


def _weight(build: Builder) -> tuple[Socket, Socket]:
    """Whether there is a weight, and its value and derivatives along x and y at the vertex."""
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
    is_known = sample_index(build, points, output(attribute, "Exists"), 0, "BOOLEAN")
    return is_known, combined(build, there, *changes)


def _turned(
    build: Builder, turned: Callable[[Socket | tuple[float, float, float]], Socket], read: Values
) -> Values:
    """Sampled values rotated to the ocean's axes: vectors R v, strain R G Rᵀ; slopes with their lost
    variance."""
    x, y, squares = coordinates(build, read[SLOPES])
    slope_x, slope_y, _ = coordinates(build, turned(combined(build, x, y)))
    held = build.math("ADD", *(build.math("MULTIPLY", part, part) for part in (x, y)))
    lost = build.math("MAXIMUM", build.math("SUBTRACT", squares, held), 0.0)
    return {
        DISPLACEMENT: turned(read[DISPLACEMENT]),
        VELOCITY: turned(read[VELOCITY]),
        SLOPES: combined(build, slope_x, slope_y, lost),
        OTHERS: _turned_strain(build, read[OTHERS], turned((1.0, 0.0, 0.0))),
    }


def weighted_by(build: Builder, whole: Values, weight: Socket) -> Values:
    """Values in the ocean's axes multiplied by a varying weight: its value, and its changes along x and y."""

    def product(a: Socket, b: Socket) -> Socket:
        return build.math("MULTIPLY", a, b)

    weight, by_x, by_y = coordinates(build, weight)
    dx, dy, dz = coordinates(build, whole[DISPLACEMENT])
    slope_x, slope_y, lost = coordinates(build, whole[SLOPES])
    slope_x, slope_y = (
        build.math("ADD", product(slope, weight), product(change, dz))
        for slope, change in ((slope_x, by_x), (slope_y, by_y))
    )
    shear = build.math("MULTIPLY", build.math("ADD", product(dx, by_y), product(dy, by_x)), 0.5)
    more = combined(build, product(dx, by_x), product(dy, by_y), shear)
    return {
        DISPLACEMENT: build.scaled(whole[DISPLACEMENT], weight),
        VELOCITY: build.scaled(whole[VELOCITY], weight),
        SLOPES: combined(build, slope_x, slope_y, product(lost, product(weight, weight))),
        OTHERS: build.vector("ADD", build.scaled(whole[OTHERS], weight), more),
    }


def _turned_strain(build: Builder, strain: Socket, axis: Socket) -> Socket:
    """R G Rᵀ of (Gxx, Gyy, Gxy) by the angle of an axis: half the difference and the shear rotate by twice
    the angle."""
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


CAMERA_PATCH = GroupKind("Ocean Tweak Camera Patch", 5, _build)
