# SPDX-License-Identifier: GPL-3.0-or-later
"""`spectrum`: what files of measured or forecast spectra hold, and a sea of it."""

from __future__ import annotations

import argparse
import json
import math
from pathlib import Path
from typing import Any

from ..core import Ocean, OceanParameters
from ..core.data.printable import printable
from ..core.parameters.shot import Shot
from ..export.sea_files import write_sea
from ..export.spectra.reading import chosen_place, chosen_times, measured_sea, read_spectra
from ..export.spectra.records import Record, time_text
from .outcome import DONE, UsageError

#: places and times of which a line is printed
_MOST_LINES = 60


def run(arguments: argparse.Namespace) -> int:
    """Print what the files hold and what is chosen of it, and write the sea."""
    out = arguments.out
    if out is not None and any(Path(out).resolve() == Path(file).resolve() for file in arguments.files):
        raise UsageError(f"--out {out} is one of the files that are read: give the sea another name")
    records = read_spectra(arguments.files)
    place = chosen_place(records, arguments.place)
    chosen = chosen_times(place, arguments.time)
    sea = measured_sea(chosen, arguments.tail)
    if arguments.json:
        print(json.dumps(_plain(records, chosen)))
    else:
        print("\n".join([*_places(records), *_report(chosen, sea)]))
    if out is not None:
        write_sea(out, Shot(sea))
    return DONE


def _places(records: list[Record]) -> list[str]:
    lines = []
    for record in records[:_MOST_LINES]:
        if not record.times:
            lines.append(f"{printable(record.place)}: no spectrum with energy")
            continue
        span = " to ".join(dict.fromkeys(time_text(time) for time in (record.times[0], record.times[-1])))
        count = len(record.times)
        kind = (
            "with directions"
            if record.moments is not None or record.shares is not None
            else "without directions"
        )
        lines.append(
            f"{printable(record.place)}: {count} {'spectra' if count > 1 else 'spectrum'} {kind}, {span}, "
            f"{len(record.f)} frequencies from {record.f[0]:.4g} to {record.f[-1]:.4g} Hz"
        )
        lines += [f"  {note}" for note in record.notes]
    if len(records) > _MOST_LINES:
        lines.append(f"and {len(records) - _MOST_LINES} places more")
    return lines


def _report(chosen: Record, sea: OceanParameters) -> list[str]:
    """What is taken of it, and what a grid leaves out."""
    lines = [
        f"chosen: {printable(chosen.place)}",
        f"  {'':<18}{'Hs':>9}{'Tp':>9}{'from':>7}{'towards':>9}{'spread':>8}",
    ]
    for index, time in enumerate(chosen.times[:_MOST_LINES]):
        state = chosen.summary(index)
        row = f"  {time_text(time):<18}{state.significant_wave_height:>7.2f} m{state.peak_period:>7.2f} s"
        if math.isfinite(state.mean_direction):
            spread, towards = math.degrees(state.directional_spread), math.degrees(state.mean_direction)
            row += f"{state.comes_from:>6.0f}°{towards:>8.0f}°{spread:>7.0f}°"
        lines.append(row)
    if len(chosen.times) > _MOST_LINES:
        lines.append(f"  and {len(chosen.times) - _MOST_LINES} times more")
    if chosen.wind is not None:
        speeds = abs(chosen.wind)
        lines.append(f"  wind of {speeds.min():.1f} to {speeds.max():.1f} m/s makes the whitecaps")
    else:
        lines.append(
            "  without a wind there are no whitecaps: set layers.0.wind_speed, or give a file with it"
        )
    statistics = Ocean(sea.replace(resolution=16)).statistics()
    whole = statistics.spectrum.significant_wave_height
    lines.append(f"  the sea: Hs {whole:.2f} m on {sea.domain_size:g} m with {sea.resolution}² samples")
    lines += [f"  warning: {warning}" for layer in sea.layers for warning in layer.warnings(sea)]
    return lines


def _plain(records: list[Record], chosen: Record) -> dict[str, Any]:
    return {
        "places": [
            {
                "place": record.place,
                "times": [time_text(time) for time in record.times],
                "notes": list(record.notes),
            }
            for record in records
        ],
        "chosen": {
            "place": chosen.place,
            "spectra": [
                {
                    "time": time_text(time),
                    **{
                        name: value if math.isfinite(value) else None
                        for name, value in vars(chosen.summary(index)).items()
                    },
                }
                for index, time in enumerate(chosen.times)
            ],
        },
    }
