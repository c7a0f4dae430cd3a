# SPDX-License-Identifier: GPL-3.0-or-later
"""`bake` and `resume`."""

from __future__ import annotations

import argparse
import logging
import shlex
import sys
from collections import Counter
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from contextlib import closing, contextmanager
from dataclasses import replace
from fractions import Fraction
from math import lcm
from pathlib import Path
from typing import NamedTuple, NoReturn

from .. import __version__
from ..core.data.frames import Frame, format_frames
from ..core.data.printable import LONGEST, printable, readable_bytes
from ..core.numerics.machine import usable_cores
from ..core.numerics.memo import MEMO
from ..core.sea.bake import BakedFrame, ShotSeas
from ..core.sea.bake import bake as make_frames
from ..core.sea.memory import check_memory, remedy_for
from ..export import logs
from ..export.cache.estimate import Estimate, estimate, fitting_workers, process_memory, with_spray
from ..export.cache.folders import (
    JOB_FILE,
    log_file,
    open_folder,
    read_job,
    recovered_job,
    refuse_links,
    write_job,
)
from ..export.cache.job import CacheError, Job, NewerBakeError, made_with
from ..export.cache.locks import Held, claimed, let_go
from ..export.cache.records import CacheSink, Finding, give_up_writing, remove_leftovers, unfinished
from ..export.exr import ExrError
from ..export.files import writable_folder
from ..export.shelf import use_cache
from ..export.spray import SpraySequence, WantedSpray, baked_spray
from .checking import known_frames, wanted_frames
from .outcome import DONE, FAILED, UsageError, message_of, remedy_of, shell_word
from .progress import Progress, duration
from .seas import FileSea
from .spraying import bake_spray, spray_of
from .stopping import end_now, stop_requested
from .wanted_bake import cache_of, jobs_of, only_bake
from .workers import make_in_processes

_LOG = logging.getLogger(__name__)


def bake(arguments: argparse.Namespace, seas: Mapping[str, FileSea]) -> int:
    """Bake each sea into its own folder of the cache; stop after the first that fails or is stopped."""
    jobs = jobs_of(arguments, seas)
    sprays = {name: spray_of(arguments, seas[name]) for name in jobs}  # report errors before any work
    for name, job in jobs.items():
        code = _bake_sea(arguments, cache_of(arguments, seas[name]), job, sprays[name])
        if code != DONE:
            return code
    return DONE


def _bake_sea(arguments: argparse.Namespace, cache: Path, job: Job, spray: WantedSpray | None) -> int:
    frames = job.frames
    if not frames:
        raise UsageError("--frames: say which frames to bake")
    _check_whole(job)
    chosen = arguments.only or frames
    if not set(chosen) <= set(frames):
        raise UsageError(
            f"--only {format_frames(chosen)}: must be some of the frames {format_frames(frames)}"
        )
    folder = open_folder(writable_folder(cache), job)
    files = None if spray is None else SpraySequence(folder, job.name, job.shot, spray.spray, spray.place)
    return _make_all(arguments, _Wanted(folder, job, chosen, files))


def _check_whole(job: Job) -> None:
    """Refuse subframes, which readers of NAME_disp.####.exr would skip. Raises UsageError."""
    between = [Fraction(frame) for frame in job.frames if not isinstance(frame, int)]
    if not between:
        return
    parts = lcm(*(frame.denominator for frame in between))
    stretch = job.shot.parameters.timing.stretch * parts
    remedy = (
        f", or {parts} for each with --set timing.stretch={stretch}" if job.shot.animation is None else ""
    )
    raise UsageError(
        f"--frames: {format_frames(between[:1])} lies between two frames, and file names hold "
        f"whole numbers: bake whole frames{remedy}"
    )


def resume(arguments: argparse.Namespace) -> int:
    """Continue a bake from its folder."""
    folder = only_bake(arguments.folder, arguments.json)
    try:
        job = read_job(folder)
    except NewerBakeError:
        raise
    except CacheError as error:
        job = recovered_job(folder)
        job = replace(job, frames=known_frames(folder, job))
        write_job(folder, job)
        problem = error.args[0].partition(": run")[0]
        _LOG.warning("%s; the job is written again from the images", problem)
    frames = wanted_frames(folder, job, arguments.frames)
    job = replace(job, frames=known_frames(folder, job) or frames)
    job.shot.check(frames)
    return _make_all(arguments, _Wanted(folder, job, frames, baked_spray(folder, job.name, job.shot)))


class _Wanted(NamedTuple):
    """Frames of a job in its folder, and their spray, which is made when they are there."""

    folder: Path
    job: Job
    frames: Sequence[Frame]
    spray: SpraySequence | None


def _make_all(arguments: argparse.Namespace, wanted: _Wanted) -> int:
    """Bake incomplete frames and their spray. Returns the exit code."""
    spray = wanted.spray
    if spray is not None and not arguments.estimate:
        refuse_links(wanted.folder)
        spray.ask()  # first, so that a bake that is stopped early continues with it
    code = _make(arguments, wanted)
    if code != DONE or spray is None or arguments.estimate:
        return code
    with _telling_how_to_go_on(wanted.folder):
        return bake_spray(arguments, spray, wanted.frames)


