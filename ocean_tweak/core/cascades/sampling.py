# SPDX-License-Identifier: GPL-3.0-or-later
"""Fields of patches at any rest positions, turned into the sea's axes and added up."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..masks.weights import Weights
from ..surface_query import Field, Values
from ..synthesis import X, Y, Z

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]

#: a component of the displacement and what it is differentiated by
Key = tuple[int, str]
Components = Mapping[Key, RealArray]

_GRADIENT = ((X, "x"), (X, "y"), (Y, "x"), (Y, "y"))
#: components that turn together
_TOGETHER = (((X, ""), (Y, "")), ((X, "t"), (Y, "t")), ((Z, "x"), (Z, "y")), _GRADIENT)


def closed(wanted: Iterable[Key]) -> frozenset[Key]:
    """The components wanted and those that they are mixed with when axes turn."""
    keys = set(wanted)
    for group in _TOGETHER:
        if not keys.isdisjoint(group):
            keys.update(group)
    return frozenset(keys)


def unweighted(wanted: Iterable[Key]) -> frozenset[Key]:
    """The components wanted and those of which a weight's own change makes a part: ∂(w d) = w ∂d + d ∂w."""
    keys = frozenset(wanted)
    return keys | {(component, "") for component, derivative in keys if derivative in ("x", "y")}


def weighted(values: Mapping[Key, RealArray], weights: Weights | None) -> dict[Key, RealArray]:
    """Components times weights of the same shape, in the axes of the weights' derivatives."""
    if weights is None:
        return dict(values)
    result: dict[Key, RealArray] = {
        key: weights.value.astype(field.dtype) * field for key, field in values.items()
    }
    for (component, derivative), field in result.items():
        if derivative in ("x", "y"):
            change = weights.by_x if derivative == "x" else weights.by_y
            field += change.astype(field.dtype) * values[component, ""]
    return result


def into_patch(x: Array, y: Array, rotation: float) -> tuple[Array, Array]:
    """Places in the axes of a patch that is turned by `rotation` rad, counter-clockwise."""
    if not rotation:
        return x, y
    c, s = math.cos(rotation), math.sin(rotation)
    return c * x + s * y, c * y - s * x


class Reader:
    """Reads periodic (N, N) fields, [y, x] from the origin, at places in their own axes: bilinear."""

    def __init__(self, x: Array, y: Array, spacing: float, resolution: int) -> None:
        n = resolution
        column, row = x / spacing, y / spacing
        j, i = np.floor(column).astype(np.intp), np.floor(row).astype(np.intp)
        self._u, self._v = (column - j).astype(np.float32), (row - i).astype(np.float32)
        j, i = j % n, i % n
        right, up = np.where(j + 1 < n, j + 1, 0), np.where(i + 1 < n, i + 1, 0)
        self._corners = i * n + j, i * n + right, up * n + j, up * n + right

    def read(self, field: RealArray) -> RealArray:
        """One number a place, of the field's precision."""
        p00, p01, p10, p11 = (field.ravel()[corner] for corner in self._corners)
        bottom = p00 + self._u * (p01 - p00)
        return bottom + self._v * (p10 + self._u * (p11 - p10) - bottom)


def turned(values: dict[Key, RealArray], rotation: float) -> dict[Key, RealArray]:
    """Components in the sea's axes, from those in the axes of a patch: vectors Rv, gradients R G Rᵀ."""
    if not rotation:
        return values
    c, s = (np.float32(part(rotation)) for part in (math.cos, math.sin))
    result = dict(values)
    for first, second in _TOGETHER[:3]:
        if first in values:
            a, b = values[first], values[second]
            result[first], result[second] = c * a - s * b, s * a + c * b
    if _GRADIENT[0] in values:
        xx, xy, yx, yy = (values[key] for key in _GRADIENT)
        # R G, then its product with Rᵀ
        ax, ay, bx, by = c * xx - s * yx, c * xy - s * yy, s * xx + c * yx, s * xy + c * yy
        turned_gradient = c * ax - s * ay, s * ax + c * ay, c * bx - s * by, s * bx + c * by
        result |= dict(zip(_GRADIENT, turned_gradient, strict=True))
    return result


class Grid(NamedTuple):
    """Periodic components of some waves, (N, N) each, in their own axes.

    spacing : of the samples, m
    rotation : of the axes against the sea's, rad counter-clockwise
    weights : of the places that are asked for, in the sea's axes; None for 1 everywhere
    """

    components: Components
    spacing: float
    rotation: float
    weights: Weights | None = None

    def read(self, x: Array, y: Array) -> dict[Key, RealArray]:
        """At places in the sea's axes: turned into those, and weighted."""
        if not self.components:
            return {}
        resolution = len(next(iter(self.components.values())))
        reader = Reader(*into_patch(x, y, self.rotation), self.spacing, resolution)
        found = {key: reader.read(field) for key, field in self.components.items()}
        return weighted(turned(found, self.rotation), self.weights)


class Summed:
    """Sums of components, as the writers of `fields.OUTPUTS` read them."""

    def __init__(self, parts: Iterable[Mapping[Key, RealArray]]) -> None:
        self._sums: dict[Key, RealArray] = {}
        for values in parts:
            for key, value in values.items():
                self._sums[key] = self._sums[key] + value if key in self._sums else value

    def position(self, component: int, derivative: str = "", out: RealArray | None = None) -> RealArray:
        """Displacement's component in m or its derivative; in `out` if given."""
        result = self._sums[component, derivative]
        if out is None:
            return result
        out[...] = result
        return out


def turned_field(field: Field, rotation: float) -> Field:
    """A patch's surface in the sea's axes."""
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

    def under(x: Array, y: Array, with_velocity: bool) -> tuple[Values, Array | None]:
        (value, by_x, by_y), velocity = field(x, y, with_velocity)
        weight, along_x, along_y = (part[:, np.newaxis] for part in weights_at(x, y))
        values = Values(weight * value, weight * by_x + along_x * value, weight * by_y + along_y * value)
        return values, None if velocity is None else weight * velocity

    return under


def summed_field(fields: Sequence[Field]) -> Field:
    """The surface of several patches together."""

    def total(x: Array, y: Array, with_velocity: bool) -> tuple[Values, Array | None]:
        parts = [field(x, y, with_velocity) for field in fields]
        values = Values(
            *(np.sum(columns, axis=0) for columns in zip(*(part for part, _ in parts), strict=True))
        )
        moving = [velocity for _, velocity in parts if velocity is not None]
        return values, np.sum(moving, axis=0) if len(moving) == len(parts) else None

    return total
