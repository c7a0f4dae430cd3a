# SPDX-License-Identifier: GPL-3.0-or-later
"""Inputs of a geometry nodes modifier by their name, in Blender 4.5 and 5.x."""

from __future__ import annotations

from typing import Any

import bpy


def _identifiers(modifier: bpy.types.NodesModifier) -> dict[str, str]:
    items = modifier.node_group.interface.items_tree
    return {item.name: item.identifier for item in items if getattr(item, "in_out", "") == "INPUT"}


def set_input(modifier: bpy.types.NodesModifier, name: str, value: Any) -> None:
    """Set an input where it differs; KeyError when the group has none of that name."""
    identifier = _identifiers(modifier)[name]
    if get_input(modifier, name) == value:
        return
    if hasattr(modifier, "properties"):  # 5.x
        getattr(modifier.properties.inputs, identifier).value = value
    else:
        modifier[identifier] = value


def get_input(modifier: bpy.types.NodesModifier, name: str) -> Any:
    """The value of an input; KeyError when the group has none of that name."""
    identifier = _identifiers(modifier)[name]
    if hasattr(modifier, "properties"):  # 5.x
        return getattr(modifier.properties.inputs, identifier).value
    return modifier.get(identifier)
