# SPDX-License-Identifier: GPL-3.0-or-later
"""Waves over a bed: the pictures, which are made once, and frames of them against a frame of a sea."""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable, Iterator

import numpy as np

from ocean_tweak.core import Coast, Ocean, OceanParameters, Raster, Water, WaveLayer
from ocean_tweak.core.waves.coast import propagate

from .field_sets import SIX, surface_maker
from .measure import interleaved
from .plan import Plan
from .rows import Row, ratio_row

GROUP = "coast"

#: waves of which pictures are timed, m of the bed, and fields of a frame, by component and derivative
_WAVES, _SIDE = 600, 410.0
_STILL = frozenset({(0, ""), (1, ""), (2, "")})
_MOVING = _STILL | {(0, "t"), (1, "t"), (2, "t")}


def rows(plan: Plan) -> Iterator[Row]:
    """Pictures of single waves on all cores, and frames on one thread."""
    samples, waves = (64, 20) if plan.smoke else (512, _WAVES)
    begun = time.perf_counter()
    _propagated(samples, waves)
    seconds = time.perf_counter() - begun
    yield Row(GROUP, f"pictures of {waves} waves on {samples}²", seconds, "s", target="coast pictures")
    sea = _sea(samples)
    sides = {
        "displacement": _frames(sea, _STILL), "with velocity": _frames(sea, _MOVING),
        "sea": surface_maker(SIX, samples, 1),
    }  # fmt: skip
    timings = interleaved(sides, plan.rounds, time.process_time)
    for name, target in (("displacement", "coast frame"), ("with velocity", "coast velocity")):
        yield ratio_row(
            GROUP, f"coast on about {samples}², {name}", timings, name, "sea", target=target
        )  # fmt: skip


def _propagated(samples: int, waves: int) -> None:
    along = np.maximum(np.arange(samples) - 16.0, 0.0) * (_SIDE / samples)
    wave = 0.3 * np.sin(2.0 * np.pi * np.arange(samples) / samples)
    depth = np.where(along[:, np.newaxis] > 0.0, 10.0 - 0.03 * along[:, np.newaxis] + wave, 10.0)
    omega = np.linspace(0.5, 1.7, waves)
    propagate(depth, _SIDE / samples, omega, np.zeros(waves), breaking=np.full(waves, 0.04), workers=2)


def _sea(samples: int) -> OceanParameters:
    bed = np.repeat(np.linspace(12.0, -1.0, 101)[np.newaxis], 101, axis=0)
    coast = Coast(depth=Raster(bed), spacing=3.0, rim=80.0)
    layer = WaveLayer(wind_speed=11.0, fetch=120e3)
    return OceanParameters(
        resolution=samples, domain_size=_SIDE, water=Water(depth=20.0), layers=(layer,), coast=coast
    )


def _frames(sea: OceanParameters, keys: frozenset[tuple[int, str]]) -> Callable[[], object]:
    coast, times = Ocean(sea, workers=1).coast, itertools.count()
    assert coast is not None
    over_bed = coast.over_bed

    def make() -> object:
        return over_bed.components(next(times) / 24.0, keys)

    return make
