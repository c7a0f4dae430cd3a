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

from ..nodes.camera_surface import CAMERA_SURFACE
from ..nodes.modifier_inputs import get_input, set_input
from ..nodes.solid_foam import MATERIAL_INPUT, SOLID_FOAM
from ..nodes.versioned import GroupKind, is_of_kind, node_group

#: the water's material that a copy follows
_OF = "ocean_tweak_foam_of"
#: lamps of the Solid view make a grey of 1
_WHITE = (1.7, 1.7, 1.7, 1.0)
_NAME = "Foam in Solid View"
#: of a material, what the copy has of its own
_OWN = {"name", "use_nodes", "diffuse_color", "roughness", "use_fake_user", "tag", "preview_render_type"}
_PLAIN = {"BOOLEAN", "INT", "FLOAT", "ENUM", "STRING"}
#: of a node, what has settings of its own
_PARTS = ("image_user", "color_ramp", "mapping", "texture_mapping", "color_mapping")
#: what a change of is one that copies, or objects that show them, may have to follow
_FOLLOWED = ("MATERIAL", "OBJECT", "MESH")


class _Value(NamedTuple):
    """A setting of a material, where it is and what it is."""

    owner: Any
    name: str
    value: Any


def show(item: bpy.types.Object, water: bpy.types.Material) -> None:
    """Let an object with this water show its foam in the Solid view."""
    modifier = _modifier_of(item, SOLID_FOAM)
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
    """Let copies follow their materials, and objects show those of their own, a moment after one was changed
    or exchanged: only a window shows them."""
    if (
        not bpy.app.background
        and any(map(depsgraph.id_type_updated, _FOLLOWED))
        and not bpy.app.timers.is_registered(mend)
    ):
        bpy.app.timers.register(mend, first_interval=0.0)


def mend() -> None:
    """Bring the copies into step with their materials, and objects with the material that they have now."""
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
    # whatever else may be changed of an override, this is its library's matter
    for item in [each for each in bpy.data.objects if each.library is None and each.override_library is None]:
        modifier = _modifier_of(item, SOLID_FOAM)
        if modifier is not None:
            _follow_material(item, modifier)


def _follow_material(item: bpy.types.Object, modifier: bpy.types.NodesModifier) -> None:
    """Let an object's foam be a copy of the material that it has now."""
    copy, water = get_input(modifier, MATERIAL_INPUT), _water_of(item)
    if water is None and copy is not None:
        set_input(modifier, MATERIAL_INPUT, None)
    elif water is not None and (copy is None or copy.get(_OF) != water):
        show(item, water)


def _water_of(item: bpy.types.Object) -> bpy.types.Material | None:
    """The material of an ocean, or of a surface around a camera."""
    around = _modifier_of(item, CAMERA_SURFACE)
    if around is not None:
        return get_input(around, "Material")
    return item.material_slots[0].material if item.material_slots else None


def _modifier_of(item: bpy.types.Object, kind: GroupKind) -> bpy.types.NodesModifier | None:
    found = (each for each in item.modifiers if each.type == "NODES")
    return next((each for each in found if is_of_kind(each.node_group, kind)), None)


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
    nodes = [
        (node.name, node.bl_idname, getattr(node, "node_tree", None), _stops(node), _points(node))
        for node in tree.nodes
    ]
    links = [(link.from_socket.path_from_id(), link.to_socket.path_from_id()) for link in tree.links]
    drivers = [] if tree.animation_data is None else list(tree.animation_data.drivers)
    driven = [(each.data_path, each.array_index, each.driver.expression, _read(each)) for each in drivers]
    return nodes, sorted(links), sorted(driven, key=lambda each: each[:2])


def _stops(node: bpy.types.Node) -> list[tuple[Any, ...]]:
    """Of a color ramp, which sorts them while they are set."""
    ramp = getattr(node, "color_ramp", None)
    return [] if ramp is None else [(each.position, *each.color) for each in ramp.elements]


def _points(node: bpy.types.Node) -> list[list[tuple[Any, ...]]]:
    """Of curves, which would have to be reckoned anew."""
    mapping = getattr(node, "mapping", None)
    curves = [] if mapping is None else mapping.curves
    return [[(*point.location, point.handle_type) for point in curve.points] for curve in curves]


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
        yield from _pointers(node)
        for part in (getattr(node, name, None) for name in _PARTS):
            yield from _plain(part, set()) if part is not None else ()
        for socket in (*node.inputs, *node.outputs):
            if hasattr(socket, "default_value") and socket.path_from_id("default_value") not in driven:
                yield _Value(socket, "default_value", _as_plain(socket.default_value))


def _plain(owner: Any, without: set[str]) -> Iterator[_Value]:
    for known in owner.bl_rna.properties:
        if known.type in _PLAIN and not known.is_readonly and known.identifier not in without:
            yield _Value(owner, known.identifier, _as_plain(getattr(owner, known.identifier)))


def _pointers(node: bpy.types.Node) -> Iterator[_Value]:
    """Images, objects and what else of the file a node reads."""
    for known in node.bl_rna.properties:
        if known.type == "POINTER" and not known.is_readonly and _is_of_file(known.fixed_type):
            yield _Value(node, known.identifier, getattr(node, known.identifier))


def _is_of_file(struct: bpy.types.Struct) -> bool:
    return struct.identifier == "ID" or (struct.base is not None and _is_of_file(struct.base))


def _as_plain(value: Any) -> Any:
    return tuple(value) if hasattr(value, "__len__") and not isinstance(value, (str, set)) else value
