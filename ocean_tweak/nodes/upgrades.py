# SPDX-License-Identifier: GPL-3.0-or-later
"""Replaces node groups of older versions where they are used."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

import bpy

from ..core.data.formats import NewerFormatError
from .modifier_inputs import all_inputs, input_sockets, set_inputs
from .versioned import GroupKind, check_not_newer, is_stale, node_group


def upgrade_groups(kinds: Iterable[GroupKind]) -> bool:
    """Replace older versions of groups by the present one, on modifiers and inside other groups.

    Newer groups are kept, and reported when their oceans are shown. Inputs and links are kept by name if the
    type of the socket is the same; new inputs get their defaults. Returns whether any group was replaced.
    """
    kinds = tuple(kinds)
    own = [group for group in bpy.data.node_groups if group.library is None]
    try:
        for kind in kinds:
            check_not_newer(own, kind)
    except NewerFormatError:
        return False
    stale = {group: kind for group in own for kind in kinds if is_stale(group, kind)}
    if not stale:
        return False
    for item in bpy.data.objects:
        for modifier in item.modifiers if item.library is None else ():
            if modifier.type == "NODES" and modifier.node_group in stale:
                _renew_modifier(modifier, node_group(stale[modifier.node_group]))
        item.update_tag()
    for tree in list(_editable_trees()):
        for node in [node for node in tree.nodes if getattr(node, "node_tree", None) in stale]:
            _renew_node(tree, node, node_group(stale[node.node_tree]))
    for group in [group for group in stale if group.users == 0]:
        bpy.data.node_groups.remove(group)
    return True


def _renew_modifier(modifier: bpy.types.NodesModifier, group: bpy.types.NodeTree) -> None:
    before, values = input_sockets(modifier.node_group), all_inputs(modifier)
    modifier.node_group = group
    after = input_sockets(group)
    # all of them, as Blender keeps values by the index of a socket, which may have changed
    set_inputs(modifier, {name: socket.default_value for name, socket in after.items()})
    kept = {name for name in after if name in before and before[name].socket_type == after[name].socket_type}
    set_inputs(modifier, {name: values[name] for name in kept})


def _editable_trees() -> Iterator[bpy.types.NodeTree]:
    yield from (group for group in bpy.data.node_groups if group.library is None)
    for owners in (bpy.data.materials, bpy.data.worlds):
        yield from (item.node_tree for item in owners if item.library is None and item.node_tree)


def _renew_node(tree: bpy.types.NodeTree, node: bpy.types.Node, group: bpy.types.NodeTree) -> None:
    incoming = [(socket.name, link.from_socket) for socket in node.inputs for link in socket.links]
    outgoing = [(socket.name, link.to_socket) for socket in node.outputs for link in socket.links]
    values = {
        socket.name: (socket.type, _plain(socket.default_value))
        for socket in node.inputs
        if hasattr(socket, "default_value")
    }
    node.node_tree = group
    for link in [*(link for socket in node.inputs for link in socket.links),
                 *(link for socket in node.outputs for link in socket.links)]:  # fmt: skip
        tree.links.remove(link)
    for socket in node.inputs:
        kind, value = values.get(socket.name, (None, None))
        if kind == socket.type:
            socket.default_value = value
        elif hasattr(socket, "default_value") and socket.name in input_sockets(group):
            socket.default_value = input_sockets(group)[socket.name].default_value
    inputs, outputs = ({socket.name: socket for socket in sockets} for sockets in (node.inputs, node.outputs))
    for name, other in incoming:
        if name in inputs:
            tree.links.new(other, inputs[name])
    for name, other in outgoing:
        if name in outputs:
            tree.links.new(outputs[name], other)


def _plain(value: Any) -> Any:
    """A value that outlives its socket."""
    return tuple(value) if hasattr(value, "__len__") and not isinstance(value, str) else value
