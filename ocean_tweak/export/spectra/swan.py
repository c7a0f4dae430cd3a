# SPDX-License-Identifier: GPL-3.0-or-later
"""Spectra in the text files of the wave model SWAN (its user manual, appendix D), as others write them too.

They hold any number of places and times, E(f, θ) or S(f) with a direction and a spread for each frequency.
Nautical directions (NDIR) are those from which waves come, clockwise from north; Cartesian ones (CDIR) those
towards which they run, counter-clockwise from x. Frequencies are absolute (AFREQ) or relative to a current.
"""

from __future__ import annotations

import datetime
import math
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...core.data.printable import printable
from .records import (
    MOST_DIRECTIONS,
    MOST_FREQUENCIES,
    MOST_NUMBERS,
    Record,
    filled_moments,
    ordered,
    towards,
)
from .text import Lines, refuse_file

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

FIRST_WORD = "SWAN"

#: how times are written, by SWAN's coding option
_TIME_FORMATS = {
    1: "%Y%m%d.%H%M%S", 2: "%d-%b-%y %H:%M:%S", 3: "%m/%d/%y %H:%M:%S", 5: "%y/%m/%d %H:%M:%S",
    6: "%y%m%d%H%M",
}  # fmt: skip

_MOST_PLACES = 10_000

#: m, significant, above which a file must be wrong: four times the highest ever measured
_HIGHEST = 80.0

#: N/m³: from energy in J/m² to variance, with SWAN's own density of water and gravity
_WEIGHT = 1025.0 * 9.81


@dataclass
class _Head:
    """What stands before the spectra.

    places : names
    f : Hz; theta : rad towards, in the file's order, None for S(f) alone
    is_absolute, is_nautical : of the frequencies and of the directions
    time_format : None for a stationary file
    quantities : name, unit and the number that stands for a missing one
    """

    places: list[str] = field(default_factory=list)
    f: Array | None = None
    theta: Array | None = None
    is_absolute: bool = True
    is_nautical: bool = True
    time_format: str | None = None
    quantities: list[tuple[str, str, float]] = field(default_factory=list)


def read_swan(path: Path) -> list[Record]:
    """The records of a SWAN file, one for each place. Raises ParameterError."""
    lines = Lines(path)
    if lines.needed("the first line").split()[:1] != [FIRST_WORD]:
        lines.refuse("does not begin with SWAN: it is no SWAN spectrum")
    head = _head(lines)
    assert head.f is not None
    order = np.argsort(head.f, kind="stable")
    times: list[datetime.datetime | None] = []
    blocks: list[list[Array | None]] = []
    numbers = len(head.f) * (3 if head.theta is None else len(head.theta))
    while (line := _next(lines)) is not None:
        if head.time_format is None:
            if blocks:
                lines.refuse("goes on after the last place of a file without TIME: its head lacks it")
            times.append(None)
        else:
            times.append(_time(lines, line, head.time_format))
            line = None
        if (len(blocks) + 1) * len(head.places) * numbers > MOST_NUMBERS:
            lines.refuse(f"has more than {MOST_NUMBERS} numbers: cut out the times or places that are wanted")
        row = []
        for _ in head.places:
            row.append(_spectrum(lines, head, line))
            line = None
        blocks.append(row)
    if not blocks:
        lines.refuse("the file ends where spectra should follow: it is cut off, fetch it again")
    return [
        _record(lines, head, place, times, [row[index] for row in blocks], order)
        for index, place in enumerate(head.places)
    ]


def _next(lines: Lines) -> str | None:
    """The next line that is neither empty nor a comment."""
    for line in lines:
        if line.strip() and not line.lstrip().startswith("$"):
            return line
    return None


def _needed(lines: Lines, what: str) -> str:
    line = _next(lines)
    if line is None:
        lines.refuse(f"the file ends where {what} should follow: it is cut off, fetch it again")
    return line


def _first(lines: Lines, what: str) -> str:
    return _needed(lines, what).split()[0]


def _head(lines: Lines) -> _Head:
    """All up to QUANT and its quantities."""
    head = _Head()
    while True:
        word = _first(lines, "QUANT").upper()
        if word == "TIME":
            coding = lines.whole(_first(lines, "the coding of times"), "coding of times", 0, 99)
            if coding not in _TIME_FORMATS:
                lines.refuse(
                    f"codes times by option {coding}: write the file with one of {sorted(_TIME_FORMATS)}"
                )
            head.time_format = _TIME_FORMATS[coding]
        elif word in ("LOCATIONS", "LONLAT"):
            head.places = _places(lines, word)
        elif word in ("AFREQ", "RFREQ"):
            head.is_absolute = word == "AFREQ"
            head.f = _frequencies(lines)
        elif word in ("NDIR", "CDIR"):
            head.is_nautical = word == "NDIR"
            head.theta = _directions(lines, head.is_nautical)
        elif word == "QUANT":
            break
        else:
            lines.refuse(
                f"{printable(word, 30)} is none of TIME, LOCATIONS, LONLAT, AFREQ, RFREQ, NDIR, CDIR, QUANT"
            )
    if not head.places or head.f is None:
        lines.refuse("comes before " + ("LOCATIONS" if not head.places else "AFREQ or RFREQ"))
    head.quantities = _quantities(lines, head)
    return head


