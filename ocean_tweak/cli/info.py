# SPDX-License-Identifier: GPL-3.0-or-later
"""`info`: statistics of a sea."""

from __future__ import annotations

import argparse
import dataclasses
import json
import logging
import math
from collections.abc import Mapping
from pathlib import Path

from ..core import Ocean, OceanParameters, Spray
from ..core.data.printable import readable_bytes
from ..core.foam.threshold import foam_outlook
from ..core.numerics.memo import MEMO
from ..core.parameters.patch_seas import open_sea
from ..core.sea.coast_outlook import CoastOutlook, coast_cost, coast_outlook
from ..core.sea.memory import beyond_budget, check_coast_memory, check_memory
from ..core.sea.placed_waves import has_tile, makes_foam
from ..core.sea.spray_outlook import expected_count, why_none
from ..core.spray.columns import BYTES_IN_FILE
from ..core.statistics import sea_scales
from ..core.statistics.sea_spectrum import SeaSpectrum
from ..core.statistics.sea_statistics import SeaState, Statistics, spectrum_state
from ..core.waves.contribution import NO_LONGEST, Contribution, Outlook
from ..core.waves.kinds import KINDS
from ..core.waves.spectral import WaveLayer
from ..export.cache.estimate import seconds_of_statistics, statistics_memory
from ..export.sea_files import write_sea
from .outcome import DONE, UsageError
from .progress import Sharing, duration
from .seas import FileSea

_LOG = logging.getLogger(__name__)

#: number of the largest cache entries to print
_KINDS = 3

#: samples times layers above which memory and time are printed first
_LARGE = 8 * 2048**2


def run(arguments: argparse.Namespace, seas: Mapping[str, FileSea]) -> int:
    """Print the statistics of each sea; for an animated one, at its first frame."""
    parameters = {name: sea.first_parameters() for name, sea in seas.items()}
    for name, of_sea in parameters.items():
        _foretell(name, of_sea)
    coasts = {name: _over_bed(name, Ocean(of_sea)) for name, of_sea in parameters.items()}
    results = {name: Ocean(open_sea(of_sea.separate)).statistics() for name, of_sea in parameters.items()}
    if arguments.save is not None:
        _save(arguments.save, seas)
    if arguments.json:
        report = {
            name: {
                "parameters": seas[name].shot.to_dict(),
                "statistics": _plain(statistics),
                "memory": {
                    **dataclasses.asdict(Ocean(parameters[name]).memory()),
                    "budget": MEMO.budget,
                    "kept": MEMO.report(),
                },
                **_plain_spray(parameters[name]),
                **{
                    kind.former_list or kind.kind.lower(): found.to_plain()
                    for kind, found in _outlooks(parameters[name])
                },
                **({} if (coast := coasts[name]) is None else {"coast": coast.to_plain()}),
            }
            for name, statistics in results.items()
        }
        print(json.dumps(report, indent=2))
        return DONE
    for name, statistics in results.items():
        print("\n".join(_report(name, parameters[name], statistics, coasts[name])))
    print(_kept())
    return DONE


def _kept() -> str:
    """Cache use and budget."""
    sizes = MEMO.report()
    kinds = ", ".join(f"{kind} {readable_bytes(size)}" for kind, size in list(sizes.items())[:_KINDS])
    total = readable_bytes(sum(sizes.values()))
    return f"memory for all seas: {total} of {readable_bytes(MEMO.budget)} is used: {kinds}"


def _foretell(name: str, parameters: OceanParameters) -> None:
    """Print the cost of a large sea's statistics before computing them. Raises MemoryError if it is too
    large."""
    need, layers = statistics_memory(parameters), len(parameters.active(WaveLayer))
    what = f"{name}: {parameters.resolution}² samples and {layers} layer{'s' if layers != 1 else ''}"
    check_memory(need, what)
    check_coast_memory(parameters, f"{name}: what the bed makes of the waves")
    if parameters.resolution**2 * max(1, layers) < _LARGE:
        return
    seconds = seconds_of_statistics(parameters)
    _LOG.warning(
        "%s take about %s and %s of memory; with fewer samples, such as --set resolution=1024, "
        "the numbers come sooner and are nearly the same", what, duration(seconds), readable_bytes(need),
    )  # fmt: skip


