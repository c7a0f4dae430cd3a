# SPDX-License-Identifier: GPL-3.0-or-later
"""The band-limited surface between the samples: the Fourier sum itself at any place."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from .surface_query import Field, Values
from .synthesis import Column, Synthesis, X, Y, Z

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complexfloating]

#: points whose sums are made together
_CHUNK = 2048


def exact(synthesis: Synthesis, time: float | Fraction) -> Field:
    """Positions and velocities at rest positions anywhere, as sums over all wave vectors.

    A point costs as much as there are wave vectors. Trough damping is not a sum of waves: it is left out.
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
    """Coefficients of the columns that positions and their derivatives need, made once for a time."""

    def __init__(self, synthesis: Synthesis, time: float | Fraction) -> None:
        self._synthesis = synthesis
        self._time = time
        self._made: dict[Column, ComplexArray] = {}

    def position(self, by: str, along_x: ComplexArray, along_y: ComplexArray) -> Array:
        """(points, 3) position or its derivative by "x", "y" or "t"."""
        return np.stack([self._sum(component, by, along_x, along_y) for component in (X, Y, Z)], axis=-1)

    def _sum(self, component: int, by: str, along_x: ComplexArray, along_y: ComplexArray) -> Array:
        wanted = self._synthesis.term(component, by)
        coefficients = self._coefficients(wanted.column) * self._synthesis.x_factor(wanted)
        return np.einsum("pk,pk->p", along_y @ coefficients, along_x).real

    def _coefficients(self, column: Column) -> ComplexArray:
        if column not in self._made:
            self._made |= self._synthesis.coefficients(self._time, [column])
        return self._made[column]
