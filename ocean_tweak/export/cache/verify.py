# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads baked frames back and says of each whether it can be rendered."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...core import Ocean, OceanParameters
from ...core.frames import Frame
from ...core.plain_data import to_plain
from ..exr import MAPS, ExrError, ExrSequence, read_image
from .job import Job
from .records import Finding, State, inspect

#: a surface's wave height, as a share of its seed's mean over all time, that is still believed: waves that
#: stand against each other make it change a little, a damaged or rescaled image much
WAVE_HEIGHTS = (0.5, 1.5)


def verify(folder: Path, job: Job, frames: Iterable[Frame]) -> Iterator[Finding]:
    """Read each frame back: record, hashes, header, finite pixels, wave height.

    Raises OSError for a folder that cannot be read.
    """
    expected = _WaveHeights()
    for frame in frames:
        finding = inspect(folder, job, frame)
        if finding.state is State.WHOLE:
            problem = _problem(job, job.sequence(folder, frame), frame, expected)
            if problem:
                finding = Finding(frame, State.DAMAGED, problem)
        yield finding


class _WaveHeights:
    """Hs of seas as their seed has it on average, made once for each sea."""

    def __init__(self) -> None:
        self._last: tuple[OceanParameters, float] | None = None

    def of(self, parameters: OceanParameters) -> float:
        if self._last is None or self._last[0] != parameters:
            height = Ocean(parameters, workers=1).statistics().seed.significant_wave_height
            self._last = (parameters, height)
        return self._last[1]


def _problem(job: Job, sequence: ExrSequence, frame: Frame, expected: _WaveHeights) -> str:
    moment = job.shot.at(frame)
    samples = moment.parameters.resolution
    for name in job.maps:
        path = sequence.path(frame, name)
        try:
            image, metadata = read_image(path)
        except ExrError as error:
            return str(error)
        told = {key: metadata.get(key) for key in ("map", "frame", "domain_size", "unit")}
        wanted = {
            "map": name,
            "frame": to_plain(frame),
            "domain_size": moment.parameters.domain_size,
            "unit": MAPS[name].unit,
        }
        if told != wanted:
            return f"{path.name} says it is {told}, not {wanted}"
        if image.shape != (samples, samples, 3):
            return f"{path.name} has {image.shape[1]} x {image.shape[0]} texels, not {samples} x {samples}"
        if not np.all(np.isfinite(image)):
            return f"{path.name} holds values that are not finite"
        if name == "disp" and moment.parameters.trough_damping == 0.0:
            problem = _wrong_height(image, expected.of(moment.parameters))
            if problem:
                return f"{path.name} {problem}"
    return ""


def _wrong_height(displacement: NDArray[np.float32], expected: float) -> str:
    height = 4.0 * float(np.std(displacement[..., 2], dtype=np.float64))
    low, high = (share * expected for share in WAVE_HEIGHTS)
    if low <= height <= high:
        return ""
    return f"has waves of {height:.3g} m; this sea has {expected:.3g} m"
