# SPDX-License-Identifier: GPL-3.0-or-later
"""What a bake will take, told before it begins: bytes on the disk, seconds, and memory of each process."""

from __future__ import annotations

import hashlib
import math
import os
import secrets
import shutil
import time
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

from ...core import Coast, Ocean, OceanParameters
from ...core.data.frames import Frame
from ...core.data.printable import readable_bytes
from ...core.foam.model import LATTICE_RATE
from ...core.foam.threshold import foam_outlook
from ...core.numerics.machine import usable_cores, usable_memory
from ...core.parameters.patch_seas import AROUND, OVER_BED, PARTS, open_sea, parts
from ...core.parameters.shot import OCEAN_TIME, Shot
from ...core.sea.bake import ShotSeas
from ...core.sea.memory import A_SAMPLE_AROUND, TABLES, ground_of, memory_need
from ...core.sea.over_bed import mesh_over_bed, over_bed
from ...core.sea.placed_waves import without_placed
from ...core.sea.shot_spray import ShotSpray
from ...core.spray.columns import BYTES_IN_FILE
from ...core.synthesis.channels import OF_MEMORY, SurfaceFields, is_put_together
from ...core.waves.coast.ground import LEAST_RIM
from ..shelf import nothing_kept
from ..spray import SpraySequence
from .job import CacheError, Job

#: the trial frame's samples along each side: few enough to take a moment. Images of more are smoother and
#: pack better, never worse
_TRIAL = 128
#: those of the trials whose time is taken, of which the larger is twice the smaller: what does not grow with
#: the samples is told from what does; for seas of at least so many samples
_TIMED = {0: 256, 1024: 512}
_TIMED_PATCHES = 1024
#: s; half-life of the foam in those trials, which looks back at some thirty moments
_SHORT_FOAM = 0.4
#: how much longer a sample takes each time that the side is doubled beyond the trial's: caches are small
_LARGER_IS_SLOWER = 1.05
#: steps of a coast between those of its trial
_COARSER = 4.0
#: s until one of several processes begins
_START = 0.4
#: bytes in which disks give room; a frame's record takes two of them with its name and its folder's
_BLOCK = 4096
_RECORD = 2 * _BLOCK
#: bytes of a process: Python with its packages, and tables of which others take the place when they are done
_PROCESS, _LEAST = 67 * 2**20, 88 * 2**20
#: bytes a sample while a map is written, and of one that is put together first
_WRITING, _PUT_TOGETHER = 20, 29
#: bytes a sample of a part while its points are written
_POINTS = 480
#: bytes a sample of foam: births, what draws them out and what is worked with, as far as that meets the peak
#: of the rest
_FOAM = 44

#: s to make and write a particle of spray, and where in a shot it is counted
_PARTICLE, _OUTLOOKS = 1.2e-6, (0.0, 0.5, 1.0)
#: bytes a sample while the waves are made and measured
_STATISTICS = 40

# CPU time, independent of other programs; too coarse on Windows
_clock = time.perf_counter if os.name == "nt" else time.process_time


