# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry nodes that extend an ocean to the horizon: copies around it, and flat water beyond.

The copies are instances and use hardly any memory. The size is that of the ocean's mesh at rest, so the
horizon adapts when the domain or the repeats change.
"""

from __future__ import annotations

import bpy

from .building import Builder, Socket, output
from .names import DISPLACEMENT
from .versioned import GroupKind

INPUTS = (
    ("Ocean", "NodeSocketObject", None, "The ocean to continue"),
    ("Rings", "NodeSocketInt", 4, "Rings of copies around the ocean in renders"),
    ("Viewport Rings", "NodeSocketInt", 1, "Rings of copies around the ocean in the viewport"),
    ("Far Distance", "NodeSocketFloat", 30_000.0, "Where the flat water beyond them ends, in Blender units"),
    ("Material", "NodeSocketMaterial", None, "Of the flat water"),
)


def _build(tree: bpy.types.NodeTree) -> None:
    build = Builder(tree, INPUTS)
    ocean = {"Object": build.given("Ocean")}
    info = build.add("GeometryNodeObjectInfo", {**ocean, "As Instance": False}, transform_space="RELATIVE")
    copy = build.add("GeometryNodeObjectInfo", {**ocean, "As Instance": True}, transform_space="RELATIVE")
    is_viewport = output(build.add("GeometryNodeIsViewport"), "Is Viewport")
    rings = build.switch("INT", is_viewport, build.given("Rings"), build.given("Viewport Rings"))
    rings = build.integer("MAXIMUM", rings, 0)
    size = _size(build, output(info, "Geometry"))
    joined = build.add("GeometryNodeJoinGeometry")
    for part in (_copies(build, output(copy, "Geometry"), size, rings), _far(build, size, rings)):
        build.tree.links.new(part, joined.inputs[0])
    build.finish(joined.outputs[0])


def _size(build: Builder, geometry: Socket) -> Socket:
    """The far corner of the ocean at rest: its sides along x and y."""
    position = output(build.add("GeometryNodeInputPosition"), "Position")
    moved = build.add("GeometryNodeInputNamedAttribute", {"Name": DISPLACEMENT}, data_type="FLOAT_VECTOR")
    rest = build.vector("SUBTRACT", position, output(moved, "Attribute"))
    statistic = build.add(
        "GeometryNodeAttributeStatistic", {"Geometry": geometry, "Attribute": rest},
        data_type="FLOAT_VECTOR", domain="POINT",
    )  # fmt: skip
    return output(statistic, "Max")


def _copies(build: Builder, instance: Socket, size: Socket, rings: Socket) -> Socket:
    """Instances at every place of the rings except the ocean's own."""
    side = build.integer("ADD", build.integer("MULTIPLY", rings, 2), 1)
    grid = build.add("GeometryNodeMeshGrid", {"Vertices X": side, "Vertices Y": side})
    column, row, index = _columns_and_rows(build, side)
    count = build.integer("MULTIPLY", side, side)
    middle = build.integer("DIVIDE", build.integer("SUBTRACT", count, 1), 2)
    others = build.compare("NOT_EQUAL", index, middle)
    shift = build.add(
        "ShaderNodeCombineXYZ",
        {"X": build.integer("SUBTRACT", column, rings), "Y": build.integer("SUBTRACT", row, rings)},
    )
    place = build.vector("MULTIPLY", output(shift, "Vector"), size)
    placed = build.change("GeometryNodeSetPosition", output(grid, "Mesh"), {"Position": place})
    inputs = {"Selection": others, "Instance": instance}
    return build.change("GeometryNodeInstanceOnPoints", placed, inputs)


def _far(build: Builder, size: Socket, rings: Socket) -> Socket:
    """A flat square at mean water with a hole for the ocean and its copies."""
    grid = build.add("GeometryNodeMeshGrid", {"Vertices X": 4, "Vertices Y": 4})
    column, row, _ = _columns_and_rows(build, 4)
    number = build.add("ShaderNodeCombineXYZ", {"X": column, "Y": row})
    beyond = build.scaled(size, build.math("ADD", rings, 1.0))
    before = build.scaled(size, build.math("MULTIPLY", rings, -1.0))
    far = build.given("Far Distance")
    ends = [build.math("MULTIPLY", far, -1.0), far]
    corners = [output(build.add("ShaderNodeCombineXYZ", {"X": end, "Y": end}), "Vector") for end in ends]
    place = _chosen(build, output(number, "Vector"), [corners[0], before, beyond, corners[1]])
    turned = build.change("GeometryNodeFlipFaces", output(grid, "Mesh"))
    placed = build.change("GeometryNodeSetPosition", turned, {"Position": place})
    index = output(build.add("GeometryNodeInputIndex"), "Index")
    hole = build.change(
        "GeometryNodeDeleteGeometry", placed, {"Selection": build.compare("EQUAL", index, 4)}, domain="FACE"
    )
    return build.change("GeometryNodeSetMaterial", hole, {"Material": build.given("Material")})


def _chosen(build: Builder, number: Socket, values: list[Socket]) -> Socket:
    """Select a value by an index along each axis, as a weighted sum."""
    total = None
    for index, value in enumerate(values):
        away = build.vector("SUBTRACT", number, (float(index),) * 3)
        absolute = output(build.add("ShaderNodeVectorMath", {"Vector": away}, operation="ABSOLUTE"), "Vector")
        share = build.vector("MAXIMUM", build.vector("SUBTRACT", (1.0, 1.0, 1.0), absolute), (0.0,) * 3)
        # z is flat
        share = build.vector("MULTIPLY", share, (1.0, 1.0, 0.0))
        part = build.vector("MULTIPLY", share, value)
        total = part if total is None else build.vector("ADD", total, part)
    return total


def _columns_and_rows(build: Builder, side: Socket | int) -> tuple[Socket, Socket, Socket]:
    """Column, row and index of a vertex, x fastest."""
    index = output(build.add("GeometryNodeInputIndex"), "Index")
    return build.integer("MODULO", index, side), build.integer("DIVIDE_FLOOR", index, side), index


HORIZON = GroupKind("Ocean Tweak Horizon", 1, _build)
