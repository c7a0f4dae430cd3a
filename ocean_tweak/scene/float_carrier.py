# SPDX-License-Identifier: GPL-3.0-or-later
"""Carriers: hidden helpers that take floating objects to the surface.

A carrier is a small triangle with its object's parent, transform, animation and constraints. Its node group
moves it onto the surface, and constraints take the object there. The object's own transform remains as set by
the user; `follow` updates the carriers from it. An object cannot be the carrier itself, nor drive one, as
that would be a dependency cycle.

Carriers are in no collection, so users do not see, select or delete them, and Blender evaluates them because
their objects depend on them.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import bpy

from ..nodes.floating import CARRIER, TRANSFORM
from ..nodes.modifier_inputs import set_input
from ..nodes.versioned import is_of_kind, node_group
from . import float_keys

#: of the modifiers and constraints
NAME = "Float on Ocean"
# values of the custom property by which helpers are recognised, whatever their names
_KEY = "ocean_tweak_float_part"
_CARRIER, _RIDER = "follower", "rider"
_VISIBLE = "carrier"  # of files in which the carrier was what one moved
_HALF = 0.5  # of a triangle's first side, Blender units
_PLACE = (
    "parent", "parent_type", "parent_bone", "parent_vertices", "matrix_parent_inverse", "rotation_mode",
    "location", "rotation_euler", "rotation_quaternion", "rotation_axis_angle",
    "delta_location", "delta_rotation_euler", "delta_rotation_quaternion",
)  # fmt: skip
#: of a constraint, that say nothing about what it does
_DRAWN = {"active", "show_expanded"}


def is_carrier(item: bpy.types.Object | None) -> bool:
    """Whether an object is a carrier."""
    return item is not None and item.get(_KEY) in (_CARRIER, _VISIBLE)


def carrier_of(item: bpy.types.Object) -> bpy.types.Object | None:
    """The carrier of a floating object; None for one that does not float, or whose carrier was deleted."""
    for constraint in own_constraints(item):
        target = constraint.target
        carrier = target.parent if target.get(_KEY) == _RIDER else target
        if is_carrier(carrier):
            return carrier
    return None


def own_constraints(item: bpy.types.Object) -> list[bpy.types.Constraint]:
    """The constraints that take an object to its carrier."""
    return [each for each in item.constraints if _KEY in (getattr(each, "target", None) or ())]


def carried_by(carrier: bpy.types.Object) -> Iterator[bpy.types.Object]:
    """The objects that float with a carrier."""
    return (item for item in bpy.data.objects if carrier_of(item) == carrier)


def modifier_of(carrier: bpy.types.Object) -> bpy.types.NodesModifier | None:
    """The modifier of a carrier; None if it was removed."""
    return next(
        (each for each in carrier.modifiers if each.type == "NODES" and is_of_kind(each.node_group, CARRIER)),
        None,
    )


def set_inputs(carrier: bpy.types.Object, values: dict[str, Any]) -> None:
    """Set the inputs of a carrier's node group."""
    modifier = modifier_of(carrier)
    if modifier is None:
        modifier = carrier.modifiers.new(NAME, "NODES")
        modifier.node_group = node_group(CARRIER)
    for name, value in values.items():
        set_input(modifier, name, value)
    carrier.update_tag()


def new_carrier(item: bpy.types.Object) -> bpy.types.Object:
    """Create a carrier at an object, which from now on follows it."""
    mesh = bpy.data.meshes.new(f"{item.name} Float")
    # a vertex parent has the axes of such a triangle, whose first side runs along x
    corners = [(-_HALF, -_HALF, 0.0), (_HALF, -_HALF, 0.0), (0.0, 2.0 * _HALF, 0.0)]
    mesh.from_pydata(corners, [], [(0, 1, 2)])
    carrier = bpy.data.objects.new(f"{item.name} Float", mesh)
    _hide(carrier, _CARRIER)
    stand_where(item, carrier)
    (_attach_by_attribute if bpy.app.version >= (5, 0) else _attach_by_rider)(item, carrier)
    return carrier


def stand_in(item: bpy.types.Object) -> bpy.types.Object:
    """An empty with an object's transform without floating, or as it was before floating was baked."""
    empty = bpy.data.objects.new(f"{item.name} Place", None)
    stand_where(item, empty)
    float_keys.restore_place(item, empty)
    return empty


def remove_carrier(carrier: bpy.types.Object) -> None:
    """Delete a carrier, its mesh and its rider."""
    for rider in _riders(carrier):
        bpy.data.objects.remove(rider)
    mesh = carrier.data
    bpy.data.objects.remove(carrier)
    if mesh.users == 0:
        bpy.data.meshes.remove(mesh)


def follow() -> None:
    """Update all carriers from their objects.

    Copies of a floating object get their own carrier, and carriers of deleted objects are removed. Nothing is
    written unless something has changed, so this may be called after every evaluation.
    """
    if not any(is_of_kind(group, CARRIER) for group in bpy.data.node_groups):
        return
    found = {item: carrier_of(item) for item in bpy.data.objects if item.library is None}
    afloat = [(item, carrier) for item, carrier in found.items() if carrier is not None and item.users]
    # a copy is younger than its original
    afloat.sort(key=lambda pair: pair[0].session_uid)
    taken: set[bpy.types.Object] = set()
    for item, carrier in afloat:
        own = carrier
        if carrier.library is not None or carrier in taken:
            own = _copied(item, carrier)
        taken.add(own)
        if own[_KEY] == _CARRIER:
            stand_where(item, own)
            _put_last(item)
    for carrier in [item for item in found if item.get(_KEY) == _CARRIER and item not in taken]:
        remove_carrier(carrier)