@dataclass(frozen=True)
class Estimate:
    """Of a number of frames.

    bytes : for all of them
    seconds : from the start to the last, with all that is made before the first
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
                f"{folder}: {self.frames} frames need about {readable_bytes(self.bytes)}, and the "
                f"disk has {readable_bytes(self.free)} free: make room, bake fewer frames or "
                "maps, or lower the resolution"
            )


def estimate(folder: Path, job: Job, frames: Sequence[Frame], workers: int = 1) -> Estimate:
    """What the frames will take with a number of processes, from trials with few samples.

    Nothing is written. Seconds are those of a machine that does nothing else.
    """
    free = shutil.disk_usage(folder).free
    if not frames:
        return Estimate(0, 0, 0.0, free)
    size = _frame_bytes(folder, job, frames[0]) + _RECORD
    return Estimate(len(frames), size * len(frames), _seconds(folder, job, frames, workers), free)


def with_spray(needed: Estimate, files: SpraySequence, frames: Sequence[Frame]) -> Estimate:
    """An estimate together with frames of spray, which one process makes when all else is done."""
    if not frames:
        return needed
    shot, changes = files.shot, _changes(files.shot)
    maker = ShotSpray(shot, files.spray, files.place)
    spread = [frames[round(share * (len(frames) - 1))] for share in _OUTLOOKS]
    count = sum(map(maker.outlook, spread)) / len(spread)
    moment = cpu_seconds(partial(maker.outlook, spread[-1]))
    most = files.spray.life * LATTICE_RATE
    gaps = (float(later - earlier) for earlier, later in pairwise(frames))
    a_frame = LATTICE_RATE / float(shot.parameters.timing.fps)
    looks = most + sum(most if changes else min(most, gap * a_frame) for gap in gaps)
    return Estimate(
        max(needed.frames, len(frames)),
        needed.bytes + len(frames) * _room(count * BYTES_IN_FILE),
        needed.seconds + looks * moment + len(frames) * count * _PARTICLE,
        needed.free,
    )


def statistics_memory(parameters: OceanParameters) -> int:
    """Bytes that a process takes which makes the statistics of a sea."""
    sides = [patch.resolution for patch in parameters.patches] or [parameters.resolution]
    return max(_LEAST, _PROCESS + Ocean(parameters).memory().state + _STATISTICS * max(sides) ** 2)


def fitting_workers(job: Job, frames: int) -> int:
    """Processes that share so many frames: one a core, as far as memory allows."""
    memory = usable_memory()
    fitting = frames if memory is None else memory // process_memory(job)
    return max(1, min(usable_cores(), fitting, frames))


def process_memory(job: Job) -> int:
    """Bytes that a process takes which makes and writes frames of a job."""
    parameters = job.shot.parameters
    if job.area is not None:
        return _memory_of_area(job)
    need = memory_need(parameters, job.outputs - OF_MEMORY)
    parameters = open_sea(parameters)
    if AROUND in job.outputs:
        parameters = without_placed(parameters)
    sides = [patch.resolution for patch in parameters.patches if parameters.is_cascade]
    samples = max([*sides, parameters.resolution]) ** 2
    writing = _writing(job) * samples
    if PARTS in job.outputs:
        writing = max(writing, _POINTS * max(part.parameters.resolution for part in parts(parameters)) ** 2)
    making = need.surface + writing
    if job.shot.around is not None:
        making += A_SAMPLE_AROUND * job.shot.around.resolution**2
    if job.outputs & OF_MEMORY:  # made for the next frame meanwhile
        own = parameters.foam.resolution or parameters.resolution
        coarse = Ocean(parameters.at_resolution(own)).memory({"cusp"})
        making += coarse.surface + _FOAM * own**2 + 4 * len(job.outputs & OF_MEMORY) * samples
        making += coarse.state if own != parameters.resolution else 0
    return max(_LEAST, _PROCESS + need.state + max(need.building - TABLES, making))


def _memory_of_area(job: Job) -> int:
    need = Ocean(job.shot.parameters).memory(job.outputs, job.on)
    making = need.surface + _writing(job) * job.resolution**2
    return max(_LEAST, _PROCESS + need.state + max(need.building - TABLES, making))


def _writing(job: Job) -> int:
    """Bytes a sample while a map is written."""
    return _PUT_TOGETHER if any(is_put_together(name) for name in job.images) else _WRITING


def _frame_bytes(folder: Path, job: Job, frame: Frame) -> int:
    """Of a frame's files on the disk."""
    trial = _at(job, _TRIAL)
    scale = (job.resolution / trial.resolution) ** 2
    with nothing_kept():
        fields = _seas(trial).frames(frame, trial.outputs - {PARTS, OVER_BED, AROUND})
    images = sum(_room(len(data) * scale) for data in _images(folder, trial, frame, fields))
    others = (*job.points(folder, frame), job.coast(folder, frame), job.wakes(folder))
    return images + sum(_room(each.bytes) for each in others if each is not None)


class _Costs(NamedTuple):
    """Seconds of a processor.

    sea : to make the sea
    moment : to look at a moment, for foam
    frame : to make and encode a frame, without its foam
    """

    sea: float
    moment: float
    frame: float


