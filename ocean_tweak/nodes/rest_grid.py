# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes that know the regular grid of an ocean's mesh at rest, and read values between its vertices.

They only need the attribute `displacement`: vertices are in x-fastest order on a regular grid, and position -
displacement is that grid at rest. Its first, second and last vertices determine its layout. The mesh covers
whole periods, and places beyond it are wrapped.

Places are counted in cells, the quads of the grid at rest.
"""

from __future__ import annotations

import bpy

from .building import Builder, Plug, Socket, output
from .fields import alone, combined, coordinates, named_attribute, sample_index, whole_number
from .names import AVERAGES_TABLE, DISPLACEMENT
from .versioned import GroupKind

GEOMETRY = Plug("Geometry", "NodeSocketGeometry", None, "An ocean's evaluated mesh in its own space")
COLUMNS = Plug("Columns", "NodeSocketInt", 2, "Vertices along x")
ROWS = Plug("Rows", "NodeSocketInt", 2, "Vertices along y")

_GRID_OUTPUTS = (
    Plug("Geometry", "NodeSocketGeometry", None, "The same mesh, or nothing where it is no ocean's"),
    Plug("Corner", "NodeSocketVector", None, "First vertex at rest; 0 where the mesh is no ocean's"),
    Plug("Spacing", "NodeSocketVector", None, "Size of a cell; (1, 1, 1) where the mesh is no ocean's"),
    COLUMNS,
    ROWS,
)
_CELL_INPUTS = (
    GEOMETRY,
    Plug("Value", "NodeSocketVector", None, "What to look up on the mesh"),
    Plug("Place", "NodeSocketVector", None, "At rest, in cells from the first vertex"),
    COLUMNS,
    ROWS,
)
_CELL_OUTPUTS = (
    Plug("Value", "NodeSocketVector", None, "Bilinear between the four vertices around"),
    Plug("Along X", "NodeSocketVector", None, "Its change along x, per cell"),
    Plug("Along Y", "NodeSocketVector", None, "Its change along y, per cell"),
)


def _build_grid_facts(tree: bpy.types.NodeTree) -> None:
    build = Builder(tree, (GEOMETRY,), _GRID_OUTPUTS)
    # what the sea is over a bed are points
    geometry = output(
        build.add("GeometryNodeSeparateComponents", {"Geometry": build.given("Geometry")}), "Mesh"
    )
    displacement = named_attribute(build, DISPLACEMENT, "FLOAT_VECTOR")
    position = output(build.add("GeometryNodeInputPosition"), "Position")
    count = _count(build, geometry)

    def at_rest(index: object) -> Socket:
        moved = sample_index(build, geometry, position, index, "FLOAT_VECTOR")
        by = sample_index(build, geometry, output(displacement, "Attribute"), index, "FLOAT_VECTOR")
        return build.vector("SUBTRACT", moved, by)

    first, last = at_rest(0), at_rest(build.integer("SUBTRACT", count, 1))
    width, depth, _ = coordinates(build, build.vector("SUBTRACT", last, first))
    step, _, _ = coordinates(build, build.vector("SUBTRACT", at_rest(1), first))
    across = whole_number(build, build.math("DIVIDE", width, step), "ROUND")
    columns = build.integer("MAXIMUM", build.integer("ADD", across, 1), 2)
    rows = build.integer("MAXIMUM", build.integer("DIVIDE_FLOOR", count, columns), 2)
    spacing = combined(
        build,
        build.math("DIVIDE", width, build.integer("SUBTRACT", columns, 1)),
        build.math("DIVIDE", depth, build.integer("SUBTRACT", rows, 1)),
        1.0,
    )
    known = sample_index(build, geometry, output(displacement, "Exists"), 0, "BOOLEAN")
    complete = build.compare("EQUAL", build.integer("MULTIPLY", columns, rows), count)
    extent = build.compare("GREATER_THAN", build.math("MINIMUM", step, depth), 0.0, "FLOAT")
    usable = build.logic("AND", build.logic("AND", known, complete), extent)
    # not an ocean, or a mesh whose vertices are changed by later modifiers
    _, step_y, _ = coordinates(build, spacing)
    for index, offset in (
        (build.integer("SUBTRACT", columns, 1), combined(build, width, 0.0)),
        (columns, combined(build, 0.0, step_y)),
    ):
        off = build.vector("SUBTRACT", at_rest(index), build.vector("ADD", first, offset))
        usable = build.logic("AND", usable, _is_short(build, off, step))
    nothing = build.add("GeometryNodeJoinGeometry").outputs[0]
    build.finish_with(
        {
            "Geometry": build.switch("GEOMETRY", usable, nothing, geometry),
            "Corner": build.switch("VECTOR", usable, (0.0, 0.0, 0.0), first),
            "Spacing": build.switch("VECTOR", usable, (1.0, 1.0, 1.0), spacing),
            "Columns": columns,
            "Rows": rows,
        }
    )


def _count(build: Builder, geometry: Socket) -> Socket:
    """Number of the grid's vertices, without the averages that may follow them."""
    whole = output(build.add("GeometryNodeAttributeDomainSize", {"Geometry": geometry}), "Point Count")
    table = named_attribute(build, AVERAGES_TABLE, "FLOAT_VECTOR")
    has_averages = sample_index(build, geometry, output(table, "Exists"), 0, "BOOLEAN")
    own = sample_index(build, geometry, output(table, "Attribute"), 0, "FLOAT_VECTOR")
    columns, rows, _ = coordinates(build, own)
    of_grid = whole_number(build, build.math("MULTIPLY", columns, rows), "ROUND")
    return build.switch("INT", has_averages, whole, of_grid)


