# SPDX-License-Identifier: GPL-3.0-or-later
"""Repeat zones, and joining of geometries."""

from __future__ import annotations

from collections.abc import Mapping

import bpy

from .building import Builder, Socket


def repeated(build: Builder, kinds: Mapping[str, str]) -> tuple[bpy.types.Node, bpy.types.Node]:
    """Both ends of a repeat zone that passes on values of these names and socket types."""
    end = build.add("GeometryNodeRepeatOutput")
    end.repeat_items.clear()
    for name, kind in kinds.items():
        end.repeat_items.new(kind, name)
    begin = build.add("GeometryNodeRepeatInput")
    begin.pair_with_output(end)
    return begin, end


def joined(build: Builder, first: Socket, second: Socket) -> Socket:
    """Both geometries as one, in this order."""
    node = build.add("GeometryNodeJoinGeometry")
    # of several links on one socket, Blender joins the last one first
    for geometry in (second, first):
        build.tree.links.new(geometry, node.inputs[0])
    return node.outputs[0]
