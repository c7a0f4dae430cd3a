# SPDX-License-Identifier: GPL-3.0-or-later
"""What a bake will take, told before it begins."""

from __future__ import annotations

import shutil
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from ...core import OceanParameters
from ...core.bake import ShotSurfaces
from ...core.frames import Frame
from .job import CacheError, Job

#: the trial frame's samples along each side: few enough to take a moment. Images of more are smoother and
#: pack better, never worse
_TRIAL = 128


@dataclass(frozen=True)
class Estimate:
    """Of a number of frames.

    bytes, seconds : for all of them, one after the other
    free : bytes that the disk has
    """

    frames: int
    bytes: int
    seconds: float
    free: int

    def check(self, folder: Path) -> None:
        """Raise CacheError where the disk cannot hold the frames."""
        if self.bytes > self.free:
            raise CacheError(
                f"{folder}: {self.frames} frames need about {readable_bytes(self.bytes)} and the disk has "
                f"{readable_bytes(self.free)} free: make room, bake fewer frames or maps, "
                "or lower the resolution"
            )


def estimate(folder: Path, job: Job, frames: Sequence[Frame]) -> Estimate:
    """What the frames will take, from a frame of the same sea with few samples, made and written aside."""
    free = shutil.disk_usage(folder).free
    if not frames:
        return Estimate(0, 0, 0.0, free)
    parameters = job.shot.at(frames[0]).parameters
    trial = parameters.replace(resolution=min(parameters.resolution, _TRIAL))
    scale = (parameters.resolution / trial.resolution) ** 2
    with tempfile.TemporaryDirectory() as aside:
        size, seconds = _trial_frame(Path(aside), job, trial, frames[0])
    return Estimate(len(frames), int(size * scale * len(frames)), seconds * scale * len(frames), free)


def _trial_frame(folder: Path, job: Job, parameters: OceanParameters, frame: Frame) -> tuple[int, float]:
    """Bytes of a frame's files, and seconds to make them without what is made once."""
    sequence = replace(job.sequence(folder, frame), parameters=parameters)
    surfaces = ShotSurfaces(job.shot)
    time_at = job.shot.at(frame).time
    ocean = surfaces.ocean(parameters)
    ocean.surface(time_at, sequence.outputs)
    started = time.perf_counter()
    # the next frame: foam goes on from the one before, as in a bake
    fields = ocean.surface(time_at + 1 / parameters.timing.fps, sequence.outputs)
    paths = sequence.write(frame, fields)
    seconds = time.perf_counter() - started
    return sum(path.stat().st_size for path in paths), seconds


def readable_bytes(size: float) -> str:
    """The size as an artist reads it: `1.5 GB`."""
    for unit in ("bytes", "kB", "MB", "GB"):
        if size < 1000.0 or unit == "GB":
            return f"{size:.0f} {unit}" if unit == "bytes" else f"{size:.3g} {unit}"
        size /= 1000.0
    raise AssertionError
