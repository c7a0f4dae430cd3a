# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry nodes that average an ocean's surface over larger and larger cells.

A surface is a mesh in the layout of `nodes.rest_grid`: vertices in x-fastest order, with the first ones of
each row and column repeated at the end. It and its averages become points, one level after another, of which
only the attributes matter.

Each level averages 2 × 2 samples of the level before: sample j of nₖ lies at (j + ½)/nₖ of the period,
between two samples of that level. Odd counts are halved and rounded up, with interpolation between samples.
Live patches bring averages computed in the same way by `core.numerics.halving`.
"""

from __future__ import annotations

import bpy

from .building import Builder, Input, Plug, Socket, output
from .fields import alone, combined, connect, coordinates, named_attribute, sample_index, whole_number
from .loops import joined, repeated
from .names import (
    AVERAGES_TABLE,
    BREAKING,
    CUSP,
    DISPLACEMENT,
    FOAM,
    OTHERS,
    SLOPE,
    SLOPE_VARIANCE,
    SLOPES,
    STRAIN,
    VELOCITY,
)
from .rest_grid import CELL
from .versioned import GroupKind, node_group

#: what is averaged
MOVING = (DISPLACEMENT, VELOCITY, SLOPES)
CARRIED = (*MOVING, OTHERS)
#: smallest z of a normal, so that a fold does not dominate an average
_LEAST_UPWARDS = 0.2

_MESH = (
    Plug("Geometry", "NodeSocketGeometry", None, "Mesh with the surface's attributes"),
    Plug("Columns", "NodeSocketInt", 2, "Vertices along x"),
    Plug("Rows", "NodeSocketInt", 2, "Vertices along y"),
)
_FADE = Plug("Fade", "NodeSocketBool", True, "Average; otherwise there is the surface alone")
_IS_MOVING = Plug(
    "Moving", "NodeSocketBool", True, "Whether displacement, velocity and slopes are needed too"
)
_OUTPUTS = (
    Plug("Geometry", "NodeSocketGeometry", None, "Points of the surface and of all its averages"),
    Plug(
        "Levels", "NodeSocketGeometry", None,
        "A point for the surface and for each of its averages, at columns, rows, number of the first point",
    ),
)  # fmt: skip


def ocean_carried(build: Builder, ocean: Socket, moving: Socket) -> Socket:
    """An ocean's mesh with the values to average: its foam and, if requested, its motion."""
    normal = output(build.add("GeometryNodeInputNormal"), "Normal")
    x, y, z = coordinates(build, normal)
    up = build.math("MAXIMUM", z, _LEAST_UPWARDS)
    slopes = [build.math("DIVIDE", build.math("MULTIPLY", part, -1.0), up) for part in (x, y)]
    squares = build.math("ADD", *(build.math("MULTIPLY", part, part) for part in slopes))
    of_point = build.add(
        "GeometryNodeFieldOnDomain", {"Value": combined(build, slopes[0], slopes[1], squares)},
        data_type="FLOAT_VECTOR", domain="POINT",
    )  # fmt: skip
    sloped = build.store(ocean, SLOPES, output(of_point, "Value"), "FLOAT_VECTOR")
    either = build.switch("GEOMETRY", moving, ocean, sloped)
    others = (output(named_attribute(build, name, "FLOAT"), "Attribute") for name in (FOAM, CUSP, BREAKING))
    return build.store(either, OTHERS, combined(build, *others), "FLOAT_VECTOR")


def patch_carried(build: Builder, patch: Socket) -> Socket:
    """The mesh of one patch with the values to average: its motion and its strain.

    Its slope variance attribute holds the variance lost in its samples.
    """
    x, y, _ = coordinates(build, told(build, SLOPE))
    held = build.math("ADD", *(build.math("MULTIPLY", part, part) for part in (x, y)))
    lost = output(named_attribute(build, SLOPE_VARIANCE, "FLOAT"), "Attribute")
    squares = build.math("ADD", held, lost)
    sloped = build.store(patch, SLOPES, combined(build, x, y, squares), "FLOAT_VECTOR")
    return build.store(sloped, OTHERS, told(build, STRAIN), "FLOAT_VECTOR")


def patch_averages(
    build: Builder, patch: Socket, counts: dict[str, Socket], fade: dict[str, Socket]
) -> tuple[Socket, Socket]:
    """Points of a patch and of its averages, and the points that give the start of each level; the patch's
    own averages if it has them.

    patch : its mesh
    counts : numbers of columns and rows
    """
    made = build.group(node_group(AVERAGES), {"Geometry": patch_carried(build, patch), **counts, **fade})
    has_own, own_levels, _, _ = own_averages(build, patch)
    own = {"Geometry": patch, "Levels": own_levels}
    geometry, levels = (
        build.switch("GEOMETRY", has_own, output(made, name), own[name]) for name in ("Geometry", "Levels")
    )
    return geometry, levels


def own_averages(build: Builder, points: Socket) -> tuple[Socket, Socket, Socket, Socket]:
    """Whether averages come after some points; the points that give the start of each level; and how many
    columns and rows there are of them themselves."""
    table = named_attribute(build, AVERAGES_TABLE, "FLOAT_VECTOR")
    has_own = sample_index(build, points, output(table, "Exists"), 0, "BOOLEAN")
    of_first = sample_index(build, points, output(table, "Attribute"), 0, "FLOAT_VECTOR")
    columns, rows, less = coordinates(build, of_first)
    count = whole_number(build, build.math("MULTIPLY", less, -1.0), "ROUND")
    index = output(build.add("GeometryNodeInputIndex"), "Index")
    told_there = sample_index(build, points, output(table, "Attribute"), index, "FLOAT_VECTOR")
    x, y, first = coordinates(build, told_there)
    place = combined(build, x, y, build.math("MAXIMUM", first, 0.0))
    levels = output(build.add("GeometryNodePoints", {"Count": count, "Position": place}), "Points")
    return has_own, levels, columns, rows


