# SPDX-License-Identifier: GPL-3.0-or-later
"""A node tree as text that can be read and compared: interface, nodes with what was set on them, links."""

import bpy

# where nodes stand and how they are drawn changes no result
_DRAWN = set(bpy.types.Node.bl_rna.properties.keys())


def tree_text(tree):
    """All of a tree that decides what it does."""
    lines = [f"{tree.bl_idname}: {tree.name}", "", "interface"]
    for item in tree.interface.items_tree:
        if item.item_type == "PANEL":
            lines.append(f"  panel {item.name}")
            continue
        panel = item.parent.name
        place = f"{panel} / " if panel else ""
        default = getattr(item, "default_value", None)
        shown = "" if default is None else f" = {_value(default)}"
        hidden = ", hidden" if item.hide_in_modifier else ""
        lines.append(f"  {item.in_out.lower()} {place}{item.name}: {item.socket_type}{shown}{hidden}")
    for node in tree.nodes:
        lines += ["", f"{node.name} ({node.bl_idname})", *_settings(node), *_inputs(node)]
    return "\n".join(lines) + "\n"


def _settings(node):
    for name, described in node.bl_rna.properties.items():
        if name in _DRAWN or described.is_readonly or described.type in ("COLLECTION",):
            continue
        value = getattr(node, name)
        if described.type == "POINTER":
            if value is not None:
                yield f"  {name}: {value.name}"
        elif value != described.default:
            yield f"  {name}: {_value(value)}"


def _inputs(node):
    for socket in node.inputs:
        if not socket.enabled:
            continue
        for link in socket.links:
            yield f"  {socket.name} <- {link.from_node.name} . {link.from_socket.name}"
        if not socket.links and getattr(socket, "default_value", None) is not None:
            yield f"  {socket.name} = {_value(socket.default_value)}"


def _value(value):
    if isinstance(value, float):
        return f"{value:.6g}"
    if hasattr(value, "__len__") and not isinstance(value, str):
        return "(" + ", ".join(f"{part:.6g}" for part in value) + ")"
    return repr(value)
