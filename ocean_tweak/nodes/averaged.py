# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry nodes that sample a surface at the vertices of a grid, averaged over the grid's cell size.

Values are blended between two levels of averages, as the level (number of halvings) is fractional, so nothing
pops.
"""

from __future__ import annotations

import bpy

from .averages import CARRIED, cells, halvings, told
from .building import Builder, Plug, Socket, output
from .fields import alone, coordinates, mixed, sample_index, whole_number
from .versioned import GroupKind

#: grid cells per cell of the averages, so that remaining waves are at least four grid cells long
_GRID_CELLS = 2.0

_INPUTS = (
    Plug("Averages", "NodeSocketGeometry", None, "Points of a surface and of its averages"),
    Plug("Levels", "NodeSocketGeometry", None, "Points that hold where each of them begins"),
    Plug("Columns", "NodeSocketInt", 2, "Of the surface itself, its vertices along x"),
    Plug("Rows", "NodeSocketInt", 2, "Its vertices along y"),
    Plug("Spacing", "NodeSocketVector", None, "Between them"),
    Plug("Place", "NodeSocketVector", None, "Of the grid's vertices at rest, from the surface's first one"),
    Plug("Size", "NodeSocketFloat", 1.0, "Of the grid's cells where a vertex is"),
    Plug("Fade", "NodeSocketBool", True, "Average; otherwise the surface is read as it is"),
)
#: names of averaged values → sockets
SOCKETS = {name: name.removeprefix("ocean_tweak_").title() for name in CARRIED}
#: values sampled at a vertex
READ = tuple(Plug(socket, "NodeSocketVector", None, "At the vertex") for socket in SOCKETS.values())


def _build(tree: bpy.types.NodeTree) -> None:
    build = Builder(tree, _INPUTS, READ)
    counts = build.given("Columns"), build.given("Rows")
    number = cells(build, *counts)
    period = build.vector("MULTIPLY", build.given("Spacing"), number)
    periods = alone(build, "FRACTION", build.vector("DIVIDE", build.given("Place"), period))
    # samples of averages are at cell centres, those of the surface at cell corners
    periods = build.vector("ADD", periods, build.vector("DIVIDE", (0.5, 0.5, 0.0), number))
    most = halvings(build, *counts)
    level = _level(build, most)
    low = alone(build, "FLOOR", level, "ShaderNodeMath")
    high = build.math("MINIMUM", build.math("ADD", low, 1.0), most)
    values = [_of_level(build, each, periods) for each in (low, high)]
    part = build.math("SUBTRACT", level, low)
    either = {}
    for name, socket in SOCKETS.items():
        between = mixed(build, values[0][name], values[1][name], part)
        either[socket] = build.switch("VECTOR", build.given("Fade"), values[0][name], between)
    build.finish_with(either)


def _level(build: Builder, most: Socket) -> Socket:
    """Number of halvings at a vertex: fractional, 0 where the grid is fine enough."""
    step_x, step_y, _ = coordinates(build, build.given("Spacing"))
    ratio = build.math("DIVIDE", build.given("Size"), build.math("MINIMUM", step_x, step_y))
    level = build.math("LOGARITHM", build.math("MULTIPLY", ratio, _GRID_CELLS), 2.0)
    held = build.math("MINIMUM", build.math("MAXIMUM", level, 0.0), most)
    return build.switch("FLOAT", build.given("Fade"), 0.0, held)


def _of_level(build: Builder, level: Socket, periods: Socket) -> dict[str, Socket]:
    """Value of one level of averages at a place in periods, bilinear between four samples."""
    levels = build.given("Levels")
    place = output(build.add("GeometryNodeInputPosition"), "Position")
    fact = sample_index(build, levels, place, whole_number(build, level, "ROUND"), "FLOAT_VECTOR")
    columns, rows, first = (whole_number(build, each, "ROUND") for each in coordinates(build, fact))
    in_cells = build.vector("SUBTRACT", fact, (1.0, 1.0, 0.0))
    place = build.vector("SUBTRACT", build.vector("MULTIPLY", periods, in_cells), (0.5, 0.5, 0.0))
    x, y, _ = coordinates(build, place)
    part_x, part_y, _ = coordinates(build, alone(build, "FRACTION", place))
    column, row = (
        build.integer("FLOORED_MODULO", whole_number(build, along, "FLOOR"), build.integer("SUBTRACT", n, 1))
        for along, n in ((x, columns), (y, rows))
    )
    south = build.integer("ADD", first, build.integer("ADD", build.integer("MULTIPLY", row, columns), column))
    north = build.integer("ADD", south, columns)
    corners = (south, build.integer("ADD", south, 1), north, build.integer("ADD", north, 1))

    def read(name: str) -> Socket:
        points, value = build.given("Averages"), told(build, name)
        at = [sample_index(build, points, value, corner, "FLOAT_VECTOR") for corner in corners]
        lower, upper = (mixed(build, at[first], at[first + 1], part_x) for first in (0, 2))
        return mixed(build, lower, upper, part_y)

    return {name: read(name) for name in CARRIED}


AVERAGED = GroupKind("Ocean Tweak Averaged", 2, _build)
