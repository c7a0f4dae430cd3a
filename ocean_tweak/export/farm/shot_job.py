# SPDX-License-Identifier: GPL-3.0-or-later
"""A shot as a job for a farm: what is baked, verified and rendered, in which portions, with which programs.

The seas travel as JSON files beside the job, so a farm bakes without Blender and without the .blend file.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from ...core.data.frames import Frame, format_frames
from ...core.data.printable import without_exponent
from ..cache.job import Job
from ..spray import WantedSpray

#: the Python script that renders, in a Blender with or without this extension
RENDER_SCRIPT = Path(__file__).with_name("render_baked.py")
#: folder of the seas' parameters, in a job's own
SEAS = "seas"
#: characters of a value and of the job's name, in the strictest form of job
LONGEST_VALUE, _LONGEST_NAME = 1024, 128

#: what bakes → its arguments before those of the command line
BAKERS = {
    "python": ("-m", "ocean_tweak"),
    "blender": ("--background", "--command", "ocean_tweak"),
}


@dataclass(frozen=True)
class Render:
    """A render of the shot from its bakes.

    blend : the .blend file
    pictures : folder for the pictures; None for one in the job's own
    chunk : frames in a task
    """

    blend: Path
    pictures: Path | None
    chunk: int


@dataclass(frozen=True)
class ShotJob:
    """A shot for a farm.

    bakes : one for each sea, all of the same frames
    frames : of the shot, whole numbers
    chunk : frames in a task of baking or verifying
    cache : folder of all bakes; None for one in the job's own
    bake_with : a key of BAKERS
    python, blender : how the machines of the farm call these programs
    sprays : to be baked too, by the names of the bakes
    workers : processes of one baking task; None for one a core
    plain_ranges : write tasks out, for farms that cannot divide frames into chunks themselves
    """

    name: str
    bakes: tuple[Job, ...]
    frames: tuple[Frame, ...]
    chunk: int
    cache: Path | None
    bake_with: str
    python: str
    blender: str
    sprays: Mapping[str, WantedSpray] = field(default_factory=dict)
    workers: int | None = None
    plain_ranges: bool = False
    render: Render | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "name", _shown(self.name))
        render = (self.render.blend, self.render.pictures) if self.render is not None else ()
        for text in (self.cache, *render, self.python, self.blender):
            _check_text(str(text))
        between = [frame for frame in self.frames if not isinstance(frame, int)]
        if between:
            raise ValueError(f"frame {float(between[0])}: farm tasks are whole frames")
        names = [bake.name for bake in self.bakes]
        if len({name.casefold() for name in names}) < len(names):  # some disks tell no capitals apart
            raise ValueError(f"{', '.join(names)}: two seas of one job cannot have the same file names")


def _shown(name: str) -> str:
    """The job's name as every farm shows it: a line of at most so many characters, and no formula."""
    line = "".join(letter if letter.isprintable() else " " for letter in name)
    # OpenJD takes {{ }} for an expression
    line = " ".join(re.sub(r"([{}])(?=\1)", r"\1 ", line).split()) or "shot"
    return line if len(line) <= _LONGEST_NAME else f"{line[: _LONGEST_NAME - 1]}…"


def _check_text(text: str) -> None:
    """Raise ValueError for a path or a command that no job can hold."""
    if not text:
        raise ValueError("--python and --blender: say how these programs are called on the farm's machines")
    if len(text) > LONGEST_VALUE:
        raise ValueError(
            f"{text[:40]}…: has {len(text)} characters; a farm job holds at most {LONGEST_VALUE}"
        )
    try:
        text.encode()
    except UnicodeEncodeError:
        raise ValueError(f"{text!r}: is not Unicode text, which a farm job needs: rename it") from None


def chunks(frames: Sequence[Frame], size: int) -> list[str]:
    """Ranges of at most so many frames each."""
    return [format_frames(frames[start : start + size]) for start in range(0, len(frames), size)]


def sea_arguments(bake: Job, seas: str, cache: str) -> list[str]:
    """Common arguments of `bake` and `verify`: the sea, its files and their folder.

    What the farm fills in stands behind an equals sign: a folder or a range may begin with a minus.

    seas, cache : folders, as the farm writes them
    """
    return [
        f"--params={seas}/{bake.name}.json",
        *_option("--name", bake.name),
        *_option("--uid", bake.uid),
        *_option("--maps", ",".join(bake.maps)),
        *_option("--compression", bake.compression),
        *(("--area", *bake.area.words()) if bake.area is not None else ()),
        f"--out={cache}",
    ]


def bake_arguments(
    job: ShotJob, bake: Job, seas: str, cache: str, frames: str, only: str, openjd: bool
) -> list[str]:
    """The arguments of Python or Blender that bake some of the frames."""
    # a farm gives a lost machine's task to another one, which finds the lost one's lock
    arguments = [*BAKERS[job.bake_with], "bake", *sea_arguments(bake, seas, cache), "--take-over"]
    if job.workers is not None:
        arguments.append(f"--workers={job.workers}")
    spray = _spray(job, bake)
    return [*arguments, *spray, *_openjd(openjd), f"--frames={frames}", f"--only={only}"]


def verify_arguments(job: ShotJob, bake: Job, seas: str, cache: str, only: str, openjd: bool) -> list[str]:
    """The arguments of Python or Blender that read some of the frames back."""
    sea = sea_arguments(bake, seas, cache)
    return [*BAKERS[job.bake_with], "verify", *sea, *_openjd(openjd), f"--frames={only}"]


def render_arguments(job: ShotJob, cache: str, frames: str, pictures: str, openjd: bool) -> list[str]:
    """Arguments of the render script, after Blender's own."""
    bakes = [word for bake in job.bakes for word in _option("--bake", f"{bake.home}/{bake.hash8}")]
    return [f"--cache={cache}", *bakes, f"--pictures={pictures}", *_openjd(openjd), f"--frames={frames}"]


def _option(name: str, value: str) -> list[str]:
    """An option and its value; as one word where the value would be taken for another option."""
    return [f"{name}={value}"] if value.startswith("-") else [name, value]


def _spray(job: ShotJob, bake: Job) -> list[str]:
    wanted = job.sprays.get(bake.name)
    if wanted is None:
        return []
    return [
        "--spray",
        *(() if wanted.place is None else ("--spray-place", *map(without_exponent, wanted.place))),
    ]


def _openjd(openjd: bool) -> list[str]:
    return ["--openjd"] if openjd else []


def sea_files(folder: Path, job: ShotJob) -> dict[Path, str]:
    """The seas' parameters as the files of a job's folder."""
    shots = {
        bake.name: job.sprays[bake.name].of(bake.shot) if bake.name in job.sprays else bake.shot
        for bake in job.bakes
    }
    return {folder / SEAS / f"{name}.json": shot.to_json() + "\n" for name, shot in shots.items()}