def take_over() -> None:
    """Convert objects of older files, in which users moved the carrier."""
    for carrier in [item for item in bpy.data.objects if item.get(_KEY) == _VISIBLE and item.library is None]:
        items = [item for item in carried_by(carrier) if item.library is None]
        for item in items:
            stand_where(carrier, item, keep=own_constraints(item))
        if items:
            _hide(carrier, _CARRIER)
            for rider in _riders(carrier):
                _hide(rider, _RIDER)
    follow()


def stand_where(
    item: bpy.types.Object, other: bpy.types.Object, keep: list[bpy.types.Constraint] | None = None
) -> None:
    """Copy an object's transform, animation and constraints, except ours, to another object.

    keep : own constraints of the other object. Only differences are written.
    """
    for name in _PLACE:
        value = getattr(item, name)
        if _plain(getattr(other, name)) != _plain(value):
            setattr(other, name, value)
    _share_action(item, other)
    ours, kept = own_constraints(item), keep or []
    wanted = [each for each in item.constraints if each not in ours]
    present = [each for each in other.constraints if each not in kept]
    if list(map(_said, wanted)) != list(map(_said, present)):
        for each in present:
            other.constraints.remove(each)
        for each in wanted:
            other.constraints.copy(each)


def _share_action(item: bpy.types.Object, other: bpy.types.Object) -> None:
    animation, present = item.animation_data, other.animation_data
    action = animation.action if animation is not None else None
    if action is None:
        if present is not None and present.action is not None:
            present.action = None
        return
    present = present or other.animation_data_create()
    if present.action != action:
        present.action = action
    if present.action_slot != animation.action_slot:
        present.action_slot = animation.action_slot


def _said(constraint: bpy.types.Constraint) -> list[Any]:
    """All that an artist may have set of a constraint."""
    names = (each.identifier for each in constraint.bl_rna.properties if not each.is_readonly)
    return [constraint.type, *(_plain(getattr(constraint, name)) for name in names if name not in _DRAWN)]


def _plain(value: Any) -> Any:
    """A value that can be compared: arrays of Blender's are equal to nothing but themselves."""
    is_array = hasattr(value, "__len__") and not isinstance(value, (str, set))
    return [_plain(part) for part in value] if is_array else value


def _put_last(item: bpy.types.Object) -> None:
    """Move our constraints to the end of an object's stack."""
    if item.override_library is not None:  # constraints of its library keep their order
        return
    count, ours = len(item.constraints), [each.name for each in own_constraints(item)]
    if [each.name for each in item.constraints[count - len(ours) :]] != ours:
        for name in ours:
            item.constraints.move(item.constraints.find(name), count - 1)


def _copied(item: bpy.types.Object, carrier: bpy.types.Object) -> bpy.types.Object:
    """Create a carrier for an object that shares that of another one."""
    copy = carrier.copy()
    copy.name = f"{item.name} Float"
    if copy.data.library is not None:
        copy.data = copy.data.copy()
    copies = {carrier: copy}
    for rider in _riders(carrier):
        copies[rider] = rider.copy()
        copies[rider].parent = copy
        copies[rider].use_fake_user = True
    copy.use_fake_user = True
    for constraint in own_constraints(item):
        constraint.target = copies[constraint.target]
    return copy


def _riders(carrier: bpy.types.Object) -> list[bpy.types.Object]:
    return [item for item in bpy.data.objects if item.parent == carrier and item.get(_KEY) == _RIDER]


def _hide(helper: bpy.types.Object, role: str) -> None:
    """Keep a helper alive and hidden."""
    helper[_KEY] = role
    helper.use_fake_user = True
    helper.hide_viewport = helper.hide_render = helper.hide_select = True
    for collection in [each for each in helper.users_collection if each.library is None]:
        collection.objects.unlink(helper)


def _attach_by_attribute(item: bpy.types.Object, carrier: bpy.types.Object) -> None:
    constraint = item.constraints.new("GEOMETRY_ATTRIBUTE")
    constraint.name = NAME
    constraint.target = carrier
    constraint.attribute_name = TRANSFORM
    constraint.data_type = "FLOAT4X4"
    constraint.apply_target_transform = True
    constraint.mix_loc = constraint.mix_rot = True
    constraint.mix_scl = False


def _attach_by_rider(item: bpy.types.Object, carrier: bpy.types.Object) -> None:
    """Before 5.0: constraints cannot read attributes, but a vertex parent moves with the carrier."""
    rider = bpy.data.objects.new(f"{item.name} Float Rider", None)
    _hide(rider, _RIDER)
    rider.parent, rider.parent_type, rider.parent_vertices = carrier, "VERTEX_3", (0, 1, 2)
    for kind in ("COPY_LOCATION", "COPY_ROTATION"):
        constraint = item.constraints.new(kind)
        constraint.name = NAME
        constraint.target = rider
