# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry nodes of the mesh over a bed. They pass on what the extension writes, or move the mesh, which then
is at rest, by baked points, one for each of its vertices. As it has a modifier, Blender exports its motion.
"""

from __future__ import annotations

import bpy

from ..core.synthesis.channels import CHANNELS
from .building import Builder, Plug, Socket, output
from .extension_check import INPUTS as ABSENCE_INPUTS
from .extension_check import LIVE_REMEDY
from .fields import combined, named_attribute, sample_index
from .frame_warnings import WARNINGS
from .held import held_still
from .names import BREAKING, CUSP, DISPLACEMENT, FOAM, FOAM_AGE, VELOCITY
from .patch import SCALE_INPUTS, moved_on
from .point_files import column, is_given, point_file
from .shown_frame import FRAME_INPUTS, SHOWN_FRAME
from .versioned import GroupKind, node_group

#: the input that holds a path
FILES = "Files"

_INPUTS = (
    Plug(
        FILES, "NodeSocketString", "",
        "Baked points over the bed, up to the number of the frame; empty where it is live",
    ),
    *FRAME_INPUTS,
    *SCALE_INPUTS,
    Plug(
        "Warn Out of Range", "NodeSocketBool", False,
        "Show a warning at frames without a file. The last one before, or else the first, is held either way",
    ),
    *ABSENCE_INPUTS,
)  # fmt: skip
_NUMBERS = (FOAM, CUSP, BREAKING, FOAM_AGE)


def _build(tree: bpy.types.NodeTree) -> None:
    build = Builder(tree, _INPUTS)
    geometry = build.given("Geometry")
    live = held_still(build, geometry, "The coast stands still as it was in frame", LIVE_REMEDY)
    is_baked = is_given(build, build.given(FILES))
    build.finish(build.switch("GEOMETRY", is_baked, live, _moved(build, geometry)))


def _moved(build: Builder, geometry: Socket) -> Socket:
    """The mesh moved by the points of the frame; at rest where these are missing, which Blender tells."""
    frame = build.group(node_group(SHOWN_FRAME), {name: build.given(name) for name, *_ in FRAME_INPUTS})
    points = point_file(build, build.given(FILES), output(frame, "Frame"))
    count = output(build.add("GeometryNodeAttributeDomainSize", {"Geometry": points}), "Point Count")
    index = output(build.add("GeometryNodeInputIndex"), "Index")
    position = output(build.add("GeometryNodeInputPosition"), "Position")

    def told(value: Socket, data_type: str) -> Socket:
        return sample_index(build, points, value, index, data_type)

    place = build.scaled(told(position, "FLOAT_VECTOR"), build.given("Scale"))
    velocity = combined(build, *(column(build, name) for name in CHANNELS["velocity"].columns))
    velocity = build.scaled(told(velocity, "FLOAT_VECTOR"), build.given("Velocity Scale"))
    displacement = moved_on(
        build, build.vector("SUBTRACT", place, position), velocity, output(frame, "Seconds")
    )
    result = build.store(geometry, DISPLACEMENT, displacement, "FLOAT_VECTOR")
    result = build.store(result, VELOCITY, velocity, "FLOAT_VECTOR")
    for name in _NUMBERS:
        result = build.store(result, name, told(column(build, name), "FLOAT"), "FLOAT")
    stored = output(named_attribute(build, DISPLACEMENT, "FLOAT_VECTOR"), "Attribute")
    result = build.change("GeometryNodeSetPosition", result, {"Offset": stored})
    result = build.switch("GEOMETRY", build.compare("GREATER_THAN", count, 0), geometry, result)
    warnings = build.group(
        node_group(WARNINGS),
        {
            "Scene Frame": output(frame, "Scene Frame"),
            "Frame": output(frame, "Frame"),
            "Is Held": build.logic("AND", output(frame, "Is Held"), build.given("Warn Out of Range")),
        },
    )
    # nobody asks a group for its warnings unless something hangs on them
    return build.switch("GEOMETRY", output(warnings, "Warning"), result, result)


COAST = GroupKind("Ocean Tweak Coast", 2, _build)