def _make(arguments: argparse.Namespace, wanted: _Wanted) -> int:
    """Bake incomplete frames, if there is room for them and their spray. Returns the exit code."""
    folder, job, frames, spray = wanted
    if arguments.log:
        logs.to_file(log_file(folder))
        _LOG.info(
            "Ocean Tweak %s, %s, %d cores: %s", __version__, made_with(), usable_cores(), shlex.join(sys.argv)
        )
    progress = Progress(job.name, arguments.json, arguments.openjd)
    with (
        stop_requested(lambda: _give_up(progress, folder)) as stop,
        claimed(
            folder, tuple(frames), arguments.wait, arguments.take_over, stop.is_set, progress.remark
        ) as hold,
    ):
        left = list(unfinished(folder, job, frames, stop.is_set))
        if left:
            job.check_foam()
        todo = tuple(finding.frame for finding in left)
        workers = _worker_count(arguments.workers, job, todo)
        needed = estimate(folder, job, todo, workers)
        if spray is not None:
            needed = with_spray(needed, spray, spray.missing(frames))
        _announce(progress, folder, job, frames, left, needed)
        needed.check(folder)
        if arguments.estimate:
            return DONE
        progress.begin(len(left))
        with _telling_how_to_go_on(folder):
            _make_frames(progress, folder, job, todo, workers, lambda: stop.is_set() or hold.is_lost())
            if hold.is_lost():
                raise Held(
                    f"{folder}: the lock is gone: another process took it over, or the folder was removed"
                )
    if progress.is_complete:
        return DONE
    progress.fail("stopped")
    _LOG.error("stopped; %s", _go_on(folder))
    return FAILED


def _give_up(progress: Progress, folder: Path) -> NoReturn:
    """End in the middle of a frame."""
    try:
        give_up_writing(folder)
        let_go(folder)
        progress.fail("stopped")
        _LOG.error("stopped; %s", _go_on(folder))
    finally:
        end_now(FAILED)


def _make_frames(
    progress: Progress,
    folder: Path,
    job: Job,
    frames: tuple[Frame, ...],
    workers: int,
    stopped: Callable[[], bool],
) -> None:
    remove_leftovers(folder, job, frames)
    use_cache(folder.parents[1])
    try:
        with closing(_frames(folder, job, frames, workers, stopped, progress.tell)) as making:
            for baked in making:
                progress.frame(baked)
    finally:
        progress.end()


def _frames(
    folder: Path,
    job: Job,
    frames: tuple[Frame, ...],
    workers: int,
    stopped: Callable[[], bool],
    tell: Callable[[Frame, str], None],
) -> Generator[BakedFrame, None, None]:
    if workers > 1:
        _prepare(job, frames[0], tell)
        yield from make_in_processes(folder, job, frames, workers, stopped, tell)
        return
    sink = CacheSink(folder, job, tell)
    with closing(make_frames(job.shot, frames, sink, tell=tell, on=job.on)) as making:
        while not stopped():  # frames in progress are finished
            baked = next(making, None)
            if baked is None:
                return
            yield baked


def _prepare(job: Job, frame: Frame, tell: Callable[[Frame, str], None]) -> None:
    """Compute a coast's waves once, and keep them where all processes find them."""
    if job.shot.parameters.has_coast:
        ShotSeas(job.shot, job.on, job.outputs).prepare(frame, tell)
        MEMO.drop()


def _worker_count(wanted: int | None, job: Job, frames: Sequence[Frame]) -> int:
    """Number of processes: as requested, or as cores and memory allow. Raises MemoryError."""
    most, need = max(len(frames), 1), process_memory(job)
    workers = fitting_workers(job, most) if wanted is None else min(wanted, most)
    check_memory(
        workers * need,
        f"Baking {job.resolution}² samples with {workers} worker{'s' if workers > 1 else ''}",
        remedy_for(job.shot.parameters, need),
    )
    _LOG.info("processes: %d, each with about %s of memory", workers, readable_bytes(need))
    return workers


@contextmanager
def _telling_how_to_go_on(folder: Path) -> Iterator[None]:
    """Append the remedy to the error that ended a bake."""
    try:
        yield
    except (OSError, ExrError, CacheError, Held, MemoryError) as error:
        message = message_of(error).rstrip(".")
        raise CacheError(f"{message}{remedy_of(error)}; {_go_on(folder)}") from error


def _go_on(folder: Path) -> str:
    if not (folder / JOB_FILE).exists():
        return "the folder is gone: bake it again"
    return f"complete frames are kept; continue with: resume {shell_word(folder)}"


def _announce(
    progress: Progress,
    folder: Path,
    job: Job,
    frames: Sequence[Frame],
    left: Sequence[Finding],
    needed: Estimate,
) -> None:
    reasons = Counter(finding.state.value for finding in left)
    found = ", ".join(f"{count} {state}" for state, count in reasons.items())
    progress.say(
        f"{printable(folder, LONGEST)}\n  {len(frames)} frames of {','.join(job.maps)}"
        + (f": {found}" if left else ", all whole")
        + (
            f"; about {readable_bytes(needed.bytes)} and {duration(needed.seconds)}, "
            f"{readable_bytes(needed.free)} are free"
            if needed.bytes
            else ""
        ),
        folder=str(folder), frames=len(frames), left=len(left), bytes=needed.bytes,
        seconds=round(needed.seconds, 1), free=needed.free, **reasons,
    )  # fmt: skip
