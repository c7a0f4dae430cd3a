# SPDX-License-Identifier: GPL-3.0-or-later
"""The rows as a printed table and as JSON; all of them as tables, and of docs/performance.md the targets."""

from __future__ import annotations

import json
from collections.abc import Collection, Sequence
from pathlib import Path
from typing import Any

from .plan import ROOT
from .rows import Row
from .targets import TARGETS

LATEST = ROOT / "benchmarks" / "results" / "latest.json"
TABLES = LATEST.with_suffix(".md")
DOCUMENT = ROOT / "docs" / "performance.md"
BEGIN = "<!-- written by `make bench` from here: do not edit -->"
END = "<!-- to here -->"

_VERDICTS = {True: "met", False: "**not met**", None: ""}
_TARGETS_HEAD = ("work", "target", "worst", "of rows", "")
_ROWS_HEAD = ("measurement", "value", "half of the rounds", "ours", "reference", "n", "free cores", "")


class IncompleteRun(RuntimeError):
    """A run that lacks rows that it should have, or has values that are no measurements."""


#: targets of what should not grow, and may not have
_MAY_BE_NOTHING = {"baked memory"}


def check(rows: Sequence[Row], groups: Sequence[str], left_out: Collection[str] = ()) -> None:
    """Raise IncompleteRun unless every group and every target has its rows, each of them a number above 0.

    left_out : targets without rows
    """
    missing = [group for group in groups if not any(row.group.startswith(group) for row in rows)]
    wanted = [work for work in TARGETS if work not in left_out]
    missing += [work for work in wanted if not any(row.target == work for row in rows)]
    if missing:
        raise IncompleteRun(f"no rows for {', '.join(missing)}")
    names = [(row.group, row.name) for row in rows]
    if len(set(names)) < len(names):
        raise IncompleteRun("two rows have the same name")
    for row in rows:
        if not (0.0 < row.value < float("inf") or (row.value == 0.0 and row.target in _MAY_BE_NOTHING)):
            raise IncompleteRun(f"{row.name}: {row.value} is no measurement")


def line(row: Row, judge: bool = True) -> str:
    """One row for the terminal; small sizes are not judged."""
    times = " / ".join(_milliseconds(value) for value in (row.seconds, row.reference_seconds) if value)
    cores = f"{row.free_cores:.2f} free cores" if row.free_cores else ""
    verdict = {True: "met", False: "NOT MET", None: ""}[row.met if judge else None]
    limit = f"({TARGETS[row.target]})" if row.target and judge else ""
    return f"{row.name:78} {_value(row):>16} {verdict:8}{limit:36}{times:>24}  {cores}".rstrip()


def summary(rows: Sequence[Row]) -> list[tuple[str, str, str, str, str]]:
    """Of each target: its work, its limit, the worst value, how many rows, and the verdict."""
    result = []
    for key, target in TARGETS.items():
        judged = [row for row in rows if row.target == key]
        if not judged:  # of a run before the target was set
            result.append((target.work, str(target), "", "0", "not measured yet"))
            continue
        worst = target.worst([row.value for row in judged])
        verdicts = {row.met for row in judged}
        met = next(verdict for verdict in (False, None, True) if verdict in verdicts)
        shown = _VERDICTS[met] or "not judged: fewer than two free cores"
        if met is False and target.what_limits:
            shown += f"; the limit: {target.what_limits}"
            if target.tried:
                shown += f". Tried: {target.tried}"
        result.append((target.work, str(target), _number(worst), str(len(judged)), shown))
    return result


def save(report: dict[str, Any], path: Path) -> None:
    """Write the whole report as JSON."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(report, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


def rows_of(report: dict[str, Any]) -> list[Row]:
    """The rows of a report that was read from JSON."""
    return [Row.from_dict(row) for row in report["rows"]]


def markdown(report: dict[str, Any]) -> str:
    """The generated part of the document."""
    return f"{_about(report)}\n\n{_table(_TARGETS_HEAD, summary(rows_of(report)))}"


def tables(report: dict[str, Any]) -> str:
    """All rows of a run, a table a group."""
    rows = rows_of(report)
    parts = ["# All measurements of the last complete run", _about(report)]
    for group in dict.fromkeys(row.group for row in rows):
        cells = [_cells(row) for row in rows if row.group == group]
        parts += [f"## {group[0].upper()}{group[1:]}", _table(_ROWS_HEAD, cells)]
    return "\n\n".join(parts) + "\n"


def update_document(report: dict[str, Any], path: Path = DOCUMENT) -> None:
    """Put the generated part between the document's markers. Raises ValueError if they are not there."""
    before, begin, rest = path.read_text(encoding="utf-8").partition(BEGIN)
    _, end, after = rest.partition(END)
    if not begin or not end:
        raise ValueError(f"{path.name} lacks the markers {BEGIN} and {END}")
    path.write_text(f"{before}{BEGIN}\n\n{markdown(report)}\n\n{END}{after}", encoding="utf-8")


def _about(report: dict[str, Any]) -> str:
    machine, versions = report["machine"], report["versions"]
    caches = ", ".join(f"{name} {size}" for name, size in machine["caches of one core"].items())
    blenders = "; ".join(
        f"{place}: Blender {found['blender']} with Python {found['python']} and NumPy {found['numpy']}"
        for place, found in report["blender"].items()
    )
    packages = ", ".join(f"{name} {number}" for name, number in versions.items())
    return (
        f"{machine['processor']}, {machine['cores']} cores ({caches}), {machine['memory in GB']} GB, "
        f"{machine['system']}. {packages}. {blenders}. Load average before the run {report['load before']}, "
        f"{report['rounds']} rounds (3 of foam of a frame by itself), {report['minutes']} minutes in all."
    )


def _cells(row: Row) -> tuple[str, ...]:
    half = " … ".join(_number(value) for value in row.quartiles) if row.quartiles else ""
    verdict = f"{_VERDICTS[row.met]} ({TARGETS[row.target]})" if row.target else ""
    name = f"{row.name} ({row.remark})" if row.remark else row.name
    return (
        name, _value(row), half, _milliseconds(row.seconds), _milliseconds(row.reference_seconds),
        str(row.repeats), f"{row.free_cores:.2f}" if row.free_cores else "", verdict.strip(),
    )  # fmt: skip


def _table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in lines)


def _value(row: Row) -> str:
    return f"{_number(row.value)} {row.unit}"


def _number(value: float) -> str:
    return f"{value:.1e}" if value < 1e-3 else f"{value:.3g}" if value < 100 else f"{value:.0f}"


def _milliseconds(seconds: float | None) -> str:
    return "" if seconds is None else f"{_number(1e3 * seconds)} ms"
