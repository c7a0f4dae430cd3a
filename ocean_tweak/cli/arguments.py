# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line's arguments."""

from __future__ import annotations

import argparse
from typing import Any

from .. import __version__
from ..core.parameters.presets import built_in
from ..core.synthesis.channels import MOVING_MAP
from ..export.exr import COMPRESSION_ERROR
from ..export.frame_files import BAKED
from ..export.places import CACHE_VARIABLE
from ..export.usd.attributes import ATTRIBUTES
from ..export.usd.options import DEFAULTS, FORM_OPTIONS, OPTIONS, written
from ..export.usd.package import FORMS, UP_AXES
from . import argument_values, baking, checking, info, job, spectrum, usd
from .seas import chosen_seas


def make_parser(in_blender: bool) -> argparse.ArgumentParser:
    """Create the parser; each command's `run` takes its arguments and a function that returns the open file's
    oceans."""
    program = "blender --command ocean_tweak" if in_blender else "python -m ocean_tweak"
    parser = argparse.ArgumentParser(
        prog=program,
        description="Ocean Tweak: seas with true wave heights, from wind, fetch, depth and swell.",
    )
    parser.add_argument("--version", action="version", version=f"Ocean Tweak {__version__}")
    commands = parser.add_subparsers(title="commands", required=True, metavar="COMMAND")
    _add_info(commands, in_blender)
    _add_bake(commands, in_blender)
    _add_resume(commands)
    _add_verify(commands, in_blender)
    _add_clean(commands)
    _add_job(commands, in_blender)
    _add_usd(commands, in_blender)
    _add_usd_verify(commands)
    _add_spectrum(commands)
    return parser


_FOLDER_HELP = "a bake's folder, NAME-UID/vNNN-hash8"
_PLACE_HELP = f"{_FOLDER_HELP}, or what was given to --out, where it holds one bake"

_Arguments = argparse._ActionsContainer  # a parser or a group of its arguments
_Commands = argparse._SubParsersAction  # type: ignore[type-arg]


def _command(commands: _Commands, name: str, purpose: str) -> argparse.ArgumentParser:
    parser: argparse.ArgumentParser = commands.add_parser(
        name, help=purpose, description=f"{purpose[0].upper()}{purpose[1:]}."
    )
    parser.add_argument("--json", action="store_true", help="print JSON, one object per line")
    parser.add_argument(
        "-v", "--verbose", action="count", default=0,
        help="print what is done; twice (-vv), what is read too",
    )  # fmt: skip
    return parser


def _add_info(commands: _Commands, in_blender: bool) -> None:
    parser = _command(commands, "info", "print what the sea will be")
    _add_sea_arguments(parser, in_blender)
    parser.add_argument(
        "--save",
        type=argument_values.path,
        metavar="FILE.json",
        help="write the sea with all changes, and planned patches, as parameters",
    )
    parser.set_defaults(run=lambda arguments, oceans: info.run(arguments, chosen_seas(arguments, oceans)))


def _add_spectrum(commands: _Commands) -> None:
    parser = _command(
        commands, "spectrum", "read spectra that were measured or forecast, and write a sea of them"
    )
    parser.add_argument(
        "files", type=argument_values.path, nargs="+", metavar="FILE",
        help="NDBC's text (data_spec, swdir, swdir2, swr1, swr2, or historical w, d, i, j, k, also .gz, and "
        "the weather for its wind), or SWAN's spectra",
    )  # fmt: skip
    parser.add_argument(
        "--time", metavar="TIME",
        help="2020-06-08T03:50 in UTC, one to another with / between, or all; by default the latest",
    )  # fmt: skip
    parser.add_argument(
        "--place", metavar="NAME", help="which of several places; by default the first with energy"
    )
    parser.add_argument(
        "--tail", action="store_true",
        help="continue the spectrum beyond its highest frequency as f⁻⁵: short waves that the file lacks",
    )  # fmt: skip
    parser.add_argument("--out", type=argument_values.path, metavar="FILE.json", help="write the sea")
    parser.set_defaults(run=lambda arguments, _oceans: spectrum.run(arguments))


