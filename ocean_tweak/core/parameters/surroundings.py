# SPDX-License-Identifier: GPL-3.0-or-later
"""The square around a camera in which a shot shows waves that do not repeat."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Self

from ..data.errors import ParameterError
from ..data.frames import LARGEST_FRAME, Frame

#: of a shot's plain data
KEY = "around"
#: samples along each side, at most
_MOST_SAMPLES = 4096
#: frames of a path, at most
_MOST_CORNERS = 1_000_000
#: m, side of the square and distance of its corner at the most: fields are single precision
_LARGEST = 1e12


@dataclass(frozen=True)
class Surroundings:
    """A square that may be elsewhere in each frame.

    size : m, as of `core.sea.regions.Area`
    resolution : samples along each side
    corners : x and y in m of the first sample: of each frame, or one for all
    first_frame : that of the first corner; frames before and after the path have its ends

    Raises ParameterError for values that are no such square.

    Examples
    --------
    >>> Surroundings(400.0, 64, ((-200.0, -200.0), (-190.0, -200.0)), 10).corner(11)
    (-190.0, -200.0)
    """

    size: float
    resolution: int
    corners: tuple[tuple[float, float], ...]
    first_frame: int = 0

    def __post_init__(self) -> None:
        if not (_is_number(self.size) and 0.0 < self.size <= _LARGEST):
            raise ParameterError("size", self.size, f"must be a length above 0 and at most {_LARGEST:g} m")
        if type(self.resolution) is not int or not 2 <= self.resolution <= _MOST_SAMPLES:
            raise ParameterError("resolution", self.resolution, f"must be from 2 to {_MOST_SAMPLES} samples")
        if type(self.first_frame) is not int or abs(self.first_frame) > LARGEST_FRAME:
            raise ParameterError(
                "first_frame", self.first_frame, f"must be a whole number, at most {LARGEST_FRAME} from 0"
            )
        if not 1 <= len(self.corners) <= _MOST_CORNERS:
            raise ParameterError(
                "corners", f"{len(self.corners)} corners", f"must be from 1 to {_MOST_CORNERS}"
            )
        for index, corner in enumerate(self.corners):
            if len(corner) != 2 or not all(_is_number(end) and abs(end) <= _LARGEST for end in corner):
                reason = f"must be x and y in m, within {_LARGEST:g} m of the origin"
                raise ParameterError(f"corners.{index}", corner, reason)
        object.__setattr__(self, "size", float(self.size))
        object.__setattr__(self, "corners", tuple((float(x), float(y)) for x, y in self.corners))

    def corner(self, frame: Frame) -> tuple[float, float]:
        """x and y in m of the first sample in a frame."""
        index = math.floor(frame) - self.first_frame
        return self.corners[min(max(index, 0), len(self.corners) - 1)]

    def in_frame(self, frame: Frame) -> Surroundings:
        """As they are in one frame, for all."""
        return Surroundings(self.size, self.resolution, (self.corner(frame),))

    def to_dict(self) -> dict[str, Any]:
        """Plain data, as in a JSON file."""
        return {
            "size": self.size,
            "resolution": self.resolution,
            "first_frame": self.first_frame,
            "corners": [list(corner) for corner in self.corners],
        }

    @classmethod
    def from_dict(cls, data: object) -> Self:
        """From plain data. Raises ParameterError naming what is wrong."""
        names = {"size", "resolution", "corners"}
        if not isinstance(data, dict) or not names <= set(data) <= {*names, "first_frame"}:
            reason = "must be an object with size, resolution and corners, and first_frame if they change"
            raise ParameterError(KEY, data, reason)
        corners = data["corners"]
        if not isinstance(corners, list) or not all(isinstance(corner, list) for corner in corners):
            raise ParameterError(f"{KEY}.corners", corners, "must be a list of [x, y]")
        try:
            places = tuple(map(tuple, corners))
            return cls(data["size"], data["resolution"], places, data.get("first_frame", 0))
        except ParameterError as error:
            raise error.inside(KEY) from None


def _is_number(value: object) -> bool:
    """Whether a value is a finite number."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return False
    try:
        return math.isfinite(value)
    except OverflowError:  # an integer beyond the range of floats
        return False
