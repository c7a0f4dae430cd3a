# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line: the same arguments as `python -m ocean_tweak` and as `blender --command ocean_tweak`."""

from __future__ import annotations

import argparse
import dataclasses
import json
import math
import os
import re
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from . import __version__
from .core import Ocean, OceanParameters, ParameterError, sea_scales
from .core.bake import bake, parse_frames
from .core.foam_field import foam_outlook
from .core.memory import memory_need
from .core.parameters import parse_json
from .core.statistics import SeaState, Statistics
from .export.exr import COMPRESSION_ERROR, MAPS, ExrError, ExrSequence
from .export.files import writable_folder

DONE, FAILED, WRONG_ARGUMENTS = 0, 1, 2

SceneOceans = Callable[[], dict[str, OceanParameters]]


class UsageError(ValueError):
    """Arguments that do not fit together."""


def main(argv: list[str] | None = None, scene_oceans: SceneOceans | None = None) -> int:
    """Run one command. Returns the exit code: 0 done, 1 failed, 2 wrong arguments or parameters.

    argv : the arguments after the program's name; those of the process by default
    scene_oceans : inside Blender, gives the parameters of the file's oceans by object name
    """
    try:
        arguments = _parser(in_blender=scene_oceans is not None).parse_args(argv)
    except SystemExit as end:  # argparse has printed the reason; Blender wants the code as a result
        return int(end.code or 0)
    try:
        seas = _seas(arguments, scene_oceans)
        return int(arguments.run(arguments, seas))
    except (ParameterError, UsageError) as error:
        _complain(error)
        return WRONG_ARGUMENTS
    except OSError as error:
        _complain(f"{error.filename}: {error.strerror}" if error.filename else error)
        return FAILED
    except ExrError as error:
        _complain(error)
        return FAILED
    except MemoryError as error:
        _complain(error if str(error) else "there is not enough memory: lower the resolution")
        return FAILED
    except KeyboardInterrupt:
        _complain("interrupted; the frames written so far are whole")
        return FAILED


def _complain(message: object) -> None:
    print(f"ocean_tweak: {message}", file=sys.stderr, flush=True)


def _parser(in_blender: bool) -> argparse.ArgumentParser:
    program = "blender --command ocean_tweak" if in_blender else "python -m ocean_tweak"
    parser = argparse.ArgumentParser(
        prog=program,
        description="Ocean Tweak: seas with true wave heights, from wind, fetch, depth and swell.",
    )
    parser.add_argument("--version", action="version", version=f"Ocean Tweak {__version__}")
    commands = parser.add_subparsers(title="commands", required=True, metavar="COMMAND")
    info = commands.add_parser(
        "info", help="print what the sea will be", description="Print what the sea will be."
    )
    info.set_defaults(run=_info)
    baking = commands.add_parser(
        "bake", help="write frames as EXR displacement", description="Write frames as EXR displacement."
    )
    baking.set_defaults(run=_bake)
    for command in (info, baking):
        _add_sea_arguments(command, in_blender)
    baking.add_argument("--frames", required=True, metavar="RANGE", help="1-48, 1-100x2 or 1001,1005-1010")
    baking.add_argument("--out", required=True, type=Path, metavar="DIR", help="folder, made if missing")
    baking.add_argument(
        "--workers", type=_workers, metavar="N", default=os.cpu_count() or 1,
        help="frames made at the same time, by default one a core",
    )  # fmt: skip
    baking.add_argument(
        "--maps", type=_maps, metavar="LIST", default=("disp",),
        help=f"what to write, of {','.join(MAPS)}; disp by default",
    )  # fmt: skip
    baking.add_argument("--name", help="start of the file names; by default that of the sea")
    baking.add_argument(
        "--compression", choices=tuple(COMPRESSION_ERROR), default="PXR24",
help="PXR24 (default) keeps 2⁻¹⁶ of a value, the others are exact; HTJ2K needs Blender 5.2 to read",
    )  # fmt: skip
    return parser


