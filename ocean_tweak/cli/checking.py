# SPDX-License-Identifier: GPL-3.0-or-later
"""`verify` and `clean`."""

from __future__ import annotations

import argparse
from collections import Counter
from pathlib import Path

from ..core.frames import Frame, format_frames
from ..core.plain_data import to_plain
from ..export.cache.clean import clean as clean_folder
from ..export.cache.estimate import readable_bytes
from ..export.cache.job import LOCKS, Job, read_job
from ..export.cache.locks import Held, claims
from ..export.cache.records import State, recorded_frames
from ..export.cache.verify import verify as verify_frames
from .outcome import DONE, FAILED, UsageError
from .progress import Progress
from .seas import SceneOceans, chosen_seas
from .wanted_bake import cache_of, existing_folder, jobs_of


def wanted_frames(folder: Path, job: Job, frames: tuple[Frame, ...] | None) -> tuple[Frame, ...]:
    """The frames that a command is about: those given, else all that were asked for or made."""
    if frames is not None:
        return frames
    known = tuple(sorted({*job.frames, *recorded_frames(folder)}))
    if not known:
        raise UsageError(f"{folder}: holds no frames; say with --frames which ones are meant")
    return known


def verify(arguments: argparse.Namespace, scene_oceans: SceneOceans | None = None) -> int:
    """Read frames back and name each that is not whole: of a folder, or of what the sea's arguments bake."""
    if arguments.folder is not None:
        if arguments.params or arguments.preset or arguments.assignments or arguments.out:
            raise UsageError(f"{arguments.folder}: give either a folder, or a sea and --out")
        return _verify_folder(arguments, arguments.folder)
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
    for frame, state, reason in verify_frames(folder, job, frames):
        states[state] += 1
        if state is not State.WHOLE or arguments.json:
            text = f"frame {to_plain(frame)} is {state.value}: {reason}"
            progress.say(text, frame=to_plain(frame), state=state.value, reason=reason)
        progress.count("verified")
    counts = {state.value: states[state] for state in State if states[state]}
    summary = ", ".join(f"{count} {name}" for name, count in counts.items())
    progress.say(f"{len(frames)} frames: {summary}", frames=format_frames(frames), **counts)
    if states[State.WHOLE] == len(frames):
        return DONE
    progress.fail(summary)
    return FAILED


def clean(arguments: argparse.Namespace) -> int:
    """Delete frames, as far as nobody is baking them."""
    folder, frames = arguments.folder, arguments.frames
    if not folder.is_dir():
        raise UsageError(f"{folder}: is no folder")
    for claim in claims(folder / LOCKS):
        if frames is None or claim.frames.intersection(frames):
            raise Held(f"{folder}: frames {format_frames(claim.frames)} are being baked by {claim.holder}")
    cleaned = clean_folder(folder, frames)
    lines = [f"{cleaned.files} files deleted, {readable_bytes(cleaned.bytes)}"]
    lines += [f"left {reason}" for reason in cleaned.left]
    progress = Progress(folder.parent.name, arguments.json)
    progress.say("\n".join(lines), files=cleaned.files, bytes=cleaned.bytes, left=list(cleaned.left))
    return FAILED if cleaned.left else DONE
