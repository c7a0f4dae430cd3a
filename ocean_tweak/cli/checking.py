# SPDX-License-Identifier: GPL-3.0-or-later
"""`verify` and `clean`."""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from ..core.data.frames import Frame, format_frames
from ..core.data.plain_data import to_plain
from ..core.data.printable import printable, readable_bytes
from ..export.cache.clean import clean as clean_frames
from ..export.cache.clean import cleanable_frames, foreign_images, remove_rest
from ..export.cache.folders import is_bake, read_job
from ..export.cache.job import CacheError, Job
from ..export.cache.locks import claimed
from ..export.cache.records import State, asked_frames, recorded_frames
from ..export.cache.verify import verify as verify_frames
from .outcome import DONE, FAILED, UsageError
from .progress import Progress
from .seas import SceneOceans, chosen_seas
from .stopping import stop_requested
from .wanted_bake import cache_of, existing_folder, jobs_of, only_bake

#: number of file names on a line
_MOST_NAMES = 20


def wanted_frames(folder: Path, job: Job, frames: tuple[Frame, ...] | None) -> tuple[Frame, ...]:
    """The frames for a command: those given, or all that were requested or baked."""
    if frames is not None:
        return frames
    known = known_frames(folder, job)
    if not known:
        raise UsageError(f"{folder}: holds no frames; say which with --frames")
    return known


def known_frames(folder: Path, job: Job) -> tuple[Frame, ...]:
    """All frames that were requested or baked."""
    return tuple(sorted({*job.frames, *recorded_frames(folder), *asked_frames(folder)}))


def verify(arguments: argparse.Namespace, scene_oceans: SceneOceans | None = None) -> int:
    """Read frames back and report each that is not complete, for a folder or for the bake described by the
    arguments."""
    if arguments.folder is not None:
        if arguments.params or arguments.preset or arguments.assignments or arguments.out:
            raise UsageError(f"{arguments.folder}: give either a folder, or a sea and --out")
        return _verify_folder(arguments, only_bake(arguments.folder, arguments.json))
    seas = chosen_seas(arguments, scene_oceans)
    jobs = jobs_of(arguments, seas)
    folders = [existing_folder(cache_of(arguments, seas[name]), job) for name, job in jobs.items()]
    return max(_verify_folder(arguments, folder) for folder in folders)


def _verify_folder(arguments: argparse.Namespace, folder: Path) -> int:
    job = read_job(folder)
    frames = wanted_frames(folder, job, arguments.frames)
    progress = Progress(job.name, arguments.json, arguments.openjd)
    progress.begin(len(frames))
    states: Counter[State] = Counter()
    missing: list[Frame] = []
    with stop_requested() as stop:
        for frame, state, reason in verify_frames(folder, job, frames):
            states[state] += 1
            if state is State.MISSING and not arguments.json:
                missing.append(frame)  # reported together, as there may be many
            elif state is not State.WHOLE or arguments.json:
                label = format_frames((frame,))
                text = f"frame {label} is {state.value}: {reason}"
                progress.say(text, frame=to_plain(frame), state=state.value, reason=reason)
            progress.count("verified")
            if stop.is_set() and not progress.is_complete:
                break
    if missing:
        label = format_frames(missing)
        one = len(missing) == 1
        progress.say(f"frame {label} is missing" if one else f"frames {label} are missing")
    foreign = foreign_images(folder)
    if foreign:
        progress.remark(f"no record lists {_first(foreign)}")
    counts = {state.value: states[state] for state in State if states[state]}
    summary = ", ".join(f"{count} {name}" for name, count in counts.items())
    if not progress.is_complete:
        summary += "; stopped before the rest was read"
    progress.say(f"{len(frames)} frames: {summary}", frames=format_frames(frames), **counts)
    if states[State.WHOLE] == len(frames):
        return DONE
    progress.fail(summary)
    return FAILED


def _first(names: Sequence[str]) -> str:
    more = f" and {len(names) - _MOST_NAMES} more" if len(names) > _MOST_NAMES else ""
    return ", ".join(printable(name, 255) for name in names[:_MOST_NAMES]) + more


def clean(arguments: argparse.Namespace) -> int:
    """Delete frames that are not being baked."""
    folder, frames = arguments.folder, arguments.frames
    if not folder.is_dir():
        raise UsageError(f"{folder}: is not a folder")
    if not is_bake(folder.resolve()):
        raise CacheError(f"{folder}: is not a bake's folder, so nothing in it is deleted")
    chosen = cleanable_frames(folder) if frames is None else frames
    with claimed(folder, chosen, take_over=arguments.take_over):
        cleaned = clean_frames(folder, chosen)
    foreign = remove_rest(folder) if frames is None and not cleaned.left else ()
    lines = [f"{cleaned.files} files deleted, {readable_bytes(cleaned.bytes)}"]
    lines += [f"left {reason}" for reason in cleaned.left]
    if foreign:
        lines.append(f"kept what no record lists: {_first(foreign)}")
    progress = Progress(folder.resolve().parent.name, arguments.json)
    progress.say(
        "\n  ".join(lines), files=cleaned.files, bytes=cleaned.bytes,
        left=list(cleaned.left), foreign=list(foreign),
    )  # fmt: skip
    return FAILED if cleaned.left else DONE
