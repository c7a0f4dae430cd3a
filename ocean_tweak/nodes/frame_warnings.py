# SPDX-License-Identifier: GPL-3.0-or-later
"""A node group that warns in the modifier about frames of a baked sequence without a file."""

from __future__ import annotations

import bpy

from .building import Builder, Input, Plug, Socket, output
from .versioned import GroupKind


def _build(tree: bpy.types.NodeTree) -> None:
    inputs = (
        ("Scene Frame", "NodeSocketInt", 1, "The scene's whole frame"),
        ("Frame", "NodeSocketInt", 1, "The frame whose file is shown"),
        ("Is Held", "NodeSocketBool", False, "Whether to tell that another frame is shown"),
        ("Is Missing", "NodeSocketBool", False, "Whether to tell that the frame's file cannot be read"),
    )
    outputs = (Plug("Warning", "NodeSocketBool", None, "Whether something is wrong"),)
    build = Builder(tree, inputs, outputs)
    held = joined_text(
        build,
        "Frame", build.given("Scene Frame"), "was not baked: frame", build.given("Frame"), "is held",
    )  # fmt: skip
    missing = joined_text(
        build,
        "The displacement image of frame", build.given("Frame"),
        "is missing or cannot be read, so the sea is flat: bake it again or choose other files",
    )  # fmt: skip
    shown = [
        output(build.add("GeometryNodeWarning", {"Show": show, "Message": text}, warning_type=kind), "Show")
        for show, text, kind in (
            (build.given("Is Held"), held, "WARNING"),
            (build.given("Is Missing"), missing, "ERROR"),
        )
    ]
    build.finish_with({"Warning": build.logic("OR", *shown)})


def joined_text(build: Builder, *words: Input) -> Socket:
    """Texts and whole numbers, joined by spaces."""
    join = build.add("GeometryNodeStringJoin", {"Delimiter": " "})
    strings = []
    for word in words:
        if isinstance(word, str):
            strings.append(output(build.add("FunctionNodeInputString", string=word), "String"))
        else:
            number = build.add("FunctionNodeValueToString", data_type="INT")
            build.tree.links.new(word, next(socket for socket in number.inputs if socket.enabled))
            strings.append(output(number, "String"))
    for string in reversed(strings):  # the last link comes first
        build.tree.links.new(string, join.inputs["Strings"])
    return output(join, "String")


WARNINGS = GroupKind("Ocean Tweak Warnings", 2, _build)
