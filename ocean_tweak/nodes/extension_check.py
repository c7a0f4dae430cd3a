# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes that detect whether the extension, without which a live ocean does not move, is running.

While it runs, their group has an image that is never saved. In a file opened without the extension, the image
is missing: the modifier shows a warning, and Blender's console a line, once per session. A linked group
cannot have such an image; there, the extension marks the modifier's sea as not live. Nodes cannot print, but
Blender prints the name of a file that cannot be opened, and that name can be a sentence.
"""

from __future__ import annotations

import bpy

from .building import Builder, Plug, Socket, output
from .frame_warnings import joined_text
from .versioned import GroupKind, kind_name

_BEACON = ".Ocean Tweak Runs"
_NODE = "Beacon"
_LINE = "Ocean Tweak: live oceans stand still, as the extension does not run here; enable it, or bake them"
_STATE = "The sea stands still as it was in frame"
#: the end of what is said of what is live
LIVE_REMEDY = (
    "because it is live and the Ocean Tweak extension does not run here: enable the extension, or bake the "
    "ocean"
)

INPUTS = (
    Plug("Live", "NodeSocketBool", False, "The extension computes the sea of each frame", hidden=True),
    Plug("Held Frame", "NodeSocketInt", 1, "The frame whose sea the file was saved with", hidden=True),
)


def _build(tree: bpy.types.NodeTree) -> None:
    build = Builder(
        tree, INPUTS, (Plug("Is Absent", "NodeSocketBool", None, "Nothing will move a live sea"),)
    )
    build.finish_with({"Is Absent": is_absent(build, _STATE, LIVE_REMEDY)})


def is_absent(build: Builder, state: str, remedy: str) -> Socket:
    """Whether a group with INPUTS is live and nothing will move it; the modifier and the console then say so.

    state : what the message begins with, before the frame
    remedy : end of the message
    """
    information = build.add("GeometryNodeImageInfo", {"Image": _beacon()})
    information.name = _NODE
    dark = build.compare("EQUAL", output(information, "Width"), 0)
    absent = build.logic("AND", build.given("Live"), dark)
    message = joined_text(build, state, build.given("Held Frame"), remedy)
    warning = build.add("GeometryNodeWarning", {"Show": absent, "Message": message}, warning_type="WARNING")
    line = output(build.add("GeometryNodeImportCSV", {"Path": _LINE}), "Point Cloud")
    told = build.add("GeometryNodeSwitch", {"Switch": absent, "True": line}, input_type="GEOMETRY")
    size = build.add(
        "GeometryNodeAttributeDomainSize", {"Geometry": told.outputs["Output"]}, component="POINTCLOUD"
    )
    # warnings and files are only evaluated if the output depends on them
    rows = build.compare("GREATER_THAN", output(size, "Point Count"), 0)
    return build.logic("OR", output(warning, "Show"), rows)


ABSENCE = GroupKind("Ocean Tweak Absence", 2, _build)


def show_that_it_runs() -> None:
    """Tell the live oceans of the file that the extension is running, after a file is opened or appended."""
    for node in _beacon_nodes():
        if node.inputs["Image"].default_value is None:
            node.inputs["Image"].default_value = _beacon()


def show_that_it_ends() -> None:
    """Tell the live oceans of the file that the extension has stopped."""
    for node in _beacon_nodes():
        node.inputs["Image"].default_value = None
    image = bpy.data.images.get((_BEACON, None))
    if image is not None:
        bpy.data.images.remove(image)


def _beacon_nodes() -> list[bpy.types.Node]:
    # Blender discards changes to linked data
    groups = (group for group in bpy.data.node_groups if group.library is None and kind_name(group))
    return [group.nodes[_NODE] for group in groups if _NODE in group.nodes]


def _beacon() -> bpy.types.Image:
    image = bpy.data.images.get((_BEACON, None))
    if image is None:
        image = bpy.data.images.new(_BEACON, 1, 1)
        image.is_runtime_data = True
    return image
