# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry nodes that sample foam around a camera, from `core.sea.foam_rings` and `core.sea.foam_fan`.

Rings are nested; the cells of ring n are 2ⁿ times as large as the first one's. Their places are the points of
one mesh, ring by ring, x fastest, with foam, breaking and age as one vector. The points of a fan are in rows,
and are also the vertices of the surface; their z is the cell size. One further point, the last, has the
values beyond all rings; its x is the frame of the foam, y the number of columns of a fan, z the number of
places along a side of a ring.
"""

from __future__ import annotations

import math

import bpy

from ..core.sea.foam_rings import INNER, OUTER
from .building import Builder, Input, Plug, Socket, output
from .fields import alone, combined, coordinates, mixed, named_attribute, sample_index, whole_number
from .versioned import GroupKind, node_group

#: attribute of the places: foam, breaking and age
RING_FOAM = "ocean_tweak_ring_foam"
#: size of a grid cell in ring cells beyond which a coarser ring is sampled
_GRID_CELLS = 2.5

_POINTS = Plug("Foam", "NodeSocketGeometry", None, "The rings' places, and the point beyond them")
_RINGS = Plug("Rings", "NodeSocketInt", 1, "How many there are")
_SAMPLES = Plug("Samples", "NodeSocketInt", 2, "Places along each side of a ring")
_PLACE = Plug("Place", "NodeSocketVector", None, "Of the grid's vertices at rest, in the ocean's space")

_FACTS_OUTPUTS = (
    Plug("Is There", "NodeSocketBool", None, "Whether there is foam of the frame that is shown"),
    Plug("Is Of Another Frame", "NodeSocketBool", None, "Whether there is foam, but of another frame"),
    Plug("Frame", "NodeSocketInt", None, "That it is of"),
    _RINGS,
    _SAMPLES,
    Plug("Columns", "NodeSocketInt", 0, "Of the fan that the points are; 0 for rings"),
)


def _build_facts(tree: bpy.types.NodeTree) -> None:
    build = Builder(tree, (_POINTS,), _FACTS_OUTPUTS)
    points = build.given("Foam")
    count = output(build.add("GeometryNodeAttributeDomainSize", {"Geometry": points}), "Point Count")
    known = build.compare("GREATER_THAN", count, 0)
    last = _position(build, points, build.integer("SUBTRACT", count, 1))
    frame, columns, along = coordinates(build, last)
    samples = build.integer("MAXIMUM", whole_number(build, along, "ROUND"), 2)
    now = output(build.add("GeometryNodeInputSceneTime"), "Frame")
    off = build.math("ABSOLUTE", build.math("SUBTRACT", now, frame), None)
    present = build.compare("LESS_THAN", off, 1.0, "FLOAT")
    build.finish_with(
        {
            "Is There": build.logic("AND", known, present),
            "Is Of Another Frame": build.logic("NIMPLY", known, present),
            "Frame": whole_number(build, frame, "ROUND"),
            "Rings": build.integer("DIVIDE_FLOOR", count, build.integer("MULTIPLY", samples, samples)),
            "Samples": samples,
            "Columns": whole_number(build, columns, "ROUND"),
        }
    )


def _build_ring(tree: bpy.types.NodeTree) -> None:
    inputs = (
        _POINTS,
        _RINGS,
        _SAMPLES,
        _PLACE,
        Plug("Ring", "NodeSocketInt", 0, "That is read; there is one more than there are, beyond all"),
        Plug("Spacing", "NodeSocketFloat", 0.25, "Of the first ring's cells"),
    )
    outputs = (Plug("Value", "NodeSocketVector", None, "Foam, breaking and age at the vertex"),)
    build = Builder(tree, inputs, outputs)
    points, rings, samples = (build.given(name) for name in ("Foam", "Rings", "Samples"))
    last, of_ring = build.integer("SUBTRACT", rings, 1), build.integer("MULTIPLY", samples, samples)
    ring = build.integer("MINIMUM", build.given("Ring"), last)
    first = build.integer("MULTIPLY", ring, of_ring)
    size = build.math("MULTIPLY", build.given("Spacing"), build.math("POWER", 2.0, ring))
    away = build.vector("SUBTRACT", build.given("Place"), _position(build, points, first))
    cell = build.scaled(away, build.math("DIVIDE", 1.0, size))
    most = build.integer("SUBTRACT", samples, 2)
    column, row = (_held(build, along, most) for along in coordinates(build, cell)[:2])
    part = build.vector("SUBTRACT", cell, combined(build, column, row))
    part = build.vector("MAXIMUM", build.vector("MINIMUM", part, (1.0, 1.0, 1.0)), (0.0, 0.0, 0.0))
    index = build.integer("ADD", build.integer("ADD", build.integer("MULTIPLY", row, samples), column), first)
    value = output(named_attribute(build, RING_FOAM, "FLOAT_VECTOR"), "Attribute")

    def told(number: Input) -> Socket:
        return sample_index(build, points, value, number, "FLOAT_VECTOR")

    north = build.integer("ADD", index, samples)
    corners = [told(each) for first in (index, north) for each in (first, build.integer("ADD", first, 1))]
    part_x, part_y, _ = coordinates(build, part)
    south, north = (mixed(build, corners[pair], corners[pair + 1], part_x) for pair in (0, 2))
    within = mixed(build, south, north, part_y)
    beyond = told(build.integer("MULTIPLY", rings, of_ring))
    is_beyond = build.compare("GREATER_THAN", build.given("Ring"), last)
    build.finish_with({"Value": build.switch("VECTOR", is_beyond, within, beyond)})


def _build(tree: bpy.types.NodeTree) -> None:
    inputs = (
        _POINTS,
        _RINGS,
        _SAMPLES,
        _PLACE,
        Plug("Size", "NodeSocketFloat", 1.0, "Of the grid's cells where a vertex is"),
    )
    outputs = (Plug("Value", "NodeSocketVector", None, "Foam, breaking and age at the vertex"),)
    build = Builder(tree, inputs, outputs)
    points, rings, samples = (build.given(name) for name in ("Foam", "Rings", "Samples"))
    cells = build.integer("SUBTRACT", samples, 1)
    first, last = (_position(build, points, index) for index in (0, cells))
    width = coordinates(build, build.vector("SUBTRACT", last, first))[0]
    spacing = build.math("DIVIDE", width, cells)
    number = _ring_number(build, first, spacing, rings)
    low = alone(build, "FLOOR", number, "ShaderNodeMath")
    values = []
    for offset in (0, 1):
        ring = build.integer("ADD", whole_number(build, low, "ROUND"), offset)
        given = {"Foam": points, "Rings": rings, "Samples": samples, "Ring": ring, "Spacing": spacing}
        given["Place"] = build.given("Place")
        values.append(output(build.group(node_group(RING), given), "Value"))
    value = mixed(build, values[0], values[1], build.math("SUBTRACT", number, low))
    build.finish_with({"Value": value})


def _build_fan(tree: bpy.types.NodeTree) -> None:
    inputs = (
        Plug("Foam", "NodeSocketGeometry", None, "The fan's places, and one point more"),
        Plug("Columns", "NodeSocketInt", 2, "Of the fan"),
        Plug("Corner", "NodeSocketVector", None, "From which its vertices are counted, in the ocean's space"),
    )
    outputs = (
        Plug("Geometry", "NodeSocketGeometry", None, "A flat grid of the fan's places"),
        Plug("Size", "NodeSocketFloat", None, "Of its cells where a vertex is"),
        Plug("Value", "NodeSocketVector", None, "Foam, breaking and age at the vertex"),
    )
    build = Builder(tree, inputs, outputs)
    points, columns = build.given("Foam"), build.given("Columns")
    count = output(build.add("GeometryNodeAttributeDomainSize", {"Geometry": points}), "Point Count")
    rows = build.integer("DIVIDE_FLOOR", count, columns)
    # the primitive counts along y first
    grid = output(build.add("GeometryNodeMeshGrid", {"Vertices X": rows, "Vertices Y": columns}), "Mesh")
    index = output(build.add("GeometryNodeInputIndex"), "Index")
    value = output(named_attribute(build, RING_FOAM, "FLOAT_VECTOR"), "Attribute")
    read = build.add("GeometryNodeCaptureAttribute", {"Geometry": grid}, domain="POINT")
    for name, told in (
        ("Place", _position(build, points, index)),
        ("White", sample_index(build, points, value, index, "FLOAT_VECTOR")),
    ):
        read.capture_items.new("VECTOR", name)
        build.tree.links.new(told, read.inputs[name])
    x, y, size = coordinates(build, read.outputs["Place"])
    place = build.vector(
        "SUBTRACT", combined(build, x, y), build.vector("MULTIPLY", build.given("Corner"), (1.0, 1.0, 0.0))
    )
    grid = build.change("GeometryNodeSetPosition", output(read, "Geometry"), {"Position": place})
    build.finish_with({"Geometry": grid, "Size": size, "Value": read.outputs["White"]})


def _ring_number(build: Builder, first: Socket, spacing: Socket, rings: Socket) -> Socket:
    """The ring at a vertex, fractional between two rings; the number of rings means beyond all of them.

    Ring n is used up to INNER of its side from its centre, and only the next one from OUTER; for a coarse
    grid, a later one.
    """
    side = build.math("MULTIPLY", spacing, build.given("Samples"))
    half = build.math("MULTIPLY", side, 0.5)
    middle = build.vector("ADD", first, combined(build, half, half))
    off = build.vector("SUBTRACT", build.given("Place"), middle)
    x, y, _ = coordinates(build, alone(build, "ABSOLUTE", off))
    inner = build.math("MULTIPLY", side, INNER)
    away = build.math("DIVIDE", build.math("MAXIMUM", x, y), inner)
    octave = build.math("LOGARITHM", build.math("MAXIMUM", away, 1e-3), 2.0)
    whole = alone(build, "FLOOR", octave, "ShaderNodeMath")
    part = build.math("DIVIDE", build.math("SUBTRACT", octave, whole), math.log2(OUTER / INNER))
    by_place = build.math("ADD", whole, build.math("MINIMUM", part, 1.0))
    coarse = build.math("DIVIDE", build.given("Size"), build.math("MULTIPLY", spacing, _GRID_CELLS))
    by_size = build.math("LOGARITHM", build.math("MAXIMUM", coarse, 1e-3), 2.0)
    number = build.math("MAXIMUM", build.math("MAXIMUM", by_place, by_size), 0.0)
    return build.math("MINIMUM", number, rings)


def _held(build: Builder, along: Socket, most: Socket) -> Socket:
    """The integer index of a cell, clamped to the ring."""
    low = build.math("MAXIMUM", alone(build, "FLOOR", along, "ShaderNodeMath"), 0.0)
    return whole_number(build, build.math("MINIMUM", low, most), "ROUND")


def _position(build: Builder, points: Socket, index: Input) -> Socket:
    position = output(build.add("GeometryNodeInputPosition"), "Position")
    return sample_index(build, points, position, index, "FLOAT_VECTOR")


RING_FACTS = GroupKind("Ocean Tweak Foam Facts", 3, _build_facts)
RING = GroupKind("Ocean Tweak Foam Ring", 3, _build_ring)
CAMERA_FOAM = GroupKind("Ocean Tweak Camera Foam", 3, _build)
CAMERA_FAN = GroupKind("Ocean Tweak Camera Fan", 1, _build_fan)
