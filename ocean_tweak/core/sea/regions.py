# SPDX-License-Identifier: GPL-3.0-or-later
"""The regions on which fields of a sea can be computed."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..data.printable import shown, without_exponent

Array = NDArray[np.float64]

#: largest number of samples along a side of an area in a file, as for a sea
MOST_SAMPLES = 8192
#: m, side of an area and distance of its corner at the most: fields are single precision
_LARGEST = 1e12


@dataclass(frozen=True)
class Tile:
    """The (N, N) samples [y, x] of a sea's own periodic domain.

    Examples
    --------
    >>> from ocean_tweak.core import Ocean, OceanParameters
    >>> Ocean(OceanParameters(resolution=64)).surface(0.0, on=Tile()).displacement.shape
    (64, 64, 3)
    """


TILE = Tile()


@dataclass(frozen=True)
class Area:
    """(N, N) samples [y, x] of any square, which is not periodic.

    size : of the square, m
    resolution : samples along each side
    corner : x and y of the first sample, m

    Raises ValueError for a size or resolution of 0 or less, and for one that is too far away.

    Examples
    --------
    >>> x, y = Area(size=40.0, resolution=4, corner=(100.0, 0.0)).rest_positions()
    >>> x[0]
    array([100., 110., 120., 130.])
    """

    size: float
    resolution: int
    corner: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        object.__setattr__(self, "size", float(self.size))
        object.__setattr__(self, "corner", tuple(map(float, self.corner)))
        if not (math.isfinite(self.size) and self.size > 0.0):
            raise ValueError(f"size = {self.size!r}: must be a length above 0 m")
        if self.resolution < 1:
            raise ValueError(f"resolution = {self.resolution!r}: must be 1 or more samples")
        if len(self.corner) != 2 or not all(map(math.isfinite, self.corner)):
            raise ValueError(f"corner = {self.corner!r}: must be x and y in m")
        if self.size > _LARGEST or not all(abs(place) <= _LARGEST for place in self.corner):
            raise ValueError(
                f"size = {self.size!r}, corner = {self.corner!r}: must be within {_LARGEST:g} m of the origin"
            )

    def rest_positions(self) -> tuple[Array, Array]:
        """x and y in m, (N, N) each.

        Examples
        --------
        >>> Area(size=2.0, resolution=2).rest_positions()[1].tolist()
        [[0.0, 0.0], [1.0, 1.0]]
        """
        along = self.size / self.resolution * np.arange(self.resolution)
        return _checked(self.corner[0] + along, (self.corner[1] + along)[:, np.newaxis])

    @classmethod
    def of_file(cls, size: float, resolution: int, corner: Sequence[float] = (0.0, 0.0)) -> Area:
        """An area from plain data, as written by `to_dict`. Raises ValueError for invalid data."""
        x, y = corner
        if not (type(resolution) is int and 2 <= resolution <= MOST_SAMPLES):
            raise ValueError(f"resolution = {resolution!r}: must be from 2 to {MOST_SAMPLES} samples")
        return cls(size, resolution, (x, y))

    @classmethod
    def of_words(cls, words: Sequence[str]) -> Area:
        """An area from its form on the command line. Raises ValueError."""
        if len(words) not in (2, 4):
            raise ValueError(f"{' '.join(words)!r} must be SIZE SAMPLES, or SIZE SAMPLES X Y")
        return cls.of_file(float(words[0]), int(words[1]), [float(word) for word in words[2:]] or (0.0, 0.0))

    def words(self) -> tuple[str, ...]:
        """The form for the command line, SIZE SAMPLES X Y, without exponents."""
        size, *corner = map(without_exponent, (self.size, *self.corner))
        return (size, str(self.resolution), *corner)

    def to_dict(self) -> dict[str, Any]:
        """Plain data, as in jobs and headers."""
        return {**asdict(self), "corner": list(self.corner)}


def told_area(data: Mapping[str, Any]) -> Area | None:
    """The area in a job or an image's header, or None. Raises ValueError for invalid data."""
    if "area" not in data:
        return None
    try:
        return Area.of_file(**data["area"])
    except (TypeError, ValueError) as error:
        raise ValueError(f"has the area {shown(data['area'])}: {error}") from None


@dataclass(frozen=True, eq=False)
class Places:
    """Rest positions x and y in m, of shapes that broadcast: fields have their shape.

    Fields of places that are not finite raise ValueError.

    Examples
    --------
    >>> Places([0.0, 1.0, 2.0], 5.0).rest_positions()[1]
    array([5., 5., 5.])
    """

    x: ArrayLike
    y: ArrayLike

    def rest_positions(self) -> tuple[Array, Array]:
        """x and y in m, of one shape.

        Examples
        --------
        >>> Places(3.0, [0.0, 1.0]).rest_positions()[0]
        array([3., 3.])
        """
        return _checked(self.x, self.y)


def _checked(x: ArrayLike, y: ArrayLike) -> tuple[Array, Array]:
    places_x, places_y = np.broadcast_arrays(np.asarray(x, np.float64), np.asarray(y, np.float64))
    if not (np.all(np.isfinite(places_x)) and np.all(np.isfinite(places_y))):
        raise ValueError("x and y: must be finite places in m")
    return places_x, places_y
