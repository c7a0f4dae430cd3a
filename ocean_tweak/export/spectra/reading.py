# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of spectra of any kind that is read: what they hold, and the sea that a choice of it makes."""

from __future__ import annotations

import datetime
import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ...core.data.errors import ParameterError
from ...core.parameters.ocean_parameters import OceanParameters
from ...core.spectral import dispersion
from ...core.waves.spectral import WaveLayer
from .ndbc import is_nameless, kind_of, read_ndbc
from .records import Record, time_text
from .swan import FIRST_WORD, read_swan
from .text import Lines, refuse_file

#: of the domain of a sea: wavelengths at the lowest frequency with much energy, and limits in m
_WAVELENGTHS, _SMALLEST, _LARGEST = 4.0, 50.0, 5000.0
#: share of the energy below that frequency
_LOW = 0.02
_RESOLUTION = 1024

ALL_TIMES = "all"


def read_spectra(paths: Sequence[Path]) -> list[Record]:
    """What is in some files, a record for each place, those with energy first.

    Several files of NDBC belong together, as one spectrum is spread over five of them.
    Raises ParameterError, which names the file and the line, for one that is none or damaged.
    """
    ndbc: list[Path] = []
    records: list[Record] = []
    for path in paths:
        first = Lines(path).next_line() or ""
        if first.split()[:1] == [FIRST_WORD]:
            records += read_swan(path)
        elif kind_of(path, first):
            ndbc.append(path)
        elif is_nameless(first):
            refuse_file(
                path,
                "has a name that does not say what it holds: call it as NDBC does, such as 41010w2019.txt",
            )
        else:
            refuse_file(
                path, "is no spectrum of SWAN or of NDBC: of other kinds wavespectra writes one for SWAN, as "
                "docs/measured-seas.md says",
            )  # fmt: skip
    if ndbc:
        records += read_ndbc(ndbc)
    if not any(record.times for record in records):
        refuse_file(paths[0], "has no spectrum with energy: choose another file")
    return sorted(records, key=lambda record: not record.times)


def chosen_place(records: Sequence[Record], wanted: str | None) -> Record:
    """The first with energy, or the one whose name begins with what is wanted. Raises ParameterError."""
    if wanted is None:
        return records[0]
    text = wanted.strip().lower()
    for matches in (str.__eq__, str.startswith):
        for record in records:
            names = [record.place.lower(), record.place.lower().split()[0]]
            if any(matches(name, text) for name in names) and text:
                if not record.times:
                    raise ParameterError("place", wanted, "has no spectrum with energy: choose another place")
                return record
    known = "; ".join(record.place for record in records[:20])
    raise ParameterError("place", wanted, f"is not in the file: it has {known}")


def chosen_times(record: Record, wanted: str | None) -> Record:
    """The latest spectrum, that of a time, those from one to another (A/B), or all. Raises ParameterError."""
    if wanted is None:
        return record.at([len(record.times) - 1])
    if wanted.strip().lower() == ALL_TIMES:
        return record
    known = [time for time in record.times if time is not None]
    if not known:
        raise ParameterError("time", wanted, "cannot be chosen: the file tells no time")
    first, slash, last = wanted.partition("/")
    start = _time(first)
    end = _time(last) if slash else start
    if end < start:
        raise ParameterError("time", wanted, "must go from the earlier time to the later: exchange the two")
    indices = [index for index, time in enumerate(known) if start <= time <= end]
    if not indices:
        nearest = min(known, key=lambda time: abs((time - start).total_seconds()))
        span = f"{time_text(known[0])} to {time_text(known[-1])}"
        raise ParameterError(
            "time", wanted, f"is not in the file, which has {span}: the nearest is {time_text(nearest)}"
        )
    return record.at(indices)


def _time(text: str) -> datetime.datetime:
    try:
        time = datetime.datetime.fromisoformat(text.strip())
    except ValueError:
        raise ParameterError("time", text, "must be a time in UTC such as 2020-06-08T03:50") from None
    return time if time.tzinfo is None else time.astimezone(datetime.UTC).replace(tzinfo=None)


def measured_layer(record: Record, tail: bool = False) -> WaveLayer:
    """A wave layer of a record's spectra; without a measured wind it makes no foam."""
    has_wind = record.wind is not None
    return WaveLayer(
        definition="MEASURED",
        measured=record.spectra(tail),
        wind_speed=WaveLayer().wind_speed if has_wind else 0.0,
    )


def measured_sea(record: Record, tail: bool = False) -> OceanParameters:
    """A sea of a record's spectra alone, on a domain that has room for its longest waves."""
    sea = OceanParameters(layers=(measured_layer(record, tail),), resolution=_RESOLUTION)
    energy = record.energy.max(axis=0)
    lowest = record.f[int(np.searchsorted(np.cumsum(energy), _LOW * energy.sum()))]
    k = float(dispersion.wave_number(2.0 * math.pi * lowest, sea.dispersion, sea.water))
    size = min(max(_WAVELENGTHS * 2.0 * math.pi / k, _SMALLEST), _LARGEST)
    unit = 10.0 ** (math.floor(math.log10(size)) - 1)
    return sea.replace(domain_size=math.ceil(size / unit) * unit)