def _add_bake(commands: _Commands, in_blender: bool) -> None:
    parser = _command(commands, "bake", "write frames as EXR images; existing frames are kept")
    _add_sea_arguments(parser, in_blender)
    _add_frames(parser, in_blender)
    parser.add_argument(
        "--only", type=argument_values.frames, metavar="RANGE",
        help="bake only these of the frames now; the others are baked elsewhere or later",
    )  # fmt: skip
    _add_cache(parser, in_blender, "--out")
    _add_files_arguments(parser)
    _add_spray(parser)
    _add_work_arguments(parser)
    parser.set_defaults(run=lambda arguments, oceans: baking.bake(arguments, chosen_seas(arguments, oceans)))


def _add_frames(parser: argparse.ArgumentParser, in_blender: bool) -> None:
    parser.add_argument(
        "--frames", type=argument_values.frames, metavar="RANGE", required=not in_blender,
        help="1-48, 1-100x2 or 1001,1005-1010" + ("; by default the scene's" if in_blender else ""),
    )  # fmt: skip


def _add_cache(parser: _Arguments, in_blender: bool, option: str) -> None:
    parser.add_argument(
        option, type=argument_values.path, metavar="DIR",
        help="cache folder, in which the sea gets its own folder; by default "
        + ("the file's, or " if in_blender else "")
        + f"${CACHE_VARIABLE}",
    )  # fmt: skip


def _add_files_arguments(parser: _Arguments) -> None:
    """Arguments besides the sea that determine the files of a bake."""
    parser.add_argument(
        "--maps", type=argument_values.maps, metavar="LIST", default=(MOVING_MAP,),
        help=f"what to write, of {','.join(BAKED)}; {MOVING_MAP} by default",
    )  # fmt: skip
    _add_area(parser)
    parser.add_argument("--name", help="start of the file names; by default that of the sea")
    parser.add_argument(
        "--uid",
        type=argument_values.uid,
        help="tells seas with the same name apart, in the folder's name; made from the name by default",
    )
    parser.add_argument(
        "--compression", choices=tuple(COMPRESSION_ERROR), default="PXR24",
        help="PXR24 (default) keeps displacement to 2⁻¹⁶ and foam, normals and velocity to 2⁻¹¹ of the "
        "largest; the others are exact; HTJ2K needs Blender 5.2 to read",
    )  # fmt: skip


def _add_area(parser: _Arguments) -> None:
    parser.add_argument(
        "--area", action=argument_values.AreaAction, nargs="+", metavar=("SIZE", "SAMPLES X Y"),
        help="SIZE SAMPLES [X Y]: instead of the repeating tile, a square of SIZE m with SAMPLES² "
        "samples and its corner at X Y (0 0 by default)",
    )  # fmt: skip


def _add_spray(parser: _Arguments) -> None:
    parser.add_argument(
        "--spray", action="store_true",
        help="write the sea's spray too, as points; --set spray.amount=2 and the like change it",
    )  # fmt: skip
    parser.add_argument(
        "--spray-place", type=argument_values.coordinate, nargs=2, metavar=("X", "Y"),
        help="of a sea of patches: make it around this place, in metres: where the camera is",
    )  # fmt: skip


def _add_resume(commands: _Commands) -> None:
    parser = _command(commands, "resume", "make what is missing, stale or damaged of a bake")
    _add_folder_arguments(parser, _PLACE_HELP)
    _add_work_arguments(parser)
    parser.set_defaults(run=lambda arguments, _oceans: baking.resume(arguments))


def _add_verify(commands: _Commands, in_blender: bool) -> None:
    parser = _command(commands, "verify", "read a bake back: hashes, headers, pixels and wave heights")
    parser.add_argument(
        "folder", type=argument_values.path, metavar="FOLDER", nargs="?",
        help=f"{_PLACE_HELP}; or leave it out and give the arguments of the bake",
    )  # fmt: skip
    _add_wanted_frames(parser)
    sea = parser.add_argument_group("the sea, instead of a folder")
    _add_sea_arguments(sea, in_blender)
    _add_cache(sea, in_blender, "--out")
    _add_files_arguments(sea)
    _add_openjd(parser)
    parser.set_defaults(run=checking.verify)


def _add_clean(commands: _Commands) -> None:
    parser = _command(commands, "clean", "delete the frames of a bake, and nothing else")
    _add_folder_arguments(parser, _FOLDER_HELP)
    _add_take_over(parser)
    parser.set_defaults(run=lambda arguments, _oceans: checking.clean(arguments))


