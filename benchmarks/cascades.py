# SPDX-License-Identifier: GPL-3.0-or-later
"""A sea of three patches against one of a single patch with as many samples."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from ocean_tweak.core import Ocean, OceanParameters
from ocean_tweak.core.parameters.patch import Patch
from ocean_tweak.core.waves.contribution import NO_LONGEST

from .field_sets import SIX, TIME, arrays, surface_maker
from .measure import interleaved
from .plan import Plan, sea
from .rows import Row, ratio_row

GROUP = "cascades"

#: sides of the patches over that of the first, and samples of the first along the wave where the next begins
_SIDES, _SAMPLES = (1.0, 0.2137, 0.0469), 5.0


def rows(plan: Plan) -> Iterator[Row]:
    """Six fields of each patch, on one thread."""
    resolution = 64 if plan.smoke else 512
    sides = {"three patches": _maker(three(resolution)), "one patch": surface_maker(SIX, resolution, 1)}
    timings = interleaved(sides, plan.rounds)
    yield ratio_row(
        GROUP, f"three patches of {resolution}² against one, {SIX.name}, 1 worker",
        timings, "three patches", "one patch", target="cascades",
    )  # fmt: skip
    joined = 2 * resolution
    sides = {
        "joined": _displacement(three(resolution).on_one_grid(joined)),
        "one patch": _displacement(sea(joined)),
    }
    timings = interleaved(sides, plan.rounds)
    yield ratio_row(
        GROUP, f"displacement of three patches joined on {joined}² against one patch, 1 worker",
        timings, "joined", "one patch", target="joined",
    )  # fmt: skip


def three(resolution: int) -> OceanParameters:
    """The storm on three patches whose bands join."""
    storm = sea(resolution)
    patches, longest = [], NO_LONGEST
    for number, share in enumerate(_SIDES):
        side = share * storm.domain_size
        shortest = _SAMPLES * side / resolution
        patches.append(Patch(side, 0.6 * number, shortest, longest, resolution))
        longest = shortest
    return storm.replace(patches=tuple(patches))


def _displacement(parameters: OceanParameters) -> Callable[[], object]:
    ocean, n = Ocean(parameters, workers=1), parameters.resolution
    out = {"displacement": np.empty((n, n, 3), np.float32)}
    return lambda: ocean.surface(TIME, out, out=out)


def _maker(parameters: OceanParameters) -> Callable[[], object]:
    patches = Ocean(parameters, workers=1).patches
    out = [arrays(SIX, ocean.parameters.resolution) for ocean in patches]

    def make() -> None:
        for ocean, fields in zip(patches, out, strict=True):
            ocean.surface(TIME, SIX.outputs, out=fields)

    return make
