# SPDX-License-Identifier: GPL-3.0-or-later
"""Masks, and their weights: from 0 to 1 over the sea, by which displacement and velocity are multiplied.

A weight belongs to the water at rest, lies over the domain and repeats with it. It is continuous and has
continuous derivatives, which the slopes and strains of a masked sea need: ∂(w d) = w ∂d + d ∂w.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .data.errors import ParameterError
from .data.raster import Raster
from .data.validation import Validated, choice, number, raster, switch
from .numerics.interpolation import spline_slopes, spline_weights
from .numerics.memo import remembered

Array = NDArray[np.float64]

#: rows of a square of weights that are made at once
_ROWS = 128


MASK_SOURCES = ("IMAGE", "DISTANCE")
#: lines of a mask, each as much work as a mask's place, and how many domains each may be long
MOST_LINES, MOST_DOMAINS = 500, 4.0


@dataclass(frozen=True)
class Mask(Validated):
    """Where the waves of a layer, a patch or a whole sea are: fully at weight 1, not at all at 0.

    Examples
    --------
    >>> Mask(x=200.0, y=200.0, inner_radius=30.0, outer_radius=80.0).source
    'DISTANCE'
    """

    source: str = choice("DISTANCE", MASK_SOURCES, "What gives the weight: an image, or a distance")
    image: Raster | None = raster("Weights from 0 to 1, stretched over the domain", channels=1)
    x: float = number(
        0.0, -1e6, 1e6, "m", "Distance: the place from which it is measured", "far outside of any domain"
    )
    y: float = number(
        0.0, -1e6, 1e6, "m", "Distance: the place from which it is measured", "far outside of any domain"
    )
    lines: Raster | None = raster(
        "Distance: straight lines from which it is measured, not from a place: x and y of one end, x and y "
        "of the other, m", channels=4, left_out=True,
    )  # fmt: skip
    inner_radius: float = number(50.0, 0.0, 1e6, "m", "Distance up to which the weight is 0", "any domain")
    outer_radius: float = number(
        150.0, 1e-3, 1e6, "m", "Distance from which on the weight is 1", "any domain"
    )
    inverted: bool = switch(False, "Exchange 0 and 1: waves near the place, or where the image is dark")
    strength: float = number(
        1.0, 0.0, 1.0, "", "How much of the waves it takes where the weight is 0: all of them, or a share",
        "a share", left_out=True,
    )  # fmt: skip

    def __post_init__(self) -> None:
        if isinstance(self.image, Raster):
            object.__setattr__(self, "image", self.image.grey())
        super().__post_init__()
        if self.lines is not None and self.lines.shape[0] * self.lines.shape[1] > MOST_LINES:
            count = self.lines.shape[0] * self.lines.shape[1]
            raise ParameterError("lines", f"{count} lines", f"must be at most {MOST_LINES}")
        if self.source == "IMAGE" and self.image is None:
            raise ParameterError("image", None, "give an image, whose brightness is the weight")
        if self.source == "DISTANCE" and self.inner_radius >= self.outer_radius:
            raise ParameterError(
                "inner_radius", self.inner_radius, f"must be below outer_radius = {self.outer_radius:g} m"
            )


class Weights(NamedTuple):
    """Of places: w, and its derivatives by x and y in 1/m; one shape."""

    value: Array
    by_x: Array
    by_y: Array

    @property
    def nbytes(self) -> int:
        """Bytes of all three."""
        return self.value.nbytes + self.by_x.nbytes + self.by_y.nbytes


def weights(masks: Sequence[Mask], domain_size: float, x: Array, y: Array) -> Weights:
    """The product of some masks at rest positions x and y in m, of shapes that broadcast."""
    shape = np.broadcast_shapes(x.shape, y.shape)
    total = Weights(np.ones(shape), np.zeros(shape), np.zeros(shape))
    for mask in masks:
        own = _SOURCES[mask.source](mask, domain_size, x, y)
        if mask.inverted:
            own = Weights(1.0 - own.value, -own.by_x, -own.by_y)
        if mask.strength < 1.0:
            left, share = 1.0 - mask.strength, mask.strength
            own = Weights(left + share * own.value, share * own.by_x, share * own.by_y)
        total = Weights(
            total.value * own.value,
            total.by_x * own.value + total.value * own.by_x,
            total.by_y * own.value + total.value * own.by_y,
        )
    return total


@remembered("weights of masks")
def weights_on_grid(
    masks: tuple[Mask, ...], domain_size: float, resolution: int, dtype: type = np.float64
) -> Weights:
    """The same on the (N, N) samples [y, x] of the domain, in float32 or float64."""
    along: Array = domain_size / resolution * np.arange(resolution, dtype=np.float64)
    parts = [
        weights(masks, domain_size, along, along[first : first + _ROWS, np.newaxis])
        for first in range(0, resolution, _ROWS)
    ]
    return Weights(*(np.concatenate(columns).astype(dtype) for columns in zip(*parts, strict=True)))


def _by_image(mask: Mask, domain_size: float, x: Array, y: Array) -> Weights:
    """A quadratic B-spline through the texels, whose centres are half a texel in; it stays in 0…1."""
    assert mask.image is not None
    texels = np.clip(mask.image.values[..., 0].astype(np.float64), 0.0, 1.0)
    rows, columns = texels.shape
    column, row = x / domain_size * columns - 0.5, y / domain_size * rows - 0.5
    (j, along_x), (i, along_y) = spline_weights(column), spline_weights(row)
    slope_x, slope_y = spline_slopes(column), spline_slopes(row)
    shape = np.broadcast_shapes(x.shape, y.shape)
    value, by_x, by_y = (np.zeros(shape) for _ in range(3))
    for b in range(3):
        for a in range(3):
            texel = texels[i[b] % rows, j[a] % columns]
            value += texel * along_y[b] * along_x[a]
            by_x += texel * along_y[b] * slope_x[a]
            by_y += texel * slope_y[b] * along_x[a]
    return Weights(value, by_x * (columns / domain_size), by_y * (rows / domain_size))


def _by_distance(mask: Mask, domain_size: float, x: Array, y: Array) -> Weights:
    """A smooth step over the distance from the nearest of places, or lines, that repeat with the domain."""
    dx, dy = (_from_place if mask.lines is None else _from_lines)(mask, domain_size, x, y)
    distance = np.hypot(dx, dy)
    part = np.clip((distance - mask.inner_radius) / (mask.outer_radius - mask.inner_radius), 0.0, 1.0)
    rate = 6.0 * part * (1.0 - part) / (mask.outer_radius - mask.inner_radius) / np.maximum(distance, 1e-12)
    return Weights(part * part * (3.0 - 2.0 * part), rate * dx, rate * dy)


def _from_place(mask: Mask, domain_size: float, x: Array, y: Array) -> tuple[Array, Array]:
    """x and y away from the nearest of its places, m."""
    dx, dy = (
        (p - at + 0.5 * domain_size) % domain_size - 0.5 * domain_size for p, at in ((x, mask.x), (y, mask.y))
    )
    return dx, dy


def _from_lines(mask: Mask, domain_size: float, x: Array, y: Array) -> tuple[Array, Array]:
    """x and y away from the nearest point of its lines, m."""
    x, y = np.broadcast_arrays(x % domain_size, y % domain_size)
    nearest = np.full(x.shape, np.inf)
    away_x, away_y = np.zeros(x.shape), np.zeros(x.shape)
    for (ax, ay), (ux, uy) in _lines_in_reach(mask, domain_size):
        along = np.clip(((x - ax) * ux + (y - ay) * uy) / max(ux * ux + uy * uy, 1e-12), 0.0, 1.0)
        dx, dy = x - ax - along * ux, y - ay - along * uy
        square = dx * dx + dy * dy
        is_nearer = square < nearest
        for kept, found in ((nearest, square), (away_x, dx), (away_y, dy)):
            np.copyto(kept, found, where=is_nearer)
    return away_x, away_y


def _lines_in_reach(mask: Mask, domain_size: float) -> Iterator[tuple[Array, Array]]:
    """Begin and extent of those lines, repeated with the domain, that may be the nearest of a place in it.

    No place is farther than half a diagonal from the nearest repetition of a point.
    """
    assert mask.lines is not None
    reach = min(mask.outer_radius, math.sqrt(0.5) * domain_size)
    for line in mask.lines.values.reshape(-1, 2, 2).astype(np.float64):
        first = np.ceil((-reach - line.max(axis=0)) / domain_size).astype(int)
        last = np.floor((domain_size + reach - line.min(axis=0)) / domain_size).astype(int)
        for i in range(first[0], last[0] + 1):
            for j in range(first[1], last[1] + 1):
                yield line[0] + domain_size * np.array([i, j]), line[1] - line[0]


def check_lines(mask: Mask, domain_size: float) -> None:
    """Raise ParameterError for lines that would be repeated with the domain too often."""
    if mask.lines is None:
        return
    x0, y0, x1, y1 = np.moveaxis(mask.lines.values, -1, 0)
    longest = float(max(np.abs(x1 - x0).max(), np.abs(y1 - y0).max()))
    if longest > MOST_DOMAINS * domain_size:
        raise ParameterError(
            "mask.lines", f"{longest:g} m",
            f"must be at most {MOST_DOMAINS * domain_size:g} m long along x and y, {MOST_DOMAINS:g} domains",
        )  # fmt: skip


_SOURCES = {"IMAGE": _by_image, "DISTANCE": _by_distance}
