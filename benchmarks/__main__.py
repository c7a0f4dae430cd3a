# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures everything, prints it, and keeps a complete run in results and docs/performance.md."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable, Iterator
from typing import Any

from . import (
    baking,
    blender_rows,
    cascades,
    coast,
    foam_rows,
    growth,
    initial_states,
    machine,
    memory_use,
    precision,
    report,
    transforms,
    usd_rows,
    wakes,
    wind_fields,
)
from .plan import FULL, SCRATCH, SMOKE, Plan
from .rows import Row

GROUPS: dict[str, Callable[[Plan], Iterator[Row]]] = {
    module.GROUP: module.rows
    for module in (
        blender_rows,
        baking,
        initial_states,
        transforms,
        wind_fields,
        cascades,
        wakes,
        coast,
        foam_rows,
        growth,
        memory_use,
        usd_rows,
        precision,
    )
}

#: above this load, others are at work and the numbers are noise
_QUIET = 0.5


def main(arguments: list[str] | None = None) -> int:
    """Measure what was asked for; return the exit code: 0 where all rows are there, whatever they say."""
    options = _parse(arguments)
    plan = SMOKE if options.smoke else FULL
    load = machine.load()
    if load > _QUIET and not options.smoke:
        print(f"load average {load}: others are at work, so these numbers will be noise", flush=True)
    begin = time.monotonic()
    rows = _measure(options.rows or list(GROUPS), plan)
    result: dict[str, Any] = {
        "machine": machine.machine(),
        "versions": machine.versions(),
        "blender": blender_rows.versions,
        "load before": load,
        "minutes": round((time.monotonic() - begin) / 60.0, 1),
        "rounds": plan.rounds,
        "rows": [row.to_dict() for row in rows],
    }
    return _keep(result, rows, plan, complete=not options.rows)


def _parse(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument("--smoke", action="store_true", help="small and few: only to see that all of it runs")
    parser.add_argument("--rows", nargs="+", choices=list(GROUPS), metavar="GROUP", help=", ".join(GROUPS))
    return parser.parse_args(arguments)


def _measure(groups: list[str], plan: Plan) -> list[Row]:
    rows = []
    for group in groups:
        print(f"== {group}", flush=True)
        for row in GROUPS[group](plan):
            print(report.line(row, judge=not plan.smoke), flush=True)
            rows.append(row)
    return rows


def _keep(result: dict[str, Any], rows: list[Row], plan: Plan, complete: bool) -> int:
    """Write the results; only a complete run of full size replaces the latest one."""
    if not complete:
        report.save(result, SCRATCH / "part.json")
        return 0
    try:
        report.check(rows, list(GROUPS), plan.left_out)
    except report.IncompleteRun as error:
        print(f"benchmarks: {error}", file=sys.stderr)
        return 1
    if plan.smoke:
        report.save(result, SCRATCH / "smoke.json")
        print(f"{len(rows)} rows, all there, in {result['minutes']} minutes")
        return 0
    report.save(result, report.LATEST)
    report.TABLES.write_text(report.tables(result), encoding="utf-8")
    report.update_document(result)
    print("== targets", *(" | ".join(cells) for cells in report.summary(rows)), sep="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
