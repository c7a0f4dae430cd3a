# SPDX-License-Identifier: GPL-3.0-or-later
"""A bake's job and its folder, `CACHE/NAME-UID/vNNN-hash8/`.

The folder's name holds the job's fingerprint, so frames of another sea are never overwritten, and whoever
bakes the same job, on whatever machine, finds the same folder. `bake.json` in it is the job, written once;
only one that was damaged is ever replaced.
"""

from __future__ import annotations

import json
import platform
import re
import unicodedata
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import chain, combinations
from pathlib import Path
from typing import Any

import numpy as np

from ...core.data import formats
from ...core.data.errors import ParameterError
from ...core.data.frames import Frame, format_frames, frame_label, parse_frames
from ...core.data.printable import shown
from ...core.parameters.fingerprint import fingerprint, frame_fingerprint, hashed
from ...core.parameters.ocean_parameters import OceanParameters
from ...core.parameters.patch_seas import PARTS, parts
from ...core.parameters.shot import Shot
from ...core.sea.on import TILE, Area, Tile, told_area
from ...core.sea.placed_waves import check_repeats
from ...core.synthesis.channels import ADDING, MAPS, MOVING_MAP, SurfaceFields, channels_of
from ..exr import COMPRESSION_ERROR, ExrError, ExrSequence, read_header
from ..files import LARGEST_JSON, alone, is_link, new_file, read_bytes, sync_folder, write_text
from ..frame_files import BAKED, POINTS
from ..points import PointSequence

JOB_FILE = "bake.json"
RECORDS, LOCKS = "records", "locks"
#: locked while versions are told apart, or claims are looked at
ENTRY = "entry"
_SEAL = "sha256"

UID = re.compile("[0-9A-Za-z]{1,32}")
_VERSION = re.compile(r"v(\d{3,})-([0-9a-f]{8})")
#: images that are asked for a lost job
_TELLING_IMAGES = 8


class CacheError(RuntimeError):
    """A folder of baked frames that cannot be used, with its path, the reason and the remedy."""


class NewerBakeError(CacheError):
    """A folder that a newer version of the program baked: nothing in it is to be replaced."""


