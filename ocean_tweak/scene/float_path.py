# SPDX-License-Identifier: GPL-3.0-or-later
"""Computes an object's transform at other frames from its keys and those of its parents, without evaluating
them; and those that were recorded where keys do not determine it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction

import bpy
import numpy as np
from mathutils import Euler, Matrix, Quaternion, Vector

from .animated import channel_bags

# custom properties of a carrier: rows of matrices, and the first and the step of their frames
_ROWS, _FRAMES = "ocean_tweak_past", "ocean_tweak_past_frames"
#: Blender units, and their share a unit away from the origin, by which a place is another one
_MOVED = 1e-3


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


def keep_past(carrier: bpy.types.Object, rows: Sequence[float], frames: tuple[float, float]) -> None:
    """Keep with a carrier where it was, as `recorded` reads it.

    rows : the upper three rows of a world matrix a frame, one after another
    frames : of the animation, the first, and the step to the next
    """
    carrier[_ROWS], carrier[_FRAMES] = rows, frames


def recorded(carrier: bpy.types.Object) -> Callable[[Fraction], Matrix] | None:
    """The place of a carrier by the frame of the animation, as at the ends of what was recorded beyond them;
    None where nothing was."""
    if _ROWS not in carrier or _FRAMES not in carrier:
        return None
    rows = np.array(carrier[_ROWS]).reshape(-1, 3, 4)
    first, step = carrier[_FRAMES]

    def at(frame: Fraction) -> Matrix:
        place = min(max((float(frame) - first) / step, 0.0), len(rows) - 1.0)
        before = min(int(place), max(len(rows) - 2, 0))
        share, after = place - before, min(before + 1, len(rows) - 1)
        return Matrix((*((1.0 - share) * rows[before] + share * rows[after]).tolist(), (0.0, 0.0, 0.0, 1.0)))

    return at


def past_of(carrier: bpy.types.Object, there: Matrix, frame: Fraction) -> Callable[[Fraction], Matrix] | None:
    """What was recorded of a carrier; None where it is not where it was then, at a frame of the animation."""
    at = recorded(carrier)
    if at is None:
        return None
    off = (np.array(at(frame)) - np.array(there))[:3]
    return at if np.abs(off).max() <= _MOVED * (1.0 + there.translation.length) else None
