# SPDX-License-Identifier: GPL-3.0-or-later
"""The job of a bake, as stored in `bake.json`; its fingerprint identifies the bake."""

from __future__ import annotations

import platform
import re
import unicodedata
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from ...core.data import formats
from ...core.data.errors import ParameterError
from ...core.data.frames import Frame, format_frames, parse_frames
from ...core.data.printable import shown
from ...core.foam.threshold import has_windrows
from ...core.parameters.fingerprint import fingerprint, frame_fingerprint, hashed
from ...core.parameters.ocean_parameters import OceanParameters
from ...core.parameters.patch_seas import AROUND, OVER_BED, PARTS, open_sea, parts
from ...core.parameters.shot import Shot
from ...core.sea.memory import ground_of
from ...core.sea.placed_waves import check_repeats, placed_waves, without_placed
from ...core.sea.regions import TILE, Area, Tile, told_area
from ...core.synthesis.channels import ADDING, MAPS, MOVING_MAP, OF_MEMORY, SurfaceFields, channels_of
from ...core.waves.coast.mesh import coast_mesh
from ..coast_points import CoastSequence
from ..exr import COMPACT, COMPRESSION_ERROR, ExrSequence, halved_maps
from ..frame_files import BAKED, COAST, POINTS, WAKES, frame_file
from ..points import PointSequence
from ..wake_points import WakeSequence

_SEAL = "sha256"

UID = re.compile("[0-9A-Za-z]{1,32}")


class CacheError(RuntimeError):
    """A folder of baked frames that cannot be used, with its path, the reason and the remedy."""


class NewerBakeError(CacheError):
    """A bake of a newer version of the program, which must not be changed."""