@dataclass(frozen=True)
class Job:
    """What is baked.

    name : of the sea, and of its files
    uid : tells seas of the same name apart, letters and digits
    maps : some of BAKED; in whatever order they are given, the job is the same
    compression : a key of COMPRESSION_ERROR
    frames : those that are asked for
    area : the square where the sea is baked; None for its own tile, or those of its patches

    Raises ParameterError for what would name files elsewhere, and for maps that cannot be made.
    """

    name: str
    uid: str
    shot: Shot
    maps: tuple[str, ...] = (MOVING_MAP,)
    compression: str = "PXR24"
    frames: tuple[Frame, ...] = field(default=(), compare=False)
    area: Area | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "maps", tuple(name for name in BAKED if name in self.maps))
        if self.name != safe_name(self.name):
            raise ParameterError("name", self.name, "holds what file names cannot hold")
        if not UID.fullmatch(self.uid):
            raise ParameterError("uid", self.uid, "must be 1 to 32 letters and digits")
        _check_maps(self.maps, self.shot.parameters, self.area)

    @cached_property
    def fingerprint(self) -> str:
        """SHA-256 of all that the frames' files depend on, whichever frames are made."""
        return fingerprint(
            {
                "format": formats.JOB,
                "synthesis": formats.SYNTHESIS,
                "shot": hashed(self.shot),
                "maps": list(self.maps),
                "compression": self.compression,
                **self._told_area(),
            }
        )

    def frame_fingerprint(self, frame: Frame) -> str:
        """SHA-256 of what a frame is made from."""
        return frame_fingerprint(self.shot, frame, **self._told_area())

    def _told_area(self) -> dict[str, Any]:
        return {} if self.area is None else {"area": self.area.to_dict()}

    @property
    def on(self) -> Tile | Area:
        """Where the fields of a frame are made."""
        return self.area or TILE

    @property
    def resolution(self) -> int:
        """Texels along each side of an image, the first patch's where it has several."""
        return self.shot.parameters.resolution if self.area is None else self.area.resolution

    @property
    def home(self) -> str:
        """The folder of all versions of this sea, in a cache."""
        return f"{self.name}-{self.uid}"

    @property
    def hash8(self) -> str:
        """What tells its folder from those of other versions."""
        return self.fingerprint[:8]

    @property
    def outputs(self) -> frozenset[str]:
        """The fields that its maps are made of; of points, PARTS."""
        own = frozenset({PARTS}) if POINTS in self.maps else frozenset()
        return own | channels_of(self.images)

    @property
    def images(self) -> tuple[str, ...]:
        """Those of its maps that are images."""
        return tuple(name for name in self.maps if name in MAPS)

    def sequences(self, folder: Path, frame: Frame) -> tuple[ExrSequence, ...]:
        """The sinks for a frame, whose headers tell its parameters: one a patch, or one of an area."""
        parameters = self.shot.at(frame).parameters
        is_one = self.area is not None or not parameters.is_cascade
        patches: Iterable[int | None] = (None,) if is_one else range(len(parameters.patches))
        return tuple(
            ExrSequence(folder, self.name, parameters, self.compression, self.images, patch, self.area)
            for patch in patches
        )

    def points(self, folder: Path, frame: Frame) -> tuple[PointSequence, ...]:
        """The sinks for a frame's points, one a part; none where they are not among the maps."""
        if POINTS not in self.maps:
            return ()
        of_sea = parts(self.shot.at(frame).parameters)
        return tuple(PointSequence(folder, self.name, number, part) for number, part in enumerate(of_sea, 1))

    def sequence(self, folder: Path, frame: Frame) -> ExrSequence:
        """The sink for a frame of a sea of one patch, or of an area. Raises CacheError for another."""
        sequence, *others = self.sequences(folder, frame)
        if others:
            raise CacheError(f"{folder} holds the images of several patches, not of one")
        return sequence

    def files(self, folder: Path, frame: Frame) -> list[tuple[str, str]]:
        """Map and file name of each of a frame's files."""
        sequences = self.sequences(folder, frame)
        images = [(name, sequence.path(frame, name).name) for sequence in sequences for name in self.images]
        points = [path.name for sequence in self.points(folder, frame) for path in sequence.paths(frame)]
        return [*images, *((POINTS, name) for name in points)]

    def write(self, folder: Path, frame: Frame, fields: Sequence[SurfaceFields]) -> Iterator[Path]:
        """Write a frame's files, those that `files` names, in its order. Yields each path when it is whole.

        fields : what `core.bake.ShotSurfaces` makes for `outputs`
        """
        sequences = self.sequences(folder, frame)
        for sequence, own in zip(sequences, fields, strict=False):
            for name in self.images:
                yield sequence.write_map(frame, own, name)
        for points, own in zip(self.points(folder, frame), fields[len(sequences) :], strict=True):
            yield from points.write(frame, own)

    def to_dict(self) -> dict[str, Any]:
        """Plain data, as it stands in `bake.json`."""
        data = {
            "format": formats.JOB,
            "synthesis": formats.SYNTHESIS,
            "fingerprint": self.fingerprint,
            "name": self.name,
            "uid": self.uid,
            "frames": format_frames(self.frames),
            "maps": list(self.maps),
            "compression": self.compression,
            **self._told_area(),
            "shot": self.shot.to_dict(),
            "made_with": made_with(),
        }
        return sealed(data)

    @classmethod
    def from_dict(cls, data: Any) -> Job:
        """A job from plain data. Raises ValueError naming what is wrong."""
        if not isinstance(data, dict):
            raise ValueError("is not a JSON object")
        for key, known in (("format", formats.JOB), ("synthesis", formats.SYNTHESIS)):
            formats.check_format(data, known, key)
        if data.get("format") != formats.JOB or data.get("synthesis") != formats.SYNTHESIS:
            raise ValueError(
                f"is of format {shown(data.get('format'))} and synthesis {shown(data.get('synthesis'))}; "
                f"this version bakes format {formats.JOB} and synthesis {formats.SYNTHESIS}"
            )
        check_seal(data)
        name, uid, maps = data.get("name"), data.get("uid"), data.get("maps")
        if not (isinstance(name, str) and isinstance(uid, str)):
            raise ValueError(f"has the name {shown(name)} and uid {shown(uid)}")
        if not (isinstance(maps, list) and maps and all(isinstance(m, str) and m in BAKED for m in maps)):
            raise ValueError(f"has the maps {shown(maps)}")
        compression, frames = data.get("compression"), data.get("frames")
        if not (isinstance(compression, str) and compression in COMPRESSION_ERROR):
            raise ValueError(f"has the compression {shown(compression)}")
        if not isinstance(frames, str):
            raise ValueError(f"has the frames {shown(frames)}")
        job = cls(
            name, uid, Shot.from_dict(data.get("shot")), tuple(maps), compression,
            parse_frames(frames) if frames else (), told_area(data),
        )  # fmt: skip
        if job.fingerprint != data.get("fingerprint"):
            raise ValueError("was changed: its fingerprint is not that of its contents")
        return job


