# SPDX-License-Identifier: GPL-3.0-or-later
"""How far a keyed current has carried an ocean's water: a sum over its keys, for any frame alone."""

from __future__ import annotations

import itertools
import math
from fractions import Fraction

import bpy

from ..core.parameters.current import Current
from .animated import OCEAN_TIME, clock_of, curves_of
from .settings import OceanSettings
from .units import frame_rate, frame_with_subframe, metres_per_unit, shortest_decimal, time_stretch

_SPEED, _DIRECTION = (f"ocean_tweak.current.{name}" for name in ("speed", "direction"))


def carried(settings: OceanSettings, current: Current, scene: bpy.types.Scene, start_frame: int) -> Current:
    """A current with how far it has come by the scene's frame, where keys change it; else the same one.

    Between frames it is linear, as the keys of a shot are. Drivers tell nothing of other frames.
    """
    curves = {curve.data_path: curve for curve in curves_of(settings.id_data)}
    if _SPEED not in curves and _DIRECTION not in curves:
        return current
    now = frame_with_subframe(scene) / time_stretch(scene)
    metres = float(metres_per_unit(scene))

    def water(frame: Fraction) -> tuple[float, float, float]:
        """Velocity in m/s and the ocean's time in s."""
        at = float(frame)
        speed = curves[_SPEED].evaluate(at) * metres if _SPEED in curves else current.speed
        towards = curves[_DIRECTION].evaluate(at) if _DIRECTION in curves else current.direction
        if settings.use_ocean_time:
            time = curves[OCEAN_TIME].evaluate(at) if OCEAN_TIME in curves else settings.ocean_time
        else:
            time = float((frame - start_frame) / frame_rate(scene) * shortest_decimal(settings.time_scale))
        return speed * math.cos(towards), speed * math.sin(towards), time

    step = 1 if now >= start_frame else -1
    whole = range(start_frame, math.floor(now) + 1 if step > 0 else math.ceil(now) - 1, step)
    moments = [water(Fraction(frame)) for frame in whole] + [water(now)]
    x, y = (moments[0][axis] * moments[0][2] for axis in (0, 1))
    for (ux, uy, then), (vx, vy, later) in itertools.pairwise(moments):
        x += 0.5 * (ux + vx) * (later - then)
        y += 0.5 * (uy + vy) * (later - then)
    time = float(clock_of(settings, scene, start_frame).time)
    ux, uy = current.velocity
    return Current(current.speed, current.direction, x - ux * time, y - uy * time)