def _places(lines: Lines, word: str) -> list[str]:
    count = lines.whole(_first(lines, "the number of places"), "number of places", 1, _MOST_PLACES)
    result = []
    for number in range(1, count + 1):
        words = _needed(lines, "a place").split()
        if len(words) < 2:
            lines.refuse("must have two numbers: where the place is")
        x, y = (lines.decimal(each, "a place") for each in words[:2])
        result.append(f"{number} ({x:g}°, {y:g}°)" if word == "LONLAT" else f"{number} ({x:g}, {y:g})")
    return result


def _frequencies(lines: Lines) -> Array:
    count = lines.whole(
        _first(lines, "the number of frequencies"), "number of frequencies", 2, MOST_FREQUENCIES
    )
    f = np.array([lines.decimal(_first(lines, "a frequency"), "a frequency") for _ in range(count)])
    if not (bool(np.all(f > 0.0)) and bool(np.all(f < 100.0)) and _differ(f)):
        lines.refuse("ends frequencies that are not all different and between 0 and 100 Hz")
    return f


def _differ(f: Array) -> bool:
    """Whether all are different in the precision in which a layer keeps them."""
    return len(np.unique(f.astype(np.float32))) == len(f)


def _directions(lines: Lines, is_nautical: bool) -> Array:
    """rad towards, in the file's order."""
    count = lines.whole(_first(lines, "the number of directions"), "number of directions", 4, MOST_DIRECTIONS)
    degrees = np.array([lines.decimal(_first(lines, "a direction"), "a direction") for _ in range(count)])
    if float(np.max(np.abs(degrees))) > 1e6:
        lines.refuse("ends directions that are no angles in degrees")
    step = np.median(np.mod(np.diff(np.sort(np.mod(degrees, 360.0))), 360.0))
    if not (
        step > 0.0 and abs(360.0 / step - round(360.0 / step)) < 0.02 and 360.0 / step < MOST_DIRECTIONS + 0.5
    ):
        lines.refuse("ends directions that are not evenly spaced: write the file with even ones")
    places = np.mod(degrees - degrees[0], 360.0) / step
    if float(np.max(np.abs(places - np.rint(places)))) > 0.05:
        lines.refuse("ends directions that are not evenly spaced: write the file with even ones")
    if len(np.unique(np.rint(places).astype(int) % round(360.0 / step))) != count:
        lines.refuse("ends directions of which two are the same")
    return towards(degrees) if is_nautical else np.radians(degrees)


def _quantities(lines: Lines, head: _Head) -> list[tuple[str, str, float]]:
    wanted = 1 if head.theta is not None else 3
    count = lines.whole(_first(lines, "the number of quantities"), "number of quantities", 1, 3)
    if count != wanted:
        lines.refuse(
            f"must be {wanted}: with directions the energy, without them the energy, direction and spread"
        )
    result = []
    for _ in range(count):
        name = _first(lines, "a quantity")
        unit = _first(lines, "a unit")
        result.append((name, unit, lines.decimal(_first(lines, "a number for missing ones"), "a number")))
        if name in ("CDIR", "NDIR"):
            head.is_nautical = name == "NDIR"
    name, unit, _ = result[0]
    if name not in ("VaDens", "EnDens"):
        lines.refuse(
            f"the first quantity is {printable(name, 30)}, not VaDens or EnDens: it is no spectrum of waves"
        )
    if "/hz" not in unit.lower():
        lines.refuse(f"the energy is in {printable(unit, 30)}: must be in m2/Hz/degr or J/m2/Hz/degr")
    return result


def _time(lines: Lines, line: str, time_format: str) -> datetime.datetime:
    words = line.split()
    text = " ".join(words[: len(time_format.split())])
    try:
        return datetime.datetime.strptime(text, time_format)
    except ValueError:
        lines.refuse(f"{printable(text, 40)} is no time as the head of the file codes them")


