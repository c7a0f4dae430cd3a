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
from ...core.shot import Shot
from .job import CacheError, Job

#: the trial frame's samples along each side: few enough to take a moment. Images of more are smoother and
#: pack better, never worse
_TRIAL = 128
#: bytes in which disks give room; a frame's record takes two of them with its name and its folder's
_BLOCK = 4096
_RECORD = 2 * _BLOCK


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
    """What the frames will take, from two of them with few samples, made and written aside."""
    free = shutil.disk_usage(folder).free
    if not frames:
        return Estimate(0, 0, 0.0, free)
    trial = _with_few_samples(job.shot.parameters)
    scale = (job.shot.parameters.resolution / trial.resolution) ** 2
    small = replace(job, shot=Shot(trial, job.shot.animation), maps=job.images)
    with tempfile.TemporaryDirectory() as aside:
        sizes, seconds = _trial_frame(Path(aside), small, frames)
        point_sizes, point_seconds = _points_of_a_frame(Path(aside), job, frames[0])
    size = sum(_room(length * scale) for length in sizes) + sum(map(_room, point_sizes)) + _RECORD
    seconds = seconds * scale + point_seconds
    return Estimate(len(frames), size * len(frames), seconds * len(frames), free)


def _with_few_samples(parameters: OceanParameters) -> OceanParameters:
    samples = min(parameters.resolution, _TRIAL)
    foam = parameters.foam
    if foam.resolution:  # in proportion, so that its time is too
        of_foam = max(16, 2 * round(foam.resolution * samples / parameters.resolution / 2))
        foam = replace(foam, resolution=of_foam)
    return parameters.at_resolution(samples).replace(foam=foam)


def _room(size: float) -> int:
    return -int(-size // _BLOCK) * _BLOCK


def _trial_frame(folder: Path, job: Job, frames: Sequence[Frame]) -> tuple[list[int], float]:
    """Bytes of a frame's files, and seconds to make them after the frame before."""
    surfaces = ShotSurfaces(job.shot)
    started = time.perf_counter()
    made = surfaces.frames(frames[0], job.outputs)
    if len(frames) > 1:  # what is made once does not count where there are many
        started = time.perf_counter()
        made = surfaces.frames(frames[1], job.outputs)
    paths = job.write(folder, frames[0], made)
    return [path.stat().st_size for path in paths], time.perf_counter() - started


def _points_of_a_frame(folder: Path, job: Job, frame: Frame) -> tuple[list[int], float]:
    """The same for points: their samples are those of the patches, however few the sea has."""
    sequences = job.points(folder, frame)
    if not sequences:
        return [], 0.0
    surfaces = ShotSurfaces(job.shot)
    surfaces.parts(frame)  # what is made once does not count
    started = time.perf_counter()
    made = surfaces.parts(frame)
    paths = [
        path for sequence, own in zip(sequences, made, strict=True) for path in sequence.write(frame, own)
    ]
    return [path.stat().st_size for path in paths], time.perf_counter() - started


def readable_bytes(size: float) -> str:
    """The size as an artist reads it: `1.5 GB`."""
    for unit in ("bytes", "kB", "MB", "GB"):
        if size < 1000.0 or unit == "GB":
            return f"{size:.0f} {unit}" if unit == "bytes" else f"{size:.3g} {unit}"
        size /= 1000.0
    raise AssertionError