def maps_for(parameters: OceanParameters, area: Area | None = None) -> tuple[str, ...]:
    """The maps that a sea can be baked to: of several patches those that add up, and their points."""
    if area is not None:
        return tuple(MAPS)
    images = tuple(name for name in MAPS if not parameters.is_cascade or ADDING.issuperset(MAPS[name]))
    return (*images, POINTS) if parameters.patches else images


def _check_maps(maps: tuple[str, ...], parameters: OceanParameters, area: Area | None) -> None:
    if area is not None:
        if POINTS in maps:
            raise ParameterError("maps", POINTS, "are those of patches, which repeat: an area has none")
        return
    check_repeats(parameters)
    if parameters.is_cascade and parameters.is_masked:
        raise ParameterError(
            "joined", parameters.joined,
            "masks lie over the sea and not over its patches, which repeat: say of how many samples the one "
            "grid shall be on which the patches are joined, such as 1024",
        )  # fmt: skip
    if POINTS in maps and not parameters.patches:
        raise ParameterError("maps", POINTS, "are of a sea of several patches, and this one has none")
    for name in maps:
        if name not in maps_for(parameters):
            raise ParameterError(
                "maps", name,
                "of several patches do not add up, and their sum does not repeat: bake "
                f"{', '.join(maps_for(parameters))}, of whose sums normals and cusps are made, or join the "
                "patches on one grid, by joined=1024",
            )  # fmt: skip


def made_with() -> dict[str, str]:
    """What may change last bits, and where it was: recorded, never compared."""
    return {"numpy": np.__version__, "machine": platform.machine(), "host": platform.node()}


def sealed(data: dict[str, Any]) -> dict[str, Any]:
    """The data with a SHA-256 of its contents, by which a changed byte is seen."""
    return {**data, _SEAL: fingerprint(data)}


def check_seal(data: dict[str, Any]) -> None:
    """Raise ValueError for data that were changed since they were sealed."""
    contents = {key: value for key, value in data.items() if key != _SEAL}
    if data.get(_SEAL) != fingerprint(contents):
        raise ValueError("was changed: its SHA-256 is not that of its contents")


def safe_name(name: str) -> str:
    """The name without what file systems or frame patterns cannot hold, at most 100 bytes."""
    # a Mac takes an accented letter apart, a farm's Linux does not: both must mean the same folder
    clean = re.sub(r"[^\w\- ]+", "_", unicodedata.normalize("NFC", name)).strip()
    return clean.encode()[:100].decode(errors="ignore").strip() or "ocean"


def uid_of(name: str) -> str:
    """The uid of a sea that has none of its own: the same on every machine."""
    return fingerprint(name)[:8]


def find_folder(cache: Path, job: Job) -> Path | None:
    """The job's folder in a cache; None where nobody has begun to bake it."""
    versions = _versions(cache / job.home)
    return next((path for path, (_, hash8) in versions if hash8 == job.hash8), None)


def open_folder(cache: Path, job: Job) -> Path:
    """The job's folder in a cache, made where it is missing.

    Raises CacheError where another job has its name, OSError for what the disk refuses.
    """
    home = cache / job.home
    home.mkdir(parents=True, exist_ok=True)
    with alone(home / ENTRY):  # else two machines might number the same job differently
        folder = find_folder(cache, job)
        if folder is None:
            number = max((number for _, (number, _) in _versions(home)), default=0) + 1
            folder = home / f"v{number:03d}-{job.hash8}"
        for part in (RECORDS, LOCKS):
            (folder / part).mkdir(parents=True, exist_ok=True)
        write_job(folder, job)
        sync_folder(home)
    return folder


