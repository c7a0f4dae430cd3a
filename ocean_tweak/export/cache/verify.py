# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads baked frames back and reports whether each can be rendered."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...core import Ocean
from ...core.data.frames import Frame
from ...core.data.plain_data import to_plain
from ...core.data.printable import printable
from ...core.parameters.shot import Moment
from ...core.sea.bake import ShotSeas
from ...core.sea.regions import TILE, Area, Tile
from ...core.synthesis.channels import MOVING_MAP, unit_of
from ...core.synthesis.coefficients import propagate
from ..exr import ExrError, ExrSequence, read_image
from ..ply import PlyError
from ..spray import baked_spray
from .job import Job
from .records import Finding, State, inspect_all

#: accepted wave heights, relative to that of the waves at this moment: compression and NumPy versions change
# it by far less than a thousandth
WAVE_HEIGHTS = (0.999, 1.001)
#: for seas with trough damping, which is applied after the summation, so that the sum is only approximate
DAMPED_WAVE_HEIGHTS = (0.3, 1.1)
#: an invisible difference in m, for values so small that digits are lost
_FLAT = 1e-6


def verify(folder: Path, job: Job, frames: Iterable[Frame]) -> Iterator[Finding]:
    """Read each frame back: record, hashes, header, finite pixels, wave height."""
    surfaces = ShotSeas(job.shot, job.on, job.outputs)
    spray = baked_spray(folder, job.name, job.shot)
    for finding in inspect_all(folder, job, frames):
        frame = finding.frame
        if finding.state is State.WHOLE:
            seas = surfaces.seas(frame)
            for sequence, sea in zip(job.sequences(folder, frame), seas, strict=True):
                problem = _problem(job, sequence, frame, sea)
                if problem:
                    break
            problem = problem or _points_problem(job, folder, frame)
            problem = problem or (spray.problem(frame) if spray is not None else "")
            if problem:
                finding = Finding(frame, State.DAMAGED, problem)
        yield finding


def wave_height(sea: Ocean, moment: Moment, on: Tile | Area = TILE) -> float:
    """Hs in m at a moment: from the amplitudes of a single sum of waves, or else from the surface."""
    if sea.parameters.needs_summation or on != TILE:
        return _height_of(sea.surface(moment.time, on=on).displacement)
    state = sea.initial_state
    weight = state.grid.multiplicity[0]
    variance = 0.0
    for columns in state.grid.column_blocks():
        waves = propagate(state, moment.time, columns=columns).elevation
        variance += float(np.sum(np.abs(waves).astype(np.float64) ** 2 * weight[columns]))
    return 4.0 * float(np.sqrt(variance))


def _problem(job: Job, sequence: ExrSequence, frame: Frame, sea: Ocean) -> str:
    moment = job.shot.at(frame)
    samples = sequence.resolution
    for name in sequence.maps:
        path = sequence.path(frame, name)
        try:
            image, metadata = read_image(path, (samples, samples))
        except ExrError as error:
            return str(error)
        told = {key: metadata.get(key) for key in ("map", "frame", "domain_size", "unit")}
        told |= {"area": metadata["area"]} if "area" in metadata else {}
        wanted = {
            "map": name,
            "frame": to_plain(frame),
            "domain_size": sequence.domain_size,
            "unit": unit_of(name),
            **({} if sequence.area is None else {"area": sequence.area.to_dict()}),
        }
        if told != wanted:
            return f"{path.name} says it is {printable(told, 200)}, not {wanted}"
        if not np.all(np.isfinite(image)):
            return f"{path.name} holds values that are not finite"
        if name == MOVING_MAP:
            bounds = DAMPED_WAVE_HEIGHTS if moment.parameters.trough_damping else WAVE_HEIGHTS
            expected = wave_height(sea, moment, job.on)
            problem = _wrong_height(image, expected, bounds)
            if problem:
                return f"{path.name} {problem}"
    return ""


def _points_problem(job: Job, folder: Path, frame: Frame) -> str:
    try:
        for sequence in job.points(folder, frame):
            sequence.check(frame)
        for beside in (job.coast(folder, frame), job.wakes(folder)):
            if beside is not None:
                beside.check(frame)
    except PlyError as error:
        return str(error)
    return ""


def _height_of(displacement: NDArray[np.floating]) -> float:
    return 4.0 * float(np.std(displacement[..., 2], dtype=np.float64))


def _wrong_height(displacement: NDArray[np.float32], expected: float, bounds: tuple[float, float]) -> str:
    height = _height_of(displacement)
    low, high = (share * expected for share in bounds)
    if low - _FLAT <= height <= high + _FLAT:
        return ""
    return f"has waves of {height:.4g} m; this sea has {expected:.4g} m at this frame"
