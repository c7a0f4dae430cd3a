# SPDX-License-Identifier: GPL-3.0-or-later
"""Waves that do not repeat, such as wakes, as points in PLY files, which Blender's nodes can read.

NAME_wakes.####.ply has the samples of a square around the camera, x fastest, in the sea's axes, in metres and
seconds: position of the water (x, y, z) as these waves alone move it, their velocity, slope and strain, how
far they move it aside (moved_x, moved_y), and the foam of hulls. Binary, little-endian, float.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..core.data.frames import Frame
from ..core.foam.model import Whitecaps
from ..core.parameters.surroundings import Surroundings
from ..core.sea.regions import Area
from ..core.synthesis.channels import CHANNELS, SurfaceFields
from .frame_files import WAKES, frame_file
from .ply import LONGEST_HEADER, PlyError, read_ply, write_ply

#: where a sample is at rest is its position without these
MOVED = ("moved_x", "moved_y")
_CHANNELS = ("velocity", "slope", "strain")
#: columns of a sample; the first three are the position of the water
COLUMNS = (
    "x", "y", "z",
    *(column for name in _CHANNELS for column in CHANNELS[name].columns),
    *MOVED,
    *(column for name in Whitecaps._fields for column in CHANNELS[name].columns),
)  # fmt: skip


@dataclass(frozen=True)
class WakeSequence:
    """Writes the frames of a square around a camera."""

    directory: Path
    name: str
    around: Surroundings

    def path(self, frame: Frame) -> Path:
        """Path of a frame's points."""
        return self.directory / frame_file(self.name, WAKES, frame)

    @property
    def bytes(self) -> int:
        """Largest size of a frame's file."""
        return 4 * self.around.resolution**2 * len(COLUMNS) + LONGEST_HEADER

    def write(self, frame: Frame, fields: SurfaceFields) -> Path:
        """Write a frame from what `core.sea.bake.ShotSeas.around` gives. Returns the file's path.

        Raises PlyError for a value that is not finite, and OSError if it cannot be written.
        """
        about = {"around": self.around.in_frame(frame).to_dict(), "time": fields.time}
        write_ply(self.path(frame), COLUMNS, self.values(frame, fields), about)
        return self.path(frame)

    def values(self, frame: Frame, fields: SurfaceFields) -> NDArray[np.float32]:
        """(samples², columns), the content of a file."""
        square = self.around
        x, y = Area(square.size, square.resolution, square.corner(frame)).rest_positions()
        moved = fields.displacement.astype(np.float64)
        columns = np.concatenate(
            [
                np.stack((moved[..., 0] + x, moved[..., 1] + y, moved[..., 2]), axis=-1),
                *(fields[name] for name in _CHANNELS),
                moved[..., :2],
                *(fields[name][..., np.newaxis] for name in Whitecaps._fields),
            ],
            axis=-1,
        )
        return columns.reshape(-1, len(COLUMNS)).astype("<f4")

    def check(self, frame: Frame) -> None:
        """Read a frame back. Raises PlyError if it differs from what was written."""
        path = self.path(frame)
        values = read_ply(path, (COLUMNS,))
        if len(values["x"]) != self.around.resolution**2:
            raise PlyError(f"{path}: has not {self.around.resolution}² points")
        if not all(np.all(np.isfinite(column)) for column in values.values()):
            raise PlyError(f"{path}: holds values that are not finite")
