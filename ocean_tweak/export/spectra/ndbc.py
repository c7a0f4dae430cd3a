# SPDX-License-Identifier: GPL-3.0-or-later
"""Spectra of the buoys of the National Data Buoy Center, as its web pages give them.

A spectrum is spread over five files: energy, α₁, α₂, r₁ and r₂ (Steele, Lau & Hsu 1985). Realtime files say
in their first line what they hold and beside each number its frequency; historical ones say it in their
name, 41010w2019.txt, and have the frequencies in the first line. Directions are those from which waves come,
clockwise from north; r is in hundredths in historical files. Wind is in a sixth file, of the weather.
"""

from __future__ import annotations

import datetime
import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .records import MOST_FREQUENCIES, MOST_NUMBERS, Record, filled_moments, ordered, towards
from .text import Lines, refuse_file

Array = NDArray[np.float64]

#: what realtime files say in their first line, by the letter that historical ones have in their name
_REALTIME = {"w": "spec_1", "d": "alpha1_1", "i": "alpha2_1", "j": "r1_1", "k": "r2_1"}
_NAMES = {"w": "energy (data_spec, w)", "d": "α1 (swdir, d)", "i": "α2 (swdir2, i)", "j": "r1 (swr1, j)",
          "k": "r2 (swr2, k)"}  # fmt: skip
_HISTORICAL = re.compile(r"([0-9a-z]{5})([wdijk])\d{4}\b", re.IGNORECASE)
_WEATHER = re.compile(r"\bWDIR?\b.*\bWSPD\b")

_Times = dict[datetime.datetime, Array]


class Table(NamedTuple):
    """One file: what it holds (a letter), of which station, and rows of numbers by time; NaN for missing."""

    kind: str
    station: str
    f: Array
    rows: _Times


def kind_of(path: Path, first_line: str) -> str:
    """The letter of what an NDBC file holds, "h" for weather; "" for a file that is none."""
    if _WEATHER.search(first_line):
        return "h"
    for kind, word in _REALTIME.items():
        if word in first_line:
            return kind
    found = _HISTORICAL.match(path.name)
    if found and first_line.lstrip("#").split()[:1] in (["YY"], ["YYYY"]):
        return found[2].lower()
    return ""


def is_nameless(first_line: str) -> bool:
    """Whether it is a historical file whose name does not say what it holds."""
    words = first_line.lstrip("#").split()
    return words[:2] in (["YY", "MM"], ["YYYY", "MM"])


def read_ndbc(paths: Sequence[Path]) -> list[Record]:
    """The records of NDBC files, one for each station. Raises ParameterError."""
    tables: dict[str, dict[str, Table]] = {}
    winds: dict[str, _Times] = {}
    for path in paths:
        lines = Lines(path)
        first = lines.needed("the first line")
        kind = kind_of(path, first)
        if kind == "h":
            winds.setdefault(_station(path), {}).update(_winds(lines, first))
            continue
        read: Callable[[Lines, str, str], Table] = _historical if _is_historical(first) else _realtime
        table = read(lines, first, kind)
        own = tables.setdefault(table.station, {})
        if kind in own:
            own[kind] = _together(path, own[kind], table)
        else:
            own[kind] = table
    if not tables:
        refuse_file(paths[0], "holds weather alone: give the file of the energy too, such as 41010.data_spec")
    return [_record(station, own, winds.get(station), paths) for station, own in tables.items()]


def _is_historical(first_line: str) -> bool:
    return not any(word in first_line for word in _REALTIME.values())


def _station(path: Path) -> str:
    found = _HISTORICAL.match(path.name)
    return (found[1] if found else path.name.partition(".")[0][:5]).upper()


def _together(path: Path, first: Table, second: Table) -> Table:
    """Two files of the same kind, of one time after the other."""
    if not np.array_equal(first.f, second.f):
        refuse_file(path, "has other frequencies than the file before it: read them one after the other")
    return first._replace(rows={**first.rows, **second.rows})