def _add_sea_arguments(command: argparse.ArgumentParser, in_blender: bool) -> None:
    default = "the file's oceans" if in_blender else "the default sea"
    command.add_argument(
        "--params", type=Path, metavar="FILE.json", help=f"parameters; without them {default}"
    )
    command.add_argument(
        "--set", action="append", default=[], metavar="KEY=VALUE", dest="assignments",
        help="change one parameter, for example layers.0.wind_speed=25 (may be repeated)",
    )  # fmt: skip
    command.add_argument("--fps", metavar="N", help="frames per second, also as a fraction: 24000/1001")
    command.add_argument("--start-frame", metavar="N", help="frame at which ocean time is 0")
    command.add_argument("--json", action="store_true", help="print JSON for machines")
    if in_blender:
        command.add_argument("--object", metavar="NAME", help="only the ocean of this object")


def _maps(text: str) -> tuple[str, ...]:
    names = tuple(dict.fromkeys(name.strip() for name in text.split(",")))
    unknown = [name for name in names if name not in MAPS]
    if unknown:
        raise argparse.ArgumentTypeError(f"{unknown[0]!r} is no map; known are {', '.join(MAPS)}")
    return names


def _workers(text: str) -> int:
    if not (text.isdecimal() and 1 <= int(text) <= 256):
        raise argparse.ArgumentTypeError(f"{text!r} must be a whole number from 1 to 256")
    return int(text)


def _seas(arguments: argparse.Namespace, scene_oceans: SceneOceans | None) -> dict[str, OceanParameters]:
    """The seas that the command is about, by name."""
    if arguments.params is not None or scene_oceans is None:
        if getattr(arguments, "object", None):
            raise UsageError("--object and --params exclude each other")
        seas = {_file_sea_name(arguments.params): _file_parameters(arguments.params)}
    else:
        seas = _chosen(scene_oceans(), arguments.object)
    return {name: _changed(parameters, arguments) for name, parameters in seas.items()}


def _file_sea_name(path: Path | None) -> str:
    return path.stem if path else "ocean"


def _file_parameters(path: Path | None) -> OceanParameters:
    if path is None:
        return OceanParameters()
    try:
        text = path.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise ParameterError("params", str(path), f"is not UTF-8 text ({error.reason})") from None
    except OSError as error:
        raise UsageError(f"--params {path}: {error.strerror}") from None
    return OceanParameters.from_json(text)


def _chosen(oceans: dict[str, OceanParameters], name: str | None) -> dict[str, OceanParameters]:
    if not oceans:
        raise UsageError("the file holds no ocean: add one, or give --params FILE.json")
    if name is None:
        return oceans
    if name not in oceans:
        raise UsageError(f"--object {name!r}: no such ocean; the file has {', '.join(sorted(oceans))}")
    return {name: oceans[name]}


def _changed(parameters: OceanParameters, arguments: argparse.Namespace) -> OceanParameters:
    """Parameters with the command line's changes."""
    data = parameters.to_dict()
    for assignment in arguments.assignments:
        path, equals, value = assignment.partition("=")
        if not equals:
            raise UsageError(f"--set {assignment}: must look like layers.0.wind_speed=25")
        _assign(data, path.strip(), _value(value))
    for key in ("fps", "start_frame"):
        value = getattr(arguments, key)
        if value is not None:
            data["timing"][key] = _value(value)
    return OceanParameters.from_dict(data)


def _value(text: str) -> Any:
    """JSON where it is JSON, else the text itself: names of enumerations need no quotes."""
    try:
        return parse_json(text)
    except ParameterError:
        return text.strip()


def _assign(data: Any, path: str, value: Any) -> None:
    """Set data[a][0][b] for the path a.0.b; the parameters' own validation judges the result."""
    *parents, last = path.split(".")
    for key in parents:
        data = _entry(data, key, path)
    if isinstance(data, list):
        _entry(data, last, path)
        data[int(last)] = value
    elif isinstance(data, dict):
        data[last] = value
    else:
        raise UsageError(f"--set {path}: there is nothing inside {parents[-1]}")


def _entry(data: Any, key: str, path: str) -> Any:
    if isinstance(data, list):
        if not key.isdecimal() or int(key) >= len(data):
            raise UsageError(f"--set {path}: {key} must be a number from 0 to {len(data) - 1}")
        return data[int(key)]
    if not isinstance(data, dict) or key not in data:
        known = f"; known keys: {', '.join(data)}" if isinstance(data, dict) else ""
        raise UsageError(f"--set {path}: there is no {key}{known}")
    return data[key]


