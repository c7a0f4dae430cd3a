# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry nodes that read the baked points of one patch, written by `export.points`.

The result has the form of a live patch: vertices in x-fastest order, with the first ones of each row and
column repeated at the end, and displacement, velocity, slope and strain. The viewport reads the files with
fewer samples.
"""

from __future__ import annotations

import bpy

from ..core.synthesis.channels import CHANNELS
from .building import Builder, Plug, Socket, output
from .fields import alone, combined, named_attribute, sample_index, whole_number
from .names import DISPLACEMENT, SLOPE, SLOPE_VARIANCE, STRAIN, VELOCITY
from .patch import SCALE_INPUTS, moved_on
from .point_files import column as file_column
from .point_files import point_file
from .shown_frame import FRAME_INPUTS, SHOWN_FRAME
from .versioned import GroupKind, node_group

#: inputs with paths
FILES = ("Files", "Viewport Files")

INPUTS = (
    Plug(FILES[0], "NodeSocketString", "", "Baked points of all samples, up to the number of the frame"),
    Plug(FILES[1], "NodeSocketString", "", "What a window reads in their place"),
    *FRAME_INPUTS,
    Plug("Domain Size", "NodeSocketFloat", 400.0, "Side of the patch, in metres"),
    Plug("Resolution", "NodeSocketInt", 512, "All samples along each side"),
    *SCALE_INPUTS,
)
#: attribute of the result → columns of the files
_NUMBERS = {
    VELOCITY: CHANNELS["velocity"].columns,
    SLOPE: CHANNELS["slope"].columns,
    STRAIN: CHANNELS["strain"].columns,
}


def _build(tree: bpy.types.NodeTree) -> None:
    build = Builder(tree, INPUTS)
    frame = build.group(node_group(SHOWN_FRAME), {name: build.given(name) for name, *_ in FRAME_INPUTS})
    points = _read(build, output(frame, "Frame"))
    count = output(build.add("GeometryNodeAttributeDomainSize", {"Geometry": points}), "Point Count")
    along = whole_number(build, alone(build, "SQRT", count, "ShaderNodeMath"), "ROUND")
    columns = build.integer("ADD", along, 1)
    vertices = build.integer("MULTIPLY", columns, columns)
    line = output(build.add("GeometryNodeMeshLine", {"Count": vertices}), "Mesh")
    index = output(build.add("GeometryNodeInputIndex"), "Index")
    column, row = (build.integer(operation, index, columns) for operation in ("MODULO", "DIVIDE_FLOOR"))
    cells = build.integer("MAXIMUM", along, 1)
    near_column, near_row = (build.integer("MODULO", number, cells) for number in (column, row))
    source = build.integer("ADD", build.integer("MULTIPLY", near_row, along), near_column)

    def told(value: Socket, data_type: str = "FLOAT_VECTOR") -> Socket:
        return sample_index(build, points, value, source, data_type)

    place = told(output(build.add("GeometryNodeInputPosition"), "Position"))
    moved = build.vector("SUBTRACT", place, _at_rest(build, near_column, near_row, along))
    values = {
        name: told(combined(build, *(file_column(build, each) for each in _NUMBERS[name])))
        for name in _NUMBERS
    }
    variance = told(file_column(build, SLOPE_VARIANCE), "FLOAT")
    values[VELOCITY] = build.scaled(values[VELOCITY], build.given("Velocity Scale"))
    scaled = build.scaled(moved, build.given("Scale"))
    values[DISPLACEMENT] = moved_on(build, scaled, values[VELOCITY], output(frame, "Seconds"))
    grid = build.store(line, SLOPE_VARIANCE, variance, "FLOAT")
    for name, value in values.items():
        grid = build.store(grid, name, value, "FLOAT_VECTOR")
    rest = build.scaled(_at_rest(build, column, row, along), build.given("Scale"))
    displacement = output(named_attribute(build, DISPLACEMENT, "FLOAT_VECTOR"), "Attribute")
    position = build.vector("ADD", rest, displacement)
    build.finish(build.change("GeometryNodeSetPosition", grid, {"Position": position}))


def _read(build: Builder, frame: Socket) -> Socket:
    """Read the points of a frame."""
    is_window = output(build.add("GeometryNodeIsViewport"), "Is Viewport")
    files = build.switch("STRING", is_window, *(build.given(name) for name in FILES))
    return point_file(build, files, frame)


def _at_rest(build: Builder, column: Socket, row: Socket, along: Socket) -> Socket:
    """Rest position of a sample, m; for an average, the centre of its cell."""
    size = build.given("Domain Size")
    spacing = build.math("DIVIDE", size, along)
    own = build.math("DIVIDE", size, build.given("Resolution"))
    first = build.math("MULTIPLY", build.math("SUBTRACT", spacing, own), 0.5)
    x, y = (build.math("ADD", build.math("MULTIPLY", number, spacing), first) for number in (column, row))
    return combined(build, x, y)


PATCH_POINTS = GroupKind("Ocean Tweak Patch Points", 3, _build)
