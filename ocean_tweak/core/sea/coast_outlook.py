# SPDX-License-Identifier: GPL-3.0-or-later
"""Summary of a sea's coast: wave heights and cost."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from ..data.printable import readable_bytes
from ..numerics.machine import usable_cores
from .coast_waves import CoastWaves
from .ocean import Ocean

#: share of broken waves from which on they begin to break
_BEGINS = 0.1
#: s of one core for a sample of a frequency: measured with 600 of them on 512²
_SECONDS = 3.5e-7


class CoastCost(NamedTuple):
    """What waves over a bed will take.

    frequencies, rows, columns : of the pictures
    step : between their samples, m
    bytes : that they take
    share : of the energy of all waves, that of those which follow the bed
    seconds : about as many on this machine, unless they were kept
    """

    frequencies: int
    rows: int
    columns: int
    step: float
    bytes: int
    share: float
    seconds: float

    def text(self) -> str:
        """A sentence without its end."""
        return (
            f"{self.frequencies} frequencies on {self.rows} x {self.columns} samples, {self.step:.3g} m "
            f"apart: {readable_bytes(self.bytes)}, about {max(1.0, self.seconds):.0f} s; they hold "
            f"{100.0 * self.share:.0f} % of the energy"
        )


class CoastOutlook(NamedTuple):
    """Of waves over a bed.

    frequencies, rows, columns : of the pictures
    step : between their samples, m
    bytes : that they take
    seconds : in which they were made, or found
    share : of the energy of all waves, that of those which follow the bed
    offshore, breaking, shore : mean significant heights, m: where the bed begins, where waves begin to break,
        and at the waterline; NaN where there is no such place
    breaking_depth : of the water where they begin to break, m
    """

    frequencies: int
    rows: int
    columns: int
    step: float
    bytes: int
    seconds: float
    share: float
    offshore: float
    breaking: float
    shore: float
    breaking_depth: float

    def lines(self) -> list[str]:
        """What `info` says."""
        first = (
            f"coast: {self.frequencies} frequencies on {self.rows} x {self.columns} samples, "
            f"{self.step:.3g} m apart: {readable_bytes(self.bytes)}, made in {self.seconds:.1f} s; they hold "
            f"{100.0 * self.share:.0f} % of the energy"
        )
        second = f"coast: Hs {self.offshore:.2f} m offshore"
        if np.isfinite(self.breaking):
            second += f", {self.breaking:.2f} m where waves begin to break, in {self.breaking_depth:.1f} m"
        if np.isfinite(self.shore):
            second += f", {self.shore:.2f} m at the shore"
        return [first, second]

    @property
    def warnings(self) -> tuple[str, ...]:
        """One sentence each, with the remedy."""
        if self.frequencies:
            return ()
        return (
            "No waves follow the coast's bed: none that is longer than coast.shortest_wavelength runs "
            "towards coast.shore. Make that wavelength shorter, or turn the waves or the shore",
        )

    def to_plain(self) -> dict[str, Any]:
        """What `info --json` says."""
        numbers = {
            name: None if isinstance(value, float) and not np.isfinite(value) else value
            for name, value in self._asdict().items()
        }
        return {**numbers, "warnings": list(self.warnings)}


def coast_cost(sea: Ocean) -> CoastCost | None:
    """What the waves over a sea's bed will take, before they are computed; None without a coast."""
    coast = sea.coast
    if coast is None:
        return None
    rows, columns = coast.ground.depth.shape
    frequencies, wet = len(np.unique(coast.incoming.number)), int((coast.ground.depth > 0.0).sum())
    samples = frequencies * rows * columns
    return CoastCost(
        frequencies, rows, columns, coast.ground.step, 16 * frequencies * wet, coast.share_of_energy,
        _SECONDS * samples / usable_cores(),
    )  # fmt: skip


def coast_outlook(sea: Ocean, tell: Callable[[float], None] = lambda done: None) -> CoastOutlook | None:
    """Summary of a sea's coast, for which its pictures are computed; None without a coast.

    tell : is told again and again which share of them is
    """
    coast = sea.coast
    if coast is None:
        return None
    begun = time.perf_counter()
    made = coast.make(tell)
    seconds = time.perf_counter() - begun
    rows, columns = coast.ground.depth.shape
    return CoastOutlook(
        len(made.numbers), rows, columns, coast.ground.step, made.nbytes, seconds, coast.share_of_energy,
        *_heights(coast),
    )  # fmt: skip


def _heights(coast: CoastWaves) -> tuple[float, float, float, float]:
    """Offshore, where waves begin to break and at the shore, and the depth where they begin."""
    depth, height = coast.ground.depth, coast.significant_height
    breaks = (coast.broken_share > _BEGINS) & (depth > 0.0)
    shore = (depth[:-1] > 0.0) & (depth[1:] <= 0.0)
    first = np.argmax(breaks, axis=0), np.arange(depth.shape[1])
    found = breaks.any(axis=0)
    nan = float("nan")
    return (
        float(height[coast.ground.rim_rows - 1].mean()),
        float(height[first][found].mean()) if found.any() else nan,
        float(height[:-1][shore].mean()) if shore.any() else nan,
        float(depth[first][found].mean()) if found.any() else nan,
    )
