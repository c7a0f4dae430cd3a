# SPDX-License-Identifier: GPL-3.0-or-later
"""A shot as a job type of Flamenco 3, Blender's own farm: a script for its manager, and the seas."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

from ...core.data.frames import format_frames
from ..cache.job import uid_of
from ..files import write_texts
from .shot_job import (
    RENDER_SCRIPT,
    SEAS,
    ShotJob,
    bake_arguments,
    render_arguments,
    sea_files,
    verify_arguments,
)

_SCRIPT = Path(__file__).with_name("flamenco.js")
_PLACE = '"@SHOT@"'
#: around the name of a value; no name or path holds it
_BORDER = "\0"


def write(folder: Path, job: ShotJob) -> list[Path]:
    """Write the job type. Returns its files; raises ValueError for what Flamenco cannot run, or OSError."""
    # also where the script is shown on a page, nothing in it ends the script
    shot = json.dumps(_shot(folder, job), indent=4).replace("<", "\\u003c")
    texts = sea_files(folder, job)
    if job.render is not None:
        texts[folder / RENDER_SCRIPT.name] = RENDER_SCRIPT.read_text(encoding="utf-8")
    texts[folder / f"ocean_tweak_{_type_name(job.name)}.js"] = _SCRIPT.read_text(encoding="utf-8").replace(
        _PLACE, shot
    )
    (folder / SEAS).mkdir(parents=True, exist_ok=True)
    return write_texts(texts)


def _type_name(name: str) -> str:
    """What Flamenco calls the job type: the name in its alphabet, told apart where letters are lost."""
    ours = re.sub(r"[^0-9A-Za-z]+", "_", name).lower()
    return ours if name.isascii() else f"{ours.strip('_')}_{uid_of(name)}"


def _value(name: str) -> str:
    """A value that the script puts into an argument."""
    return f"{_BORDER}{name}{_BORDER}"


def _parts(arguments: list[str]) -> list[list[str]]:
    """Arguments as the script takes them: texts, of which every second one names a value."""
    return [argument.split(_BORDER) for argument in arguments]


def _shot(folder: Path, job: ShotJob) -> dict[str, Any]:
    """What the script knows of the shot. Raises ValueError."""
    if any(frame < 0 for frame in job.frames):
        raise ValueError(f"frame {job.frames[0]}: Flamenco has no negative frames")
    if job.plain_ranges:
        raise ValueError("--plain-ranges: a Flamenco job type divides frames itself")
    folder = folder.absolute()
    seas, cache, frames = f"{_value('job_folder')}/{SEAS}", _value("cache"), _value("frames")
    return {
        "label": f"Ocean Tweak: {job.name}",
        "frames": format_frames(job.frames, step_sign=""),
        "chunk": job.chunk,
        "folder": str(folder),
        "cache": str((job.cache or folder / "cache").absolute()),
        # Flamenco's manager knows for each worker what {blender} is
        "program": "{blender}" if job.bake_with == "blender" else job.python,
        "seas": [
            {
                "name": bake.name,
                "bake": _parts(
                    bake_arguments(job, bake, seas, cache, _value("all_frames"), frames, openjd=False)
                ),
                "verify": _parts(verify_arguments(job, bake, seas, cache, frames, openjd=False)),
            }
            for bake in job.bakes
        ],
        "render": _render(folder, job),
    }


def _render(folder: Path, job: ShotJob) -> dict[str, Any] | None:
    if job.render is None:
        return None
    cache, frames, pictures = map(_value, ("cache", "frames", "pictures"))
    script = f"{_value('job_folder')}/{RENDER_SCRIPT.name}"
    arguments = render_arguments(job, cache, frames, pictures, openjd=False)
    return {
        "chunk": job.render.chunk,
        "pictures": str((job.render.pictures or folder / "pictures").absolute()),
        "args": _parts(["--python-exit-code", "1", "--python", script, "--", *arguments]),
    }
