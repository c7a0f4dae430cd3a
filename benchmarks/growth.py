# SPDX-License-Identifier: GPL-3.0-or-later
"""How the time per sample grows with the surface."""

from __future__ import annotations

from collections.abc import Iterator

from .field_sets import SIX, THREE, surface_maker
from .measure import interleaved
from .plan import Plan
from .rows import Row
from .transforms import numpy_transforms

GROUP = "growth"


def rows(plan: Plan) -> Iterator[Row]:
    """The large size against the small one, ours and, to compare, one bare transform."""
    small, large = plan.growth
    sides = {
        (title, size): maker(size)
        for title, maker in (
            ("3 fields", lambda size: surface_maker(THREE, size, 1)),
            ("6 fields + eigenvalue", lambda size: surface_maker(SIX, size, 1)),
            ("one irfft2", lambda size: numpy_transforms(1, size)),
        )
        for size in (small, large)
    }
    timings = interleaved({f"{title} {size}": work for (title, size), work in sides.items()}, plan.rounds)
    samples = (large / small) ** 2
    for title in dict.fromkeys(title for title, _ in sides):
        pair = f"{title} {large}", f"{title} {small}"
        low, high = timings.quartiles(*pair)
        yield Row(
            GROUP,
            f"{title}, time per sample at {large}² against {small}²",
            timings.ratio(*pair) / samples,
            repeats=timings.rounds,
            quartiles=(low / samples, high / samples),
            seconds=timings.median(pair[0]),
            reference_seconds=timings.median(pair[1]),
            target=None if title == "one irfft2" else "growth",
        )
