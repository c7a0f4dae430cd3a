# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes that find the surface of an ocean's mesh above a place, in the ocean's own space.

Places are counted in cells of its grid at rest, `rest_grid`. Over a bed the water moves as `over_bed` has it.
"""

from __future__ import annotations

import bpy

from .building import Builder, Plug, Socket, output
from .fields import alone, combined, connect, coordinates, named_attribute
from .names import DISPLACEMENT, FOAM, VELOCITY
from .over_bed import IS_THERE, OVER_BED, SHARE, foam_with_bed, with_bed
from .rest_grid import CELL, GEOMETRY, GRID_FACTS
from .versioned import GroupKind, node_group

#: Newton's steps. A storm with choppiness 1 takes 6, a sea that all but folds (minimum eigenvalue 0.1) 8
STEPS = 12
#: smallest limit of a step's length, in cells
LONGEST_STEP = 2.0
#: smallest determinant of the map from rest position to surface used in a step
LEAST_DETERMINANT = 0.05

_INPUTS = (
    GEOMETRY,
    Plug("Position", "NodeSocketVector", None, "Where to look, in the ocean's space"),
    Plug("At Rest", "NodeSocketBool", False, "The position is that of the water at rest"),
)
_OUTPUTS = (
    Plug("Point", "NodeSocketVector", None, "On the surface"),
    Plug("Displacement", "NodeSocketVector", None, "Of the water that is there"),
    Plug("Along X", "NodeSocketVector", None, "A tangent of the surface"),
    Plug("Along Y", "NodeSocketVector", None, "A tangent of the surface"),
    Plug("Foam", "NodeSocketFloat", None, "0 to 1"),
    Plug("Velocity", "NodeSocketVector", None, "Of the water, per second"),
)


def _build_surface(tree: bpy.types.NodeTree) -> None:
    build = Builder(tree, _INPUTS, _OUTPUTS)
    facts = build.group(node_group(GRID_FACTS), {"Geometry": build.given("Geometry")})
    wanted = _place(build, facts)
    steps = build.switch("INT", build.given("At Rest"), STEPS, 0)
    rest = _inverted(build, facts, wanted, steps)
    bed, (displacement, along_x, along_y) = _water(build, facts, wanted, rest)
    foam = _looked_up(build, facts, rest, output(named_attribute(build, FOAM, "FLOAT"), "Attribute"))
    of_foam, _, _ = coordinates(build, output(foam, "Value"))
    velocity = named_attribute(build, VELOCITY, "FLOAT_VECTOR")
    moving = output(_looked_up(build, facts, rest, output(velocity, "Attribute")), "Value")
    share, _, _ = coordinates(build, output(bed, SHARE))
    over_bed = build.vector("ADD", build.scaled(moving, share), output(bed, "Velocity"))
    x, y, _ = coordinates(build, build.given("Position"))
    step_x, step_y, _ = coordinates(build, output(facts, "Spacing"))
    _, _, level = coordinates(build, output(facts, "Corner"))
    _, _, by_z = coordinates(build, displacement)
    flat = combined(build, x, y, level)
    above = combined(build, 0.0, 0.0, by_z)
    by = build.switch("VECTOR", build.given("At Rest"), above, displacement)
    build.finish_with(
        {
            "Point": build.vector("ADD", flat, by),
            "Displacement": displacement,
            "Along X": build.vector("ADD", combined(build, step_x, 0.0), along_x),
            "Along Y": build.vector("ADD", combined(build, 0.0, step_y), along_y),
            "Foam": foam_with_bed(build, bed, of_foam),
            "Velocity": build.switch("VECTOR", output(bed, IS_THERE), moving, over_bed),
        }
    )


def _water(
    build: Builder, facts: bpy.types.Node, wanted: Socket, rest: Socket
) -> tuple[bpy.types.Node, tuple[Socket, Socket, Socket]]:
    """The bed where water is at rest, and the displacement of this water with its changes along x and y, per
    cell."""
    open_sea = _looked_up(build, facts, rest, output(_displacement(build), "Attribute"))
    spacing = output(facts, "Spacing")
    # places in cells are wrapped, and a bed does not repeat with the mesh
    away = build.vector("MULTIPLY", build.vector("SUBTRACT", rest, wanted), spacing)
    place = build.vector("ADD", build.given("Position"), away)
    inputs = {"Geometry": build.given("Geometry"), "Place": place, "Fade": False}
    bed = build.group(node_group(OVER_BED), inputs)
    step_x, step_y, _ = coordinates(build, spacing)
    water = output(open_sea, "Value"), output(open_sea, "Along X"), output(open_sea, "Along Y")
    return bed, with_bed(build, bed, water, (step_x, step_y))


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
    _, moved = _water(build, facts, wanted, rest)
    displacement, along_x, along_y = (
        coordinates(build, build.vector("DIVIDE", each, output(facts, "Spacing")))[:2] for each in moved
    )
    here = build.vector("ADD", rest, combined(build, *displacement))
    off = build.vector("MULTIPLY", build.vector("SUBTRACT", here, wanted), (1.0, 1.0, 0.0))
    step = _bounded(build, _newton_step(build, off, along_x, along_y), off)
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


SURFACE = GroupKind("Ocean Tweak Surface", 3, _build_surface)