def _add_job(commands: _Commands, in_blender: bool) -> None:
    parser = _command(commands, "job", "write a job for a render farm: bake, verify and render a shot")
    _add_sea_arguments(parser, in_blender)
    _add_frames(parser, in_blender)
    _add_files_arguments(parser)
    _add_spray(parser)
    _add_cache(parser, in_blender, "--cache")
    parser.add_argument(
        "--out",
        type=argument_values.path,
        metavar="DIR",
        required=True,
        help="folder for the job, on a disk that the farm reads",
    )
    parser.add_argument(
        "--form", choices=tuple(job.FORMS), default="openjd",
        help="openjd (default): Open Job Description, for AWS Deadline Cloud; flamenco: a job type",
    )  # fmt: skip
    parser.add_argument(
        "--chunk",
        type=argument_values.count,
        metavar="N",
        default=25,
        help="frames per baking task; 25 by default",
    )
    parser.add_argument(
        "--plain-ranges", action="store_true",
        help="write out the frames of each task, for farms without the extension TASK_CHUNKING",
    )  # fmt: skip
    _add_program_arguments(parser)
    _add_render_arguments(parser)
    parser.set_defaults(run=lambda arguments, oceans: job.job(arguments, chosen_seas(arguments, oceans)))


def _add_program_arguments(parser: argparse.ArgumentParser) -> None:
    programs = parser.add_argument_group("programs on the farm")
    programs.add_argument(
        "--bake-with", choices=tuple(job.BAKERS), default="python",
        help="what bakes: a Python with Ocean Tweak (default), or Blender with the extension",
    )  # fmt: skip
    programs.add_argument("--python", metavar="COMMAND", default=job.PYTHON, help=f"{job.PYTHON} by default")
    programs.add_argument("--blender", metavar="COMMAND", default="blender", help="blender by default")
    programs.add_argument(
        "--workers",
        type=argument_values.workers,
        metavar="N",
        help="processes per baking task; by default one per core",
    )


def _add_render_arguments(parser: argparse.ArgumentParser) -> None:
    rendering = parser.add_argument_group("rendering")
    rendering.add_argument(
        "--blend",
        type=argument_values.path,
        metavar="FILE.blend",
        help="the file to render from the bake; without it nothing is rendered",
    )
    rendering.add_argument(
        "--pictures", type=argument_values.path, metavar="DIR", help="by default a folder in the job's own"
    )
    rendering.add_argument(
        "--render-chunk",
        type=argument_values.count,
        metavar="N",
        default=5,
        help="frames per rendering task; 5 by default",
    )


def _add_usd(commands: _Commands, in_blender: bool) -> None:
    parser = _command(commands, "usd", "write the sea as USD layers, for other programs")
    _add_sea_arguments(parser, in_blender)
    parser.add_argument(
        "--frames",
        type=argument_values.frames,
        metavar="RANGE",
        help="1-48, 1001-1010x0.5; with --bake by default all",
    )
    parser.add_argument(
        "--form", choices=FORMS, required=True,
        help="; ".join(f"{form}: {option.text}" for form, option in FORM_OPTIONS.items()),
    )  # fmt: skip
    parser.add_argument(
        "--out",
        type=argument_values.path,
        required=True,
        metavar="FILE.usd",
        help="the asset; its other layers are written beside it",
    )
    parser.add_argument("--name", help="of the asset, by default that of the file")
    parser.add_argument("--force", action="store_true", help=OPTIONS["force"].text)
    parser.add_argument(
        "--workers",
        type=argument_values.workers,
        metavar="N",
        help="threads that make frames; 2 by default",
    )
    _add_openjd(parser)
    _add_spray(parser)
    _add_usd_content(parser.add_argument_group("what the layers hold"))
    forms = parser.add_argument_group("one form only")
    forms.add_argument(
        "--only",
        type=argument_values.frames,
        metavar="RANGE",
        help="clips: write only these frames now, without the top layer",
    )
    forms.add_argument(
        "--stitch", action="store_true", help=("clips: write the top layer over existing clips")
    )
    forms.add_argument(
        "--bake",
        type=argument_values.path,
        metavar="FOLDER",
        help="displacement: use this bake instead of making one",
    )
    parser.set_defaults(run=usd.run)