@dataclass(frozen=True)
class Job:
    """What is baked.

    name : of the sea, and of its files
    uid : distinguishes seas of the same name; letters and digits
    maps : some of BAKED, in any order
    compression : a key of COMPRESSION_ERROR
    frames : the requested frames
    area : the square that is baked; None for the sea's own tile, or those of its patches
    foam : version of the foam in its maps; ignored without such maps
    windrows : version of those in that foam; ignored without them
    encoding : version of the encoding of its maps; ignored if all have 32 bits

    Raises ParameterError for names that would lead to files elsewhere, and for maps that the sea does not
    have.
    """

    name: str
    uid: str
    shot: Shot
    maps: tuple[str, ...] = (MOVING_MAP,)
    compression: str = COMPACT
    frames: tuple[Frame, ...] = field(default=(), compare=False)
    area: Area | None = None
    foam: int = field(default=formats.FOAM, kw_only=True)
    windrows: int = field(default=formats.WINDROWS, kw_only=True)
    encoding: int = field(default=formats.ENCODING, kw_only=True)

    def __post_init__(self) -> None:
        object.__setattr__(self, "maps", tuple(name for name in BAKED if name in self.maps))
        if self.name != safe_name(self.name):
            raise ParameterError("name", self.name, "holds characters that file names cannot hold")
        if not UID.fullmatch(self.uid):
            raise ParameterError("uid", self.uid, "must be 1 to 32 letters and digits")
        # it does not affect the images: see `export.spray`
        object.__setattr__(self, "shot", self.shot.without_spray)
        _check_maps(self.maps, self.shot, self.area)
        if WAKES not in self.maps and self.shot.around is not None:
            object.__setattr__(self, "shot", replace(self.shot, around=None))
        if not self.outputs & OF_MEMORY:
            object.__setattr__(self, "foam", formats.FOAM)
        if not self._has_windrows:
            object.__setattr__(self, "windrows", formats.WINDROWS)
        if not halved_maps(self.maps, self.compression):
            object.__setattr__(self, "encoding", formats.ENCODING)

    @cached_property
    def fingerprint(self) -> str:
        """SHA-256 of everything that the files depend on, except the choice of frames."""
        return fingerprint(
            {
                "format": formats.JOB,
                "synthesis": formats.SYNTHESIS,
                "shot": hashed(self.shot),
                "maps": list(self.maps),
                "compression": self.compression,
                **self._told_area(),
                **({} if self.shot.around is None else {"around": self.shot.around.to_dict()}),
                **self._told_foam(),
                **self._told_encoding(),
            }
        )

    def frame_fingerprint(self, frame: Frame) -> str:
        """SHA-256 of everything that a frame depends on."""
        around = self.shot.around
        square = None if around is None else around.in_frame(frame).to_dict()
        return frame_fingerprint(self.shot, frame, **self._told_area(), around=square)

    def check_foam(self) -> None:
        """Raise CacheError if its frames have foam of an earlier version, which can no longer be computed."""
        for name, own, made in (
            ("foam", self.foam, formats.FOAM), ("windrows", self.windrows, formats.WINDROWS),
        ):  # fmt: skip
            if own != made:
                raise CacheError(
                    f"{self.home} was baked with {name} of version {own}, which this program shows but no "
                    f"longer makes (it makes version {made}): bake the sea again; the old bake is kept"
                )

    def _told_foam(self) -> dict[str, int]:
        return {
            **formats.told_foam(self.foam, bool(self.outputs & OF_MEMORY)),
            **formats.told_windrows(self.windrows, self._has_windrows),
        }

    @cached_property
    def _has_windrows(self) -> bool:
        """Whether its maps have foam that the wind may draw out, in any frame."""
        return bool(self.outputs & OF_MEMORY) and has_windrows(self.shot)

    def _told_encoding(self) -> dict[str, int]:
        return formats.told_encoding(self.encoding, bool(halved_maps(self.maps, self.compression)))

    def _told_area(self) -> dict[str, Any]:
        return {} if self.area is None else {"area": self.area.to_dict()}

    @property
    def on(self) -> Tile | Area:
        """The region on which the fields of a frame are computed."""
        return self.area or TILE

    @property
    def resolution(self) -> int:
        """Texels along each side of an image, for several patches those of the first."""
        return self.shot.parameters.resolution if self.area is None else self.area.resolution

    @property
    def home(self) -> str:
        """The folder of all versions of this sea, in a cache."""
        return f"{self.name}-{self.uid}"

    @property
    def hash8(self) -> str:
        """The part of its folder's name that identifies the version."""
        return self.fingerprint[:8]

    @property
    def outputs(self) -> frozenset[str]:
        """The outputs needed for its maps; PARTS for points, OVER_BED for a coast, AROUND for wakes."""
        markers = (POINTS, PARTS), (COAST, OVER_BED), (WAKES, AROUND)
        own = {marker for name, marker in markers if name in self.maps}
        return frozenset(own) | channels_of(self.images)

    @property
    def images(self) -> tuple[str, ...]:
        """Its maps that are images."""
        return tuple(name for name in self.maps if name in MAPS)

    def sequences(self, folder: Path, frame: Frame) -> tuple[ExrSequence, ...]:
        """The image writers for a frame, one per patch, or one for an area."""
        parameters = self.shot.at(frame).parameters
        is_one = self.area is not None or not parameters.is_cascade
        patches: Iterable[int | None] = (None,) if is_one else range(len(parameters.patches))
        return tuple(
            ExrSequence(
                folder, self.name, parameters, self.compression, self.images, patch, self.area, self.encoding
            )
            for patch in patches
        )

    def points(self, folder: Path, frame: Frame) -> tuple[PointSequence, ...]:
        """The writers for a frame's points, one per part; none if points are not baked."""
        if POINTS not in self.maps:
            return ()
        of_sea = parts(self.shot.at(frame).parameters)
        return tuple(PointSequence(folder, self.name, number, part) for number, part in enumerate(of_sea, 1))

    def coast(self, folder: Path, frame: Frame) -> CoastSequence | None:
        """The writer for what is over a frame's bed; None if that is not baked."""
        if COAST not in self.maps:
            return None
        sea = self.shot.at(frame).parameters
        return CoastSequence(folder, self.name, coast_mesh(ground_of(sea), sea.domain_size, sea.resolution))

    def wakes(self, folder: Path) -> WakeSequence | None:
        """The writer for waves that do not repeat; None if they are not baked."""
        around = self.shot.around
        return None if WAKES not in self.maps or around is None else WakeSequence(folder, self.name, around)

    def sequence(self, folder: Path, frame: Frame) -> ExrSequence:
        """The image writer for a frame of one patch or of an area. Raises CacheError for several patches."""
        sequence, *others = self.sequences(folder, frame)
        if others:
            raise CacheError(f"{folder} holds the images of several patches, not of one")
        return sequence

    def files(self, folder: Path, frame: Frame) -> list[tuple[str, str]]:
        """Map and file name of each of a frame's files."""
        sequences = self.sequences(folder, frame)
        images = [(name, sequence.path(frame, name).name) for sequence in sequences for name in self.images]
        points = [path.name for sequence in self.points(folder, frame) for path in sequence.paths(frame)]
        coast = [] if COAST not in self.maps else [(COAST, frame_file(self.name, COAST, frame))]
        wakes = [] if WAKES not in self.maps else [(WAKES, frame_file(self.name, WAKES, frame))]
        return [*images, *((POINTS, name) for name in points), *coast, *wakes]

    def write(self, folder: Path, frame: Frame, fields: Sequence[SurfaceFields]) -> Iterator[Path]:
        """Write a frame's files in the order of `files`. Yields each path once it is complete.

        fields : computed by `core.sea.bake.ShotSeas` for `outputs`
        """
        sequences = self.sequences(folder, frame)
        for sequence, own in zip(sequences, fields, strict=False):
            for name in self.images:
                yield sequence.write_map(frame, own, name)
        points, others = self.points(folder, frame), (self.coast(folder, frame), self.wakes(folder))
        of_others = fields[len(sequences) + len(points) :]
        for of_part, own in zip(points, fields[len(sequences) :], strict=False):
            yield from of_part.write(frame, own)
        for other, own in zip((each for each in others if each is not None), of_others, strict=True):
            yield other.write(frame, own)

    def to_dict(self) -> dict[str, Any]:
        """Plain data, as in `bake.json`."""
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
            **self._told_foam(),
            **self._told_encoding(),
            "shot": {"format": formats.SEA, **self.shot.to_dict()},
            "made_with": made_with(),
        }
        return sealed(data)

    @classmethod
    def from_dict(cls, data: Any) -> Job:
        """A job from plain data. Raises ValueError with the invalid part."""
        if not isinstance(data, dict):
            raise ValueError("is not a JSON object")
        versions = {
            "format": formats.JOB, "synthesis": formats.SYNTHESIS, "foam": formats.FOAM,
            "windrows": formats.WINDROWS, "encoding": formats.ENCODING,
        }  # fmt: skip
        for key, known in versions.items():
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
            parse_frames(frames) if frames else (), told_area(data), foam=data.get("foam", 1),
            windrows=data.get("windrows", 1), encoding=data.get("encoding", 1),
        )  # fmt: skip
        if job.fingerprint != data.get("fingerprint"):
            raise ValueError("was changed: its fingerprint does not match its contents")
        return job


