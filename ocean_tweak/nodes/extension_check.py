# SPDX-License-Identifier: GPL-3.0-or-later
"""A node group that tells a live ocean whether the extension, which alone moves it, runs here.

While it runs, the group holds an image that no file keeps. In a file that is opened without the extension the
image is gone: the modifier warns, and Blender's console has a line, once a session. A linked group cannot
hold such an image; where it runs, the extension tells the modifier that its sea is not live.
Nodes cannot print, but a file that cannot be opened is told there with its name, which may be a sentence.
"""

from __future__ import annotations

import bpy

from .building import Builder, Plug, output
from .frame_warnings import joined_text
from .versioned import GroupKind, is_of_kind

_BEACON = ".Ocean Tweak Runs"
_NODE = "Beacon"
_LINE = "Ocean Tweak: live oceans stand still, as the extension does not run here; enable it, or bake them"

INPUTS = (
    Plug("Live", "NodeSocketBool", False, "The extension computes the sea of each frame", hidden=True),
    Plug("Held Frame", "NodeSocketInt", 1, "The frame whose sea the file was saved with", hidden=True),
)


def _build(tree: bpy.types.NodeTree) -> None:
    build = Builder(
        tree, INPUTS, (Plug("Is Absent", "NodeSocketBool", None, "Nothing will move a live sea"),)
    )
    information = build.add("GeometryNodeImageInfo", {"Image": _beacon()})
    information.name = _NODE
    dark = build.compare("EQUAL", output(information, "Width"), 0)
    absent = build.logic("AND", build.given("Live"), dark)
    message = joined_text(
        build,
        "The sea stands still as it was in frame", build.given("Held Frame"),
        "because it is live and the Ocean Tweak extension does not run here: enable the "
        "extension, or bake the ocean",
    )  # fmt: skip
    warning = build.add("GeometryNodeWarning", {"Show": absent, "Message": message}, warning_type="WARNING")
    line = output(build.add("GeometryNodeImportCSV", {"Path": _LINE}), "Point Cloud")
    told = build.add("GeometryNodeSwitch", {"Switch": absent, "True": line}, input_type="GEOMETRY")
    size = build.add(
        "GeometryNodeAttributeDomainSize", {"Geometry": told.outputs["Output"]}, component="POINTCLOUD"
    )
    # nobody asks for warnings or files unless something hangs on them
    rows = build.compare("GREATER_THAN", output(size, "Point Count"), 0)
    build.finish_with({"Is Absent": build.logic("OR", output(warning, "Show"), rows)})


ABSENCE = GroupKind("Ocean Tweak Absence", 2, _build)


def show_that_it_runs() -> None:
    """Let the live oceans of the file know that the extension runs: after a file is opened or appended."""
    for node in _beacon_nodes():
        if node.inputs["Image"].default_value is None:
            node.inputs["Image"].default_value = _beacon()


def show_that_it_ends() -> None:
    """Let the live oceans of the file know that nobody moves them any more."""
    for node in _beacon_nodes():
        node.inputs["Image"].default_value = None
    image = bpy.data.images.get((_BEACON, None))
    if image is not None:
        bpy.data.images.remove(image)


def _beacon_nodes() -> list[bpy.types.Node]:
    # Blender drops changes to what is linked
    groups = (group for group in bpy.data.node_groups if group.library is None and is_of_kind(group, ABSENCE))
    return [group.nodes[_NODE] for group in groups if _NODE in group.nodes]


def _beacon() -> bpy.types.Image:
    image = bpy.data.images.get((_BEACON, None))
    if image is None:
        image = bpy.data.images.new(_BEACON, 1, 1)
        image.is_runtime_data = True
    return image
