# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry nodes for the sea over a bed, which an ocean's geometry has besides its mesh.

The mesh is the open sea. Where there is a bed, the geometry also has points: samples over the bed and before
it, at rest in the ocean's space, lines along the march one after another, in the layout of
`scene.patch_averages`. With s the open sea's share there and c what the bed adds, both on the points, the
water is s · mesh + c, `core.sea.coast_waves`. Along the march it ends with the points, and across it repeats.
"""

from __future__ import annotations

import bpy

from ..core.waves.coast.breakers import WHITECAPS_BY_HEIGHT
from .averaged import AVERAGED, READ, SOCKETS
from .averages import own_averages
from .building import Builder, Plug, Socket, output
from .fields import alone, combined, coordinates, named_attribute, sample_index, whole_number
from .names import BED_FOAM, COAST_DEPTH, OPEN_SHARE, OTHERS, SLOPES
from .rest_grid import CELL, GEOMETRY
from .versioned import GroupKind, node_group

#: outputs besides those that add up
IS_THERE, SHARE, FOAM_OVER_BED, DEPTH = "Is There", "Share", "Foam", "Depth"

_INPUTS = (
    GEOMETRY,
    Plug("Place", "NodeSocketVector", None, "At rest, in the ocean's space"),
    Plug("Size", "NodeSocketFloat", 1.0, "Of the cells of a grid around the camera"),
    Plug("Fade", "NodeSocketBool", True, "Average by the size of the cells"),
)
_OUTPUTS = (
    Plug(IS_THERE, "NodeSocketBool", None, "Whether there is a bed at all"),
    Plug(SHARE, "NodeSocketVector", None, "Of the open sea, and how it changes along x and y"),
    *(Plug(plug.name, plug.socket_type, None, "What the bed adds, in the ocean's axes") for plug in READ),
    Plug(FOAM_OVER_BED, "NodeSocketVector", None, "Foam, breaking and age of waves that the bed breaks"),
    Plug(DEPTH, "NodeSocketFloat", None, "Of still water, m"),
)
#: cells that a place keeps from the last point along the march, behind which the first ones come again
_INSIDE = 1e-3


def _build(tree: bpy.types.NodeTree) -> None:
    build = Builder(tree, _INPUTS, _OUTPUTS)
    parts = build.add("GeometryNodeSeparateComponents", {"Geometry": build.given("Geometry")})
    points = output(parts, "Point Cloud")
    is_there, levels, *numbers = own_averages(build, points)
    columns, rows = (whole_number(build, number, "ROUND") for number in numbers)
    place, step = _in_cells(build, points, columns)
    counts = {"Columns": columns, "Rows": rows}
    read = build.group(
        node_group(AVERAGED),
        {
            "Averages": points, "Levels": levels, **counts,
            "Spacing": combined(build, step, step, 1.0), "Place": build.scaled(place, step),
            **{name: build.given(name) for name in ("Size", "Fade")},
        },
    )  # fmt: skip
    values = {socket: output(read, socket) for socket in SOCKETS.values()}
    x, y, squares = coordinates(build, values[SOCKETS[SLOPES]])
    held = build.math("ADD", *(build.math("MULTIPLY", part, part) for part in (x, y)))
    lost = build.math("MAXIMUM", build.math("SUBTRACT", squares, held), 0.0)
    values[SOCKETS[SLOPES]] = combined(build, x, y, lost)

    def told(name: str, data_type: str) -> Socket:
        value = output(named_attribute(build, name, data_type), "Attribute")
        inputs = {"Geometry": points, "Value": value, "Place": place, **counts}
        return output(build.group(node_group(CELL), inputs), "Value")

    values |= {SHARE: told(OPEN_SHARE, "FLOAT_VECTOR"), FOAM_OVER_BED: told(BED_FOAM, "FLOAT_VECTOR")}
    values[DEPTH] = coordinates(build, told(COAST_DEPTH, "FLOAT"))[0]
    build.finish_with({IS_THERE: is_there, **values})


def _in_cells(build: Builder, points: Socket, columns: Socket) -> tuple[Socket, Socket]:
    """The place in steps along the march and across it, from the first point, and the length of a step."""
    position = output(build.add("GeometryNodeInputPosition"), "Position")
    first, along, across = (
        sample_index(build, points, position, index, "FLOAT_VECTOR") for index in (0, 1, columns)
    )
    away = build.vector("SUBTRACT", build.given("Place"), first)
    step = alone(build, "LENGTH", build.vector("SUBTRACT", along, first))
    x, y = (
        build.math(
            "DIVIDE",
            build.vector("DOT_PRODUCT", away, build.vector("SUBTRACT", axis, first)),
            build.math("MULTIPLY", step, step),
        )
        for axis in (along, across)
    )
    # the last column of points is the first one again
    most = build.math("SUBTRACT", build.integer("SUBTRACT", columns, 2), _INSIDE)
    held = build.math("MINIMUM", build.math("MAXIMUM", x, 0.0), most)
    return combined(build, held, y), step


def with_bed(
    build: Builder,
    bed: bpy.types.Node,
    water: tuple[Socket, Socket, Socket],
    cell: tuple[Socket, Socket],
) -> tuple[Socket, Socket, Socket]:
    """The displacement of the open sea and its changes along x and y, per cell of this size, over a bed."""
    xx, yy, xy = coordinates(build, output(bed, SOCKETS[OTHERS]))
    slope_x, slope_y, _ = coordinates(build, output(bed, SOCKETS[SLOPES]))
    tangents = combined(build, xx, xy, slope_x), combined(build, xy, yy, slope_y)
    added = output(bed, "Displacement"), *map(build.scaled, tangents, cell)
    share, *changes = coordinates(build, output(bed, SHARE))
    weighted = [build.scaled(each, share) for each in water]
    for axis, (change, size) in enumerate(zip(changes, cell, strict=True), 1):
        by_share = build.scaled(water[0], build.math("MULTIPLY", change, size))
        weighted[axis] = build.vector("ADD", weighted[axis], by_share)
    sums = (build.vector("ADD", own, more) for own, more in zip(weighted, added, strict=True))
    is_there = output(bed, IS_THERE)
    value, along_x, along_y = (
        build.switch("VECTOR", is_there, own, whole) for own, whole in zip(water, sums, strict=True)
    )
    return value, along_x, along_y


def whitecaps_left(build: Builder, bed: bpy.types.Node) -> Socket:
    """`core.waves.coast.breakers.whitecaps_left` of the open sea's share."""
    share, _, _ = coordinates(build, output(bed, SHARE))
    return build.math("POWER", share, WHITECAPS_BY_HEIGHT)


