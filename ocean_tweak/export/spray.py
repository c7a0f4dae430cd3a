# SPDX-License-Identifier: GPL-3.0-or-later
"""Baked spray: spray/NAME_spray.####.ply beside the images of its sea, one file per frame.

Each file stores the parameters it was computed from. A file with the same parameters is complete and kept;
changing amount, size, wind or life rewrites these files, but no images. `spray.json` beside them stores the
last request, from which commands on a bake's folder know that it has spray.
"""

from __future__ import annotations

import contextlib
import json
import re
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ..core.data import formats
from ..core.data.frames import Frame
from ..core.data.plain_data import from_plain, to_plain
from ..core.parameters.fingerprint import fingerprint, frame_fingerprint
from ..core.parameters.shot import Shot
from ..core.parameters.spray import Spray
from ..core.spray.columns import COLUMNS, columns
from ..core.spray.particles import Particles
from .files import LARGEST_JSON, PART, is_link, read_bytes, write_text
from .frame_files import SPRAY, files_start, frame_file
from .ply import PlyError, read_ply, told_by_ply, write_ply

#: in the folder of the files
ASKED = "spray.json"


@dataclass(frozen=True)
class WantedSpray:
    """A request for spray.

    place : x and y in m that it is made around; None for the sea's own tile
    """

    spray: Spray
    place: tuple[float, float] | None = None

    def of(self, shot: Shot) -> Shot:
        """A shot with this spray."""
        return replace(shot, parameters=shot.parameters.replace(spray=self.spray))

    def to_dict(self) -> dict[str, Any]:
        """Plain data, as in `spray.json`."""
        place = None if self.place is None else list(self.place)
        return {"format": formats.SPRAY, "spray": to_plain(self.spray), "place": place}


@dataclass(frozen=True)
class SpraySequence:
    """The files of a shot's spray.

    directory : of the bake, which contains the folder of the files
    place : x and y in m that it is made around; None for the sea's own tile
    """

    directory: Path
    name: str
    shot: Shot
    spray: Spray
    place: tuple[float, float] | None = None

    def path(self, frame: Frame) -> Path:
        """Path of a frame's spray."""
        return self.directory / SPRAY / frame_file(self.name, SPRAY, frame)

    @property
    def wanted(self) -> WantedSpray:
        """The request."""
        return WantedSpray(self.spray, self.place)

    def ask(self) -> None:
        """Store the request in the folder. Raises OSError if it cannot be written."""
        path = self.directory / SPRAY / ASKED
        path.parent.mkdir(exist_ok=True)
        text = json.dumps(self.wanted.to_dict(), indent=1) + "\n"
        if not path.is_file() or path.read_bytes() != text.encode():
            write_text(path, text)

    def _is_whole(self, frame: Frame) -> bool:
        """Whether a frame's file exists and has the same parameters."""
        told = told_by_ply(self.path(frame), (COLUMNS,))
        return told is not None and self._is_of_this(frame, told)

    def missing(self, frames: Iterable[Frame]) -> list[Frame]:
        """The frames whose files do not exist or have other parameters."""
        return [frame for frame in frames if not self._is_whole(frame)]

    def problem(self, frame: Frame) -> str:
        """Read a frame's file; returns its problem, or ""."""
        path = self.path(frame)
        told = told_by_ply(path, (COLUMNS,))
        if not path.exists():
            return f"{path.name} is missing"
        if told is None:
            return f"{path.name} is cut off or damaged"
        if not self._is_of_this(frame, told):
            return f"{path.name} is of other settings or another version"
        try:
            values = read_ply(path, (COLUMNS,))
        except PlyError as error:
            return str(error)
        is_finite = all(np.isfinite(column).all() for column in values.values())
        return "" if is_finite else f"{path.name} holds values that are not finite"

    def write(self, frame: Frame, particles: Particles) -> Path:
        """Write a frame. Returns the file's path. Raises OSError if it cannot be written."""
        path = self.path(frame)
        path.parent.mkdir(exist_ok=True)
        write_ply(path, COLUMNS, columns(particles), self._about(frame))
        return path

    def _is_of_this(self, frame: Frame, told: dict[str, Any]) -> bool:
        return bool(told.get("fingerprint") == self._about(frame)["fingerprint"])

    def _about(self, frame: Frame) -> dict[str, Any]:
        made_from = {
            "sea": frame_fingerprint(self.shot, frame), "spray": to_plain(self.spray),
            "place": None if self.place is None else list(self.place),
            "foam": formats.FOAM, "version": formats.SPRAY,
        }  # fmt: skip
        return {**made_from, "fingerprint": fingerprint(made_from)}


def baked_spray(directory: Path, name: str, shot: Shot) -> SpraySequence | None:
    """The spray files requested for a bake's folder; None if there are none.

    Raises PlyError if the request cannot be read.
    """
    path = directory / SPRAY / ASKED
    try:
        data = json.loads(read_bytes(path, LARGEST_JSON))
        formats.check_format(data, formats.SPRAY)
        spray, place = from_plain(Spray, data["spray"]), data["place"]
        x, y = (0.0, 0.0) if place is None else map(float, place)
    except FileNotFoundError:
        return None
    except (OSError, AttributeError, KeyError, TypeError, ValueError, RecursionError) as error:
        raise PlyError(f"{path}: is not readable ({error}): bake the sea with --spray again") from None
    return SpraySequence(directory, name, shot, spray, None if place is None else (x, y))


def spray_files(directory: Path, name: str) -> dict[Frame, Path]:
    """The files of a bake's spray by their frames, ascending."""
    own = re.compile(re.escape(files_start(name, SPRAY)) + r"(-\d{3,}|\d{4,})\.ply")
    found = ((own.fullmatch(path.name), path) for path in (directory / SPRAY).glob("*.ply"))
    return dict(sorted((int(match[1]), path) for match, path in found if match is not None))


def remove_empty(directory: Path) -> None:
    """Remove the folder of spray if it contains no frame any more."""
    folder = directory / SPRAY
    if is_link(folder) or any(folder.glob("*.ply")):
        return
    for path in (folder / ASKED, *folder.glob(f".*{PART}")):  # including those of killed processes
        path.unlink(missing_ok=True)
    with contextlib.suppress(OSError):
        folder.rmdir()
