# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes that find the surface of an ocean's mesh above a place, in the ocean's own space.

They only need the attribute `displacement`: vertices are in x-fastest order on a regular grid, and position -
displacement is that grid at rest. Its first, second and last vertices determine its layout. The mesh covers
whole periods, and places beyond it are wrapped.

Places are counted in cells, the quads of the grid at rest.
"""

from __future__ import annotations

import bpy

from .building import Builder, Plug, Socket, output
from .fields import alone, combined, connect, coordinates, named_attribute, sample_index, whole_number
from .names import AVERAGES_TABLE, DISPLACEMENT, FOAM, VELOCITY
from .versioned import GroupKind, node_group

#: Newton's steps. A storm with choppiness 1 takes 6, a sea that all but folds (minimum eigenvalue 0.1) 8
STEPS = 12
#: smallest limit of a step's length, in cells
LONGEST_STEP = 2.0
#: smallest determinant of the map from rest position to surface used in a step
LEAST_DETERMINANT = 0.05

_GEOMETRY = Plug("Geometry", "NodeSocketGeometry", None, "An ocean's evaluated mesh in its own space")
_COLUMNS = Plug("Columns", "NodeSocketInt", 2, "Vertices along x")
_ROWS = Plug("Rows", "NodeSocketInt", 2, "Vertices along y")


_GRID_OUTPUTS = (
    Plug("Geometry", "NodeSocketGeometry", None, "The same mesh, or nothing where it is no ocean's"),
    Plug("Corner", "NodeSocketVector", None, "First vertex at rest; 0 where the mesh is no ocean's"),
    Plug("Spacing", "NodeSocketVector", None, "Size of a cell; (1, 1, 1) where the mesh is no ocean's"),
    _COLUMNS,
    _ROWS,
)


def _build_grid_facts(tree: bpy.types.NodeTree) -> None:
    build = Builder(tree, (_GEOMETRY,), _GRID_OUTPUTS)
    geometry = build.given("Geometry")
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
    build = Builder(
        tree,
        (
            _GEOMETRY,
            Plug("Value", "NodeSocketVector", None, "What to look up on the mesh"),
            Plug("Place", "NodeSocketVector", None, "At rest, in cells from the first vertex"),
            _COLUMNS,
            _ROWS,
        ),
        (
            Plug("Value", "NodeSocketVector", None, "Bilinear between the four vertices around"),
            Plug("Along X", "NodeSocketVector", None, "Its change along x, per cell"),
            Plug("Along Y", "NodeSocketVector", None, "Its change along y, per cell"),
        ),
    )
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


def _build_surface(tree: bpy.types.NodeTree) -> None:
    build = Builder(
        tree,
        (
            _GEOMETRY,
            Plug("Position", "NodeSocketVector", None, "Where to look, in the ocean's space"),
            Plug("At Rest", "NodeSocketBool", False, "The position is that of the water at rest"),
        ),
        (
            Plug("Point", "NodeSocketVector", None, "On the surface"),
            Plug("Displacement", "NodeSocketVector", None, "Of the water that is there"),
            Plug("Along X", "NodeSocketVector", None, "A tangent of the surface"),
            Plug("Along Y", "NodeSocketVector", None, "A tangent of the surface"),
            Plug("Foam", "NodeSocketFloat", None, "0 to 1"),
            Plug("Velocity", "NodeSocketVector", None, "Of the water, per second"),
        ),
    )
    facts = build.group(node_group(GRID_FACTS), {"Geometry": build.given("Geometry")})
    wanted = _place(build, facts)
    steps = build.switch("INT", build.given("At Rest"), STEPS, 0)
    rest = _inverted(build, facts, wanted, steps)
    moved = _looked_up(build, facts, rest, output(_displacement(build), "Attribute"))
    foam = _looked_up(build, facts, rest, output(named_attribute(build, FOAM, "FLOAT"), "Attribute"))
    velocity = named_attribute(build, VELOCITY, "FLOAT_VECTOR")
    moving = _looked_up(build, facts, rest, output(velocity, "Attribute"))
    x, y, _ = coordinates(build, build.given("Position"))
    step_x, step_y, _ = coordinates(build, output(facts, "Spacing"))
    _, _, level = coordinates(build, output(facts, "Corner"))
    displacement = output(moved, "Value")
    _, _, by_z = coordinates(build, displacement)
    flat = combined(build, x, y, level)
    above = combined(build, 0.0, 0.0, by_z)
    by = build.switch("VECTOR", build.given("At Rest"), above, displacement)
    build.finish_with(
        {
            "Point": build.vector("ADD", flat, by),
            "Displacement": displacement,
            "Along X": build.vector("ADD", combined(build, step_x, 0.0), output(moved, "Along X")),
            "Along Y": build.vector("ADD", combined(build, 0.0, step_y), output(moved, "Along Y")),
            "Foam": output(foam, "Value"),
            "Velocity": output(moving, "Value"),
        }
    )


def _displacement(build: Builder) -> bpy.types.Node:
    return named_attribute(build, DISPLACEMENT, "FLOAT_VECTOR")


def _place(build: Builder, facts: bpy.types.Node) -> Socket:
    """The position in cells, wrapped into the mesh, where floats are more precise."""
    position = build.vector("SUBTRACT", build.given("Position"), output(facts, "Corner"))
    place = build.vector("DIVIDE", position, output(facts, "Spacing"))
    period = combined(
        build,
        build.integer("SUBTRACT", output(facts, "Columns"), 1),
        build.integer("SUBTRACT", output(facts, "Rows"), 1),
        1.0,
    )
    periods = alone(build, "FLOOR", build.vector("DIVIDE", place, period))
    return build.vector("SUBTRACT", place, build.vector("MULTIPLY", periods, period))


def _looked_up(build: Builder, facts: bpy.types.Node, place: Socket, value: Socket) -> bpy.types.Node:
    inputs = {"Value": value, "Place": place}
    inputs |= {name: output(facts, name) for name in ("Geometry", "Columns", "Rows")}
    return build.group(node_group(CELL), inputs)


def _inverted(build: Builder, facts: bpy.types.Node, wanted: Socket, steps: Socket) -> Socket:
    """The rest position of the water now above a place, by Newton's method."""
    end = build.add("GeometryNodeRepeatOutput")
    end.repeat_items.clear()
    end.repeat_items.new("VECTOR", "Rest")
    begin = build.add("GeometryNodeRepeatInput")
    begin.pair_with_output(end)
    connect(build, begin.inputs["Iterations"], steps)
    connect(build, begin.inputs["Rest"], wanted)
    rest = begin.outputs["Rest"]
    moved = _looked_up(build, facts, rest, output(_displacement(build), "Attribute"))

    def in_cells(name: str) -> tuple[Socket, Socket]:
        return coordinates(build, build.vector("DIVIDE", output(moved, name), output(facts, "Spacing")))[:2]

    here = build.vector("ADD", rest, combined(build, *in_cells("Value")))
    off = build.vector("MULTIPLY", build.vector("SUBTRACT", here, wanted), (1.0, 1.0, 0.0))
    step = _bounded(build, _newton_step(build, off, in_cells("Along X"), in_cells("Along Y")), off)
    connect(build, end.inputs["Rest"], build.vector("SUBTRACT", rest, step))
    return end.outputs["Rest"]