def _realtime(lines: Lines, _first: str, kind: str) -> Table:
    """Rows of a time and of numbers, each with its frequency in brackets."""
    f: Array | None = None
    rows: _Times = {}
    for line in lines:
        words = line.replace("(", " ").replace(")", " ").split()
        if not words or words[0].startswith("#"):
            continue
        time, rest = _time(lines, words, True)
        if kind == "w" and len(rest) % 2:  # the frequency that parts sea from swell
            rest = rest[1:]
        if len(rest) % 2 or len(rest) < 4:
            lines.refuse(f"has {len(rest)} words after its time, not pairs of a number and its frequency")
        own = np.array([lines.decimal(word, "a frequency") for word in rest[1::2]])
        if f is None:
            f = _checked_frequencies(lines, own)
        elif not np.array_equal(own, f):
            lines.refuse("has other frequencies than the lines before: cut the file where they change")
        rows[time] = _values(lines, kind, rest[::2], 1.0)
        _check_count(lines, rows, f)
    if f is None:
        lines.refuse("has no spectrum: it holds a first line alone, fetch it again")
    return Table(kind, _station(lines.path), f, rows)


def _historical(lines: Lines, first: str, kind: str) -> Table:
    """Rows of a time and of a number for each frequency in the first line."""
    words = first.lstrip("#").split()
    has_minutes = "mm" in words
    head = 5 if has_minutes else 4
    f = _checked_frequencies(lines, np.array([lines.decimal(word, "a frequency") for word in words[head:]]))
    rows: _Times = {}
    for line in lines:
        own = line.split()
        if not own or own[0].startswith("#"):
            continue
        time, rest = _time(lines, own, has_minutes)
        if len(rest) != len(f):
            lines.refuse(f"has {len(rest)} numbers for the {len(f)} frequencies of the first line")
        rows[time] = _values(lines, kind, rest, 0.01 if kind in "jk" else 1.0)
        _check_count(lines, rows, f)
    if not rows:
        lines.refuse("has no spectrum: it holds a first line alone, fetch it again")
    return Table(kind, _station(lines.path), f, rows)


def _time(lines: Lines, words: list[str], has_minutes: bool) -> tuple[datetime.datetime, list[str]]:
    """The time at the start of a row, and the words after it."""
    count = 5 if has_minutes else 4
    if len(words) < count:
        lines.refuse("is too short for a time: year, month, day, hour" + ", minute" * has_minutes)
    told = [lines.whole(word, "part of a time", 0, 9999) for word in words[:count]]
    year, month, day, hour, minute = (*told, 0)[:5]
    if year < 100:  # before 1999 files have two digits
        year += 1900 if year > 69 else 2000
    try:
        return datetime.datetime(year, month, day, hour, minute), words[count:]
    except ValueError as error:
        lines.refuse(f"has no time that exists ({error})")


def _values(lines: Lines, kind: str, words: Sequence[str], factor: float) -> Array:
    """Numbers, NaN where they are missing."""
    result = np.empty(len(words))
    for index, word in enumerate(words):
        value = np.nan if word == "MM" else lines.decimal(word, "a number")
        missing = value >= 999.0 or (kind != "d" and kind != "i" and value == 99.0)
        result[index] = np.nan if missing else value * factor
    if kind == "w" and bool(np.any(result < 0.0)):
        lines.refuse("has energy below 0, which no spectrum has")
    if kind in "jk" and bool(np.any((result < 0.0) | (result > 1.0))):
        lines.refuse(
            f"has r of {np.nanmax(np.abs(result)):g}: must be from 0 to 1, or hundredths in historical files"
        )
    return result


def _checked_frequencies(lines: Lines, f: Array) -> Array:
    if not 2 <= len(f) <= MOST_FREQUENCIES:
        lines.refuse(f"has {len(f)} frequencies: must have from 2 to {MOST_FREQUENCIES}")
    if not (bool(np.all(f > 0.0)) and bool(np.all(np.diff(f.astype(np.float32)) > 0.0)) and f[-1] < 100.0):
        lines.refuse("has frequencies that do not ascend from above 0 Hz to below 100 Hz")
    return f


