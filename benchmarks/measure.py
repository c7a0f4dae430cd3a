# SPDX-License-Identifier: GPL-3.0-or-later
"""Times several ways to do a thing in turns, so that a machine that drifts drifts for all of them."""

from __future__ import annotations

import gc
import statistics
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

#: seconds that one sample lasts at least: what is quicker is repeated within it
_SHORTEST = 0.02
_MOST_LOOPS = 64

Clock = Callable[[], float]


@dataclass(frozen=True)
class Timings:
    """Seconds that each side took, one number a round."""

    seconds: Mapping[str, Sequence[float]]

    @property
    def rounds(self) -> int:
        """How often each side was timed."""
        return min(len(values) for values in self.seconds.values())

    def median(self, side: str) -> float:
        """Seconds of one call."""
        return statistics.median(self.seconds[side])

    def ratios(self, side: str, reference: str) -> list[float]:
        """One side's time in units of another's, of each round."""
        return [a / b for a, b in zip(self.seconds[side], self.seconds[reference], strict=True)]

    def ratio(self, side: str, reference: str) -> float:
        """The median of the rounds' ratios."""
        return statistics.median(self.ratios(side, reference))

    def quartiles(self, side: str, reference: str) -> tuple[float, float]:
        """Between which half of the rounds' ratios lie."""
        ratios = self.ratios(side, reference)
        if len(ratios) < 2:
            return ratios[0], ratios[0]
        low, _, high = statistics.quantiles(ratios, n=4, method="inclusive")
        return low, high


def interleaved(
    sides: Mapping[str, Callable[[], object]], rounds: int, clock: Clock = time.perf_counter
) -> Timings:
    """Time each side once a round, in turns and every other round in the opposite order.

    Each side runs once before, untimed, and is then repeated within a round until the clock can tell.
    """
    loops = {name: _loops(work, clock) for name, work in sides.items()}
    seconds: dict[str, list[float]] = {name: [] for name in sides}
    collecting = gc.isenabled()
    gc.disable()
    try:
        for turn in range(rounds):
            for name in list(sides)[:: -1 if turn % 2 else 1]:
                seconds[name].append(_timed(sides[name], loops[name], clock))
    finally:
        if collecting:
            gc.enable()
    return Timings(seconds)


def _loops(work: Callable[[], object], clock: Clock) -> int:
    work()
    single = max(_timed(work, 1, clock), 1e-9)
    return min(_MOST_LOOPS, max(1, round(_SHORTEST / single)))


def _timed(work: Callable[[], object], loops: int, clock: Clock) -> float:
    begin = clock()
    for _ in range(loops):
        work()
    return (clock() - begin) / loops
