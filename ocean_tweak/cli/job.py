# SPDX-License-Identifier: GPL-3.0-or-later
"""`job`: writes a render farm job that bakes, verifies and renders a shot."""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable, Mapping
from pathlib import Path

from ..core.data.frames import Frame, format_frames
from ..export.cache.job import Job
from ..export.farm import flamenco, openjd
from ..export.farm.shot_job import BAKERS, Render, ShotJob
from ..export.files import writable_folder
from .outcome import DONE, UsageError
from .progress import Progress
from .seas import FileSea
from .spraying import spray_of
from .wanted_bake import jobs_of, known_cache

__all__ = ["BAKERS", "FORMS", "PYTHON", "job"]

#: kind of job → function that writes it
FORMS: dict[str, Callable[[Path, ShotJob], list[Path]]] = {"openjd": openjd.write, "flamenco": flamenco.write}

#: command for Python on the farm's machines
PYTHON = "python" if os.name == "nt" else "python3"


def job(arguments: argparse.Namespace, seas: Mapping[str, FileSea]) -> int:
    """Write a job for a farm."""
    jobs = jobs_of(arguments, seas)
    bakes = tuple(jobs.values())
    sprays = {each.name: spray_of(arguments, seas[name]) for name, each in jobs.items()}
    caches = {known_cache(arguments.cache, sea) for sea in seas.values()}
    frames = _frames(bakes)
    render = _render(arguments)
    name = render.blend.stem if render is not None and len(bakes) > 1 else bakes[0].name
    try:
        shot = ShotJob(
            name, bakes, frames, arguments.chunk, caches.pop() if len(caches) == 1 else None,
            arguments.bake_with, arguments.python, arguments.blender,
            {name: spray for name, spray in sprays.items() if spray is not None}, arguments.workers,
            arguments.plain_ranges, render,
        )  # fmt: skip
        files = FORMS[arguments.form](writable_folder(arguments.out), shot)
    except ValueError as error:
        raise UsageError(str(error)) from None
    needs = [need for sea in seas.values() for need in sea.needs] if render is not None else []
    lines = [f"  {path}" for path in files]
    if needs:
        lines.append("Blender on the render machines needs the Ocean Tweak extension, or nothing of this:")
        lines += [f"  {need}" for need in needs]
    Progress(name, arguments.json).say(
        "\n".join((f"frames {format_frames(frames)}", *lines)),
        frames=format_frames(frames), form=arguments.form, files=[str(path) for path in files], needs=needs,
    )  # fmt: skip
    return DONE


def _frames(bakes: tuple[Job, ...]) -> tuple[Frame, ...]:
    frames = bakes[0].frames
    if not frames:
        raise UsageError("--frames: say which frames the shot has")
    if any(bake.frames != frames for bake in bakes):
        raise UsageError("--frames: the oceans are in scenes with different frames; say which to use")
    return frames


def _render(arguments: argparse.Namespace) -> Render | None:
    if arguments.blend is None:
        if arguments.pictures is not None:
            raise UsageError("--pictures: nothing is rendered without --blend, the file to render")
        return None
    if not arguments.blend.is_file():
        raise UsageError(f"--blend {arguments.blend}: is not a file")
    return Render(arguments.blend, arguments.pictures, arguments.render_chunk)