def maps_for(parameters: OceanParameters, area: Area | None = None) -> tuple[str, ...]:
    """The maps that can be baked from a sea: for several patches those that add up, and their points."""
    if area is not None:
        return tuple(MAPS)
    images = tuple(name for name in MAPS if not parameters.is_cascade or ADDING.issuperset(MAPS[name]))
    points = (POINTS,) if parameters.patches else ()
    coast = (COAST,) if parameters.has_coast else ()
    return (*images, *points, *coast, *((WAKES,) if placed_waves(parameters) else ()))


_NOT_IN_AREAS = {
    POINTS: "belong to patches, which repeat: an area has none",
    COAST: "is the mesh over the bed: an area shows the bed by itself",
    WAKES: "are beside a tile: an area shows them by itself",
}


def _check_maps(maps: tuple[str, ...], shot: Shot, area: Area | None) -> None:
    parameters = shot.parameters
    if area is not None:
        for name, why in _NOT_IN_AREAS.items():
            if name in maps:
                raise ParameterError("maps", name, why)
        return
    if COAST in maps and not parameters.has_coast:
        raise ParameterError("maps", COAST, "needs a sea with a coast, and this one has none")
    if WAKES in maps:
        _check_wakes(shot)
    bare = open_sea(parameters) if COAST in maps else parameters
    check_repeats(without_placed(bare) if WAKES in maps else bare)
    if parameters.is_cascade and parameters.is_masked:
        raise ParameterError(
            "merged_resolution", parameters.merged_resolution,
            "masks lie over the sea, not over its patches, which repeat: give the samples of one "
            "grid to merge the patches on, such as 1024",
        )  # fmt: skip
    if POINTS in maps and not parameters.patches:
        raise ParameterError("maps", POINTS, "need a sea of several patches, and this one has none")
    for name in maps:
        if name not in maps_for(parameters):
            raise ParameterError(
                "maps", name,
                "of several patches do not add up, and their sum does not repeat: bake "
                f"{', '.join(maps_for(parameters))}, from whose sums normals and cusps are made, "
                "or merge the patches on one grid with merged_resolution=1024",
            )  # fmt: skip


def _check_wakes(shot: Shot) -> None:
    if not placed_waves(shot.parameters):
        raise ParameterError("maps", WAKES, "needs a sea with wakes, and this one has none")
    if shot.parameters.has_coast:
        raise ParameterError("maps", WAKES, "are of the open sea: over a bed bake an area")
    if shot.around is None:
        raise ParameterError(
            "maps", WAKES,
            "needs the place where they are seen: give the file "
            '"around": {"size": 512, "resolution": 512, "corners": [[-256, -256]]}',
        )  # fmt: skip


def made_with() -> dict[str, str]:
    """What may affect the last bits, and the host: recorded, never compared."""
    return {"numpy": np.__version__, "machine": platform.machine(), "host": platform.node()}


def sealed(data: dict[str, Any]) -> dict[str, Any]:
    """The data with a SHA-256 of its contents, to detect changes."""
    return {**data, _SEAL: fingerprint(data)}


def check_seal(data: dict[str, Any]) -> None:
    """Raise ValueError if data were changed after they were sealed."""
    contents = {key: value for key, value in data.items() if key != _SEAL}
    if data.get(_SEAL) != fingerprint(contents):
        raise ValueError("was changed: its SHA-256 does not match its contents")


def safe_name(name: str) -> str:
    """The name without characters that file systems or frame patterns do not allow, at most 100 bytes."""
    # macOS decomposes accented letters and Linux does not: both must use the same folder
    clean = re.sub(r"[^\w\- ]+", "_", unicodedata.normalize("NFC", name)).strip()
    return clean.encode()[:100].decode(errors="ignore").strip() or "ocean"


def uid_of(name: str) -> str:
    """The uid of a sea without one of its own, the same on every machine."""
    return fingerprint(name)[:8]
