# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the fields of a sea are wanted."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Tile:
    """The (N, N) samples [y, x] of a sea's own domain, which repeats."""


@dataclass(frozen=True)
class Area:
    """(N, N) samples [y, x] over any square, which does not repeat: its far sides do not fit its near ones.

    size : of the square, m
    resolution : samples along each side
    corner : x and y of the first sample, m

    Raises ValueError for a square without size or samples.
    """

    size: float
    resolution: int
    corner: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        if not (math.isfinite(self.size) and self.size > 0.0):
            raise ValueError(f"size = {self.size!r}: must be a length above 0 m")
        if self.resolution < 1:
            raise ValueError(f"resolution = {self.resolution!r}: must be 1 or more samples")

    def rest_positions(self) -> tuple[Array, Array]:
        """x and y in m, (N, N) each."""
        along = self.size / self.resolution * np.arange(self.resolution)
        return _checked(self.corner[0] + along, (self.corner[1] + along)[:, np.newaxis])


@dataclass(frozen=True, eq=False)
class Places:
    """Rest positions x and y in m, of shapes that broadcast: fields have their shape.

    Raises ValueError where they are asked for and not finite.
    """

    x: ArrayLike
    y: ArrayLike

    def rest_positions(self) -> tuple[Array, Array]:
        """x and y in m, of one shape."""
        return _checked(self.x, self.y)


def _checked(x: ArrayLike, y: ArrayLike) -> tuple[Array, Array]:
    places_x, places_y = np.broadcast_arrays(np.asarray(x, np.float64), np.asarray(y, np.float64))
    if not (np.all(np.isfinite(places_x)) and np.all(np.isfinite(places_y))):
        raise ValueError("x and y: must be finite places in m")
    return places_x, places_y
