# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces as functions of the rest position: bilinear between samples, or the exact Fourier sum; and sums of
several, each with its own axes and weights.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..masks.weights import Weights
from ..numerics.interpolation import between
from ..synthesis.transforms import Column, Synthesis, X, Y, Z
from .sampling import into_patch

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]
ComplexArray = NDArray[np.complexfloating]

#: points processed at a time
_CHUNK = 2048


class Values(NamedTuple):
    """A field and its derivatives with respect to the rest position at some points: (points, channels)
    each."""

    value: Array
    by_x: Array
    by_y: Array


#: function that returns the displacement P (x, y, z), or with `True` the velocity, at rest positions x and y
# in m
Field = Callable[[Array, Array, bool], tuple[Values, Array | None]]


def bilinear(displacement: RealArray, velocity: RealArray | None, spacing: float) -> Field:
    """The periodic surface bilinear between samples, as on a mesh with one vertex per sample."""

    def field(x: Array, y: Array, with_velocity: bool) -> tuple[Values, Array | None]:
        corners, *shares = between(y / spacing, x / spacing, displacement.shape)
        u, v = (share[:, np.newaxis] for share in shares)
        p00, p01, p10, p11 = (displacement[corner].astype(np.float64) for corner in corners)
        bottom, top = p00 + u * (p01 - p00), p10 + u * (p11 - p10)
        by_x = ((1.0 - v) * (p01 - p00) + v * (p11 - p10)) / spacing
        values = Values(bottom + v * (top - bottom), by_x, (top - bottom) / spacing)
        if not with_velocity or velocity is None:
            return values, None
        weights = ((1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v)
        moving = sum((w * velocity[corner] for w, corner in zip(weights, corners, strict=True)), np.zeros(()))
        return values, np.asarray(moving)

    return field


def exact(synthesis: Synthesis, time: float | Fraction) -> Field:
    """Positions and velocities at any rest positions, as sums over all wave vectors.

    The cost per point is proportional to the number of wave vectors. Trough damping is not a sum of waves and
    is ignored.
    """
    grid = synthesis.state.grid
    columns = _Columns(synthesis, time)

    def field(x: Array, y: Array, with_velocity: bool) -> tuple[Values, Array | None]:
        sums = np.zeros((4 if with_velocity else 3, len(x), 3))
        for first in range(0, len(x), _CHUNK):
            chunk = slice(first, first + _CHUNK)
            along_x = np.exp(1j * x[chunk, np.newaxis] * grid.kx[0]) * grid.multiplicity[0]
            along_y = np.exp(1j * y[chunk, np.newaxis] * grid.ky[:, 0])
            for result, by in zip(sums, ("", "x", "y", "t"), strict=False):
                result[chunk] = columns.position(by, along_x, along_y)
        return Values(*sums[:3]), sums[3] if with_velocity else None

    return field


class _Columns:
    """Coefficients of the columns needed for positions and derivatives, computed once for a time."""

    def __init__(self, synthesis: Synthesis, time: float | Fraction) -> None:
        self._synthesis = synthesis
        self._time = time
        self._made: dict[Column, ComplexArray] = {}

    def position(self, by: str, along_x: ComplexArray, along_y: ComplexArray) -> Array:
        """(points, 3) position or its derivative by "x", "y" or "t"."""
        return np.stack([self._sum(component, by, along_x, along_y) for component in (X, Y, Z)], axis=-1)

    def _sum(self, component: int, by: str, along_x: ComplexArray, along_y: ComplexArray) -> Array:
        wanted = self._synthesis.terms[component, by, False]
        factor = self._synthesis.x_factor(wanted)
        coefficients = self._coefficients(wanted.column)
        if factor is not None:
            coefficients = coefficients * factor
        return np.einsum("pk,pk->p", along_y @ coefficients, along_x).real

    def _coefficients(self, column: Column) -> ComplexArray:
        if column not in self._made:
            self._made |= self._synthesis.coefficients(self._time, [column])
        return self._made[column]


def turned_field(field: Field, rotation: float) -> Field:
    """A patch's surface rotated to the sea's axes."""
    if not rotation:
        return field
    c, s = math.cos(rotation), math.sin(rotation)

    def vectors(values: Array) -> Array:
        return np.stack(
            (c * values[:, 0] - s * values[:, 1], s * values[:, 0] + c * values[:, 1], values[:, 2]), axis=-1
        )

    def in_sea(x: Array, y: Array, with_velocity: bool) -> tuple[Values, Array | None]:
        (value, by_x, by_y), velocity = field(*into_patch(x, y, rotation), with_velocity)
        turned_values = Values(vectors(value), vectors(c * by_x - s * by_y), vectors(s * by_x + c * by_y))
        return turned_values, None if velocity is None else vectors(velocity)

    return in_sea


def weighted_field(field: Field, weights_at: Callable[[Array, Array], Weights] | None) -> Field:
    """A surface times weights, both in the sea's axes."""
    if weights_at is None:
        return field

    def masked(x: Array, y: Array, with_velocity: bool) -> tuple[Values, Array | None]:
        (value, by_x, by_y), velocity = field(x, y, with_velocity)
        under = weights_at(x, y)
        weight, along_x, along_y = (part[:, np.newaxis] for part in (under.value, under.by_x, under.by_y))
        values = Values(weight * value, weight * by_x + along_x * value, weight * by_y + along_y * value)
        if velocity is None:
            return values, None
        change = 0.0 if under.by_t is None else under.by_t[:, np.newaxis] * value
        return values, weight * velocity + change

    return masked


def summed_field(fields: Sequence[Field]) -> Field:
    """The sum of the surfaces of several patches."""

    def total(x: Array, y: Array, with_velocity: bool) -> tuple[Values, Array | None]:
        parts = [field(x, y, with_velocity) for field in fields]
        values = Values(
            *(np.sum(columns, axis=0) for columns in zip(*(part for part, _ in parts), strict=True))
        )
        moving = [velocity for _, velocity in parts if velocity is not None]
        return values, np.sum(moving, axis=0) if len(moving) == len(parts) else None

    return total