def _info(arguments: argparse.Namespace, seas: dict[str, OceanParameters]) -> int:
    results = {name: Ocean(parameters).statistics() for name, parameters in seas.items()}
    if arguments.json:
        report = {
            name: {
                "parameters": seas[name].to_dict(),
                "statistics": statistics.to_dict(),
                "memory": dataclasses.asdict(memory_need(seas[name])),
            }
            for name, statistics in results.items()
        }
        print(json.dumps(report, indent=2))
        return DONE
    for name, statistics in results.items():
        print("\n".join(_report(name, seas[name], statistics)))
    return DONE


def _report(name: str, parameters: OceanParameters, statistics: Statistics) -> list[str]:
    share = f"{100.0 * statistics.resolved_share:.1f} % of the energy"
    state = sea_scales.sea_state(statistics.significant_wave_height)
    need = memory_need(parameters)
    lines = [
        f"{name}: {parameters.resolution}² samples, {statistics.sample_spacing:.3g} m apart; "
        f"{need.peak() / 2**20:.0f} MB of memory, {need.surface / 2**20:.0f} MB more for each further worker",
        f"  {'':<18}{'Hs':>10}{'Tp':>10}{'Tz':>10}{'slope':>8}{'towards':>9}{'spread':>8}",
        _state_row("spectrum", statistics.spectrum),
        f"{_state_row('resolved by grid', statistics.resolved)}  {share}",
        _state_row(f"seed {parameters.seed}", statistics.seed),
        f"  peak wavelength {statistics.peak_wavelength:.4g} m, "
        f"{statistics.wavelengths_per_domain:.3g} in the domain of {parameters.domain_size:g} m; "
        f"steepness {statistics.spectrum.steepness:.3f}; "
        f"sea state {state}, {sea_scales.SEA_STATE_NAMES[state].lower()}",
    ]
    coverage, earlier = foam_outlook(parameters)
    if coverage > 0.0:
        share = f"{100.0 * coverage:.2g} %"
        lines.append(f"  foam on {share} of the sea; a frame by itself looks back at {earlier} moments")
    if statistics.loop_speed_change is not None:
        change = 100.0 * statistics.loop_speed_change
        duration = float(parameters.loop_duration or 0)
        lines.append(f"  loop of {duration:g} s: changes the speed of waves by at most {change:.2g} %")
    return lines + [f"  warning: {warning}" for warning in statistics.warnings]


def _state_row(title: str, state: SeaState) -> str:
    slope = math.sqrt(state.mean_square_slope)
    direction, spread = math.degrees(state.mean_direction), math.degrees(state.directional_spread)
    return (
        f"  {title:<18}{state.significant_wave_height:>8.2f} m{state.peak_period:>8.2f} s"
        f"{state.zero_crossing_period:>8.2f} s{slope:>8.3f}{direction:>8.0f}°{spread:>7.0f}°"
    )


def _bake(arguments: argparse.Namespace, seas: dict[str, OceanParameters]) -> int:
    frames = parse_frames(arguments.frames)
    if arguments.name and len(seas) > 1:
        raise UsageError("--name: the file has several oceans; choose one with --object")
    folder = writable_folder(arguments.out)
    for sea_name, parameters in seas.items():
        name = _file_name(arguments.name or sea_name)
        sink = ExrSequence(folder, name, parameters, arguments.compression, arguments.maps)
        for done, baked in enumerate(bake(parameters, frames, sink, arguments.workers), start=1):
            paths, seconds = [str(path) for path in baked.paths], round(baked.seconds, 4)
            if arguments.json:
                print(json.dumps({"frame": baked.frame, "paths": paths, "seconds": seconds}), flush=True)
            else:
                progress = f"frame {baked.frame} ({done}/{len(frames)})"
                print(f"{name}: {progress} {seconds:.2f} s  {', '.join(paths)}", flush=True)
    return DONE


def _file_name(name: str) -> str:
    """The name without what file systems or frame patterns cannot hold."""
    return re.sub(r"[^\w\- ]+", "_", name).strip() or "ocean"
