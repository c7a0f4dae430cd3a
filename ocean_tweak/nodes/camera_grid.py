# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry nodes that create a flat grid around a place: dense near it, coarse far away, without cracks.

The grid consists of nested square levels. Level n has cells of size s·2ⁿ, and its vertices are on integer
multiples of that, so they do not move with the place. It is centred on the multiple of 2·s·2ⁿ nearest to the
place, so that the previous level, which has the same number of cells of half the size, covers whole cells of
it. These are omitted.

Where two levels meet, every other vertex of the finer one has no counterpart: it is moved onto its neighbour,
which turns half of the cells there into triangles, and coincident vertices are merged.
"""

from __future__ import annotations

from typing import NamedTuple

import bpy

from .building import Builder, Input, Plug, Socket, output
from .fields import alone, combined, coordinates, whole_number
from .versioned import GroupKind

#: largest number of levels: the last one is eight million times as coarse as the first
MOST_LEVELS = 24
#: least number of cells from the centre of a level to its edge, with several levels
LEAST_HALF = 8
_LEAST_SPACING = 1e-4

INPUTS = (
    Plug("Center", "NodeSocketVector", None, "The place around which the grid lies"),
    Plug("Finest Spacing", "NodeSocketFloat", 0.25, "Size of the smallest cells"),
    Plug("Vertex Budget", "NodeSocketInt", 200_000, "Vertices of the grid, at most"),
    Plug("Reach", "NodeSocketFloat", 5000.0, "How far the grid goes in each direction, at least"),
)
OUTPUTS = (
    Plug("Geometry", "NodeSocketGeometry", None, "The flat grid, at z = 0"),
    Plug("Half", "NodeSocketInt", None, "Cells from a level's middle to its edge"),
    Plug("Reached", "NodeSocketFloat", None, "How far the grid goes; less than asked for with few vertices"),
)


def finest_spacing(wanted: float, budget: int, reach: float, half: int) -> float:
    """The requested size of the smallest cells, or a larger one if levels would have too few cells.

    budget : largest number of vertices
    reach : distance covered by the grid
    half : least number of cells from the centre of a level to its edge
    """
    # n levels of m cells have (3n + 1)m² + (6 - 2n)m + 1 vertices
    levels = (budget - 1 - half**2 - 6 * half) // (3 * half**2 - 2 * half)
    levels = min(max(levels, 1), MOST_LEVELS)
    return max(wanted, reach / ((half - 1) * 2.0 ** (levels - 1)))


class _Level(NamedTuple):
    """The level of a vertex or face, and the centres of the levels in units of its cells.

    number : 0 is the finest
    spacing : size of its cells
    middle : centre of the level
    hole : centre of the previous level
    """

    number: Socket
    spacing: Socket
    middle: Socket
    hole: Socket


def _build(tree: bpy.types.NodeTree) -> None:
    build = Builder(tree, INPUTS, OUTPUTS)
    spacing = build.math("MAXIMUM", build.given("Finest Spacing"), _LEAST_SPACING)
    levels = _levels(build, spacing)
    half = _half(build, levels)
    side = build.integer("MULTIPLY", half, 2)
    columns = build.integer("ADD", side, 1)
    # the primitive counts along y first; read along x first, its faces look down
    sizes = {"Vertices X": build.integer("MULTIPLY", columns, levels), "Vertices Y": columns}
    strip = output(build.add("GeometryNodeMeshGrid", sizes), "Mesh")
    turned = build.change("GeometryNodeFlipFaces", strip)
    last = build.integer("SUBTRACT", levels, 1)
    number, level, seam = _vertices(build, spacing, columns, last)
    captured = build.add("GeometryNodeCaptureAttribute", {"Geometry": turned}, domain="POINT")
    captured.capture_items.new("BOOLEAN", "Seam")
    build.tree.links.new(seam, captured.inputs["Seam"])
    place = build.scaled(number, level.spacing)
    placed = build.change("GeometryNodeSetPosition", output(captured, "Geometry"), {"Position": place})
    kept = build.change(
        "GeometryNodeDeleteGeometry", placed, {"Selection": _left_out(build, spacing, side)}, domain="FACE"
    )
    reached = _reach(build, spacing, levels)
    inputs = {"Selection": output(captured, "Seam"), "Distance": _same(build, spacing, reached)}
    whole = build.change("GeometryNodeMergeByDistance", kept, inputs)
    build.finish_with({"Geometry": whole, "Half": half, "Reached": reached})


def _same(build: Builder, spacing: Socket, reached: Socket) -> Socket:
    """Merge distance of vertices: the resolution of floats there."""
    center = alone(build, "LENGTH", build.given("Center"))
    farthest = build.math("ADD", center, build.math("MULTIPLY", reached, 2.0))
    digit = build.math("MULTIPLY", farthest, 2.0**-23)
    return build.math("MAXIMUM", build.math("MULTIPLY", spacing, 0.01), digit)


def _levels(build: Builder, spacing: Socket) -> Socket:
    """Number of levels needed for the reach, or allowed by the budget."""
    line = build.add("GeometryNodeMeshLine", {"Count": MOST_LEVELS - 1})
    levels = build.integer("ADD", output(build.add("GeometryNodeInputIndex"), "Index"), 1)
    short = build.math("LESS_THAN", _reach(build, spacing, levels), build.given("Reach"))
    more = _half(build, build.integer("ADD", levels, 1))
    possible = build.math("LESS_THAN", LEAST_HALF - 0.5, more)
    statistic = build.add(
        "GeometryNodeAttributeStatistic",
        {"Geometry": output(line, "Mesh"), "Attribute": build.math("MULTIPLY", short, possible)},
        data_type="FLOAT",
    )
    return build.integer("ADD", whole_number(build, output(statistic, "Sum"), "ROUND"), 1)


def _half(build: Builder, levels: Socket) -> Socket:
    """The largest even number m of cells from middle to edge that n levels can have.

    A single level has (2m + 1)² vertices; each further one adds 3m² - 2m, counting merged vertices once: (3n
    + 1)m² + (6 - 2n)m + 1 in total.
    """
    a = build.math("ADD", build.math("MULTIPLY", levels, 3.0), 1.0)
    b = build.math("SUBTRACT", 6.0, build.math("MULTIPLY", levels, 2.0))
    rest = build.math("SUBTRACT", build.given("Vertex Budget"), 1.0)
    root = build.math("MULTIPLY", build.math("MULTIPLY", a, 4.0), rest)
    root = build.math("SQRT", build.math("ADD", build.math("MULTIPLY", b, b), root), None)
    pairs = build.math("DIVIDE", build.math("SUBTRACT", root, b), build.math("MULTIPLY", a, 4.0))
    pairs = build.integer("MAXIMUM", whole_number(build, pairs, "FLOOR"), 1)
    return build.integer("MULTIPLY", pairs, 2)


def _reach(build: Builder, spacing: Socket, levels: Socket) -> Socket:
    """(m - 1)·s·2ⁿ⁻¹: the place is up to a cell away from the centre of the last level."""
    cells = build.integer("SUBTRACT", _half(build, levels), 1)
    size = _size(build, spacing, build.integer("SUBTRACT", levels, 1))
    return build.math("MULTIPLY", cells, size)


def _size(build: Builder, spacing: Socket, level: Socket) -> Socket:
    return build.math("MULTIPLY", spacing, build.math("POWER", 2.0, level))


def _level(build: Builder, spacing: Socket, number: Socket) -> _Level:
    size = _size(build, spacing, number)
    center = build.vector("MULTIPLY", build.given("Center"), (1.0, 1.0, 0.0))
    scaled = build.scaled(center, build.math("DIVIDE", 1.0, size))
    middle = build.scaled(_rounded(build, build.scaled(scaled, 0.5)), 2.0)
    return _Level(number, size, middle, _rounded(build, scaled))


def _rounded(build: Builder, value: Socket) -> Socket:
    up = build.vector("ADD", value, (0.5, 0.5, 0.0))
    return alone(build, "FLOOR", up)


def _vertices(
    build: Builder, spacing: Socket, columns: Socket, last: Socket
) -> tuple[Socket, _Level, Socket]:
    """Position of a vertex in its level's cells, the level, and whether it is on a seam."""
    column, row, level = _in_strip(build, columns, columns, spacing)
    side = build.integer("SUBTRACT", columns, 1)
    at_x, at_y = _at_edge(build, column, side), _at_edge(build, row, side)
    inner = build.compare("LESS_THAN", level.number, last)
    column, row = (
        build.integer(
            "SUBTRACT",
            along,
            build.switch("INT", build.logic("AND", edge, inner), 0, build.integer("MODULO", along, 2)),
        )
        for along, edge in ((column, at_y), (row, at_x))
    )
    number = _number(build, column, row, level, side)
    away = alone(build, "ABSOLUTE", build.vector("SUBTRACT", number, level.hole))
    x, y, _ = coordinates(build, away)
    off = build.math("SUBTRACT", build.math("MAXIMUM", x, y), build.math("MULTIPLY", side, 0.25))
    at_hole = build.compare("LESS_THAN", build.math("ABSOLUTE", off, None), 0.25, "FLOAT")
    return number, level, build.logic("OR", build.logic("OR", at_x, at_y), at_hole)


