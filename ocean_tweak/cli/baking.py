# SPDX-License-Identifier: GPL-3.0-or-later
"""`bake` and `resume`."""

from __future__ import annotations

import argparse
import os
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path

from ..core.bake import BakedFrame
from ..core.bake import bake as make_frames
from ..core.frames import Frame, format_frames
from ..export.cache.estimate import Estimate, estimate, readable_bytes
from ..export.cache.job import (
    CacheError,
    Job,
    open_folder,
    read_job,
    recovered_job,
    write_job,
)
from ..export.cache.locks import claimed
from ..export.cache.records import CacheSink, Finding, remove_leftovers, unfinished
from ..export.files import writable_folder
from .checking import wanted_frames
from .outcome import DONE, FAILED, UsageError, complain
from .progress import Progress, duration
from .seas import Sea
from .stopping import stop_requested
from .wanted_bake import cache_of, jobs_of
from .workers import make_in_processes


def bake(arguments: argparse.Namespace, seas: Mapping[str, Sea]) -> int:
    """Bake each sea into its own folder of the cache."""
    jobs = jobs_of(arguments, seas)
    return max(_bake_sea(arguments, cache_of(arguments, seas[name]), job) for name, job in jobs.items())


def _bake_sea(arguments: argparse.Namespace, cache: Path, job: Job) -> int:
    frames = job.frames
    if not frames:
        raise UsageError("--frames: say which frames to bake")
    chosen = arguments.only or frames
    if not set(chosen) <= set(frames):
        raise UsageError(
            f"--only {format_frames(chosen)}: must be some of the frames {format_frames(frames)}"
        )
    return _make(arguments, open_folder(writable_folder(cache), job), job, chosen)


def resume(arguments: argparse.Namespace) -> int:
    """Go on with a bake from what its folder tells."""
    folder = arguments.folder
    try:
        job = read_job(folder)
    except CacheError:
        job = recovered_job(folder)
        write_job(folder, job)
    frames = wanted_frames(folder, job, arguments.frames)
    job.shot.check(frames)
    return _make(arguments, folder, job, frames)


def _make(arguments: argparse.Namespace, folder: Path, job: Job, frames: Sequence[Frame]) -> int:
    """Make what is not whole of the frames. Returns the exit code."""
    progress = Progress(job.name, arguments.json, arguments.openjd)
    with (
        stop_requested() as stop,
        claimed(folder, tuple(frames), arguments.wait, arguments.take_over, stop.is_set),
    ):
        left = list(unfinished(folder, job, frames))
        needed = estimate(folder, job, [finding.frame for finding in left])
        _announce(progress, folder, job, frames, left, needed, arguments.workers)
        needed.check(folder)
        if arguments.estimate or not left:
            return DONE
        progress.begin(len(left))
        todo = tuple(finding.frame for finding in left)
        remove_leftovers(folder, job, todo)
        try:
            for baked in _frames(folder, job, todo, arguments.workers, stop.is_set):
                progress.frame(baked)
        except BaseException:
            progress.end()
            complain(f"the frames written so far are whole; go on with: resume {folder}")
            raise
        progress.end()
    if stop.is_set():
        progress.fail("stopped")
        complain(f"stopped after a whole frame; go on with: resume {folder}")
        return FAILED
    return DONE


def _frames(
    folder: Path, job: Job, frames: tuple[Frame, ...], workers: int, stopped: Callable[[], bool]
) -> Iterator[BakedFrame]:
    if min(workers, len(frames)) > 1:
        yield from make_in_processes(folder, job, frames, workers, stopped)
        return
    making = make_frames(job.shot, frames, CacheSink(folder, job))
    for baked in making:
        yield baked
        if stopped():
            making.close()  # finishes what is under way
            return


def _announce(
    progress: Progress,
    folder: Path,
    job: Job,
    frames: Sequence[Frame],
    left: Sequence[Finding],
    needed: Estimate,
    workers: int,
) -> None:
    reasons = Counter(finding.state.value for finding in left)
    found = ", ".join(f"{count} {state}" for state, count in reasons.items())
    seconds = needed.seconds / min(workers, max(len(left), 1), os.cpu_count() or 1)
    progress.say(
        f"{folder}\n  {len(frames)} frames of {','.join(job.maps)}"
        + (f": {found}" if left else ", all whole")
        + (
            f"; about {readable_bytes(needed.bytes)} and {duration(seconds)}, "
            f"{readable_bytes(needed.free)} are free"
            if left
            else ""
        ),
        folder=str(folder), frames=len(frames), left=len(left), bytes=needed.bytes,
        seconds=round(seconds, 1), free=needed.free, **reasons,
    )  # fmt: skip
