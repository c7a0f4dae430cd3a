# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene's units and frame rate as exact numbers.

Blender keeps these settings as float32. A typed number is taken to be the shortest decimal that gives this
float32, so 1.001 is 1001/1000 and not 1.00100004673.
"""

from __future__ import annotations

from fractions import Fraction

import bpy
import numpy as np

_LARGEST_MAP = 900  # of scene.render.frame_map_old and frame_map_new
_LARGEST_FPS = 32767  # of scene.render.fps
_SMALLEST_BASE = Fraction(1, 100_000)


def shortest_decimal(value: float) -> Fraction:
    """The shortest decimal number that rounds to this finite float32, exactly."""
    return Fraction(str(np.float32(value)))


def metres_per_unit(scene: bpy.types.Scene) -> Fraction:
    """Metres in one Blender unit of the scene."""
    return shortest_decimal(scene.unit_settings.scale_length)


def frame_rate(scene: bpy.types.Scene) -> Fraction:
    """Frames per second; 24 over a base of 1.001 is exactly 24000/1001."""
    return Fraction(scene.render.fps) / shortest_decimal(scene.render.fps_base)


def time_stretch(scene: bpy.types.Scene) -> Fraction:
    """Frames of the scene in a frame of its animation, of Time Stretching: 2 is half the speed."""
    return Fraction(scene.render.frame_map_new, scene.render.frame_map_old)


def set_time_stretch(scene: bpy.types.Scene, stretch: Fraction) -> None:
    """Set the scene's Time Stretching to a fraction, as near as Blender can hold it."""
    held = min(max(stretch, Fraction(1, _LARGEST_MAP)), Fraction(_LARGEST_MAP))
    old = max(min(_LARGEST_MAP, int(_LARGEST_MAP / held)), 1)
    near = held.limit_denominator(old)
    # as artists write it: 100 to 200
    times = max(min(100 // near.denominator, _LARGEST_MAP // near.numerator), 1)
    scene.render.frame_map_old, scene.render.frame_map_new = near.denominator * times, near.numerator * times


def set_frame_rate(scene: bpy.types.Scene, fps: Fraction) -> None:
    """Set the scene's frame rate to a fraction, exactly where Blender can hold it."""
    for count in (round(fps), round(fps) + 1, fps.numerator):
        if not 1 <= count <= _LARGEST_FPS:
            continue
        base = count / fps
        if base >= _SMALLEST_BASE and shortest_decimal(float(base)) == base:
            break
    else:
        count = max(round(fps), 1)
        base = count / fps
    scene.render.fps = count
    scene.render.fps_base = float(base)


def frame_with_subframe(scene: bpy.types.Scene) -> Fraction:
    """The scene's frame, sub-frame included."""
    return scene.frame_current + Fraction(scene.frame_subframe)
