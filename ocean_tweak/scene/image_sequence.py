# SPDX-License-Identifier: GPL-3.0-or-later
"""Baked EXR sequences on disk and as Blender images."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import bpy

from .live_image import mark_as_data
from .settings import OceanObjectError

_FILE = re.compile(r"(?P<name>.+)_disp\.(?P<frame>\d{4,})\.exr")


class SequenceError(OceanObjectError):
    """An image sequence that cannot be used, and why."""


@dataclass(frozen=True)
class ImageSequence:
    """The files NAME_disp.####.exr of a folder from a first to a last frame.

    directory : may start with // for the folder of the .blend file
    """

    directory: str | Path
    name: str
    first: int
    last: int

    def path(self, frame: int) -> Path:
        """Where the displacement of a frame is."""
        return _absolute(self.directory) / f"{self.name}_disp.{frame:04d}.exr"

    def check(self) -> None:
        """Raise SequenceError unless every frame has its file."""
        if self.first > self.last:
            raise SequenceError(f"The first frame {self.first} lies after the last frame {self.last}")
        available = _frames_by_name(_absolute(self.directory))
        frames = available.get(self.name, [])
        if not frames:
            hint = f"; it holds {', '.join(sorted(available))}" if available else ""
            raise SequenceError(f"No files {self.name}_disp.####.exr in {_absolute(self.directory)}{hint}")
        missing = sorted(set(range(self.first, self.last + 1)).difference(frames))
        if missing:
            raise SequenceError(
                f"{len(missing)} of the frames {self.first} to {self.last} have no file, "
                f"the first of them {self.path(missing[0])}"
            )


def find_sequence(path: str | Path) -> ImageSequence:
    """The sequence that a file belongs to, or the only one of a folder.

    Raises SequenceError when there is none, more than one, or a gap in it.
    """
    chosen = _absolute(path)
    directory, name = chosen, None
    if not chosen.is_dir():
        match = _FILE.fullmatch(chosen.name)
        if match is None:
            raise SequenceError(f"{chosen} is neither a folder nor a file named NAME_disp.####.exr")
        directory, name = chosen.parent, match["name"]
    available = _frames_by_name(directory)
    if name is None:
        if len(available) != 1:
            found = f"more than one: {', '.join(sorted(available))}" if available else "none"
            raise SequenceError(f"{directory} should hold one sequence NAME_disp.####.exr, but has {found}")
        name = next(iter(available))
    frames = available.get(name)
    if not frames:
        raise SequenceError(f"No files {name}_disp.####.exr in {directory}")
    sequence = ImageSequence(directory, name, min(frames), max(frames))
    sequence.check()
    return sequence


def load_image(sequence: ImageSequence) -> tuple[bpy.types.Image, int]:
    """The sequence as an image of the file, and its samples along each side.

    An image of the same files that is there already is read anew and returned.
    Raises SequenceError for missing files and for images that cannot be read or are not square.
    """
    sequence.check()
    path = sequence.path(sequence.first)
    present = next((image for image in bpy.data.images if _shows(image, path)), None)
    image = bpy.data.images.load(str(path), check_existing=False)
    # as a sequence, Blender tells the size of whichever file it read last, or none
    width, height = image.size
    if width != height or width == 0:
        bpy.data.images.remove(image)
        problem = f"is {width} x {height} texels, not square" if width else "cannot be read as an image"
        raise SequenceError(f"{path} {problem}")
    if present is not None:
        bpy.data.images.remove(image)
        present.reload()
        return present, width
    image.source = "SEQUENCE"
    image.name = f"{sequence.name}_disp"
    mark_as_data(image)
    return image, width


def _shows(image: bpy.types.Image, path: Path) -> bool:
    return (
        image.source == "SEQUENCE"
        and image.library is None
        and Path(bpy.path.abspath(image.filepath)).resolve() == path.resolve()
    )


def _absolute(path: str | Path) -> Path:
    return Path(bpy.path.abspath(str(path))).resolve()


def _frames_by_name(directory: Path) -> dict[str, list[int]]:
    if not directory.is_dir():
        raise SequenceError(f"The folder {directory} does not exist")
    frames: dict[str, list[int]] = {}
    for path in directory.iterdir():
        match = _FILE.fullmatch(path.name)
        if match is not None:
            frames.setdefault(match["name"], []).append(int(match["frame"]))
    return frames
