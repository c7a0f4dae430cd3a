# SPDX-License-Identifier: GPL-3.0-or-later
"""The part of a live ocean that is saved: the sea that a Blender without the extension shows.

Everything else is recomputed when the file is opened. It is removed from the ocean's mesh while a file is
written; objects around a camera are run-time data, which Blender does not save.
"""

from __future__ import annotations

import bpy

from ..core.numerics.rounding import rounded
from ..nodes.modifier_inputs import set_inputs
from ..nodes.versioned import GroupKind, is_of_kind, node_group
from . import vertex_attributes
from .modifiers import is_of_library, set_changed
from .vertex_attributes import Fields

#: what of a surface a sea that stands still is drawn with: its normals are the mesh's, and it has no velocity
_HELD = ("displacement", "foam", "cusp", "breaking", "foam_age")
#: of the root mean square; 0.1 mm in waves of two metres
_PRECISION = 1.0 / 4096.0

# what the meshes had before the save that is under way, by session uid
_before: dict[int, Fields] = {}


def held(fields: Fields) -> Fields:
    """What a file keeps of a surface, with as many digits as are seen."""
    return {name: rounded(fields[name], _PRECISION) for name in _HELD if name in fields}


def leave_out(mesh: bpy.types.Mesh) -> None:
    """Let a mesh with a live surface have only what a file keeps of it, until `take_back`."""
    if mesh.session_uid not in _before:  # or a linked duplicate has been here
        found = vertex_attributes.read(mesh)
        _before[mesh.session_uid] = found
        vertex_attributes.write(mesh, held(found))


def take_back() -> None:
    """Give the meshes the whole surfaces again."""
    for mesh in bpy.data.meshes if _before else ():
        if mesh.session_uid in _before:
            vertex_attributes.write(mesh, _before[mesh.session_uid])
    _before.clear()


def keep_out(item: bpy.types.Object, is_out: bool) -> None:
    """Let an object and its mesh be run-time data, which files are without, or take them in again."""
    for each in (item, item.data):
        if each.library is None and each.override_library is None:
            set_changed(each, is_runtime_data=is_out)


def tell(item: bpy.types.Object, kind: GroupKind, frame: int) -> None:
    """Let an object whose mesh was written for a frame say so where the extension is missing.

    kind : with INPUTS of `nodes.extension_check`
    """
    set_inputs(modifier_of(item, kind), {"Live": True, "Held Frame": frame})


def say_nothing(item: bpy.types.Object, kind: GroupKind) -> None:
    """Let a linked object say nothing: its group cannot know that the extension runs. This is not saved."""
    for modifier in _modifiers_of(item, kind):
        set_inputs(modifier, {"Live": False})


def _modifiers_of(item: bpy.types.Object, kind: GroupKind) -> list[bpy.types.Modifier]:
    return [each for each in item.modifiers if each.type == "NODES" and is_of_kind(each.node_group, kind)]


def drop(item: bpy.types.Object, kind: GroupKind) -> None:
    """Remove the modifiers of a kind; that of a library is switched off."""
    for modifier in _modifiers_of(item, kind):
        if is_of_library(modifier):
            set_changed(modifier, show_viewport=False, show_render=False)
        else:
            item.modifiers.remove(modifier)


def modifier_of(item: bpy.types.Object, kind: GroupKind) -> bpy.types.Modifier:
    """The modifier of a kind, made where there is none. In an override that of the library is replaced, as
    its group is linked."""
    found = _modifiers_of(item, kind)
    for modifier in found:
        if is_of_library(modifier):
            set_changed(modifier, show_viewport=False, show_render=False)
    own = [modifier for modifier in found if not is_of_library(modifier)]
    if own:
        if own[0].node_group != node_group(kind):
            own[0].node_group = node_group(kind)
        return own[0]
    modifier = item.modifiers.new(kind.name, "NODES")
    modifier.node_group = node_group(kind)
    return modifier