def foam_with_bed(build: Builder, bed: bpy.types.Node, foam: Socket) -> Socket:
    """Foam of the open sea, over a bed."""
    left = whitecaps_left(build, bed)
    of_bed, _, _ = coordinates(build, output(bed, FOAM_OVER_BED))
    most = build.math("MAXIMUM", build.math("MULTIPLY", foam, left), of_bed)
    return build.switch("FLOAT", output(bed, IS_THERE), foam, most)


def _build_points(tree: bpy.types.NodeTree) -> None:
    plug = Plug("Points", "NodeSocketObject", None, "Vertices over the bed; without them there is none")
    build = Builder(tree, (plug,))
    given = {"Object": build.given("Points")}
    mesh = output(build.add("GeometryNodeObjectInfo", given, transform_space="ORIGINAL"), "Geometry")
    points = build.change("GeometryNodeMeshToPoints", mesh, {"Radius": 0.0})
    node = build.add("GeometryNodeJoinGeometry")
    for each in (points, build.given("Geometry")):
        build.tree.links.new(each, node.inputs[0])
    build.finish(node.outputs[0])


OVER_BED = GroupKind("Ocean Tweak Over Bed", 1, _build)
BED_POINTS = GroupKind("Ocean Tweak Bed Points", 1, _build_points)
