# SPDX-License-Identifier: GPL-3.0-or-later
"""What a changed spectral parameter costs, the random numbers being known, in units of a frame."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator

from ocean_tweak.core import Ocean

from .field_sets import SIX, TIME, arrays, surface_maker
from .measure import interleaved
from .plan import Plan, sea, with_wind
from .rows import Row, ratio_row

GROUP = "initial state"


def rows(plan: Plan) -> Iterator[Row]:
    """The state alone, and with the first frame after it."""
    for resolution in plan.state:
        sides = {
            "state": changed_state(resolution),
            "state and frame": changed_state(resolution, with_frame=True),
            "frame": surface_maker(SIX, resolution, 1),
        }
        timings = interleaved(sides, plan.rounds)
        target = "initial state" if resolution == 512 or plan.smoke else None
        yield ratio_row(
            GROUP, f"wind changed, {resolution}²", timings, "state", "frame", target=target,
            remark="against 6 fields + eigenvalue",
        )  # fmt: skip
        yield ratio_row(
            GROUP, f"wind changed, with the first frame, {resolution}²", timings, "state and frame", "frame"
        )


def changed_state(resolution: int, with_frame: bool = False) -> Callable[[], None]:
    """Makes the state of a sea in a wind that never blew before, so that no cache knows it."""
    start = 20.0 if with_frame else 10.0
    speeds = (start + 1e-3 * step for step in itertools.count())
    out = arrays(SIX, resolution)

    def run() -> None:
        ocean = Ocean(with_wind(sea(resolution), next(speeds)), workers=1)
        ocean.initial_state  # noqa: B018
        if with_frame:
            ocean.surface(TIME, SIX.outputs, out=out)

    return run
