# SPDX-License-Identifier: GPL-3.0-or-later
"""Handles (gizmos) of the active ocean in the 3D view: its size, and the active layer's wind or position.

Each reads and sets one setting; a drag is one undo step.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import bpy
from mathutils import Matrix, Vector

from ..scene.settings import is_ocean, settings_of
from .active_ocean import active_layer

#: wind speed in m/s at which its arrow is as long as a side of the domain
_FULL_LENGTH = 60.0
#: arrows point along z: rotation from z to x
_ALONG_X = Matrix.Rotation(math.radians(90.0), 4, "Y")
#: dials begin at y: rotation from y to x
_FROM_X = Matrix.Rotation(math.radians(-90.0), 4, "Z")
_SIZE_COLOUR, _WIND_COLOUR, _WAVE_COLOUR = (0.9, 0.9, 0.9), (1.0, 0.65, 0.1), (0.2, 0.8, 1.0)

_Object = bpy.types.Object


class Handle(NamedTuple):
    """One handle.

    gizmo : Blender's type, with a number or a position `offset`
    colour : of its lines
    style : its other properties
    read, write : access the setting, in Blender units or rad; `read` returns None if the ocean does not have
        it
    place : world matrix
    """

    gizmo: str
    colour: tuple[float, float, float]
    style: dict[str, Any]
    read: Callable[[_Object], Any]
    write: Callable[[_Object, Any], None]
    place: Callable[[_Object], Matrix]


def _sized(item: _Object) -> Any:
    """The owner of the domain size: the first patch, or the ocean."""
    settings = settings_of(item)
    return settings.patches[0] if settings.patches else settings


def _size(item: _Object) -> float:
    return float(_sized(item).domain_size)


def _half_width(item: _Object) -> float:
    return 0.5 * settings_of(item).repeats_x * _size(item)


def _set_half_width(item: _Object, value: float) -> None:
    _sized(item).domain_size = max(2.0 * value / settings_of(item).repeats_x, 1e-3)


def _group(item: _Object, *kinds: str) -> Any:
    """Settings of the active layer if it is of one of these kinds."""
    layer = active_layer(settings_of(item))
    return layer.group if layer is not None and layer.kind in kinds else None


def _blown(item: _Object) -> Any:
    """Settings of the active layer if it has a uniform wind."""
    group = _group(item, "WAVES", "WIND_FIELD", "IMAGE")
    return None if group is None or getattr(group, "source", "UNIFORM") != "UNIFORM" else group


def _directed(item: _Object) -> tuple[Any, str] | None:
    """The owner of a direction, and the property's name."""
    wave = _group(item, "HERO_WAVE")
    if wave is not None:
        return wave, "direction"
    group = _blown(item)
    return None if group is None else (group, "wind_direction")


def _direction(item: _Object) -> float | None:
    found = _directed(item)
    return None if found is None else float(getattr(*found))


def _turn(item: _Object) -> float | None:
    """The value of its dial, which turns clockwise about its axis."""
    direction = _direction(item)
    return None if direction is None else -direction


def _set_turn(item: _Object, value: float) -> None:
    setattr(*_directed(item), -value)


def _speed(item: _Object) -> float | None:
    group = _blown(item)
    if group is None or getattr(group, "definition", "WIND") != "WIND":
        return None
    return group.wind_speed / _FULL_LENGTH * _size(item)


def _set_speed(item: _Object, value: float) -> None:
    _blown(item).wind_speed = max(value, 0.0) * _FULL_LENGTH / _size(item)


def _focus(item: _Object) -> tuple[float, float, float] | None:
    wave = _group(item, "HERO_WAVE")
    return None if wave is None else (wave.x, wave.y, 0.0)


def _set_focus(item: _Object, value: Vector) -> None:
    wave = _group(item, "HERO_WAVE")
    for name, part in zip("xy", value, strict=False):
        if getattr(wave, name) != part:
            setattr(wave, name, part)


def _wavelength(item: _Object) -> float | None:
    wave = _group(item, "HERO_WAVE")
    return None if wave is None else float(wave.wavelength)


def _set_wavelength(item: _Object, value: float) -> None:
    _group(item, "HERO_WAVE").wavelength = max(value, 1e-3)


def _at(item: _Object) -> Matrix:
    """Position of the active layer's handles: a hero wave's focus, or the middle of the ocean."""
    focus = _focus(item)
    return _middle(item) if focus is None else item.matrix_world @ Matrix.Translation(focus)


