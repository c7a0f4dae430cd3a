# SPDX-License-Identifier: GPL-3.0-or-later
"""`usd` and `usd-verify`."""

from __future__ import annotations

import argparse
import logging
import os
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

from ..core.data.frames import Frame, format_frames
from ..core.data.plain_data import to_plain
from ..core.data.printable import readable_bytes
from ..core.sea.regions import Area
from ..core.sea.shot_spray import ShotSpray
from ..export.cache.folders import read_job
from ..export.cache.records import recorded_frames
from ..export.spray import baked_spray
from ..export.usd.export import Export
from ..export.usd.isolated import problems_of
from ..export.usd.package import Package, asset_name, with_samples_between
from .outcome import DONE, FAILED, UsageError, shell_word
from .progress import Progress
from .seas import FileSea, SceneOceans, changed, chosen_seas
from .spraying import spray_of
from .stopping import stop_requested

_LOG = logging.getLogger(__name__)

#: threads that compute frames: one computes while another writes
_THREADS = 2


def run(arguments: argparse.Namespace, scene_oceans: SceneOceans | None) -> int:
    """Write a sea as USD layers."""
    sea, frames, area = _what(arguments, scene_oceans)
    shot = sea.shot
    package = Package(
        arguments.name or asset_name(arguments.out),
        shot,
        with_samples_between(frames, arguments.subframes),
        form=arguments.form,
        up_axis=arguments.up_axis,
        metres_per_unit=arguments.metres_per_unit,
        attributes=arguments.attributes,
        half=arguments.half,
        tiles=arguments.tiles,
        proxy=arguments.proxy,
        variants=arguments.variants,
        area=area,
    )
    if arguments.stitch and arguments.only:
        raise UsageError("--stitch makes no frames: leave out --only")
    if arguments.form != "clips" and arguments.stitch:
        raise UsageError(f"--stitch: is for --form clips, not {arguments.form}")
    wanted = spray_of(arguments, sea)
    spray = None if wanted is None else ShotSpray(shot, wanted.spray, wanted.place)
    export = Export(package, arguments.out, arguments.bake, arguments.force, spray)
    progress = Progress(package.name, arguments.json, arguments.openjd)
    chosen = arguments.only or package.frames
    with stop_requested() as stop:
        export.check(chosen)
        if arguments.stitch:
            export.check_clips()
        _make(export, () if arguments.stitch else chosen, arguments, progress, stop.is_set)
    if not progress.is_complete:
        progress.fail("stopped")
        _LOG.error("%s", _stopped(package))
        return FAILED
    if arguments.only:
        progress.say(
            "these clips are written; when all are there, stitch them with --stitch",
            frames=format_frames(chosen),
        )
        return DONE
    export.finish()
    size = export.written_bytes()
    progress.say(
        f"{arguments.out}\n  {len(package.frames)} frames, {format_frames(package.frames)}, as "
        f"{package.form}, {readable_bytes(size)}; check it with: usd-verify "
        f"{shell_word(arguments.out)}",
        path=str(arguments.out), frames=format_frames(package.frames), form=package.form, bytes=size,
    )  # fmt: skip
    return DONE


def _make(
    export: Export,
    frames: tuple[Frame, ...],
    arguments: argparse.Namespace,
    progress: Progress,
    stopped: Callable[[], bool],
) -> None:
    """Write frames, and the spray of all frames if requested and not left for later."""
    spray = arguments.spray and not arguments.only
    if not frames and not spray:
        return
    of_spray = len(export.package.frames) if spray else 0
    left, total = export.left(frames) + of_spray, len(frames) * export.rounds + of_spray
    progress.say(f"{left} of {total} frames to make", left=left)
    progress.begin(left)
    workers = arguments.workers or min(_THREADS, os.cpu_count() or 1)
    rounds = [export.make(frames, workers)] if frames else []
    rounds += [export.make_spray()] if spray else []
    try:
        for making in rounds:
            with closing(making):
                for made in making:
                    progress.frame(made)
                    if stopped():
                        return
    finally:
        progress.end()


def _stopped(package: Package) -> str:
    if package.form == "points":
        return "stopped; nothing was changed"
    return "stopped after a complete frame; the same command continues"


def _what(
    arguments: argparse.Namespace, scene_oceans: SceneOceans | None
) -> tuple[FileSea, tuple[Frame, ...], Area | None]:
    """The sea, its frames and its area, from the arguments or from a bake. Raises UsageError or
    CacheError."""
    if arguments.bake is not None:
        return _of_bake(arguments)
    seas = chosen_seas(arguments, scene_oceans)
    if len(seas) > 1:
        raise UsageError(
            f"the file has several oceans: choose one with --object, of {', '.join(sorted(seas))}"
        )
    ((_, sea),) = seas.items()
    frames = arguments.frames or sea.frames
    if not frames:
        raise UsageError("--frames: say which frames to write")
    return sea, frames, arguments.area


def _of_bake(arguments: argparse.Namespace) -> tuple[FileSea, tuple[Frame, ...], Area | None]:
    folder: Path = arguments.bake
    of_sea = [
        each for each in arguments.assignments if not (arguments.spray and each.strip().startswith("spray."))
    ]
    if arguments.form != "displacement":
        raise UsageError(f"--bake is for --form displacement, not {arguments.form}")
    given = {
        "--params": arguments.params, "--preset": arguments.preset, "--set": of_sea,
        "--fps": arguments.fps, "--start-frame": arguments.start_frame,
        "--area": arguments.area, "--plan": arguments.plan,
    }  # fmt: skip
    for option, value in given.items():
        if value:
            raise UsageError(f"{option}: the bake in {folder} has its own sea; leave out {option} or --bake")
    job = read_job(folder)
    frames = arguments.frames or job.frames or recorded_frames(folder)
    if not frames:
        raise UsageError(f"{folder}: holds no frames")
    spray = baked_spray(folder, job.name, job.shot)
    shot = job.shot if spray is None else spray.wanted.of(job.shot)
    place = None if spray is None else spray.place
    return FileSea(changed(shot, arguments), place=place), frames, _on_its_texels(job.area)


def _on_its_texels(area: Area | None) -> Area | None:
    """The area of a mesh with one vertex per texel of a bake's images."""
    if area is None:
        return None
    quads = area.resolution - 1
    return Area(area.size * quads / area.resolution, quads, area.corner)


def verify(arguments: argparse.Namespace) -> int:
    """Read an asset back and report what is wrong with it."""
    progress = Progress(arguments.file.stem, arguments.json)
    count = 0
    for frame, text in problems_of(arguments.file, arguments.frames):
        count += 1
        place = "" if frame is None else f"frame {format_frames((frame,))}: "
        progress.say(f"{place}{text}", problem=text, frame=None if frame is None else to_plain(frame))
    progress.say(f"{count} problems" if count else "all is well", problems=count)
    return FAILED if count else DONE
