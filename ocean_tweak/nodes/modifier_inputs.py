# SPDX-License-Identifier: GPL-3.0-or-later
"""Inputs of a geometry nodes modifier by name, in Blender 4.5 and 5.x."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

import bpy

_NOT_VALUES = {"NodeSocketGeometry"}


def input_sockets(group: bpy.types.NodeTree) -> dict[str, bpy.types.NodeTreeInterfaceSocket]:
    """The inputs of a group by name, without the geometry."""
    return {
        item.name: item
        for item in group.interface.items_tree
        if getattr(item, "in_out", "") == "INPUT" and item.socket_type not in _NOT_VALUES
    }


def _identifiers(modifier: bpy.types.NodesModifier) -> dict[str, str]:
    return {name: socket.identifier for name, socket in input_sockets(modifier.node_group).items()}


def set_inputs(modifier: bpy.types.NodesModifier, values: Mapping[str, Any]) -> None:
    """Set inputs that differ; KeyError if the group has no input of a name."""
    identifiers = _identifiers(modifier)
    for name, value in values.items():
        identifier = identifiers[name]
        if _get(modifier, identifier) == value:
            continue
        if hasattr(modifier, "properties"):  # 5.x
            getattr(modifier.properties.inputs, identifier).value = value
        else:
            modifier[identifier] = value


def set_input(modifier: bpy.types.NodesModifier, name: str, value: Any) -> None:
    """Set an input if it differs; KeyError if the group has no input of that name."""
    set_inputs(modifier, {name: value})


def get_input(modifier: bpy.types.NodesModifier, name: str) -> Any:
    """The value of an input; KeyError if the group has no input of that name."""
    socket = modifier.node_group.interface.items_tree.get(name)  # much faster than looking at all of them
    if getattr(socket, "in_out", "") == "INPUT":
        return _get(modifier, socket.identifier)
    return _get(modifier, _identifiers(modifier)[name])


def all_inputs(modifier: bpy.types.NodesModifier) -> dict[str, Any]:
    """The values of all inputs by name, without the geometry."""
    return {name: _get(modifier, identifier) for name, identifier in _identifiers(modifier).items()}


def reads(item: bpy.types.Object, others: Collection[bpy.types.Object]) -> bool:
    """Whether a modifier of an object has one of others as an input."""
    nodes = (each for each in item.modifiers if each.type == "NODES" and each.node_group is not None)
    return any(other in all_inputs(modifier).values() for modifier in nodes for other in others)


def input_property(modifier: bpy.types.NodesModifier, name: str) -> tuple[Any, str]:
    """The owner and the name of an input's property, for drawing in a panel."""
    identifier = _identifiers(modifier)[name]
    if hasattr(modifier, "properties"):  # 5.x
        return getattr(modifier.properties.inputs, identifier), "value"
    return modifier, f'["{identifier}"]'


def _get(modifier: bpy.types.NodesModifier, identifier: str) -> Any:
    if hasattr(modifier, "properties"):  # 5.x
        return getattr(modifier.properties.inputs, identifier).value
    return modifier.get(identifier)
