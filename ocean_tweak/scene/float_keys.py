# SPDX-License-Identifier: GPL-3.0-or-later
"""Baked movement of an object as a separate action, with its earlier state stored beside it."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from fractions import Fraction

import bpy
from mathutils import Euler, Matrix, Quaternion

# custom properties of a baked object: its earlier state, and its earlier action if it had one
_STATE, _ACTION = "ocean_tweak_float_state", "ocean_tweak_float_action"
_ROTATIONS = {"QUATERNION": "rotation_quaternion", "AXIS_ANGLE": "rotation_axis_angle"}
_VALUES = ("location", "rotation_euler", "rotation_quaternion", "rotation_axis_angle")


@dataclass(frozen=True)
class State:
    """The state of an object that a bake changes, besides its action.

    values : location and rotations
    slot : identifier of the action's slot, "" without one
    enabled : names of the constraints that act
    has_animation : whether there is animation data at all
    """

    values: dict[str, list[float]]
    slot: str
    enabled: list[str]
    has_animation: bool


def rotation_path(item: bpy.types.Object) -> str:
    """The rotation property of an object's rotation mode."""
    return _ROTATIONS.get(item.rotation_mode, "rotation_euler")


def state_of(item: bpy.types.Object) -> State:
    """The object's present state."""
    animation = item.animation_data
    slot = animation.action_slot if animation is not None and animation.action is not None else None
    return State(
        values={name: list(getattr(item, name)) for name in _VALUES},
        slot=slot.identifier if slot is not None else "",
        enabled=[constraint.name for constraint in item.constraints if constraint.enabled],
        has_animation=animation is not None,
    )


def is_baked(item: bpy.types.Object) -> bool:
    """Whether the object's movement was baked by this module."""
    return _STATE in item


def unbake(item: bpy.types.Object) -> None:
    """Restore a baked object's earlier state, and remove its baked action unless it has other users."""
    if not is_baked(item):
        return
    state, action = State(**json.loads(item[_STATE])), item.get(_ACTION)
    baked = item.animation_data.action if item.animation_data is not None else None
    apply_state(item, state, action)
    for name in (_STATE, _ACTION):
        if name in item:
            del item[name]
    if baked is not None and baked != action and baked.users == 0:
        bpy.data.actions.remove(baked)


def restore_place(item: bpy.types.Object, other: bpy.types.Object) -> None:
    """Copy the earlier transform of a baked object to another one."""
    if is_baked(item):
        apply_state(other, State(**json.loads(item[_STATE])), item.get(_ACTION))


def apply_state(item: bpy.types.Object, state: State, action: bpy.types.Action | None) -> None:
    """Restore a stored state and action of an object."""
    if action is not None:
        _assign(item, action, state.slot)
    elif item.animation_data is not None:
        item.animation_data.action = None
        if not state.has_animation:
            item.animation_data_clear()
    for name in _VALUES:
        if name in state.values:  # whatever else the file holds there
            setattr(item, name, state.values[name])
    for constraint in item.constraints:
        constraint.enabled = constraint.name in state.enabled


class Track:
    """Transforms of one object, collected per frame before they become keys."""

    def __init__(self, item: bpy.types.Object) -> None:
        self.item = item
        self._rows: list[list[float]] = []
        self._last: Quaternion | None = None

    def add(self, place: Matrix) -> None:
        """Add the object's world rotation and location at the next frame.

        The parent must have been evaluated at that frame. The object's transform is left as it was.
        """
        item, path = self.item, rotation_path(self.item)
        before = {name: list(getattr(item, name)) for name in (*_VALUES, "scale")}
        item.matrix_world = place
        location = list(item.location)
        rotation = self._without_jump(path)
        for name, value in before.items():
            setattr(item, name, value)
        self._rows.append([*location, *rotation])

    def _without_jump(self, path: str) -> list[float]:
        """The rotation, of all that are the same turn the one nearest to the frame before."""
        value = getattr(self.item, path)
        if path == "rotation_euler":
            if self._rows:
                value.make_compatible(Euler(self._rows[-1][3:], value.order))
            return list(value)
        turned = Quaternion(value[1:4], value[0]) if path == "rotation_axis_angle" else value.copy()
        if self._last is not None:
            turned.make_compatible(self._last)
        self._last = turned
        if path == "rotation_axis_angle":
            axis, angle = turned.to_axis_angle()
            return [angle, *axis]
        return list(turned)

    def write(self, first: Fraction, step: Fraction) -> None:
        """Write keys from a frame, with linear interpolation, to a new action; keys outside the range are
        kept.

        first, step : frames of the animation, which Time Stretching makes others than the scene's
        """
        places = [float(first + index * step) for index in range(len(self._rows))]
        item = self.item
        state, old = state_of(item), _action_of(item)
        action = old.copy() if old is not None else bpy.data.actions.new(f"{item.name} Float")
        _assign(item, action, state.slot)
        item[_STATE] = json.dumps(asdict(state))
        if old is not None:
            item[_ACTION] = old
        for constraint in item.constraints:
            constraint.enabled = False
        columns = list(zip(*self._rows, strict=True))
        for path, values in (("location", columns[:3]), (rotation_path(item), columns[3:])):
            for index, column in enumerate(values):
                _write_curve(action.fcurve_ensure_for_datablock(item, path, index=index), places, column)


def _action_of(item: bpy.types.Object) -> bpy.types.Action | None:
    return item.animation_data.action if item.animation_data is not None else None


def _assign(item: bpy.types.Object, action: bpy.types.Action, slot: str) -> None:
    animation = item.animation_data_create()
    animation.action = action
    found = next((each for each in action.slots if each.identifier == slot), None)
    animation.action_slot = found or action.slots.new("OBJECT", item.name)


def _write_curve(curve: bpy.types.FCurve, frames: Sequence[float], values: Sequence[float]) -> None:
    points = curve.keyframe_points
    for index in reversed([i for i, point in enumerate(points) if frames[0] <= point.co.x <= frames[-1]]):
        points.remove(points[index], fast=True)
    for frame, value in zip(frames, values, strict=True):
        points.insert(frame, value, options={"FAST"}).interpolation = "LINEAR"
    curve.update()
