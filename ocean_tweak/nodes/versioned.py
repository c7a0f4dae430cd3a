# SPDX-License-Identifier: GPL-3.0-or-later
"""Node groups of this extension, identified by a tag instead of their name."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import bpy

from ..core.data.formats import NewerFormatError

_KEY = "ocean_tweak_group"
# layout of nodes: distances, and number per column
_WIDE, _HIGH, _IN_COLUMN = 180, 160, 6


@dataclass(frozen=True)
class GroupKind:
    """One node group that the extension can build.

    name : shown to the user
    version : raised whenever `build` changes, so that groups from older files are recognised
    build : fills an empty group with sockets and nodes
    tree_type : GeometryNodeTree or ShaderNodeTree
    """

    name: str
    version: int
    build: Callable[[bpy.types.NodeTree], None]
    tree_type: str = "GeometryNodeTree"

    @property
    def tag(self) -> str:
        """The value of the group's custom property."""
        return f"{self.name} {self.version}"


def node_group(kind: GroupKind) -> bpy.types.NodeTree:
    """The file's group of this kind and version, created if missing.

    Raises NewerFormatError if the file has one of a newer version.
    """
    own = [group for group in bpy.data.node_groups if group.library is None and is_of_kind(group, kind)]
    for group in own:
        if group[_KEY] == kind.tag:
            return group
    check_not_newer(own, kind)
    group = bpy.data.node_groups.new(kind.name, kind.tree_type)
    kind.build(group)
    lay_out(group)
    group[_KEY] = kind.tag
    return group


def lay_out(tree: bpy.types.NodeTree) -> None:
    """Arrange a tree's nodes in columns, in the order of their creation.

    All at once, as Blender traverses the whole tree whenever a node is moved.
    """
    places = [
        (_WIDE * (number // _IN_COLUMN), -_HIGH * (number % _IN_COLUMN)) for number in range(len(tree.nodes))
    ]
    tree.nodes.foreach_set("location", [float(along) for place in places for along in place])


def beside(node: bpy.types.Node, number: int) -> tuple[float, float]:
    """Position of a node to the left of the one that it is linked to, below its siblings."""
    return node.location.x - _WIDE, node.location.y - _HIGH * number


def kind_name(group: bpy.types.NodeTree | None) -> str:
    """The name of a group's kind, in any version; "" for other groups."""
    return str(group.get(_KEY, "")).rpartition(" ")[0] if group is not None else ""


def is_of_kind(group: bpy.types.NodeTree | None, kind: GroupKind) -> bool:
    """Whether a group is of this kind, in any version."""
    return kind_name(group) == kind.name


def is_stale(group: bpy.types.NodeTree | None, kind: GroupKind) -> bool:
    """Whether a group is of this kind, but of an older version."""
    return group is not None and is_of_kind(group, kind) and _version(group) < kind.version


def check_not_newer(groups: Iterable[bpy.types.NodeTree], kind: GroupKind) -> None:
    """Raise NewerFormatError if a group of this kind has a newer version."""
    newest = max((_version(group) for group in groups if is_of_kind(group, kind)), default=0)
    if newest > kind.version:
        raise NewerFormatError(f"node group {kind.name}", newest, kind.version)


def _version(group: bpy.types.NodeTree) -> int:
    number = str(group[_KEY]).rpartition(" ")[2]
    return int(number) if number.isdecimal() else 0