def write_job(folder: Path, job: Job) -> None:
    """Write `bake.json`, or see that it is this job; one that cannot be read is replaced."""
    path = folder / JOB_FILE
    text = json.dumps(job.to_dict(), indent=1) + "\n"
    if new_file(path, text):
        return
    try:
        present = read_job(folder)
    except NewerBakeError:
        raise
    except CacheError:
        write_text(path, text)
        return
    if present.fingerprint != job.fingerprint:
        raise CacheError(f"{path} is another job, though its folder has this one's name: move it away")


def is_bake(folder: Path) -> bool:
    """Whether a folder is one of baked frames: by its name, or by the job in it."""
    if _VERSION.fullmatch(folder.name) and (folder / RECORDS).is_dir():
        return True
    try:
        read_job(folder)
    except CacheError:
        return False
    return True


def bakes_in(place: Path) -> list[Path]:
    """The folders of bakes in a cache, or in the folder that a sea has there; of a bake's folder, itself."""
    if is_bake(place):
        return [place]
    homes = [place, *sorted(path for path in place.iterdir() if path.is_dir())] if place.is_dir() else []
    return [folder for home in homes for folder, _ in _versions(home) if is_bake(folder)]


def read_job(folder: Path, asked: tuple[Frame, ...] = ()) -> Job:
    """The job of a folder, for these frames or else those asked for first.

    Raises CacheError when it is missing, damaged or of another version.
    """
    path = folder / JOB_FILE
    try:
        job = Job.from_dict(json.loads(read_bytes(path, LARGEST_JSON)))
    except OSError as error:
        raise CacheError(f"{path}: {error.strerror}; a bake's folder is named vNNN-hash8") from None
    except json.JSONDecodeError as error:
        raise CacheError(f"{path} is no JSON ({error}): run resume to have it written again") from None
    except formats.NewerFormatError as error:
        raise NewerBakeError(f"{path}: {error}") from None
    except (ValueError, RecursionError) as error:
        raise CacheError(f"{path} {error}: run resume to have it written again") from None
    return replace(job, frames=asked) if asked else job


def recovered_job(folder: Path) -> Job:
    """The job of a folder whose `bake.json` is missing or damaged, from what its images tell.

    Raises CacheError where they do not tell, or not the job that the folder's name holds.
    """
    match = _VERSION.fullmatch(folder.name)
    name, _, uid = folder.parent.name.rpartition("-")
    problem = (
        f"{folder / JOB_FILE} cannot be read, and the images do not tell the job: bake it with the same "
        "arguments as before; frames that are whole stay"
    )
    if match is None or name != safe_name(name) or not UID.fullmatch(uid):
        raise CacheError(problem)
    for path in sorted(folder.glob("*.exr"))[:_TELLING_IMAGES]:
        try:
            metadata = read_header(path)
            shot, compression = Shot.from_dict(metadata["parameters"]), str(metadata["compression"])
            area = told_area(metadata)
        except (ExrError, ValueError, KeyError):
            continue
        for maps in _all_choices(maps_for(shot.parameters, area)):
            job = Job(name, uid, shot, maps, compression, area=area)
            if job.fingerprint[:8] == match[2]:
                return job
    raise CacheError(problem)


def _all_choices(names: tuple[str, ...]) -> Iterator[tuple[str, ...]]:
    return chain.from_iterable(combinations(names, count) for count in range(1, len(names) + 1))


def _versions(home: Path) -> Iterator[tuple[Path, tuple[int, str]]]:
    if not home.is_dir():
        return
    for path in sorted(home.iterdir()):
        match = _VERSION.fullmatch(path.name)
        if match is not None and path.is_dir():
            yield path, (int(match[1]), match[2])


def log_file(folder: Path) -> Path:
    """Where what happens to a bake is written, when that is asked for: beside its folder."""
    home = folder.resolve()
    return home.with_name(f"{home.name}.log")


def refuse_links(folder: Path) -> None:
    """Raise CacheError where what is written and removed in a bake's folder would be elsewhere."""
    for part in (folder / RECORDS, folder / LOCKS):
        if is_link(part):
            raise CacheError(
                f"{part} is a link, and what it leads to is not known to be of this bake: remove it"
            )


def record_path(folder: Path, frame: Frame) -> Path:
    """Where a frame's record lies."""
    return folder / RECORDS / f"{frame_label(frame)}.json"