def _seconds(folder: Path, job: Job, frames: Sequence[Frame], workers: int) -> float:
    costs, parameters = _costs(folder, job, frames[0]), job.shot.parameters
    pictures = 0.0
    if parameters.has_coast and (job.area is not None or OVER_BED in job.outputs):
        pictures, over = _coast_costs(job, frames[0])
        costs = costs._replace(frame=costs.frame + over)
    most = foam_outlook(parameters).memory if job.outputs & OF_MEMORY else 0
    moments_a_frame = LATTICE_RATE / float(parameters.timing.fps)
    changes = _changes(job.shot)
    gaps = Counter(float(later - earlier) for earlier, later in pairwise(frames))
    # before each frame of a process but its first
    following = sum(
        count * (most if changes else min(most, gap * moments_a_frame)) for gap, count in gaps.items()
    ) / max(1, len(frames) - 1)
    alone = math.ceil(len(frames) / workers)
    foam = costs.moment if job.outputs & OF_MEMORY else 0.0
    if job.area is not None:  # each frame looks back anew
        costs, foam = costs._replace(frame=costs.frame + foam * (most + 1)), 0.0
    first, later = foam * (most + 1), foam * (following + 1)
    seas = costs.sea * (alone if changes else 1)
    # foam is made beside the frame before
    path = seas + first + costs.frame + (alone - 1) * max(later, costs.frame)
    work = seas + first + (alone - 1) * later + alone * costs.frame
    begin = (_START if workers > 1 else 0.0) + pictures / usable_cores()  # made once, for all processes
    return begin + max(path, workers * work / usable_cores())


def _costs(folder: Path, job: Job, frame: Frame) -> _Costs:
    resolution = _samples(job)
    larger = max(side for least, side in _TIMED.items() if resolution >= least)
    if job.shot.parameters.patches:  # what is made of them does not follow from few samples
        larger = _TIMED_PATCHES
    return _Costs(
        *by_trials(resolution, larger, lambda side: _timed(folder, _at(job, side, is_timed=True), frame))
    )


def _coast_costs(job: Job, frame: Frame) -> tuple[float, float]:
    """Seconds to make the pictures of a coast, and for a frame over its bed, from a coarser one."""
    moment = job.shot.at(frame)
    sea = moment.parameters
    assert sea.coast is not None
    coarse = sea.replace(coast=_coarser_coast(sea), seed=_new_seed())
    whole, few, of = ground_of(sea), ground_of(coarse), Ocean(coarse, workers=1)
    places, share = mesh_over_bed(of), whole.rows * whole.columns / (few.rows * few.columns)
    with nothing_kept():
        pictures = cpu_seconds(of.prepare)
    first = cpu_seconds(lambda: over_bed(of, places.x, places.y, moment.time))
    later = cpu_seconds(lambda: over_bed(of, places.x, places.y, moment.time + 1))
    return share * (pictures + max(0.0, first - later)), share * later


def _coarser_coast(sea: OceanParameters) -> Coast | None:
    """The coast of a sea with fewer samples over its bed, for trials, or as it is where no wave meets it."""
    coast = sea.coast
    if coast is None or coast.muted:
        return coast
    whole = ground_of(sea)
    most = min(_COARSER * whole.step, coast.rim / LEAST_RIM)
    # of which a whole number fits into the domain, as the bed's samples must
    step = whole.domain_size / math.ceil(whole.domain_size / most)
    return replace(coast, step=max(step, whole.step))


def seconds_of_statistics(parameters: OceanParameters) -> float:
    """What the statistics of a sea take, from trials of others like it."""

    def timed(side: int) -> list[float]:
        few = parameters.at_resolution(min(parameters.resolution, side)).replace(seed=_new_seed()).separate
        return [cpu_seconds(lambda: Ocean(few).statistics())]

    Ocean(parameters.at_resolution(16).separate).statistics()  # what is made once
    return by_trials(parameters.resolution, 256, timed)[0]


