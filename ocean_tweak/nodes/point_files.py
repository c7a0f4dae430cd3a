# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes that read baked points, a PLY file a frame."""

from __future__ import annotations

from .building import Builder, Socket, output
from .fields import named_attribute


def point_file(build: Builder, files: Socket, frame: Socket) -> Socket:
    """The points of a frame's file.

    files : its path up to the number
    """
    path = build.add("FunctionNodeFormatString", {"Format": "{files}{frame:04}.ply"})
    for kind, name, value in (("STRING", "files", files), ("INT", "frame", frame)):
        path.format_items.new(kind, name)
        build.tree.links.new(value, path.inputs[name])
    return output(build.add("GeometryNodeImportPLY", {"Path": output(path, "String")}), "Mesh")


def is_given(build: Builder, text: Socket) -> Socket:
    """Whether a text is not empty."""
    length = output(build.add("FunctionNodeStringLength", {"String": text}), "Length")
    return build.compare("GREATER_THAN", length, 0)


def column(build: Builder, name: str) -> Socket:
    """A column of points."""
    return output(named_attribute(build, name, "FLOAT"), "Attribute")