def _newton_step(
    build: Builder, off: Socket, along_x: tuple[Socket, Socket], along_y: tuple[Socket, Socket]
) -> Socket:
    """The step that would bring `off` to zero for a locally linear surface."""
    off_x, off_y, _ = coordinates(build, off)
    xx, yy = build.math("ADD", along_x[0], 1.0), build.math("ADD", along_y[1], 1.0)
    yx, xy = along_x[1], along_y[0]

    def crossed(a: Socket, b: Socket, c: Socket, d: Socket) -> Socket:
        return build.math("SUBTRACT", build.math("MULTIPLY", a, b), build.math("MULTIPLY", c, d))

    determinant = build.math("MAXIMUM", crossed(xx, yy, xy, yx), LEAST_DETERMINANT)
    step = combined(build, crossed(yy, off_x, xy, off_y), crossed(xx, off_y, yx, off_x))
    return build.scaled(step, build.math("DIVIDE", 1.0, determinant))


def _bounded(build: Builder, step: Socket, off: Socket) -> Socket:
    """The step, limited to the remaining distance or to a few cells."""
    longest = build.math("MAXIMUM", alone(build, "LENGTH", off), LONGEST_STEP)
    share = build.math("DIVIDE", longest, build.math("MAXIMUM", alone(build, "LENGTH", step), 1e-12))
    return build.scaled(step, build.math("MINIMUM", share, 1.0))


GRID_FACTS = GroupKind("Ocean Tweak Grid Facts", 2, _build_grid_facts)
CELL = GroupKind("Ocean Tweak Cell", 1, _build_cell)
SURFACE = GroupKind("Ocean Tweak Surface", 1, _build_surface)