def by_trials(resolution: int, larger: int, timed: Callable[[int], Sequence[float]]) -> list[float]:
    """Seconds at a resolution, from those with `larger` samples along a side and with half as many.

    timed : gives the seconds of some works with so many samples along a side
    """
    if resolution <= larger:
        return list(timed(resolution))
    few, many = larger / 2 / resolution, larger / resolution
    slower = _LARGER_IS_SLOWER ** math.log2(1.0 / many)
    times = []
    for of_few, of_many in zip(timed(larger // 2), timed(larger), strict=True):
        growing = (of_many - of_few) / (many**2 - few**2)
        fixed = of_many - growing * many**2
        times.append(max(0.0, fixed) + slower * max(0.0, growing))
    return times


def _timed(folder: Path, job: Job, frame: Frame) -> _Costs:
    surfaces, parameters = _seas(job), job.shot.at(frame).parameters
    with_foam, moment = job.outputs & OF_MEMORY, 0.0

    def sea() -> None:
        for of_grid in surfaces.seas(frame):
            of_grid.prepare()
            if with_foam:
                of_grid.foam_history if job.area is None else of_grid.foam_model  # noqa: B018
        if PARTS in job.outputs:
            surfaces.frames(frame, {PARTS})

    def made() -> None:
        fields = surfaces.frames(frame, job.outputs - OF_MEMORY - {OVER_BED})
        if with_foam:
            foam = SurfaceFields(fields[0].time, dict.fromkeys(with_foam, fields[0].cusp))
            fields = (fields[0].including(foam), *fields[1:])
        _encode(folder, job, frame, fields)

    making = cpu_seconds(sea)
    if with_foam:
        looks = foam_outlook(parameters).memory + 1
        # in an area the second would find what the first looked at
        seas = (surfaces, *(() if job.area is not None else (_seas(job),)))
        moment = min(cpu_seconds(partial(of.frames, frame, with_foam)) for of in seas) / looks
    if not parameters.patches:
        made()
    return _Costs(making, moment, min(cpu_seconds(made), cpu_seconds(made)))


def _encode(folder: Path, job: Job, frame: Frame, fields: Sequence[SurfaceFields]) -> None:
    """All that is done with a frame's fields but for the disk."""
    for data in _images(folder, job, frame, fields):
        hashlib.sha256(data).digest()
    beside, wakes = fields[len(job.sequences(folder, frame)) :], job.wakes(folder)
    for points, of_part in zip(job.points(folder, frame), beside, strict=False):
        for _, values in points.values(of_part):
            hashlib.sha256(values.data).digest()
    if wakes is not None:
        hashlib.sha256(wakes.values(frame, beside[-1]).data).digest()


def cpu_seconds(work: Callable[[], object]) -> float:
    """What some work takes of a processor; where the system tells only coarsely, until it is done."""
    started = _clock()
    work()
    return _clock() - started


def _images(folder: Path, job: Job, frame: Frame, fields: Sequence[SurfaceFields]) -> Iterator[bytes]:
    for sequence, of_patch in zip(job.sequences(folder, frame), fields, strict=False):
        for name in job.images:
            yield sequence.encoded(frame, of_patch, name)


def _seas(job: Job) -> ShotSeas:
    return ShotSeas(job.shot, job.on, job.outputs)


def _changes(shot: Shot) -> bool:
    """Whether each frame is of another sea."""
    paths = dict(shot.animation.samples) if shot.animation is not None else {}
    return bool(set(paths) - {OCEAN_TIME})


def _at(job: Job, most: int, is_timed: bool = False) -> Job:
    """The job with at most so many samples along a side."""
    parameters, area, whole = job.shot.parameters, job.area, _samples(job)
    samples = min(parameters.resolution, most)
    if area is not None and most < whole:  # both in proportion
        samples = max(16, 2 * round(parameters.resolution * most / whole / 2))
        area = replace(area, resolution=max(2, round(area.resolution * most / whole)))
    elif area is not None:
        samples = parameters.resolution
    foam = parameters.foam
    if foam.resolution:  # in proportion, so that its time is too
        of_foam = max(16, 2 * round(foam.resolution * samples / parameters.resolution / 2))
        foam = replace(foam, resolution=of_foam)
    few: OceanParameters = parameters.at_resolution(samples).replace(foam=foam)
    if area is not None:  # what images hold is over the bed; what that takes is tried on its own
        few = open_sea(few) if is_timed else few.replace(coast=_coarser_coast(parameters))
    if is_timed:
        few = few.replace(foam=replace(foam, half_life=min(foam.half_life, _SHORT_FOAM)))
        if samples < parameters.resolution:  # else the bake itself goes on with these waves
            few = few.replace(seed=_new_seed())
    return replace(job, shot=replace(job.shot, parameters=few), area=area)


def _samples(job: Job) -> int:
    """Along a side of what a frame takes longest with: its image, or the sea where it has more."""
    return max(job.resolution, job.shot.parameters.resolution)


def _new_seed() -> int:
    """For waves that do not exist yet."""
    return secrets.randbelow(2**31)


def _room(size: float) -> int:
    return -int(-size // _BLOCK) * _BLOCK