def _save(path: Path, seas: Mapping[str, FileSea]) -> None:
    if len(seas) > 1:
        raise UsageError("--save: the file has several oceans; choose one with --object")
    (sea,) = seas.values()
    write_sea(path, sea.shot)


def _plain(statistics: Statistics) -> dict[str, object]:
    """For a sea of one patch, only the totals."""
    told = statistics.to_dict()
    if len(statistics.patches) == 1:
        del told["patches"]
    return told


def _plain_spray(parameters: OceanParameters) -> dict[str, object]:
    if parameters.spray is None:
        return {}
    why = why_none(parameters)
    count = round(expected_count(parameters, parameters.spray))
    return {"spray": {"particles": count, **({} if why is None else {"why_none": why})}}


def _outlooks(parameters: OceanParameters) -> list[tuple[type[Contribution], Outlook]]:
    """Summaries of layers whose waves are not part of the sea's statistics."""
    shown = sorted(KINDS, key=lambda kind: kind.names.number)
    found = ((kind, kind.outlook(parameters)) for kind in shown)
    return [(kind, outlook) for kind, outlook in found if outlook is not None]


def _over_bed(name: str, sea: Ocean) -> CoastOutlook | None:
    """Summary of a sea's coast, after what it takes was printed, with its progress; None without a coast."""
    cost = coast_cost(sea)
    if cost is None:
        return None
    _LOG.warning("%s: waves over the coast's bed: %s", name, cost.text())
    return coast_outlook(sea, Sharing(f"{name}: waves over the coast's bed"))


def _report(
    name: str, parameters: OceanParameters, statistics: Statistics, coast: CoastOutlook | None
) -> list[str]:
    share = f"{100.0 * statistics.resolved_share:.1f} % of the energy"
    state = sea_scales.sea_state(statistics.significant_wave_height)
    need = Ocean(parameters).memory()
    sides = [patch.resolution for patch in parameters.patches] or [parameters.resolution]
    samples = " and ".join(f"{side}²" for side in sides)
    grid = "grid" if len(sides) == 1 else "grids"
    lines = [
        f"{name}: {samples} samples, {statistics.sample_spacing:.3g} m apart; "
        f"{need.peak() / 2**20:.0f} MB of memory, {need.surface / 2**20:.0f} MB more for each further worker",
        f"  {'':<18}{'Hs':>10}{'Tp':>10}{'Tz':>10}{'slope':>8}{'towards':>9}{'spread':>8}",
        _state_row("spectrum", statistics.spectrum),
        f"{_state_row(f'resolved by {grid}', statistics.resolved)}  {share}",
        _state_row(f"seed {parameters.seed}", statistics.seed),
        f"  {_peak(parameters, statistics)}sea state {state}, {sea_scales.SEA_STATE_NAMES[state].lower()}",
    ]
    lines += _patch_rows(statistics)
    if parameters.merged_resolution:
        apart = parameters.domain_size / parameters.merged_resolution
        lines.append(
            f"  merged on {parameters.merged_resolution}² samples, {apart:.3g} m apart: "
            f"waves from {2.0 * apart:.3g} m"
        )
    lines += _equalised(parameters)
    if parameters.is_masked:
        lines.append("  masks cover some of these waves; all numbers are without masks")
    coverage, earlier = foam_outlook(parameters)
    if coverage > 0.0:
        share = f"{100.0 * coverage:.2g} % of the sea by {parameters.foam.law}"
        lines.append(f"  foam on {share}; a single frame looks back over {earlier} moments")
    if parameters.spray is not None:
        lines.append(f"  {_spray(parameters, parameters.spray)}")
    if statistics.loop_speed_change is not None:
        change = 100.0 * statistics.loop_speed_change
        duration = float(parameters.repeats_after or 0)
        what = "loop" if parameters.loop_duration is not None else "coast: the sea repeats, as a loop"
        lines.append(f"  {what} of {duration:g} s: changes the speed of waves by at most {change:.2g} %")
    lines += [f"  {line}" for line in coast.lines()] if coast is not None else []
    warnings = [*statistics.warnings, *(coast.warnings if coast is not None else ())]
    for _, outlook in _outlooks(parameters):
        lines += [f"  {line}" for line in outlook.lines()]
        warnings += outlook.warnings
    over = beyond_budget(parameters)
    warnings += [] if over is None else [over]
    return lines + [f"  warning: {warning}" for warning in warnings]


