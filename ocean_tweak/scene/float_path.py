# SPDX-License-Identifier: GPL-3.0-or-later
"""Computes an object's transform at other frames from its keys and those of its parents, without evaluating
them."""

from __future__ import annotations

from collections.abc import Iterator

import bpy
from mathutils import Euler, Matrix, Quaternion, Vector

from .animated import channel_bags


def is_known(item: bpy.types.Object) -> bool:
    """Whether keys determine an object's transform: no constraint, driver, NLA strip, bone or vertex moves
    it."""
    return all(
        not any(constraint.enabled for constraint in each.constraints)
        and (each.parent is None or each.parent_type == "OBJECT")
        and (
            each.animation_data is None or not (each.animation_data.drivers or each.animation_data.nla_tracks)
        )
        for each in _with_parents(item)
    )


def matrix_at(item: bpy.types.Object, frame: float) -> Matrix:
    """An object's world matrix at a frame of its animation, if keys determine it."""
    own = _own_matrix(item, frame)
    if item.parent is None:
        return own
    return matrix_at(item.parent, frame) @ item.matrix_parent_inverse @ own


def _own_matrix(item: bpy.types.Object, frame: float) -> Matrix:
    values = {name: list(getattr(item, name)) for name in ("location", "scale", *_ROTATIONS.values())}
    for name, index, value in _keyed(item, frame):
        if name in values:
            values[name][index] = value
    location = Vector(values["location"]) + item.delta_location
    scale = Vector(values["scale"]) * item.delta_scale
    if item.rotation_mode == "QUATERNION":
        turn = item.delta_rotation_quaternion @ Quaternion(values["rotation_quaternion"]).normalized()
    elif item.rotation_mode == "AXIS_ANGLE":
        angle, *axis = values["rotation_axis_angle"]
        turn = item.delta_rotation_quaternion @ Quaternion(axis, angle)
    else:
        own = Euler(values["rotation_euler"], item.rotation_mode).to_quaternion()
        turn = item.delta_rotation_euler.to_quaternion() @ own
    return Matrix.LocRotScale(location, turn, scale)


_ROTATIONS = {
    "QUATERNION": "rotation_quaternion", "AXIS_ANGLE": "rotation_axis_angle", "": "rotation_euler",
}  # fmt: skip


def _keyed(item: bpy.types.Object, frame: float) -> Iterator[tuple[str, int, float]]:
    data = item.animation_data
    for bag in channel_bags(data.action, data.action_slot) if data is not None else ():
        for curve in bag.fcurves:
            if not curve.mute:
                yield curve.data_path, curve.array_index, curve.evaluate(frame)


def _with_parents(item: bpy.types.Object) -> Iterator[bpy.types.Object]:
    each: bpy.types.Object | None = item
    while each is not None:
        yield each
        each = each.parent
