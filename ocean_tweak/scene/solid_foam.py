# SPDX-License-Identifier: GPL-3.0-or-later
"""Foam in the Solid view, which knows no shaders but one color a material: faces that foam covers have a copy
of the water's material whose color there is white.

A modifier of the viewport alone gives it to them, so that a render does not know of it. In the viewport's own
renders the copy looks as the water does, since it follows what is changed on that.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import bpy

from ..nodes.modifier_inputs import get_input, set_input
from ..nodes.solid_foam import MATERIAL_INPUT, SOLID_FOAM
from ..nodes.versioned import is_of_kind, node_group

#: the water's material that a copy follows
_OF = "ocean_tweak_foam_of"
_WHITE = (1.0, 1.0, 1.0, 1.0)
_NAME = "Foam in Solid View"
#: of a material, what the copy has of its own
_OWN = {"name", "use_nodes", "diffuse_color", "roughness", "use_fake_user", "tag", "preview_render_type"}
_PLAIN = {"BOOLEAN", "INT", "FLOAT", "ENUM", "STRING"}


class _Value(NamedTuple):
    """A setting of a material, where it is and what it is."""

    owner: Any
    name: str
    value: Any


def show(item: bpy.types.Object, water: bpy.types.Material) -> None:
    """Let an object with this water show its foam in the Solid view."""
    found = (each for each in item.modifiers if each.type == "NODES")
    modifier = next((each for each in found if is_of_kind(each.node_group, SOLID_FOAM)), None)
    if modifier is None:
        modifier = item.modifiers.new(_NAME, "NODES")
        modifier.node_group = node_group(SOLID_FOAM)
        modifier.show_render = False
    copy = _copy_of(water)
    if get_input(modifier, MATERIAL_INPUT) != copy:
        set_input(modifier, MATERIAL_INPUT, copy)


def is_copy(material: bpy.types.Material) -> bool:
    """Whether a material follows a water's, in which all is done that it shall show."""
    return _OF in material


def follow(depsgraph: bpy.types.Depsgraph) -> None:
    """Let copies follow their materials, a moment after one was changed: only a window shows them."""
    if (
        not bpy.app.background
        and depsgraph.id_type_updated("MATERIAL")
        and not bpy.app.timers.is_registered(mend)
    ):
        bpy.app.timers.register(mend, first_interval=0.0)


def mend() -> None:
    """Bring the copies into step with their materials."""
    for copy in [each for each in bpy.data.materials if each.library is None and is_copy(each)]:
        water = copy[_OF]
        if not isinstance(water, bpy.types.Material):
            continue
        if _structure(copy) != _structure(water):
            del copy[_OF]
            copy.user_remap(_new_copy(water))
            bpy.data.materials.remove(copy)
            continue
        for own, value in zip(_values(copy), _values(water), strict=True):
            if own.value != value.value:
                setattr(own.owner, own.name, value.value)


def _copy_of(water: bpy.types.Material) -> bpy.types.Material:
    known = (each for each in bpy.data.materials if each.library is None and each.get(_OF) == water)
    return next(known, None) or _new_copy(water)


def _new_copy(water: bpy.types.Material) -> bpy.types.Material:
    copy = water.copy()
    for key in [name for name in dict(copy) if name.startswith("ocean_tweak")]:  # it is no water to choose
        del copy[key]
    copy.name, copy[_OF] = f"{water.name} {_NAME}", water
    copy.diffuse_color = _WHITE
    return copy


def _structure(material: bpy.types.Material) -> tuple[Any, ...]:
    """What of a material's nodes can only be copied as a whole."""
    tree = material.node_tree
    if tree is None:
        return ()
    nodes = [(node.name, node.bl_idname, getattr(node, "node_tree", None)) for node in tree.nodes]
    links = [(link.from_socket.path_from_id(), link.to_socket.path_from_id()) for link in tree.links]
    drivers = [] if tree.animation_data is None else list(tree.animation_data.drivers)
    driven = [(each.data_path, each.array_index, each.driver.expression, _read(each)) for each in drivers]
    return nodes, sorted(links), sorted(driven, key=lambda each: each[:2])


def _read(curve: bpy.types.FCurve) -> list[tuple[Any, ...]]:
    """What a driver reads."""
    return [
        (variable.name, variable.type, target.id, target.data_path)
        for variable in curve.driver.variables
        for target in variable.targets
    ]


def _values(material: bpy.types.Material) -> Iterator[_Value]:
    """Settings that a copy takes over one by one, in the same order for materials of one structure."""
    yield from _plain(material, _OWN)
    yield from _plain(material.cycles, set())
    tree = material.node_tree
    if tree is None:
        return
    drivers = () if tree.animation_data is None else tree.animation_data.drivers
    driven = {curve.data_path for curve in drivers}
    for node in tree.nodes:
        yield from _plain(node, set(bpy.types.Node.bl_rna.properties.keys()))
        for socket in (*node.inputs, *node.outputs):
            if hasattr(socket, "default_value") and socket.path_from_id("default_value") not in driven:
                yield _Value(socket, "default_value", _as_plain(socket.default_value))


def _plain(owner: Any, without: set[str]) -> Iterator[_Value]:
    for known in owner.bl_rna.properties:
        if known.type in _PLAIN and not known.is_readonly and known.identifier not in without:
            yield _Value(owner, known.identifier, _as_plain(getattr(owner, known.identifier)))


def _as_plain(value: Any) -> Any:
    return tuple(value) if hasattr(value, "__len__") and not isinstance(value, (str, set)) else value
