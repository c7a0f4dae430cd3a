# SPDX-License-Identifier: GPL-3.0-or-later
"""Components of parts at any rest positions, turned into the sea's axes, weighted and added up."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..masks.weights import Weights, weighted
from ..numerics.interpolation import Reader
from ..numerics.memo import total_bytes
from ..synthesis.transforms import X, Y, Z

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]

#: a component of the displacement and what it is differentiated by
Key = tuple[int, str]
Components = Mapping[Key, RealArray]

#: of the horizontal displacement
GRADIENT = ((X, "x"), (X, "y"), (Y, "x"), (Y, "y"))
#: components that turn together
_TOGETHER = (((X, ""), (Y, "")), ((X, "t"), (Y, "t")), ((Z, "x"), (Z, "y")), GRADIENT)


def closed(wanted: Iterable[Key]) -> frozenset[Key]:
    """The components wanted and those that they are mixed with when axes turn."""
    keys = set(wanted)
    for group in _TOGETHER:
        if not keys.isdisjoint(group):
            keys.update(group)
    return frozenset(keys)


def into_patch(x: Array, y: Array, rotation: float) -> tuple[Array, Array]:
    """Places in the axes of a patch that is turned by `rotation` rad, counter-clockwise."""
    if not rotation:
        return x, y
    c, s = math.cos(rotation), math.sin(rotation)
    return c * x + s * y, c * y - s * x


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
    if GRADIENT[0] in values:
        xx, xy, yx, yy = (values[key] for key in GRADIENT)
        # R G, then its product with Rᵀ
        ax, ay, bx, by = c * xx - s * yx, c * xy - s * yy, s * xx + c * yx, s * xy + c * yy
        turned_gradient = c * ax - s * ay, s * ax + c * ay, c * bx - s * by, s * bx + c * by
        result |= dict(zip(GRADIENT, turned_gradient, strict=True))
    return result


class Geometry(NamedTuple):
    """Where the samples of a grid lie: so many along a square's side in m, turned by an angle in rad."""

    size: float
    resolution: int
    rotation: float

    def reader(self, x: Array, y: Array) -> Reader:
        """Reads the grid's fields at places in m."""
        return Reader(*into_patch(x, y, self.rotation), self.size, self.resolution)


class Grid:
    """Periodic components of some waves, read in the sea's axes.

    components : (N+1, N+1) each, in axes of their own, the last row and column the first ones again
    size : of the square that they fill, m
    rotation : of its axes against the sea's, rad counter-clockwise
    """

    def __init__(self, components: Components, size: float, rotation: float) -> None:
        self._resolution = len(next(iter(components.values()), (0,))) - 1
        self._fields = {key: field.reshape(-1) for key, field in components.items()}
        self._size = size
        self._rotation = rotation

    @property
    def nbytes(self) -> int:
        """Bytes of the components."""
        return total_bytes(self._fields.values())

    @property
    def geometry(self) -> Geometry:
        """Where its samples lie."""
        return Geometry(self._size, self._resolution, self._rotation)

    def read(self, x: Array, y: Array, weights: Weights | None = None) -> dict[Key, RealArray]:
        """At places in m, of one flat shape, times weights of theirs."""
        return self.read_by(self.geometry.reader(x, y), weights) if self._fields else {}

    def read_by(self, reader: Reader, weights: Weights | None = None) -> dict[Key, RealArray]:
        """At the places of a reader of this geometry."""
        found = {key: reader.read(field) for key, field in self._fields.items()}
        return weighted(turned(found, self._rotation), weights)


class StrainFields:
    """Of the gradient at places or on samples half the sum and half the difference of the diagonal, and the
    mean of the others: those of waves add, and from the sum of all follows the compression.
    """

    def __init__(self, half_sum: RealArray, half_difference: RealArray, shear: RealArray) -> None:
        self.fields = half_sum, half_difference, shear

    @classmethod
    def of(cls, gradient: Components) -> StrainFields:
        """Those of a gradient."""
        xx, xy, yx, yy = (gradient[key] for key in GRADIENT)
        fields = xx + yy, xx - yy, xy + yx
        for field in fields:
            field *= np.float32(0.5)
        return cls(*fields)

    def add(self, other: StrainFields) -> None:
        """Add those of other waves at the same places."""
        for field, added in zip(self.fields, other.fields, strict=True):
            field += added

    def turned(self, rotation: float) -> StrainFields:
        """In axes against which theirs are turned by `rotation` rad: the last two turn twice as far."""
        if not rotation:
            return self
        half_sum, along, across = self.fields
        c, s = (np.float32(part(2.0 * rotation)) for part in (math.cos, math.sin))
        return StrainFields(half_sum, c * along - s * across, s * along + c * across)

    def compression(self) -> RealArray:
        """1 - `channels.min_eigenvalue`, below 0 where the surface is stretched."""
        half_sum, half_difference, shear = self.fields
        root = half_difference * half_difference
        root += shear * shear
        np.sqrt(root, out=root)
        root -= half_sum
        return root


class StrainGrid:
    """Periodic strains of some waves without masks, read in the sea's axes; the arguments are a `Grid`'s."""

    def __init__(self, components: Components, size: float, rotation: float) -> None:
        fields = StrainFields.of(components).fields
        self._geometry = Geometry(size, len(fields[0]) - 1, rotation)
        self._fields = [field.reshape(-1) for field in fields]

    @property
    def nbytes(self) -> int:
        """Bytes of the strains."""
        return total_bytes(self._fields)

    def read(self, x: Array, y: Array) -> StrainFields:
        """At places in m, of one flat shape."""
        reader = self._geometry.reader(x, y)
        return StrainFields(*(reader.read(field) for field in self._fields)).turned(self._geometry.rotation)


class Summed:
    """Sums of components, as the formulas of `core.synthesis.channels` read them."""

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