def _check_count(lines: Lines, rows: _Times, f: Array) -> None:
    if len(rows) * len(f) > MOST_NUMBERS:
        lines.refuse(f"has more than {MOST_NUMBERS} numbers: cut out the times that are wanted")


def _winds(lines: Lines, first: str) -> _Times:
    """Winds in m/s as x and y, by time."""
    names = first.lstrip("#").split()
    columns = [names.index("WDIR" if "WDIR" in names else "WD"), names.index("WSPD")]
    rows: _Times = {}
    for line in lines:
        words = line.split()
        if not words or words[0].startswith("#"):
            continue
        time, _ = _time(lines, words, "mm" in names)
        if len(words) <= max(columns):
            lines.refuse(f"has {len(words)} words where the first line names {len(names)}")
        told = [words[column] for column in columns]
        if "MM" in told:
            continue
        direction, speed = (lines.decimal(word, "a wind") for word in told)
        if direction < 999.0 and 0.0 <= speed < 99.0:
            angle = float(towards(np.asarray(direction)))
            rows[time] = speed * np.array([np.cos(angle), np.sin(angle)])
    return rows


def _record(station: str, tables: dict[str, Table], winds: _Times | None, paths: Sequence[Path]) -> Record:
    """A station's files together."""
    if "w" not in tables:
        found = ", ".join(_NAMES[kind] for kind in tables)
        refuse_file(paths[0], f"of {station} there is {found} alone: give the file of the energy too")
    energy = tables["w"]
    for kind, table in tables.items():
        if not np.array_equal(table.f, energy.f):
            other = f"{_NAMES[kind]} of {station} has other frequencies than its energy"
            refuse_file(paths[0], f"{other}: give files of the same times")
    times = [time for time, row in energy.rows.items() if np.any(row > 0.0)]
    if not times:
        refuse_file(paths[0], f"of {station} all spectra are missing or 0: choose another time or station")
    notes = [f"{len(energy.rows) - len(times)} spectra without energy are left out"]
    notes = notes if len(times) < len(energy.rows) else []
    times, moments, more = _directions(tables, times)
    spectra = np.array([np.nan_to_num(energy.rows[time]) for time in times])
    return ordered(
        Record(
            station, tuple(times), energy.f, spectra, moments=moments, wind=_wind_at(times, winds),
            notes=(*notes, *more),
        )
    )  # fmt: skip


def _directions(
    tables: dict[str, Table], times: list[datetime.datetime]
) -> tuple[list[datetime.datetime], Array | None, list[str]]:
    """Times with their moments, or all times and None where there are no directions; and what to tell."""
    missing = [_NAMES[kind] for kind in "dijk" if kind not in tables]
    if len(missing) == 4:
        return times, None, []
    if missing:
        reason = f"directions need all four files, and {', '.join(missing)} is not there"
        return times, None, [f"{reason}: they are left out"]
    in_all = [time for time in times if all(time in tables[kind].rows for kind in "dijk")]
    if not in_all:
        return times, None, ["no time is in all five files: directions are left out"]
    notes = []
    if len(in_all) < len(times):
        notes.append(f"{len(times) - len(in_all)} spectra without directions are left out")
    a1, a2, r1, r2 = (np.array([tables[kind].rows[time] for time in in_all]) for kind in "dijk")
    energy = np.array([tables["w"].rows[time] for time in in_all])
    moments, more = filled_moments(r1 * np.exp(1j * towards(a1)), r2 * np.exp(2j * towards(a2)), energy)
    return in_all, moments, [*notes, *more]


def _wind_at(times: Sequence[datetime.datetime], winds: _Times | None) -> NDArray[np.complex128] | None:
    """Winds at the times of the spectra, linear between those that were measured."""
    if not winds:
        return None
    known = sorted(winds)
    seconds = [(time - known[0]).total_seconds() for time in known]
    at = [(time - known[0]).total_seconds() for time in times]
    x, y = (np.interp(at, seconds, [winds[time][axis] for time in known]) for axis in (0, 1))
    return np.asarray(x + 1j * y)
