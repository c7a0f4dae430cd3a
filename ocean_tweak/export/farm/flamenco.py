# SPDX-License-Identifier: GPL-3.0-or-later
"""A shot as a job type of Flamenco 3, Blender's own farm: a script for its manager, and the seas."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

from ...core.frames import format_frames
from ..files import write_texts
from .shot_job import (
    SEAS,
    ShotJob,
    bake_arguments,
    render_arguments,
    sea_files,
    verify_arguments,
)

_SCRIPT = Path(__file__).with_name("flamenco.js")
_PLACE = '"@SHOT@"'
_RENDER_SCRIPT = "render_baked.py"


def write(folder: Path, job: ShotJob) -> list[Path]:
    """Write the job type. Returns its files; raises ValueError for what Flamenco cannot run, or OSError."""
    shot = json.dumps(_shot(folder, job), indent=4)
    texts = sea_files(folder, job)
    if job.render is not None:
        texts[folder / _RENDER_SCRIPT] = job.render.script
    name = f"ocean_tweak_{re.sub(r'[^0-9A-Za-z]+', '_', job.name).lower()}.js"
    texts[folder / name] = _SCRIPT.read_text(encoding="utf-8").replace(_PLACE, shot)
    (folder / SEAS).mkdir(parents=True, exist_ok=True)
    return write_texts(texts)


def _shot(folder: Path, job: ShotJob) -> dict[str, Any]:
    """What the script knows of the shot. Raises ValueError."""
    if any(frame < 0 for frame in job.frames):
        raise ValueError(f"frame {job.frames[0]}: Flamenco knows no negative frames")
    if job.plain_ranges:
        raise ValueError("--plain-ranges: a Flamenco job type divides frames itself")
    folder = folder.absolute()
    seas, cache = f"<job_folder>/{SEAS}", "<cache>"
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
                "bake": bake_arguments(job, bake, seas, cache, "<all_frames>", "<frames>", openjd=False),
                "verify": verify_arguments(job, bake, seas, cache, "<frames>", openjd=False),
            }
            for bake in job.bakes
        ],
        "render": _render(folder, job),
    }


def _render(folder: Path, job: ShotJob) -> dict[str, Any] | None:
    if job.render is None:
        return None
    script = render_arguments(job, "<cache>", "<frames>", "<pictures>", openjd=False)
    return {
        "chunk": job.render.chunk,
        "pictures": str((job.render.pictures or folder / "pictures").absolute()),
        "args": ["--python-exit-code", "1", "--python", f"<job_folder>/{_RENDER_SCRIPT}", "--", *script],
    }