def _is_short(build: Builder, off: Socket, step: Socket) -> Socket:
    """Whether a vertex is, up to rounding, where a grid with this step has it."""
    return build.compare("LESS_THAN", alone(build, "LENGTH", off), build.math("MULTIPLY", step, 0.1), "FLOAT")


def _build_cell(tree: bpy.types.NodeTree) -> None:
    build = Builder(tree, _CELL_INPUTS, _CELL_OUTPUTS)
    place = build.given("Place")
    x, y, _ = coordinates(build, place)
    part_x, part_y, _ = coordinates(build, alone(build, "FRACTION", place))
    column = _wrapped(build, x, build.given("Columns"))
    row = _wrapped(build, y, build.given("Rows"))
    index = build.integer("ADD", build.integer("MULTIPLY", row, build.given("Columns")), column)

    def corner(offset: object) -> Socket:
        number = build.integer("ADD", index, offset) if offset != 0 else index
        return sample_index(build, build.given("Geometry"), build.given("Value"), number, "FLOAT_VECTOR")

    beyond = build.integer("ADD", build.given("Columns"), 1)
    corners = corner(0), corner(1), corner(build.given("Columns")), corner(beyond)
    south = build.vector("SUBTRACT", corners[1], corners[0])
    north = build.vector("SUBTRACT", corners[3], corners[2])
    along_x = _mixed(build, south, north, part_y)
    below = build.vector("ADD", corners[0], build.scaled(south, part_x))
    above = build.vector("ADD", corners[2], build.scaled(north, part_x))
    along_y = build.vector("SUBTRACT", above, below)
    value = build.vector("ADD", below, build.scaled(along_y, part_y))
    build.finish_with({"Value": value, "Along X": along_x, "Along Y": along_y})


def _wrapped(build: Builder, place: Socket, vertices: Socket) -> Socket:
    """The cell's index along one axis, wrapped."""
    cells = build.integer("SUBTRACT", vertices, 1)
    return build.integer("FLOORED_MODULO", whole_number(build, place, "FLOOR"), cells)


def _mixed(build: Builder, first: Socket, second: Socket, share: Socket) -> Socket:
    return build.vector("ADD", first, build.scaled(build.vector("SUBTRACT", second, first), share))


GRID_FACTS = GroupKind("Ocean Tweak Grid Facts", 3, _build_grid_facts)
CELL = GroupKind("Ocean Tweak Cell", 1, _build_cell)