def _spectrum(lines: Lines, head: _Head, line: str | None) -> Array | None:
    """Of one place at one time: (frequencies, directions or 3), NaN for a missing direction or spread; None
    where there is none."""
    assert head.f is not None
    text = _needed(lines, "a spectrum") if line is None else line
    word = text.split()[0].upper()
    columns = 3 if head.theta is None else len(head.theta)
    if word == "NODATA":
        return None
    if word == "ZERO":
        return np.zeros((len(head.f), columns))
    factor = 1.0
    if head.theta is not None:
        if word != "FACTOR":
            lines.refuse(
                f"{printable(word, 30)} is none of FACTOR, ZERO and NODATA, with which a spectrum begins"
            )
        factor = lines.decimal(_first(lines, "the factor"), "the factor")
    elif word != "LOCATION":
        lines.refuse(
            f"{printable(word, 30)} is none of LOCATION, ZERO and NODATA, with which a spectrum begins"
        )
    values = np.array(_numbers(lines, len(head.f) * columns)).reshape(len(head.f), columns)
    energies = 1 if head.theta is None else columns
    for column in range(energies, columns):
        values[values[:, column] == head.quantities[column][2], column] = np.nan
    energy = values[:, :energies]
    with np.errstate(over="ignore"):
        energy[:] = np.where(energy == head.quantities[0][2], 0.0, energy * factor)
    if bool(np.any(energy < 0.0)):
        lines.refuse("ends a spectrum with energy below 0, which none has")
    if not bool(np.all(energy < 1e12)):
        lines.refuse("ends a spectrum with more energy than any sea has: the factor may be wrong")
    return values


def _numbers(lines: Lines, count: int) -> list[float]:
    result: list[float] = []
    while len(result) < count:
        result += [
            lines.decimal(word, "a number of a spectrum") for word in _needed(lines, "a spectrum").split()
        ]
    if len(result) > count:
        lines.refuse(f"has {len(result) - count} numbers more than the {count} of a spectrum")
    return result


def _record(
    lines: Lines, head: _Head, place: str, times: list[datetime.datetime | None], spectra: list[Array | None],
    order: NDArray[np.intp],
) -> Record:  # fmt: skip
    assert head.f is not None
    kept = [
        index for index, spectrum in enumerate(spectra) if spectrum is not None and np.any(spectrum > 0.0)
    ]
    notes = []
    if len(kept) < len(spectra):
        notes.append(f"{len(spectra) - len(kept)} spectra without energy are left out")
    columns = 3 if head.theta is None else len(head.theta)
    values = np.array([spectra[index] for index in kept]).reshape(len(kept), len(head.f), columns)[:, order]
    own_times = tuple(times[index] for index in kept)
    unit = head.quantities[0][1].lower()
    scale = 1.0 / _WEIGHT if unit.startswith("j") else 1.0
    if head.theta is None:
        energy = scale * values[..., 0]
        moments, more = filled_moments(*_moments(values, head.is_nautical), energy)
        notes += more
        record = Record(place, own_times, head.f[order], energy, moments=moments)
    else:
        per = math.radians(1.0) if "rad" not in unit else 1.0
        whole, first = _around(values, head.theta)
        density = scale / per * whole
        energy = density.sum(axis=-1) * (2.0 * np.pi / whole.shape[-1])
        sums = whole.sum(axis=-1, keepdims=True)
        shares = np.divide(whole, sums, out=np.zeros_like(whole), where=sums > 0.0)
        record = Record(place, own_times, head.f[order], energy, shares=shares, first_direction=first)
    heights = [record.summary(index).significant_wave_height for index in range(len(kept))]
    if heights and max(heights) > _HIGHEST:
        reason = (
            f"has waves of {max(heights):.3g} m at place {place}, higher than any sea's: its factor, unit"
        )
        refuse_file(lines.path, f"{reason} or frequencies may be wrong")
    return ordered(
        Record(**{**vars(record), "absolute": head.is_absolute, "notes": tuple(notes)}) if kept else record
    )


def _around(values: Array, theta: Array) -> tuple[Array, float]:
    """Energy by directions that go evenly around the circle, counter-clockwise, and the first of them.

    A file of a sector has no waves elsewhere.
    """
    turn = 2.0 * np.pi
    step = float(np.median(np.diff(np.sort(np.mod(theta, turn)))))
    count = round(turn / step)
    first = float(np.mod(theta, turn).min())
    column = np.rint(np.mod(theta - first, turn) * (count / turn)).astype(int) % count
    whole = np.zeros((*values.shape[:-1], count))
    whole[..., column] = values
    return whole, first


def _moments(values: Array, is_nautical: bool) -> tuple[ComplexArray, ComplexArray]:
    """a₁ + ib₁ and a₂ + ib₂ of cos²ˢ(θ/2) with a mean direction and a spread: r₁ = s/(s+1), r₂ =
    s(s-1)/((s+1)(s+2)); NaN where those are missing."""
    mean, spread = values[..., 1], np.radians(values[..., 2])
    theta = towards(mean) if is_nautical else np.radians(mean)
    r1 = np.clip(1.0 - 0.5 * spread**2, 0.0, 0.999)
    s = r1 / (1.0 - r1)
    r2 = s * (s - 1.0) / ((s + 1.0) * (s + 2.0))
    turn = np.exp(1j * theta)
    return np.asarray(r1 * turn, np.complex128), np.asarray(r2 * turn**2, np.complex128)
