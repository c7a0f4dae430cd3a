# SPDX-License-Identifier: GPL-3.0-or-later
"""The description of an export: a sea, its frames and its layout."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from pathlib import Path
from typing import Any

from ...core import ParameterError
from ...core.data import formats
from ...core.data.frames import Frame, as_frame, format_frames, frame_label, parse_frames
from ...core.foam.threshold import has_windrows
from ...core.parameters.fingerprint import fingerprint, hashed, shot_fingerprint
from ...core.parameters.shot import Shot
from ...core.sea.placed_waves import check_repeats
from ...core.sea.regions import MOST_SAMPLES, TILE, Area, Tile
from ...core.synthesis.channels import OF_MEMORY
from .attributes import ATTRIBUTES, outputs_of

FORMS = ("points", "clips", "displacement")
UP_AXES = ("Z", "Y")
#: names of the layers beside the asset's own
LAYER_NAMES = ("payload", "geo", "mtl", "topology", "manifest", "spray")
#: limits of the resolutions of variants, of tiles along a side, and of metres per unit
MOST_VARIANTS, MOST_TILES, UNITS = 16, 64, (1e-6, 1e6)
_NAME = re.compile(r"[\w\- ]+(\.[\w\- ]+)*")


@dataclass(frozen=True)
class Package:
    """What is exported.

    name : of the asset and of its files
    frames : ascending; subframes are samples for motion blur
    up_axis : Z as in Blender, or Y, for which all vectors are rotated
    metres_per_unit : of the layers; 0.01 gives centimetres
    attributes : keys of ATTRIBUTES
    half : foam, cusp, breaking and foam_age in 16 bits instead of 32
    tiles : number of copies along x and y, as instances
    proxy : largest number of quads along a side of the coarse mesh for viewports; 0 for none
    variants : resolutions to choose from, by default the first; none for the sea's own only
    area : the square covered by the mesh, with as many quads along each side as it has samples; None for the
        sea's tile
    foam : version of the foam in its attributes; ignored without such attributes
    windrows : version of those in that foam; ignored without them

    Raises ParameterError for settings that do not fit together.
    """

    name: str
    shot: Shot
    frames: tuple[Frame, ...]
    form: str = "points"
    up_axis: str = "Z"
    metres_per_unit: float = 1.0
    attributes: tuple[str, ...] = tuple(ATTRIBUTES)
    half: bool = False
    tiles: tuple[int, int] = (1, 1)
    proxy: int = 64
    variants: tuple[int, ...] = ()
    area: Area | None = None
    foam: int = field(default=formats.FOAM, kw_only=True)
    windrows: int = field(default=formats.WINDROWS, kw_only=True)

    def __post_init__(self) -> None:
        _check_choice("form", self.form, FORMS)
        _check_choice("up_axis", self.up_axis, UP_AXES)
        for name in self.attributes:
            _check_choice("attributes", name, tuple(ATTRIBUTES))
        low, high = UNITS
        if not (math.isfinite(self.metres_per_unit) and low <= self.metres_per_unit <= high):
            raise ParameterError("metres_per_unit", self.metres_per_unit, f"must be from {low:g} to {high:g}")
        if not all(1 <= count <= MOST_TILES for count in self.tiles):
            raise ParameterError("tiles", self.tiles, f"must be from 1 to {MOST_TILES} along each side")
        if self.proxy < 0:
            raise ParameterError("proxy", self.proxy, "must be 0 or more")
        _check_list("attributes", self.attributes, len(ATTRIBUTES))
        _check_list("variants", self.variants, MOST_VARIANTS)
        if not self.frames:
            raise ParameterError("frames", "", "must hold at least one frame")
        _check_name(self.name)
        parameters = self.shot.parameters
        if self.area is not None:
            self._check_area()
        else:
            check_repeats(parameters)
        if parameters.is_cascade and self.area is None:  # layers have one grid
            merged = parameters.on_one_grid(parameters.resolution)
            object.__setattr__(self, "shot", replace(self.shot, parameters=merged))
        self.shot.check(self.frames)
        for resolution in self.resolutions:
            self.at(resolution)

    @property
    def resolutions(self) -> tuple[int, ...]:
        """Resolutions of the editions, the default one first."""
        return self.variants or ((self.area or self.shot.parameters).resolution,)

    def at(self, resolution: int) -> Shot:
        """The sea of an edition: a tile with this many samples, and the waves that they resolve."""
        if self.area is not None:
            return self.shot
        return replace(self.shot, parameters=self.shot.parameters.at_resolution(resolution))

    def on(self, resolution: int) -> Tile | Area:
        """The region of an edition's samples: in an area, one per vertex, the last ones on its far sides."""
        if self.area is None:
            return TILE
        size = self.area.size * (resolution + 1) / resolution
        return Area(size, resolution + 1, self.area.corner)

    def _check_area(self) -> None:
        """Raise ParameterError for settings that an area does not support."""
        if self.tiles != (1, 1):
            raise ParameterError("tiles", self.tiles, "must be 1x1 of an area: it does not repeat")
        for resolution in self.resolutions:
            if not 1 <= resolution < MOST_SAMPLES:
                reason = f"must be from 1 to {MOST_SAMPLES - 1} quads along a side of an area"
                raise ParameterError("variants" if self.variants else "area", resolution, reason)

    @property
    def image_area(self) -> Area | None:
        """The area of an image that covers the mesh; None for the sea's tile."""
        on = TILE if self.area is None else self.on(self.area.resolution)
        return on if isinstance(on, Area) else None

    @property
    def texels(self) -> int:
        """Texels along each side of such an image."""
        return (self.image_area or self.shot.parameters).resolution

    @property
    def size(self) -> float:
        """Size of the mesh at rest, m."""
        return self.shot.parameters.domain_size if self.area is None else self.area.size

    @property
    def corner(self) -> tuple[float, float] | None:
        """Position of its first vertex at rest, m; None for a tile, where it is (0, 0)."""
        return None if self.area is None else self.area.corner

    @property
    def frames_per_second(self) -> float:
        """Of the shot, and of every layer."""
        return float(self.shot.parameters.timing.fps)

    @property
    def scale(self) -> float:
        """Layer units per metre."""
        return 1.0 / self.metres_per_unit

    @cached_property
    def fingerprint(self) -> str:
        """Fingerprint of the shot."""
        return shot_fingerprint(self.shot)

    def edition_fingerprint(self, resolution: int) -> str:
        """SHA-256 of everything that an edition's animated arrays depend on, except the choice of frames."""
        return fingerprint(
            {
                "format": formats.LAYER,
                "synthesis": formats.SYNTHESIS,
                "shot": hashed(self.at(resolution)),
                "up_axis": self.up_axis,
                "metres_per_unit": self.metres_per_unit,
                "attributes": list(self.attributes),
                "half": self.half,
                "proxy": self.proxy,
                **self._told_area(),
                **self._told_foam(),
            }
        )

    def _told_foam(self) -> dict[str, int]:
        return {
            **formats.told_foam(self.foam, bool(outputs_of(self.attributes) & OF_MEMORY)),
            **formats.told_windrows(self.windrows, self._has_windrows),
        }

    @property
    def foam_is_made_now(self) -> bool:
        """Whether its foam is of the versions that this program makes."""
        return self.foam == formats.FOAM and (self.windrows == formats.WINDROWS or not self._has_windrows)

    @cached_property
    def _has_windrows(self) -> bool:
        """Whether its attributes have foam that the wind may draw out, in any frame."""
        return bool(outputs_of(self.attributes) & OF_MEMORY) and has_windrows(self.shot)

    def _told_area(self) -> dict[str, str]:
        return {} if self.area is None else {"area": " ".join(self.area.words())}

    def record(self) -> dict[str, Any]:
        """The asset's customData: strings and plain numbers."""
        return {
            "format": formats.LAYER,
            "name": self.name,
            "form": self.form,
            "fingerprint": self.fingerprint,
            "shot": self.shot.to_json(indent=None),
            "frames": format_frames(self.frames),
            "upAxis": self.up_axis,
            "metersPerUnit": self.metres_per_unit,
            "attributes": ",".join(self.attributes),
            "half": self.half,
            "tiles": f"{self.tiles[0]}x{self.tiles[1]}",
            "proxy": self.proxy,
            "variants": ",".join(map(str, self.variants)),
            **self._told_area(),
            **self._told_foam(),
        }

    @classmethod
    def from_record(cls, data: dict[str, Any]) -> Package:
        """The package described by a `record`. Raises ValueError or KeyError for invalid data."""
        formats.check_format(data, formats.LAYER)
        formats.check_format(data, formats.FOAM, "foam")
        formats.check_format(data, formats.WINDROWS, "windrows")
        across, along = str(data["tiles"]).split("x")
        package = cls(
            data["name"],
            Shot.from_json(data["shot"]),
            parse_frames(data["frames"]),
            form=data["form"],
            up_axis=data["upAxis"],
            metres_per_unit=float(data["metersPerUnit"]),
            attributes=_listed(data["attributes"]),
            half=bool(data["half"]),
            tiles=(int(across), int(along)),
            proxy=int(data["proxy"]),
            variants=tuple(map(int, _listed(data["variants"]))),
            area=Area.of_words(data["area"].split()) if "area" in data else None,
            foam=data.get("foam", 1),
            windrows=data.get("windrows", 1),
        )
        if package.fingerprint != data["fingerprint"]:
            raise ValueError("was changed: its fingerprint does not match its parameters")
        return package


