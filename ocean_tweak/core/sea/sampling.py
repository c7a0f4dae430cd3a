# SPDX-License-Identifier: GPL-3.0-or-later
"""Components of parts at any rest positions, rotated to the sea's axes, weighted and summed."""

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

#: a component of the displacement and the variable of its derivative
Key = tuple[int, str]
Components = Mapping[Key, RealArray]

#: of the horizontal displacement
GRADIENT = ((X, "x"), (X, "y"), (Y, "x"), (Y, "y"))
#: components that transform together under rotation
_TOGETHER = (((X, ""), (Y, "")), ((X, "t"), (Y, "t")), ((Z, "x"), (Z, "y")), GRADIENT)


def closed(wanted: Iterable[Key]) -> frozenset[Key]:
    """The requested components and those with which they mix under rotation."""
    keys = set(wanted)
    for group in _TOGETHER:
        if not keys.isdisjoint(group):
            keys.update(group)
    return frozenset(keys)


def into_patch(x: Array, y: Array, rotation: float) -> tuple[Array, Array]:
    """Places in the axes of a patch rotated by `rotation` rad, counter-clockwise."""
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
    """The layout of a grid: samples along a square's side in m, rotated by an angle in rad."""

    size: float
    resolution: int
    rotation: float

    def reader(self, x: Array, y: Array) -> Reader:
        """A reader of the grid's fields at places in m."""
        return Reader(*into_patch(x, y, self.rotation), self.size, self.resolution)


class Grid:
    """Periodic components of some waves, sampled in the sea's axes.

    components : (N+1, N+1) each, in their own axes, with the first row and column repeated at the end
    size : of their square, m
    rotation : of its axes relative to the sea's, rad counter-clockwise
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
        """The layout of its samples."""
        return Geometry(self._size, self._resolution, self._rotation)

    def read(self, x: Array, y: Array, weights: Weights | None = None) -> dict[Key, RealArray]:
        """Components at flat arrays of places in m, times weights."""
        return self.read_by(self.geometry.reader(x, y), weights) if self._fields else {}

    def read_by(self, reader: Reader, weights: Weights | None = None) -> dict[Key, RealArray]:
        """Components at the places of a reader of this geometry."""
        found = {key: reader.read(field) for key, field in self._fields.items()}
        return weighted(turned(found, self._rotation), weights)


class StrainFields:
    """Half the sum and half the difference of the gradient's diagonal, and the mean of its off-diagonal
    elements, at places or on samples. Those of all waves add up, and the compression follows from the sums.
    """

    def __init__(self, half_sum: RealArray, half_difference: RealArray, shear: RealArray) -> None:
        self.fields = half_sum, half_difference, shear

    @classmethod
    def of(cls, gradient: Components) -> StrainFields:
        """The strains of a gradient."""
        xx, xy, yx, yy = (gradient[key] for key in GRADIENT)
        fields = xx + yy, xx - yy, xy + yx
        for field in fields:
            field *= np.float32(0.5)
        return cls(*fields)

    def add(self, other: StrainFields) -> None:
        """Add the strains of other waves at the same places."""
        for field, added in zip(self.fields, other.fields, strict=True):
            field += added

    def turned(self, rotation: float) -> StrainFields:
        """Transform to axes relative to which theirs are rotated by `rotation` rad: the last two rotate by
        twice the angle."""
        if not rotation:
            return self
        half_sum, along, across = self.fields
        c, s = (np.float32(part(2.0 * rotation)) for part in (math.cos, math.sin))
        return StrainFields(half_sum, c * along - s * across, s * along + c * across)

    def compression(self) -> RealArray:
        """1 - `channels.min_eigenvalue`, negative where the surface is stretched."""
        half_sum, half_difference, shear = self.fields
        root = half_difference * half_difference
        root += shear * shear
        np.sqrt(root, out=root)
        root -= half_sum
        return root


class StrainGrid:
    """Periodic strains of some waves without masks, sampled in the sea's axes; the arguments are those of
    `Grid`."""

    def __init__(self, components: Components, size: float, rotation: float) -> None:
        fields = StrainFields.of(components).fields
        self._geometry = Geometry(size, len(fields[0]) - 1, rotation)
        self._fields = [field.reshape(-1) for field in fields]

    @property
    def nbytes(self) -> int:
        """Bytes of the strains."""
        return total_bytes(self._fields)

    def read(self, x: Array, y: Array) -> StrainFields:
        """Strains at flat arrays of places in m."""
        reader = self._geometry.reader(x, y)
        return StrainFields(*(reader.read(field) for field in self._fields)).turned(self._geometry.rotation)


class Summed:
    """Sums of components, in the form used by the formulas of `core.synthesis.channels`."""

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