def _middle(item: _Object) -> Matrix:
    """The middle of the ocean, which stays when the size of its domain changes."""
    settings, half = settings_of(item), 0.5 * _size(item)
    place = (half * settings.repeats_x, half * settings.repeats_y, 0.0)
    return item.matrix_world @ Matrix.Translation(place)


def _along(item: _Object) -> Matrix:
    """From there along the direction of wind or wave."""
    return _at(item) @ Matrix.Rotation(_direction(item) or 0.0, 4, "Z") @ _ALONG_X


_DIAL = {"draw_options": {"ANGLE_START_Y", "ANGLE_VALUE"}}

#: by name
HANDLES = {
    "size": Handle(
        "GIZMO_GT_arrow_3d", _SIZE_COLOUR, {"draw_style": "BOX"}, _half_width, _set_half_width,
        lambda item: _middle(item) @ _ALONG_X,
    ),
    "direction": Handle(
        "GIZMO_GT_dial_3d", _WIND_COLOUR, _DIAL, _turn, _set_turn, lambda item: _at(item) @ _FROM_X
    ),
    "speed": Handle("GIZMO_GT_arrow_3d", _WIND_COLOUR, {}, _speed, _set_speed, _along),
    "focus": Handle(
        "GIZMO_GT_move_3d", _WAVE_COLOUR, {"draw_options": {"ALIGN_VIEW", "FILL"}, "scale_basis": 0.15},
        _focus, _set_focus,
        lambda item: item.matrix_world.copy(),
    ),
    "wavelength": Handle(
        "GIZMO_GT_arrow_3d", _WAVE_COLOUR, {"draw_style": "BOX"}, _wavelength, _set_wavelength, _along
    ),
}  # fmt: skip


def _keep_step() -> None:
    """Create an undo step for a handle."""
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[0]):
        bpy.ops.ed.undo_push(message="Pull Ocean Handle")


class OCEAN_GGT_handles(bpy.types.GizmoGroup):
    """The handles of the active ocean."""

    bl_idname = "OCEAN_GGT_handles"
    bl_label = "Ocean Handles"
    bl_space_type = "VIEW_3D"
    bl_region_type = "WINDOW"
    bl_options = {"3D", "PERSISTENT"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """An ocean that can be changed is active, and live: a bake moves by no handle."""
        item = context.active_object
        if not is_ocean(item) or context.mode != "OBJECT":
            return False
        return item.is_editable and item.visible_get() and settings_of(item).source == "LIVE"

    def setup(self, _context: bpy.types.Context) -> None:
        """Create all of them; which are shown is decided before each drawing."""
        self.made = {name: self._make(handle) for name, handle in HANDLES.items()}
        self.is_pulled = False

    def _make(self, handle: Handle) -> bpy.types.Gizmo:
        gizmo = self.gizmos.new(handle.gizmo)
        for name, value in handle.style.items():
            setattr(gizmo, name, value)
        gizmo.color, gizmo.alpha = handle.colour, 0.7
        gizmo.color_highlight, gizmo.alpha_highlight = (1.0, 1.0, 1.0), 1.0
        zero = (0.0, 0.0, 0.0) if handle.read is _focus else 0.0

        def read() -> Any:
            item = bpy.context.active_object
            value = handle.read(item) if is_ocean(item) else None
            return zero if value is None else value

        def write(value: Any) -> None:
            item = bpy.context.active_object
            if is_ocean(item) and handle.read(item) is not None:
                handle.write(item, value)

        gizmo.target_set_handler("offset", get=read, set=write)
        return gizmo

    def draw_prepare(self, context: bpy.types.Context) -> None:
        """Update their positions, and hide those without a setting."""
        item, was_pulled = context.active_object, self.is_pulled
        self.is_pulled = any(gizmo.is_modal for gizmo in self.made.values())
        if was_pulled and not self.is_pulled:
            # Blender creates no undo step for Python gizmos, and none can be created while drawing
            bpy.app.timers.register(_keep_step)
        for name, gizmo in self.made.items():
            handle = HANDLES[name]
            gizmo.hide = handle.read(item) is None
            if not gizmo.hide and not gizmo.is_modal:  # the start of a drag is the reference
                gizmo.matrix_basis = handle.place(item).normalized()


CLASSES = (OCEAN_GGT_handles,)