def cells(build: Builder, columns: Socket, rows: Socket) -> Socket:
    """Along x and y, and 1."""
    x, y = (build.integer("SUBTRACT", count, 1) for count in (columns, rows))
    return combined(build, x, y, 1.0)


def told(build: Builder, name: str) -> Socket:
    """An attribute of three integers."""
    return output(named_attribute(build, name, "FLOAT_VECTOR"), "Attribute")


def halvings(build: Builder, columns: Socket, rows: Socket) -> Socket:
    """Number of halvings until one cell is left."""
    most = build.integer("SUBTRACT", build.integer("MAXIMUM", columns, rows), 1)
    return alone(build, "CEIL", build.math("LOGARITHM", most, 2.0), "ShaderNodeMath")


def _build_next(tree: bpy.types.NodeTree) -> None:
    build = Builder(tree, (*_MESH, _IS_MOVING), _MESH)
    given = {plug.name: build.given(plug.name) for plug in _MESH}
    counts = [
        build.integer("ADD", build.integer("DIVIDE_FLOOR", given[name], 2), 1) for name in ("Columns", "Rows")
    ]
    points = build.add("GeometryNodePoints", {"Count": build.integer("MULTIPLY", *counts)})
    index = output(build.add("GeometryNodeInputIndex"), "Index")
    number = combined(
        build, *(build.integer(operation, index, counts[0]) for operation in ("MODULO", "DIVIDE_FLOOR"))
    )
    ratio = build.vector("DIVIDE", cells(build, given["Columns"], given["Rows"]), cells(build, *counts))
    middle = build.vector("MULTIPLY", build.vector("ADD", number, (0.5, 0.5, 0.0)), ratio)
    place = build.vector("SUBTRACT", middle, (0.5, 0.5, 0.0))

    def averaged(*names: str) -> Socket:
        node = build.add(
            "GeometryNodeCaptureAttribute", {"Geometry": output(points, "Points")}, domain="POINT"
        )
        for name in names:
            node.capture_items.new("VECTOR", name)
            cell = build.group(node_group(CELL), {**given, "Value": told(build, name), "Place": place})
            build.tree.links.new(output(cell, "Value"), node.inputs[name])
        result = output(node, "Geometry")
        for name in names:
            result = build.store(result, name, node.outputs[name], "FLOAT_VECTOR")
        return result

    averages = build.switch("GEOMETRY", build.given("Moving"), averaged(OTHERS), averaged(*CARRIED))
    build.finish_with({"Geometry": averages, "Columns": counts[0], "Rows": counts[1]})


def _build(tree: bpy.types.NodeTree) -> None:
    build = Builder(tree, (*_MESH, _FADE, _IS_MOVING), _OUTPUTS)
    surface = {plug.name: build.given(plug.name) for plug in _MESH}
    surface["Geometry"] = build.change("GeometryNodeMeshToPoints", surface["Geometry"])
    all_points = build.change("GeometryNodeGeometryToInstance", surface["Geometry"])
    first = build.integer("MULTIPLY", surface["Columns"], surface["Rows"])
    kinds = {plug.name: plug.socket_type.removeprefix("NodeSocket").upper() for plug in _MESH}
    kinds |= {"All": "GEOMETRY", "Levels": "GEOMETRY", "First": "INT"}
    begin, end = repeated(build, kinds)
    start = {**surface, "All": all_points, "Levels": _level(build, surface, 0), "First": first}
    for name, value in start.items():
        connect(build, begin.inputs[name], value)
    count = whole_number(build, halvings(build, surface["Columns"], surface["Rows"]), "ROUND")
    connect(build, begin.inputs["Iterations"], build.switch("INT", build.given("Fade"), 0, count))
    before = {plug.name: begin.outputs[plug.name] for plug in _MESH}
    means = build.group(node_group(NEXT_AVERAGES), {**before, "Moving": build.given("Moving")})
    after = {plug.name: output(means, plug.name) for plug in _MESH}
    more = build.change("GeometryNodeGeometryToInstance", after["Geometry"])
    present = begin.outputs["First"]
    following = {
        **after,
        "All": joined(build, begin.outputs["All"], more),
        "Levels": joined(build, begin.outputs["Levels"], _level(build, after, present)),
        "First": build.integer("ADD", present, build.integer("MULTIPLY", after["Columns"], after["Rows"])),
    }
    for name, value in following.items():
        connect(build, end.inputs[name], value)
    points = build.change("GeometryNodeRealizeInstances", end.outputs["All"])
    build.finish_with({"Geometry": points, "Levels": end.outputs["Levels"]})


def _level(build: Builder, mesh: dict[str, Socket], first: Input) -> Socket:
    """The point that describes one level of averages."""
    place = combined(build, mesh["Columns"], mesh["Rows"], first)
    return output(build.add("GeometryNodePoints", {"Count": 1, "Position": place}), "Points")


NEXT_AVERAGES = GroupKind("Ocean Tweak Next Averages", 1, _build_next)
AVERAGES = GroupKind("Ocean Tweak Averages", 3, _build)
