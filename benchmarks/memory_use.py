# SPDX-License-Identifier: GPL-3.0-or-later
"""The most that `surface()` takes at once beside the arrays it fills, as NumPy asks for it."""

from __future__ import annotations

import tracemalloc
from collections.abc import Iterator

from ocean_tweak.core import Ocean
from ocean_tweak.core.numerics.memo import MEMO

from .field_sets import ALL, SIX, THREE, TIME, FieldSet, arrays
from .plan import Plan, sea
from .rows import Row

GROUP = "memory"


def rows(plan: Plan) -> Iterator[Row]:
    """Of a fresh ocean whose initial state exists: all that playback adds."""
    for resolution in plan.memory:
        for fields in (THREE, SIX, ALL):
            for workers in (1, 2):
                peaks = [peak_bytes(fields, resolution, workers) for _ in range(plan.rounds)]
                yield Row(
                    GROUP,
                    f"{fields.name}, {resolution}², {'one worker' if workers == 1 else 'two workers'}",
                    max(peaks) / resolution**2,
                    "bytes a sample",
                    plan.rounds,
                    target="memory",
                )


def peak_bytes(fields: FieldSet, resolution: int, workers: int) -> int:
    """Bytes allocated at most at once during the first surface, its outputs apart."""
    ocean = Ocean(sea(resolution), workers=workers)
    ocean.initial_state  # noqa: B018
    out = arrays(fields, resolution)
    MEMO.drop("workspaces")  # of the surface before
    tracemalloc.start()
    try:
        ocean.surface(TIME, fields.outputs, out=out)
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
