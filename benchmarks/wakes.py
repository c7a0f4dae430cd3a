# SPDX-License-Identifier: GPL-3.0-or-later
"""The wake of an object that turns, of a frame by itself and of the next frame, against a frame of a sea."""

from __future__ import annotations

import itertools
import math
import time
from collections.abc import Callable, Iterator

import numpy as np

from ocean_tweak.core import Area, Ocean, OceanParameters, PathSample, WakeLayer, WaveLayer
from ocean_tweak.core.numerics.memo import MEMO

from .field_sets import SIX, surface_maker
from .measure import interleaved
from .plan import Plan
from .rows import Row, ratio_row

GROUP = "wakes"

#: s of path, and s between its samples, of which no two go straight on
_LONG, _STEP = 60.0, 0.5
#: in which the fields are read: its samples, as few as leave the reading out
_PLACE = Area(1.0, 1)


def rows(plan: Plan) -> Iterator[Row]:
    """Six fields of a wake, on one thread."""
    resolution = 64 if plan.smoke else 512
    sea = turning(resolution)
    sides = {
        "alone": _alone(sea), "in sequence": _in_sequence(sea), "sea": surface_maker(SIX, resolution, 1),
    }  # fmt: skip
    timings = interleaved(sides, plan.rounds, time.process_time)
    pieces = len(sea.of(WakeLayer)[0].track.pieces)
    yield ratio_row(
        GROUP, f"wake of {_LONG:g} s of path in {pieces} pieces on {resolution}², a frame by itself",
        timings, "alone", "sea", target="wake alone",
    )  # fmt: skip
    yield ratio_row(
        GROUP, f"wake on {resolution}², the next frame", timings, "in sequence", "sea", target="wake sequence"
    )


def turning(resolution: int) -> OceanParameters:
    """A ship that swings to and fro."""
    times = np.arange(0.0, _LONG + _STEP, _STEP).tolist()
    path = tuple(PathSample(time, 8.0 * time, 40.0 * math.sin(0.1 * time)) for time in times)
    ship = WakeLayer(path=path, area_resolution=resolution, length=60.0, beam=max(12.0, 2048.0 / resolution))
    return OceanParameters(resolution=64, layers=(WaveLayer(muted=True), ship))


def _alone(sea: OceanParameters) -> Callable[[], object]:
    def make() -> None:
        MEMO.drop()
        Ocean(sea, workers=1).surface(_LONG, SIX.outputs, on=_PLACE)

    return make


def _in_sequence(sea: OceanParameters) -> Callable[[], object]:
    ocean = Ocean(sea, workers=1)
    frames = itertools.count()

    def make() -> None:
        ocean.surface(_LONG + next(frames) / 24.0, SIX.outputs, on=_PLACE)

    return make
