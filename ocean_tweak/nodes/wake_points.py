# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry nodes that read baked waves which do not repeat, such as wakes, written by `export.wake_points`.

The result has the form of the live ones: vertices in x-fastest order with displacement, velocity, slope and
strain. The foam of hulls is on them too.
"""

from __future__ import annotations

import bpy

from ..core.synthesis.channels import CHANNELS
from .building import Builder, Plug, output
from .fields import combined, coordinates, named_attribute
from .names import BREAKING, DISPLACEMENT, FOAM, SLOPE, STRAIN, VELOCITY
from .patch import SCALE_INPUTS, moved_on
from .point_files import column, point_file
from .shown_frame import FRAME_INPUTS, SHOWN_FRAME
from .versioned import GroupKind, node_group

#: input with a path
FILES = "Files"

_INPUTS = (
    Plug(FILES, "NodeSocketString", "", "Baked points, up to the number of the frame"),
    *FRAME_INPUTS,
    *SCALE_INPUTS,
    Plug("Foam", "NodeSocketBool", True, "Show the foam of hulls"),
)


def _build(tree: bpy.types.NodeTree) -> None:
    build = Builder(tree, _INPUTS)
    frame = build.group(node_group(SHOWN_FRAME), {name: build.given(name) for name, *_ in FRAME_INPUTS})
    points = point_file(build, build.given(FILES), output(frame, "Frame"))
    for name in (SLOPE, STRAIN):
        value = combined(build, *(column(build, each) for each in CHANNELS[name].columns))
        points = build.store(points, name, value, "FLOAT_VECTOR")
    share = build.switch("FLOAT", build.given("Foam"), 0.0, 1.0)
    for name in (FOAM, BREAKING):
        points = build.store(points, name, build.math("MULTIPLY", column(build, name), share), "FLOAT")
    velocity = combined(build, *(column(build, each) for each in CHANNELS["velocity"].columns))
    velocity = build.scaled(velocity, build.given("Velocity Scale"))
    x, y, z = coordinates(build, output(build.add("GeometryNodeInputPosition"), "Position"))
    aside = [column(build, name) for name in ("moved_x", "moved_y")]
    moved = build.scaled(combined(build, aside[0], aside[1], z), build.given("Scale"))
    rest_x, rest_y = (build.math("SUBTRACT", place, by) for place, by in zip((x, y), aside, strict=True))
    rest = build.scaled(combined(build, rest_x, rest_y), build.given("Scale"))
    now = moved_on(build, moved, velocity, output(frame, "Seconds"))
    # what is told is worked out of the positions that are changed at last
    points = build.store(points, VELOCITY, velocity, "FLOAT_VECTOR")
    points = build.store(points, DISPLACEMENT, now, "FLOAT_VECTOR")
    shown = output(named_attribute(build, DISPLACEMENT, "FLOAT_VECTOR"), "Attribute")
    position = build.vector("ADD", rest, shown)
    build.finish(build.change("GeometryNodeSetPosition", points, {"Position": position}))


WAKE_POINTS = GroupKind("Ocean Tweak Wake Points", 1, _build)
