# SPDX-License-Identifier: GPL-3.0-or-later
"""The past of a damped hull that keys do not tell: recorded frame by frame, where constraints, drivers or
nonlinear animation move it, and kept with its carrier."""

from __future__ import annotations

from collections.abc import Iterable

import bpy
import numpy as np

from . import float_path
from .floating import ride_of
from .shots import evaluations
from .units import time_stretch


def record(carriers: Iterable[bpy.types.Object], scene: bpy.types.Scene) -> None:
    """Keep where carriers are at each frame of a scene that ride damped and whose keys do not tell it."""
    wanted = []
    for carrier in carriers:
        ocean, ride = ride_of(carrier)
        if carrier.library is None and ocean is not None and ride.damped and not float_path.is_known(carrier):
            wanted.append((carrier, ocean))
    if not wanted:
        return
    frames, rows = range(scene.frame_start, scene.frame_end + 1), dict[bpy.types.Object, list[float]]()
    for depsgraph in evaluations(scene, frames, wanted[0][1]):
        for carrier, _ in wanted:
            matrix = carrier.evaluated_get(depsgraph).matrix_world
            rows.setdefault(carrier, []).extend(np.array(matrix)[:3].ravel().tolist())
    step = 1 / time_stretch(scene)
    for carrier, _ in wanted:
        float_path.keep_past(carrier, rows[carrier], (float(frames[0] * step), float(step)))