def with_samples_between(frames: Iterable[Frame], samples: int) -> tuple[Frame, ...]:
    """Frames with a number of samples from each one to the next; 1 returns them unchanged.

    Raises ParameterError for a number whose fractions need more than six decimals.
    """
    frames = tuple(frames)
    if samples < 1:
        raise ParameterError("subframes", samples, "must be 1 or more")
    step = Fraction(1, samples)
    if (step * 10**6).denominator != 1:
        raise ParameterError(
            "subframes", samples, "must divide a frame into finite decimals, such as 2, 4, 5, 8 or 10"
        )
    between = {frame + part * step for frame in frames for part in range(samples) if frame + 1 in frames}
    return tuple(sorted(as_frame(frame) for frame in {*frames, *between}))


def asset_name(file: Path) -> str:
    """An asset's name from that of its file: sea.v001 for sea.v001.usd. Characters not allowed in names
    become _."""
    return ".".join(re.sub(r"[^\w\- ]+", "_", part) or "_" for part in file.stem.split("."))


def clip_name(name: str, frame: Frame) -> str:
    """Path of a clip relative to its geo.usd."""
    return f"clips/{name}.{frame_label(frame)}.usdc"


def edition_folder(top: Path, package: Package, resolution: int) -> Path:
    """Folder of a resolution's layers: that of the asset, or one of its own if there are several."""
    return top.parent / str(resolution) if package.variants else top.parent


def _listed(text: str) -> tuple[str, ...]:
    return tuple(text.split(",")) if text else ()


def _check_choice(field: str, value: object, known: tuple[str, ...]) -> None:
    if value not in known:
        raise ParameterError(field, value, f"must be one of {', '.join(known)}")


def _check_list(field: str, values: tuple[object, ...], most: int) -> None:
    if len(values) > most:
        raise ParameterError(field, values, f"must be at most {most}")
    if len(set(values)) < len(values):
        raise ParameterError(field, values, "must differ from each other")


def _check_name(name: str) -> None:
    if name in LAYER_NAMES:
        raise ParameterError(
            "name", name, f"is the name of a layer beside it; {', '.join(LAYER_NAMES)} are taken"
        )
    if not _NAME.fullmatch(name):
        raise ParameterError(
            "name", name, "must be made of letters, digits, spaces, - and _, with single dots between them"
        )
