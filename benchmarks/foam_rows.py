# SPDX-License-Identifier: GPL-3.0-or-later
"""The foam of a frame by itself, which looks back at what the sea was."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from ocean_tweak.core import Foam, Ocean, OceanParameters
from ocean_tweak.core.sea.regions import Places

from .cascades import three
from .field_sets import SIX, TIME, surface_maker
from .measure import interleaved
from .plan import Plan, sea
from .rows import Row, ratio_row

GROUP = "foam of a frame alone"

#: the largest tile; a frame alone takes as long as dozens of surfaces
_LARGEST, _ROUNDS = 2048, 3


def rows(plan: Plan) -> Iterator[Row]:
    """A tile's against one six-field frame, and at places of a cascade against looking at them once."""
    rounds = min(plan.rounds, _ROUNDS)
    for size in [size for size in plan.sizes if size <= _LARGEST][1:]:
        storm = sea(size).replace(foam=Foam())
        sides = {"alone": _alone(storm), "six fields": surface_maker(SIX, size, 1)}
        timings = interleaved(sides, rounds)
        yield ratio_row(
            GROUP, f"foam of a frame alone, {size}², against {SIX.name}, 1 worker",
            timings, "alone", "six fields", target="foam alone",
        )  # fmt: skip
    count = 2_000 if plan.smoke else 200_000
    sides = _at_places(three(64 if plan.smoke else 512).replace(foam=Foam()), count)
    yield ratio_row(
        GROUP, f"foam of a cascade at {count:,} places alone, against their compression once",
        interleaved(sides, rounds), "alone", "a look", target="foam of places alone",
    )  # fmt: skip


def _alone(parameters: OceanParameters) -> Callable[[], object]:
    ocean = Ocean(parameters, workers=1)
    ocean.foam_model  # noqa: B018 - it is of the sea, and not of a frame
    return lambda: ocean.new_foam_history().whitecaps(TIME)


def _at_places(parameters: OceanParameters, count: int) -> dict[str, Callable[[], object]]:
    """Each call is of another time: what one looked at is of no use to the next."""
    ocean = Ocean(parameters, workers=1)
    ocean.foam_model  # noqa: B018
    places = Places(*np.random.default_rng(1).uniform(0.0, parameters.domain_size, (2, count)))
    times = {"alone": TIME, "a look": -TIME}

    def made(side: str, output: str) -> object:
        times[side] += 100.0
        return ocean.surface(times[side], {output}, on=places)

    return {"alone": lambda: made("alone", "foam"), "a look": lambda: made("a look", "cusp")}
