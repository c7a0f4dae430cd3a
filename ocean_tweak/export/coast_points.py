# SPDX-License-Identifier: GPL-3.0-or-later
"""A sea over its bed as points in PLY files, which Blender's nodes can read.

NAME_coast.####.ply has the places of `core.waves.coast.mesh`, offshore lines first, in the sea's axes, in
metres and seconds: position of the water (x, y, z), its velocity, foam, and how wet the bed is. Binary,
little-endian, float.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..core.data.frames import Frame
from ..core.sea.over_bed import OVER_BED_CHANNELS
from ..core.synthesis.channels import CHANNELS, SurfaceFields
from ..core.waves.coast.mesh import CoastMesh
from .frame_files import COAST, frame_file
from .ply import LONGEST_HEADER, PlyError, read_ply, write_ply

#: columns of a place; the first three are the position of the water
COLUMNS = (
    "x", "y", "z",
    *(
        column
        for name in OVER_BED_CHANNELS[1:]
        for column in (CHANNELS[name].columns if name in CHANNELS else (name,))
    ),
)  # fmt: skip


@dataclass(frozen=True)
class CoastSequence:
    """Writes the frames of the mesh over a bed.

    mesh : its places
    """

    directory: Path
    name: str
    mesh: CoastMesh

    def path(self, frame: Frame) -> Path:
        """Path of a frame's points."""
        return self.directory / frame_file(self.name, COAST, frame)

    @property
    def bytes(self) -> int:
        """Largest size of a frame's file."""
        return 4 * self.mesh.x.size * len(COLUMNS) + LONGEST_HEADER

    def write(self, frame: Frame, fields: SurfaceFields) -> Path:
        """Write a frame from OVER_BED_CHANNELS at the places. Returns the file's path.

        Raises PlyError for a value that is not finite, and OSError if it cannot be written.
        """
        about = {"places": self.mesh.tag, "time": fields.time}
        write_ply(self.path(frame), COLUMNS, self.values(fields), about)
        return self.path(frame)

    def values(self, fields: SurfaceFields) -> NDArray[np.float32]:
        """(places, columns), the content of a file."""
        values = np.column_stack([fields[name] for name in OVER_BED_CHANNELS]).astype(np.float64)
        values[:, 0] += self.mesh.x
        values[:, 1] += self.mesh.y
        return values.astype("<f4")

    def check(self, frame: Frame) -> None:
        """Read a frame back. Raises PlyError if it differs from what was written."""
        path = self.path(frame)
        values = read_ply(path, (COLUMNS,))
        if len(values["x"]) != self.mesh.x.size:
            raise PlyError(f"{path}: has not {self.mesh.x.size} points")
        if not all(np.all(np.isfinite(column)) for column in values.values()):
            raise PlyError(f"{path}: holds values that are not finite")
