# SPDX-License-Identifier: GPL-3.0-or-later
"""Baked EXR sequences on disk and as Blender images."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from pathlib import Path

import bpy

from ..core import ParameterError, Timing
from ..core.data.frames import MOST_FRAMES, format_frames, held_frame, parse_frames
from ..core.synthesis.channels import MOVING_MAP
from ..export.exr import ExrError, NewerExrError, read_header, read_size
from ..export.frame_files import ImageFile, frame_file, image_file_of
from ..nodes.names import MAP_INPUTS
from .live_image import mark_as_data
from .settings import OceanObjectError, OceanSettings
from .stored_paths import absolute, image_file, relative
from .units import time_stretch

# limits of Blender's frames, and therefore of files
_FARTHEST = 1_048_574


class SequenceError(OceanObjectError):
    """An image sequence that cannot be used, with the reason."""


@dataclass(frozen=True)
class ImageSequence:
    """The files NAME_map.####.exr of a folder at some frames.

    directory : may start with // for the folder of the .blend file
    frames : ascending, at least one
    """

    directory: str | Path
    name: str
    frames: tuple[int, ...]

    def path(self, frame: int, map_name: str = MOVING_MAP) -> Path:
        """Path of a frame's map."""
        return absolute(self.directory) / frame_file(self.name, map_name, frame)

    def check(self) -> tuple[str, ...]:
        """The existing maps. Raises SequenceError unless every frame has a file of each map."""
        first, last = self.frames[0], self.frames[-1]
        if last - first >= MOST_FRAMES:  # their number is limited, as they are listed one by one
            raise SequenceError(
                f"Frames {first} and {last} are {last - first} apart: {MOST_FRAMES} is too far"
            )
        available = _frames_by_map(absolute(self.directory))
        if (self.name, MOVING_MAP) not in available:
            names = sorted(name for name, map_name in available if map_name == MOVING_MAP)
            hint = f"; it holds {', '.join(names)}" if names else ""
            raise SequenceError(f"No files {self.name}_disp.####.exr in {absolute(self.directory)}{hint}")
        wanted = set(self.frames)
        frames = {name: available[self.name, name] for name in MAP_INPUTS if (self.name, name) in available}
        # a map that was only baked for other frames is not part of this sequence
        maps = tuple(
            name
            for name in MAP_INPUTS
            if name == MOVING_MAP or not frames.get(name, set()).isdisjoint(wanted)
        )
        for name in maps:
            missing = sorted(wanted - frames[name])
            if missing:
                raise SequenceError(
                    f"{len(missing)} of the frames {format_frames(self.frames)} have no file, "
                    f"the first of them {self.path(missing[0], name)}"
                )
        return maps


@dataclass(frozen=True)
class LoadedSequence:
    """A sequence as images of the file.

    images : by map
    early_images : by map, for frames before 0, as Blender counts the files of an image upwards from 0
    samples : along each side
    fps : of the shot it was baked for; None if unknown
    stretch : frames of that shot per frame of its animation
    """

    images: dict[str, bpy.types.Image]
    early_images: dict[str, bpy.types.Image]
    samples: int
    fps: Fraction | None
    stretch: Fraction


def find_sequence(path: str | Path) -> ImageSequence:
    """The sequence that a file belongs to, or the only one of a folder.

    It has the existing frames; `unbaked_frames` returns the others.

    Raises SequenceError if there is none or more than one, or if a map lacks some of the frames.
    """
    chosen = absolute(path)
    directory, name = chosen, None
    if not chosen.is_dir():
        file = _shown_file(chosen.name)
        if file is None:
            raise SequenceError(f"{chosen} is neither a folder nor a file named NAME_disp.####.exr")
        directory, name = chosen.parent, file.name
    available = {
        name: frames for (name, kind), frames in _frames_by_map(directory).items() if kind == MOVING_MAP
    }
    if name is None:
        if len(available) != 1:
            found = f"more than one: {', '.join(sorted(available))}" if available else "none"
            raise SequenceError(f"{directory} should hold one sequence NAME_disp.####.exr, but has {found}")
        name = next(iter(available))
    frames = available.get(name)
    if not frames:
        raise SequenceError(f"No files {name}_disp.####.exr in {directory}")
    sequence = ImageSequence(directory, name, tuple(sorted(frames)))
    sequence.check()
    return sequence


