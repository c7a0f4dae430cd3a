# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry nodes that read a surface at the vertices of a grid, averaged over the size of the grid's cells.

Between two averages where the level, how often the surface is halved, is a fraction: nothing pops.
"""

from __future__ import annotations

import bpy

from .averages import AVERAGES, CARRIED, IS_MOVING, MOVING, cells, halvings, read
from .building import Builder, Plug, Socket, output
from .fields import alone, connect, coordinates, named_attribute, whole_number
from .versioned import GroupKind, node_group

#: cells of the grid in a cell of the averages: what is left is at least four cells long
_GRID_CELLS = 2.0

_INPUTS = (
    Plug("Geometry", "NodeSocketGeometry", None, "The grid"),
    Plug("Surface", "NodeSocketGeometry", None, "Mesh with what is averaged"),
    Plug("Columns", "NodeSocketInt", 2, "Its vertices along x"),
    Plug("Rows", "NodeSocketInt", 2, "Its vertices along y"),
    Plug("Spacing", "NodeSocketVector", None, "Between them"),
    Plug("Place", "NodeSocketVector", None, "Of the grid's vertices at rest, from the surface's first one"),
    Plug("Size", "NodeSocketFloat", 1.0, "Of the grid's cells where a vertex is"),
    Plug("Fade", "NodeSocketBool", True, "Average; otherwise the surface is read as it is"),
    IS_MOVING,
)
_OUTPUTS = (Plug("Geometry", "NodeSocketGeometry", None, "The grid with what was read, under its names"),)


def _build(tree: bpy.types.NodeTree) -> None:
    build = Builder(tree, _INPUTS, _OUTPUTS)
    counts = build.given("Columns"), build.given("Rows")
    grid = build.given("Geometry")
    for name in CARRIED:
        grid = build.store(grid, name, (0.0, 0.0, 0.0), "FLOAT_VECTOR")
    period = build.vector("MULTIPLY", build.given("Spacing"), cells(build, *counts))
    periods = alone(build, "FRACTION", build.vector("DIVIDE", build.given("Place"), period))
    most = halvings(build, *counts)
    once = build.add("GeometryNodeCaptureAttribute", {"Geometry": grid}, domain="POINT")
    for kind, name, value in (("FLOAT", "Level", _level(build, most)), ("VECTOR", "Periods", periods)):
        once.capture_items.new(kind, name)
        build.tree.links.new(value, once.inputs[name])
    end = build.add("GeometryNodeRepeatOutput")
    end.repeat_items.clear()
    before = {"Geometry": build.given("Surface"), "Columns": counts[0], "Rows": counts[1]}
    kinds = {"Geometry": "GEOMETRY", "Columns": "INT", "Rows": "INT", "Grid": "GEOMETRY"}
    for name, kind in kinds.items():
        end.repeat_items.new(kind, name)
    begin = build.add("GeometryNodeRepeatInput")
    begin.pair_with_output(end)
    for name, value in {**before, "Grid": output(once, "Geometry")}.items():
        connect(build, begin.inputs[name], value)
    fading = build.integer("ADD", whole_number(build, most, "ROUND"), 1)
    connect(build, begin.inputs["Iterations"], build.switch("INT", build.given("Fade"), 1, fading))
    mesh = {name: begin.outputs[name] for name in before}
    part = _with_level(build, begin, once, counts, mesh)
    after = build.group(node_group(AVERAGES), {**mesh, "Moving": build.given("Moving")})
    for name in before:
        connect(build, end.inputs[name], output(after, name))
    connect(build, end.inputs["Grid"], part)
    build.finish(end.outputs["Grid"])


def _level(build: Builder, most: Socket) -> Socket:
    """How often the surface is halved where a vertex is: a fraction, 0 where the grid is fine enough."""
    step_x, step_y, _ = coordinates(build, build.given("Spacing"))
    ratio = build.math("DIVIDE", build.given("Size"), build.math("MINIMUM", step_x, step_y))
    level = build.math("LOGARITHM", build.math("MULTIPLY", ratio, _GRID_CELLS), 2.0)
    held = build.math("MINIMUM", build.math("MAXIMUM", level, 0.0), most)
    return build.switch("FLOAT", build.given("Fade"), 0.0, held)


def _with_level(
    build: Builder,
    begin: bpy.types.Node,
    once: bpy.types.Node,
    counts: tuple[Socket, Socket],
    mesh: dict[str, Socket],
) -> Socket:
    """The grid with its share of one of the averages."""
    off = build.math(
        "ABSOLUTE", build.math("SUBTRACT", once.outputs["Level"], begin.outputs["Iteration"]), None
    )
    share = build.math("SUBTRACT", 1.0, off)
    place = _in_cells(build, once.outputs["Periods"], counts, mesh)

    def add(grid: Socket, name: str) -> Socket:
        told = output(named_attribute(build, name, "FLOAT_VECTOR"), "Attribute")
        more = build.scaled(read(build, mesh, name, place), share)
        inputs = {
            "Name": name, "Value": build.vector("ADD", told, more),
            "Selection": build.compare("GREATER_THAN", share, 0.0, "FLOAT"),
        }  # fmt: skip
        return build.change(
            "GeometryNodeStoreNamedAttribute", grid, inputs, data_type="FLOAT_VECTOR", domain="POINT"
        )

    grid = moved = begin.outputs["Grid"]
    for name in MOVING:
        moved = add(moved, name)
    grid = build.switch("GEOMETRY", build.given("Moving"), grid, moved)
    return add(grid, next(name for name in CARRIED if name not in MOVING))


def _in_cells(
    build: Builder, periods: Socket, counts: tuple[Socket, Socket], mesh: dict[str, Socket]
) -> Socket:
    """A vertex in cells of a mesh of averages, whose samples stand for places half a cell in."""
    half = build.vector("DIVIDE", (0.5, 0.5, 0.0), cells(build, *counts))
    number = cells(build, mesh["Columns"], mesh["Rows"])
    middle = build.vector("MULTIPLY", build.vector("ADD", periods, half), number)
    return build.vector("SUBTRACT", middle, (0.5, 0.5, 0.0))


AVERAGED = GroupKind("Ocean Tweak Averaged", 1, _build)
