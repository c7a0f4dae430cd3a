# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry nodes that write on a sea bed how wet it is, from baked points over it."""

from __future__ import annotations

import bpy

from .building import Builder, Plug, Socket, output
from .fields import coordinates, sample_index, whole_number
from .names import WET
from .point_files import column, point_file
from .shown_frame import FRAME_INPUTS, SHOWN_FRAME
from .versioned import GroupKind, node_group

#: the input that holds a path
FILES = "Files"

_INPUTS = (
    Plug(FILES, "NodeSocketString", "", "Baked points over the bed, up to the number of the frame"),
    *FRAME_INPUTS,
    Plug("Row", "NodeSocketVector", (0.0, 0.0, 0.0), "Lines of points in a Blender unit along x, y and z"),
    Plug("Column", "NodeSocketVector", (0.0, 0.0, 0.0), "Points of a line in a Blender unit along these"),
    Plug("Origin", "NodeSocketVector", (0.0, 0.0, 0.0), "Line and point of a line at the object's origin"),
    Plug("Lines Before", "NodeSocketInt", 0, "Lines in the files before those over the bed"),
    Plug("Lines", "NodeSocketInt", 2, "Lines over the bed"),
    Plug("Points", "NodeSocketInt", 2, "Points of a line; the last one is the first again"),
)  # fmt: skip


def _build(tree: bpy.types.NodeTree) -> None:
    build = Builder(tree, _INPUTS)
    geometry = build.given("Geometry")
    frame = build.group(node_group(SHOWN_FRAME), {name: build.given(name) for name, *_ in FRAME_INPUTS})
    points = point_file(build, build.given(FILES), output(frame, "Frame"))
    place = output(build.add("GeometryNodeInputPosition"), "Position")
    first_row, first_number, _ = coordinates(build, build.given("Origin"))
    row, number = (
        build.math("ADD", build.vector("DOT_PRODUCT", place, build.given(name)), first)
        for name, first in (("Row", first_row), ("Column", first_number))
    )
    last = build.integer("SUBTRACT", build.given("Lines"), 1)
    row = build.math("MINIMUM", build.math("MAXIMUM", row, 0.0), last)
    low_row, low_number = (whole_number(build, value, "FLOOR") for value in (row, number))
    round_trip = build.integer("SUBTRACT", build.given("Points"), 1)

    def told(rows_on: int, numbers_on: int) -> Socket:
        line = build.integer("MINIMUM", build.integer("ADD", low_row, rows_on), last)
        line = build.integer("ADD", line, build.given("Lines Before"))
        # on the other side of the origin as well
        point = build.integer("FLOORED_MODULO", build.integer("ADD", low_number, numbers_on), round_trip)
        index = build.integer("ADD", build.integer("MULTIPLY", line, build.given("Points")), point)
        return sample_index(build, points, column(build, WET), index, "FLOAT")

    across = build.math("SUBTRACT", number, low_number)
    nearer, farther = (_between(build, told(on, 0), told(on, 1), across) for on in (0, 1))
    wet = _between(build, nearer, farther, build.math("SUBTRACT", row, low_row))
    count = output(build.add("GeometryNodeAttributeDomainSize", {"Geometry": points}), "Point Count")
    written = build.store(geometry, WET, wet, "FLOAT")
    build.finish(build.switch("GEOMETRY", build.compare("GREATER_THAN", count, 0), geometry, written))


def _between(build: Builder, first: Socket, second: Socket, share: Socket) -> Socket:
    return build.math("ADD", first, build.math("MULTIPLY", build.math("SUBTRACT", second, first), share))


WET_BED = GroupKind("Ocean Tweak Wet Bed", 1, _build)
