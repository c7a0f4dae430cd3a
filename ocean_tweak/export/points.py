# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts of a sea of several patches as points in PLY files, which Blender's nodes can read.

NAME_p1_points.####.ply has all samples of the first part, x fastest, in the part's own axes, in metres and
seconds: position of the water (x, y, z), velocity, slope and strain. If there are many, the viewport reads
NAME_p1_small_points.####.ply, whose samples are averages over cells; `slope_variance` is the slope variance
lost by averaging. Binary, little-endian, float.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..core.data.frames import Frame
from ..core.parameters.patch_seas import Part
from ..core.synthesis.channels import CHANNELS, SurfaceFields
from .frame_files import POINTS, SMALL_POINTS, frame_file
from .ply import LONGEST_HEADER, PlyError, read_ply, write_ply

#: largest resolution that the viewport reads
MOST_IN_WINDOW = 256

#: columns of a sample; the first three are replaced by the position of the water
CHANNELS_OF_POINTS = ("displacement", "velocity", "slope", "strain")
COLUMNS = ("x", "y", "z", *(column for name in CHANNELS_OF_POINTS[1:] for column in CHANNELS[name].columns))
#: of means
VARIANCE = "slope_variance"

Array = NDArray[np.floating]


@dataclass(frozen=True)
class PointSequence:
    """Writes the frames of one part of a sea.

    number : of the part, from 1
    part : the part
    """

    directory: Path
    name: str
    number: int
    part: Part

    @property
    def samples(self) -> int:
        """Along each side."""
        return self.part.parameters.resolution

    @property
    def samples_by_kind(self) -> dict[bool, int]:
        """Samples along each side, in the files of all samples and, if they exist, in those of averages."""
        few = {True: MOST_IN_WINDOW} if self.samples > MOST_IN_WINDOW else {}
        return {False: self.samples, **few}

    def path(self, frame: Frame, small: bool = False) -> Path:
        """Path of a frame's points."""
        return self.directory / frame_file(self.name, SMALL_POINTS if small else POINTS, frame, self.number)

    def paths(self, frame: Frame) -> tuple[Path, ...]:
        """Paths of all files of a frame."""
        return tuple(self.path(frame, small) for small in self.samples_by_kind)

    def write(self, frame: Frame, fields: SurfaceFields) -> tuple[Path, ...]:
        """Write a frame from fields that include ADDING. Returns the files' paths.

        Raises PlyError for a value that is not finite, and OSError if it cannot be written.
        """
        about = {"part": self.number, "domain_size": self.part.parameters.domain_size,
                 "samples": self.samples, "rotation": self.part.rotation, "time": fields.time}  # fmt: skip
        for small, values in self.values(fields):
            columns = _columns(small)
            write_ply(self.path(frame, small), columns, values.reshape(-1, len(columns)), about)
        return self.paths(frame)

    @property
    def bytes(self) -> int:
        """Largest size of all files of a frame."""
        kinds = self.samples_by_kind.items()
        return sum(4 * samples**2 * len(_columns(small)) + LONGEST_HEADER for small, samples in kinds)

    def values(self, fields: SurfaceFields) -> Iterator[tuple[bool, NDArray[np.float32]]]:
        """The contents of each file, (samples, samples, columns), and whether it contains averages."""
        columns = np.concatenate([fields[name] for name in CHANNELS_OF_POINTS], axis=-1, dtype=np.float64)
        for small, samples in self.samples_by_kind.items():
            values = _means(columns, samples) if small else columns
            placed = _placed(values, self.part.parameters.domain_size, self.samples)
            yield small, placed.astype("<f4")

    def check(self, frame: Frame) -> None:
        """Read a frame back. Raises PlyError if it differs from what was written."""
        for small, samples in self.samples_by_kind.items():
            path = self.path(frame, small)
            values = read_points(path)
            if len(next(iter(values.values()))) != samples**2:
                raise PlyError(f"{path}: has not {samples}² points")
            if not all(np.all(np.isfinite(column)) for column in values.values()):
                raise PlyError(f"{path}: holds values that are not finite")


def read_points(path: Path) -> dict[str, NDArray[np.float32]]:
    """The columns of a file written here, by name, each (samples²,).

    Raises PlyError for a file that is damaged or was not written here.
    """
    return read_ply(path, (_columns(False), _columns(True)))


def _columns(small: bool) -> tuple[str, ...]:
    return (*COLUMNS, VARIANCE) if small else COLUMNS


def _placed(values: Array, size: float, samples: int) -> Array:
    """The columns with displacements replaced by positions, relative to cell centres for averages.

    samples : of the part, along each side; the first one is in the corner
    """
    along = (np.arange(len(values)) + 0.5) * (size / len(values)) - 0.5 * size / samples
    placed = values.copy()
    placed[..., 0] += along
    placed[..., 1] += along[:, np.newaxis]
    return placed


def _means(columns: Array, samples: int) -> Array:
    """Averages of the samples in each cell, with the lost slope variance as a further column."""
    slope = slice(COLUMNS.index("slope_x"), COLUMNS.index("slope_y") + 1)
    squares = (columns[..., slope] ** 2).sum(axis=-1, keepdims=True)
    means = np.concatenate([columns, squares], axis=-1)
    for axis in (0, 1):
        means = _means_along(axis, means, samples)
    means[..., -1] = np.maximum(means[..., -1] - (means[..., slope] ** 2).sum(axis=-1), 0.0)
    return means


def _means_along(axis: int, values: Array, samples: int) -> Array:
    """Sample i covers i to i + 1; cells of another length are weighted by overlap."""
    count = values.shape[axis]
    sums = np.concatenate([np.zeros_like(np.take(values, [0], axis)), np.cumsum(values, axis)], axis)
    ends = np.arange(samples + 1) * (count / samples)
    before = np.minimum(ends.astype(np.intp), count - 1)
    share = (ends - before).reshape((-1, 1, 1) if axis == 0 else (-1, 1))
    first, second = np.take(sums, before, axis), np.take(sums, before + 1, axis)
    return np.diff(first + share * (second - first), axis=axis) * (samples / count)
