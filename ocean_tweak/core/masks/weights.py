# SPDX-License-Identifier: GPL-3.0-or-later
"""Mask weights: 0 to 1 over the sea, by which displacement and velocity are multiplied.

A weight is a function of the rest position, covers the domain and repeats with it. Weights have continuous
derivatives, which the slopes, strains and velocities of a masked sea need: ∂(w d) = w ∂d + d ∂w.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..numerics.memo import MEMO, remembered, total_bytes
from .distance import by_distance
from .image import by_image
from .noise import ANY_TIME, SeaTime, by_noise
from .parameters import Mask

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]

#: rows of a square of weights computed at a time
_ROWS = 128
# each moment has its own
MEMO.limit("moving weights of masks", 16)


class Weights(NamedTuple):
    """w at places, its derivatives by x and y in 1/m and, for a moving mask, by time in 1/s; all of one
    shape."""

    value: Array
    by_x: Array
    by_y: Array
    by_t: Array | None = None

    @property
    def nbytes(self) -> int:
        """Bytes of all of them."""
        return total_bytes(self)

    def rows(self, part: slice) -> Weights:
        """The weights of some rows."""
        return Weights._make(None if each is None else each[part] for each in self)

    def less(self, strength: float) -> Weights:
        """The weights of a mask that removes only the fraction `strength` of the waves."""
        left = 1.0 - strength
        by_t = None if self.by_t is None else strength * self.by_t
        return Weights(left + strength * self.value, strength * self.by_x, strength * self.by_y, by_t)

    def times(self, other: Weights) -> Weights:
        """The product of two weights, with its derivatives."""
        return Weights(
            self.value * other.value,
            self.by_x * other.value + self.value * other.by_x,
            self.by_y * other.value + self.value * other.by_y,
            self._rate_of_product(other),
        )

    def _rate_of_product(self, other: Weights) -> Array | None:
        rates = [
            one.by_t * another.value
            for one, another in ((self, other), (other, self))
            if one.by_t is not None
        ]
        return np.sum(rates, axis=0) if rates else None

    @property
    def inverted(self) -> Weights:
        """The complement, 1 - w."""
        by_t = None if self.by_t is None else -self.by_t
        return Weights(1.0 - self.value, -self.by_x, -self.by_y, by_t)


def move(masks: Sequence[Mask]) -> bool:
    """Whether the weights of some masks change over time."""
    return any(_moves(mask) for mask in masks)


def _moves(mask: Mask) -> bool:
    return mask.source == "NOISE"


def weights(
    masks: Sequence[Mask], domain_size: float, x: Array, y: Array, when: SeaTime = ANY_TIME
) -> Weights:
    """The product of the weights of some masks at rest positions x and y in m, of shapes that broadcast."""
    shape = np.broadcast_shapes(x.shape, y.shape)
    total = Weights(np.ones(shape), np.zeros(shape), np.zeros(shape))
    for mask in masks:
        own = _of(mask, domain_size, x, y, when)
        if mask.inverted:
            own = own.inverted
        if mask.strength < 1.0:
            own = own.less(mask.strength)
        total = total.times(own)
    return total


def _of(mask: Mask, domain_size: float, x: Array, y: Array, when: SeaTime) -> Weights:
    if _moves(mask):
        return Weights(*by_noise(mask, domain_size, x, y, when))
    by = by_image if mask.source == "IMAGE" else by_distance
    return Weights(*by(mask, domain_size, x, y))


def weights_on_grid(
    masks: tuple[Mask, ...],
    domain_size: float,
    resolution: int,
    dtype: type = np.float64,
    when: SeaTime = ANY_TIME,
) -> Weights:
    """The same product on the (N, N) samples [y, x] of the domain, in float32 or float64."""
    if move(masks):
        return _moving(masks, domain_size, resolution, dtype, when)
    return _still(masks, domain_size, resolution, dtype)


@remembered("weights of masks")
def _still(masks: tuple[Mask, ...], domain_size: float, resolution: int, dtype: type) -> Weights:
    return _on_grid(masks, domain_size, resolution, dtype)


@remembered("moving weights of masks")
def _moving(
    masks: tuple[Mask, ...], domain_size: float, resolution: int, dtype: type, when: SeaTime
) -> Weights:
    still = tuple(mask for mask in masks if not _moves(mask))
    moving = tuple(mask for mask in masks if _moves(mask))
    by = _still(still, domain_size, resolution, np.float64) if still else None
    return _on_grid(moving, domain_size, resolution, dtype, when, by)


def _on_grid(
    masks: tuple[Mask, ...],
    domain_size: float,
    resolution: int,
    dtype: type,
    when: SeaTime = ANY_TIME,
    by: Weights | None = None,
) -> Weights:
    """The weights of some masks, and of others that are there already, on the samples of a domain."""
    along: Array = domain_size / resolution * np.arange(resolution, dtype=np.float64)
    parts = []
    for first in range(0, resolution, _ROWS):
        rows = slice(first, first + _ROWS)
        own = weights(masks, domain_size, along, along[rows, np.newaxis], when)
        parts.append(own if by is None else by.rows(rows).times(own))

    def joined(columns: Sequence[Array]) -> Array:
        return np.concatenate(columns).astype(dtype)

    rates = [part.by_t for part in parts if part.by_t is not None]
    return Weights(
        joined([part.value for part in parts]),
        joined([part.by_x for part in parts]),
        joined([part.by_y for part in parts]),
        joined(rates) if rates else None,
    )


def unweighted(wanted: Iterable[tuple[int, str]], moves: bool = False) -> frozenset[tuple[int, str]]:
    """The components wanted and those of which a weight's own change makes a part: ∂(w d) = w ∂d + d ∂w.

    moves : whether the weight changes with time too
    """
    keys, changing = frozenset(wanted), ("x", "y", "t") if moves else ("x", "y")
    return keys | {(component, "") for component, derivative in keys if derivative in changing}


def weighted(
    values: Mapping[tuple[int, str], RealArray], weights: Weights | None
) -> dict[tuple[int, str], RealArray]:
    """Components times weights of the same shape, in the axes of the weights' derivatives."""
    if weights is None:
        return dict(values)
    result: dict[tuple[int, str], RealArray] = {
        key: weights.value.astype(field.dtype) * field for key, field in values.items()
    }
    for (component, derivative), field in result.items():
        change = {"x": weights.by_x, "y": weights.by_y, "t": weights.by_t}.get(derivative)
        if change is not None:
            field += change.astype(field.dtype) * values[component, ""]
    return result