def load_sequence(sequence: ImageSequence) -> LoadedSequence:
    """The sequence as images of the file.

    Existing images of the same files are reloaded and reused. Raises SequenceError for missing files, and for
    images that cannot be read, are not square or differ in size.
    """
    maps = sequence.check()
    paths = {name: sequence.path(sequence.frames[0], name) for name in maps}
    sizes = {name: _samples(path) for name, path in paths.items()}
    for name, samples in sizes.items():
        if samples != sizes[MOVING_MAP]:
            raise SequenceError(
                f"{paths[name]} is {samples} texels wide, the displacement {sizes[MOVING_MAP]}: "
                "bake all maps with one resolution"
            )
    early = [frame for frame in sequence.frames if frame < 0]
    later = [frame for frame in sequence.frames if frame >= 0]
    # where all frames are early ones, the others are never read
    # by the shortest number: Blender writes others with as many digits or more
    images = {name: _image(sequence.path(later[0] if later else early[-1], name)) for name in maps}
    early_images = {name: _image(sequence.path(early[-1], name)) for name in maps if early}
    return LoadedSequence(images, early_images, sizes[MOVING_MAP], *_timing(paths[MOVING_MAP]))


def baked_frames(settings: OceanSettings) -> tuple[int, ...]:
    """The frames of an ocean's sequence, ascending; for old files, from the first to the last one."""
    return _stored(settings.sequence_frames, settings.sequence_first, settings.sequence_last)


def baked_stretch(settings: OceanSettings) -> Fraction:
    """Frames of an ocean's sequence per frame of its animation."""
    return _stored_stretch(settings.sequence_stretch)


def shown_frame(settings: OceanSettings, scene: bpy.types.Scene, frame: int) -> int:
    """The frame whose files an ocean shows at a frame of the scene: the last baked one not after it, else the
    first.

    Nodes choose the file by the same rule: see `nodes.shown_frame`.
    """
    return held_frame(baked_frames(settings), _wanted_frame(settings, scene, frame))


def since_shown(settings: OceanSettings, scene: bpy.types.Scene, frame: int) -> Fraction:
    """Offset of a frame of the scene from the moment of its files, in files, from -½ to ½.

    0 unless Time Stretching has changed since the bake; velocity then moves the water by it.
    """
    return _moment(settings, scene, frame) - _wanted_frame(settings, scene, frame)


def unbaked_frames(settings: OceanSettings, scene: bpy.types.Scene, frames: Iterable[int]) -> tuple[int, ...]:
    """The given frames of the scene that an ocean's sequence lacks; none for a live ocean."""
    if settings.source != "SEQUENCE":
        return ()
    baked = set(baked_frames(settings))
    return tuple(frame for frame in frames if _wanted_frame(settings, scene, frame) not in baked)


def _wanted_frame(settings: OceanSettings, scene: bpy.types.Scene, frame: int) -> int:
    """The frame of the bake nearest to one of the scene: the same, unless Time Stretching changed since."""
    return math.floor(_moment(settings, scene, frame) + Fraction(1, 2))


def _moment(settings: OceanSettings, scene: bpy.types.Scene, frame: int) -> Fraction:
    """A frame of the scene converted to frames of the bake, possibly fractional."""
    return frame * baked_stretch(settings) / time_stretch(scene)


