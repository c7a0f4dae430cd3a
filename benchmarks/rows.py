# SPDX-License-Identifier: GPL-3.0-or-later
"""One line of the table: a value, what it was measured against and how it is judged."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from .measure import Timings
from .targets import TARGETS, TWO_CORES


@dataclass(frozen=True)
class Row:
    """A measurement.

    value, unit : what is judged
    quartiles : between which half of the rounds lie
    seconds, reference_seconds : medians of one call of ours and of what it is compared with
    free_cores : what the probe found beside a measurement of two workers
    target : a key of TARGETS, or None for a measurement that nothing was promised for
    """

    group: str
    name: str
    value: float
    unit: str = "×"
    repeats: int = 1
    quartiles: tuple[float, float] | None = None
    seconds: float | None = None
    reference_seconds: float | None = None
    free_cores: float | None = None
    target: str | None = None
    remark: str = ""

    @property
    def met(self) -> bool | None:
        """Whether the target is met; None without one, or where the machine had not the cores for it."""
        if self.target is None:
            return None
        target = TARGETS[self.target]
        if target.needs_two_cores and (self.free_cores or 0.0) < TWO_CORES and not target.met(self.value):
            return None
        return target.met(self.value)

    def to_dict(self) -> dict[str, Any]:
        """Plain data for a JSON file."""
        limit = None if self.target is None else f"{TARGETS[self.target].work}: {TARGETS[self.target]}"
        return {**asdict(self), "limit": limit, "met": self.met}

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> Row:
        """The row that `to_dict` described."""
        own = {key: value for key, value in data.items() if key not in ("limit", "met")}
        own["quartiles"] = tuple(own["quartiles"]) if own["quartiles"] else None
        return cls(**own)


def ratio_row(
    group: str, name: str, timings: Timings, side: str, reference: str, *, faster: bool = False, **more: Any
) -> Row:
    """Compare two sides of one run.

    faster : give the reference's time in units of ours, how many times faster we are
    """
    sides = (reference, side) if faster else (side, reference)
    return Row(
        group,
        name,
        timings.ratio(*sides),
        "× faster" if faster else "×",
        timings.rounds,
        timings.quartiles(*sides),
        timings.median(side),
        timings.median(reference),
        **more,
    )