def _equalised(parameters: OceanParameters) -> list[str]:
    """What equalisers do to the height of the spectrum."""
    after = SeaSpectrum(parameters)
    if not any(spectrum.equalisers for spectrum in after.layers):
        return []
    layers = (
        layer.changed(equaliser=None) if isinstance(layer, WaveLayer) else layer
        for layer in parameters.layers
    )
    before = parameters.replace(equaliser=None, layers=tuple(layers))
    heights = [spectrum_state(sea).significant_wave_height for sea in (SeaSpectrum(before), after)]
    return [f"  equaliser: Hs {heights[0]:.2f} m before it, {heights[1]:.2f} m after"]


def _spray(parameters: OceanParameters, spray: Spray) -> str:
    if (why := why_none(parameters)) is not None:
        return why
    count = expected_count(parameters, spray)
    size = readable_bytes(round(count) * BYTES_IN_FILE)
    where = "on the tile" if has_tile(parameters) else "around the camera"
    bows = ", besides what hulls throw up" if makes_foam(parameters) else ""
    amount = f"{float(f'{count:.2g}'):,.0f} particles {where}"
    return f"spray of about {amount}, {size} a frame with bake --spray{bows}"


def _patch_rows(statistics: Statistics) -> list[str]:
    """A table of the patches, if there are several."""
    if len(statistics.patches) < 2:
        return []
    head = (
        "patch",
        "side",
        "turned",
        "waves from",
        "to",
        "samples",
        "a wave",
        "waves a side",
        "Hs",
        "energy",
    )
    rows = [head]
    for number, of_patch in enumerate(statistics.patches, 1):
        patch = of_patch.patch
        is_open = patch.longest_wavelength >= NO_LONGEST
        rows.append(
            (
                str(number),
                f"{patch.domain_size:g} m",
                f"{math.degrees(patch.rotation):.3g}°",
                f"{patch.shortest_wavelength:.4g} m",
                "all" if is_open else f"{patch.longest_wavelength:.4g} m",
                f"{patch.resolution}²",
                f"{patch.samples_a_wave:.3g}" if patch.shortest_wavelength else "–",
                "–" if is_open else f"{patch.longest_waves_a_side:.3g}",
                f"{of_patch.statistics.resolved.significant_wave_height:.3g} m",
                f"{100.0 * of_patch.share:.3g} %",
            )
        )
    widths = [max(len(row[column]) for row in rows) for column in range(len(head))]
    cells = (zip(row, widths, strict=True) for row in rows)
    return ["  " + "  ".join(f"{cell:>{width}}" for cell, width in row) for row in cells]


def _peak(parameters: OceanParameters, statistics: Statistics) -> str:
    """Text for the waves at the peak; "" for a flat sea."""
    if not math.isfinite(statistics.peak_wavelength):
        return ""
    return (
        f"peak wavelength {statistics.peak_wavelength:.4g} m, "
        f"{statistics.wavelengths_per_domain:.3g} in the domain of {parameters.domain_size:g} m; "
        f"steepness {statistics.spectrum.steepness:.3f}; "
    )


def _state_row(title: str, state: SeaState) -> str:
    slope = math.sqrt(state.mean_square_slope)
    direction, spread = math.degrees(state.mean_direction), math.degrees(state.directional_spread)
    row = f"  {title:<18}{state.significant_wave_height:>8.2f} m"
    if not math.isfinite(state.peak_period):  # a flat sea has no further numbers
        return f"{row}{'-':>10}{'-':>10}{slope:>8.3f}{'-':>9}{'-':>8}"
    return (
        f"{row}{state.peak_period:>8.2f} s{state.zero_crossing_period:>8.2f} s{slope:>8.3f}"
        f"{direction:>8.0f}°{spread:>7.0f}°"
    )