# asked on every frame; a long list takes milliseconds. What a .blend file says may be anything
@lru_cache(maxsize=16)
def _stored(text: str, first: int, last: int) -> tuple[int, ...]:
    try:
        frames = parse_frames(text) if text else range(max(first, -_FARTHEST), min(last, _FARTHEST) + 1)
    except ParameterError:
        frames = ()
    return tuple(frame for frame in frames if isinstance(frame, int) and abs(frame) <= _FARTHEST) or (0,)


@lru_cache(maxsize=16)
def _stored_stretch(text: str) -> Fraction:
    try:
        return Timing(stretch=text or 1).stretch
    except ParameterError:
        return Fraction(1)


def file_of(settings: OceanSettings, frame: int, map_name: str = MOVING_MAP) -> Path | None:
    """The path of a map at a frame of an ocean's sequence, existing or not; None if it has no such map."""
    maps = settings.early_maps if frame < 0 else settings.sequence_maps
    return _file_at(getattr(maps, map_name), frame)


def folder_of(settings: OceanSettings) -> Path | None:
    """The folder of an ocean's sequence; None if it has none."""
    file = file_of(settings, baked_frames(settings)[0])
    return None if file is None else file.parent


def missing_file(settings: OceanSettings, frame: int) -> Path | None:
    """The first missing file of a frame of an ocean's sequence; None if none is missing."""
    maps = settings.early_maps if frame < 0 else settings.sequence_maps
    files = (_file_at(getattr(maps, name), frame) for name in MAP_INPUTS)
    return next((file for file in files if file is not None and not file.is_file()), None)


def _file_at(image: bpy.types.Image | None, frame: int) -> Path | None:
    if image is None or image.source != "SEQUENCE":
        return None
    path = image_file(image)
    file = _shown_file(path.name)
    return None if file is None else path.with_name(frame_file(file.name, file.map, frame))


def _samples(path: Path) -> int:
    """Texels along each side of an image."""
    try:
        height, width = read_size(path)
    except ExrError:
        raise SequenceError(f"{path} cannot be read as an EXR image") from None
    if width != height:
        raise SequenceError(f"{path} is {width} x {height} texels, not square")
    return width


def _image(path: Path) -> bpy.types.Image:
    """The sequence that a file belongs to, as an image."""
    present = next((image for image in bpy.data.images if _shows(image, path)), None)
    if present is not None:
        present.reload()
        return present
    image = bpy.data.images.load(relative(path), check_existing=False)
    image.source = "SEQUENCE"
    image.name = path.name.partition(".")[0]
    mark_as_data(image)
    return image


def _timing(path: Path) -> tuple[Fraction | None, Fraction]:
    """Frames per second of a file's shot, and its stretch. Raises SequenceError for newer files and areas."""
    try:
        header = read_header(path)
        if "area" in header:
            raise SequenceError(
                f"{path} shows an area, which does not repeat like the ocean's mesh: bake without --area"
            )
        timing = Timing(**header["parameters"]["timing"])
        return timing.fps, timing.stretch
    except NewerExrError as error:
        raise SequenceError(str(error)) from None
    except (ExrError, KeyError, TypeError, ParameterError):  # a file from another program
        return None, Fraction(1)


def _shows(image: bpy.types.Image, path: Path) -> bool:
    return image.source == "SEQUENCE" and image.library is None and image_file(image) == path


def _frames_by_map(directory: Path) -> dict[tuple[str, str], set[int]]:
    """The frames of each name and map in a folder."""
    if not directory.is_dir():
        raise SequenceError(f"The folder {directory} does not exist")
    frames: dict[tuple[str, str], set[int]] = {}
    for path in directory.iterdir():
        file = _shown_file(path.name)
        if file is not None and abs(file.frame) <= _FARTHEST:
            frames.setdefault((file.name, file.map), set()).add(file.frame)
    return frames


def _shown_file(file_name: str) -> ImageFile | None:
    """The parts of a file name whose map Blender reads."""
    file = image_file_of(file_name)
    return file if file is not None and file.map in MAP_INPUTS else None