def _add_usd_content(parser: _Arguments) -> None:
    def add(name: str, more: str = "", **kind: Any) -> None:
        text, default = OPTIONS[name].text, written(name, DEFAULTS[name])
        if "action" not in kind:
            kind["default"] = DEFAULTS[name]
            text += more or (f"; {default} by default" if default else "")
        parser.add_argument(f"--{name.replace('_', '-')}", help=text, **kind)

    add("up_axis", choices=UP_AXES)
    add("metres_per_unit", type=float, metavar="M")
    add("subframes", type=argument_values.count, metavar="N")
    add(
        "attributes",
        f", of {','.join(ATTRIBUTES)}; all by default",
        type=argument_values.attributes,
        metavar="LIST",
    )
    add("half", action="store_true")
    add("tiles", type=argument_values.tiles, metavar="3x3")
    add("proxy", type=int, metavar="N")
    _add_area(parser)
    add("variants", type=argument_values.resolutions, metavar="512,256")


def _add_usd_verify(commands: _Commands) -> None:
    parser = _command(
        commands, "usd-verify", "read USD layers back: what is missing, still or of another sea"
    )
    parser.add_argument("file", type=argument_values.path, metavar="FILE.usd", help="the asset's own layer")
    parser.add_argument(
        "--frames",
        type=argument_values.frames,
        metavar="RANGE",
        help="compare these; by default first, middle and last",
    )
    parser.set_defaults(run=lambda arguments, _oceans: usd.verify(arguments))


def _add_folder_arguments(parser: argparse.ArgumentParser, purpose: str) -> None:
    parser.add_argument("folder", type=argument_values.path, metavar="FOLDER", help=purpose)
    _add_wanted_frames(parser)


def _add_wanted_frames(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--frames",
        type=argument_values.frames,
        metavar="RANGE",
        help="by default all that were asked for or made",
    )


def _add_work_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--workers", type=argument_values.workers, metavar="N",
        help="processes that share the frames; by default one per core as far as memory allows; a "
        "process that is killed is restarted",
    )  # fmt: skip
    parser.add_argument(
        "--wait",
        action="store_true",
        help=("wait for other processes that bake the same frames, instead of refusing"),
    )
    _add_take_over(parser)
    parser.add_argument(
        "--log", action="store_true",
        help="also write a log with times beside the bake's folder, vNNN-hash8.log",
    )  # fmt: skip
    parser.add_argument(
        "--estimate", action="store_true", help="only say how many frames, bytes and seconds it will take"
    )
    _add_openjd(parser)


def _add_take_over(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--take-over", action="store_true",
        help="also remove locks of dead processes on other machines; those of this machine are removed "
        "anyway",
    )  # fmt: skip


def _add_openjd(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--openjd",
        action="store_true",
        help="print openjd_progress and openjd_status lines for a render farm",
    )


def _add_sea_arguments(parser: _Arguments, in_blender: bool) -> None:
    default = "the file's oceans" if in_blender else "the default sea"
    source = parser.add_mutually_exclusive_group()
    source.add_argument(
        "--params",
        type=argument_values.path,
        metavar="FILE",
        help=f"parameters: JSON, - for what is piped in, or a USD layer of ours; without them {default}",
    )
    source.add_argument(
        "--preset", choices=tuple(built_in()), metavar="NAME", help=f"one of {', '.join(built_in())}"
    )
    parser.add_argument(
        "--set", action="append", default=[], metavar="KEY=VALUE", dest="assignments",
        help="change one parameter, for example layers.0.wind_speed=25 (may be repeated)",
    )  # fmt: skip
    parser.add_argument(
        "--plan", type=argument_values.wish, metavar="finest=0.1,area=4000,memory=2GB",
        help="plan patches: shortest waves in metres, side of the square without repetition in metres, "
        "memory (2GB if left out)",
    )  # fmt: skip
    parser.add_argument("--fps", metavar="N", help="frames per second, also as a fraction: 24000/1001")
    parser.add_argument("--start-frame", metavar="N", help="frame at which ocean time is 0")
    if in_blender:
        source.add_argument("--object", metavar="NAME", help="only the ocean of this object")
