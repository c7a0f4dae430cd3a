# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry nodes that average an ocean's surface over larger and larger cells, and read it in between.

A surface is held by a mesh as `nodes.surface` knows it: vertices stand x fastest, the last ones of a row and
of a column are the first ones of the next period. Of a mesh of averages only the attributes count.

The next averages are those of two by two: sample j of nₖ stands for the place (j + ½)/nₖ of the period, and
lies between two samples of the averages before. Numbers that cannot be halved are rounded up, and what
lies between two samples is interpolated.
"""

from __future__ import annotations

import bpy

from .building import Builder, Plug, Socket, output
from .fields import alone, combined, coordinates, named_attribute
from .names import BREAKING, CUSP, DISPLACEMENT, FOAM, SLOPE, STRAIN, VELOCITY
from .surface import CELL
from .versioned import GroupKind, node_group

#: slopes along x and y and the sum of their squares; foam, cusp and breaking of an ocean, strain of a patch:
#: three numbers are read at once
SLOPES, OTHERS = "ocean_tweak_slopes", "ocean_tweak_others"
#: what is averaged
MOVING = (DISPLACEMENT, VELOCITY, SLOPES)
CARRIED = (*MOVING, OTHERS)
#: how far up a normal at least points, so that a fold does not count for a whole sea
_LEAST_UPWARDS = 0.2

_MESH = (
    Plug("Geometry", "NodeSocketGeometry", None, "Mesh with the surface's attributes"),
    Plug("Columns", "NodeSocketInt", 2, "Vertices along x"),
    Plug("Rows", "NodeSocketInt", 2, "Vertices along y"),
)
IS_MOVING = Plug("Moving", "NodeSocketBool", True, "Displacement, velocity and slopes are wanted too")


def ocean_carried(build: Builder, ocean: Socket, moving: Socket) -> Socket:
    """An ocean's mesh with what is averaged: of its foam, and where that is wanted how it moves."""
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
    """The mesh of one patch of a sea with what is averaged: how it moves, and its strain.

    Slopes of means have as z what they lack of the slopes' squares.
    """
    slope, strain = (
        output(named_attribute(build, name, "FLOAT_VECTOR"), "Attribute") for name in (SLOPE, STRAIN)
    )
    x, y, lost = coordinates(build, slope)
    held = build.math("ADD", *(build.math("MULTIPLY", part, part) for part in (x, y)))
    squares = build.math("ADD", held, lost)
    sloped = build.store(patch, SLOPES, combined(build, x, y, squares), "FLOAT_VECTOR")
    return build.store(sloped, OTHERS, strain, "FLOAT_VECTOR")


def read(build: Builder, mesh: bpy.types.Node | dict[str, Socket], name: str, place: Socket) -> Socket:
    """What an attribute of a surface is at a place, in cells."""
    value = output(named_attribute(build, name, "FLOAT_VECTOR"), "Attribute")
    of_mesh = {plug.name: mesh[plug.name] for plug in _MESH}
    return output(build.group(node_group(CELL), {**of_mesh, "Value": value, "Place": place}), "Value")


def cells(build: Builder, columns: Socket, rows: Socket) -> Socket:
    """Along x and y, and 1."""
    x, y = (build.integer("SUBTRACT", count, 1) for count in (columns, rows))
    return combined(build, x, y, 1.0)


def _build(tree: bpy.types.NodeTree) -> None:
    build = Builder(tree, (*_MESH, IS_MOVING), _MESH)
    given = {plug.name: build.given(plug.name) for plug in _MESH}
    counts = [
        build.integer("ADD", build.integer("DIVIDE_FLOOR", given[name], 2), 1) for name in ("Columns", "Rows")
    ]
    grid = build.add("GeometryNodeMeshGrid", {"Vertices X": counts[1], "Vertices Y": counts[0]})
    index = output(build.add("GeometryNodeInputIndex"), "Index")
    number = combined(
        build, *(build.integer(operation, index, counts[0]) for operation in ("MODULO", "DIVIDE_FLOOR"))
    )
    ratio = build.vector("DIVIDE", cells(build, given["Columns"], given["Rows"]), cells(build, *counts))
    middle = build.vector("MULTIPLY", build.vector("ADD", number, (0.5, 0.5, 0.0)), ratio)
    place = build.vector("SUBTRACT", middle, (0.5, 0.5, 0.0))
    averages = moving = output(grid, "Mesh")
    for name in MOVING:
        moving = build.store(moving, name, read(build, given, name, place), "FLOAT_VECTOR")
    averages = build.switch("GEOMETRY", build.given("Moving"), averages, moving)
    averages = build.store(averages, OTHERS, read(build, given, OTHERS, place), "FLOAT_VECTOR")
    build.finish_with({"Geometry": averages, "Columns": counts[0], "Rows": counts[1]})


AVERAGES = GroupKind("Ocean Tweak Averages", 2, _build)


def halvings(build: Builder, columns: Socket, rows: Socket) -> Socket:
    """How often it takes until one cell is left."""
    most = build.integer("SUBTRACT", build.integer("MAXIMUM", columns, rows), 1)
    return alone(build, "CEIL", build.math("LOGARITHM", most, 2.0), "ShaderNodeMath")
