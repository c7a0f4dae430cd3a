# SPDX-License-Identifier: GPL-3.0-or-later
"""Baked spray: spray/NAME_spray.####.ply beside the images of its sea, a file a frame.

Each file tells what it was made from. One that tells the same is whole and stays; another amount, size, wind
or life makes these files anew, and no image.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..core.data import formats
from ..core.data.frames import Frame
from ..core.data.plain_data import to_plain
from ..core.parameters.fingerprint import fingerprint, frame_fingerprint
from ..core.parameters.shot import Shot
from ..core.parameters.spray import Spray
from ..core.spray.columns import COLUMNS, columns
from ..core.spray.particles import Particles
from .frame_files import SPRAY, frame_file
from .ply import told_by_ply, write_ply


@dataclass(frozen=True)
class SpraySequence:
    """The files of a shot's spray.

    directory : of the bake, in which the files have a folder
    place : x and y in m that it is made around; None for the sea's own tile
    """

    directory: Path
    name: str
    shot: Shot
    spray: Spray
    place: tuple[float, float] | None = None

    def path(self, frame: Frame) -> Path:
        """Where a frame's spray goes."""
        return self.directory / SPRAY / frame_file(self.name, SPRAY, frame)

    def is_whole(self, frame: Frame) -> bool:
        """Whether a frame's file is there and made from this."""
        told = told_by_ply(self.path(frame), (COLUMNS,))
        return told is not None and told.get("fingerprint") == self._about(frame)["fingerprint"]

    def write(self, frame: Frame, particles: Particles) -> Path:
        """Write a frame. Returns the file's path. Raises OSError for what the disk refuses."""
        path = self.path(frame)
        path.parent.mkdir(exist_ok=True)
        write_ply(path, COLUMNS, columns(particles), self._about(frame))
        return path

    def _about(self, frame: Frame) -> dict[str, Any]:
        made_from = {
            "sea": frame_fingerprint(self.shot, frame), "spray": to_plain(self.spray),
            "place": None if self.place is None else list(self.place),
            "foam": formats.FOAM, "version": formats.SPRAY,
        }  # fmt: skip
        return {**made_from, "fingerprint": fingerprint(made_from)}