def _at_edge(build: Builder, along: Socket, side: Socket) -> Socket:
    ends = (build.compare("EQUAL", along, end) for end in (0, side))
    return build.logic("OR", *ends)


def _number(build: Builder, column: Socket, row: Socket, level: _Level, side: Socket) -> Socket:
    half = build.math("MULTIPLY", side, 0.5)
    corner = build.vector("SUBTRACT", level.middle, combined(build, half, half))
    return build.vector("ADD", corner, combined(build, column, row))


def _left_out(build: Builder, spacing: Socket, side: Socket) -> Socket:
    """Whether a face is covered by a finer level, or connects two levels in the strip."""
    columns = build.integer("ADD", side, 1)
    column, row, level = _in_strip(build, side, columns, spacing)
    number = _number(build, column, row, level, side)
    middle = build.vector("ADD", number, (0.5, 0.5, 0.0))
    away = alone(build, "ABSOLUTE", build.vector("SUBTRACT", middle, level.hole))
    x, y, _ = coordinates(build, away)
    inside = build.math("LESS_THAN", build.math("MAXIMUM", x, y), build.math("MULTIPLY", side, 0.25))
    coarser = build.compare("GREATER_THAN", level.number, 0)
    return build.logic(
        "OR", build.compare("EQUAL", row, side), build.logic("AND", coarser, _true(build, inside))
    )


def _true(build: Builder, value: Socket) -> Socket:
    return build.compare("GREATER_THAN", value, 0.5, "FLOAT")


def _in_strip(
    build: Builder, across: Input, columns: Socket, spacing: Socket
) -> tuple[Socket, Socket, _Level]:
    """Column, and row within its level, of a vertex or face by its index; x fastest, level by level."""
    index = output(build.add("GeometryNodeInputIndex"), "Index")
    column, strip_row = (build.integer(operation, index, across) for operation in ("MODULO", "DIVIDE_FLOOR"))
    row, number = (build.integer(operation, strip_row, columns) for operation in ("MODULO", "DIVIDE_FLOOR"))
    return column, row, _level(build, spacing, number)


CAMERA_GRID = GroupKind("Ocean Tweak Camera Grid", 2, _build)
