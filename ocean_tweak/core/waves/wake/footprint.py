# SPDX-License-Identifier: GPL-3.0-or-later
"""The draught of an object from above, and its Fourier transform at any heading."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...numerics.interpolation import between

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex64]

#: samples of the transform for one of the footprint, along each side
_FINER, _MOST = 16, 2048

#: of a hull: samples across its beam, how soft its edges are in beams, and samples beyond them by which it
#: has gone down to 0
_FINE, _SOFTNESS, _SOFT_REACH = 8, 0.15, 8


@dataclass(frozen=True, eq=False)
class Footprint:
    """Samples of draught in m, [y, x], x forward, about the object's origin; see `of`."""

    draught: Array
    spacing: float

    @classmethod
    def of(cls, draught: ArrayLike, spacing: float) -> Footprint:
        """A checked footprint. Raises ValueError for one without size, or whose numbers are not finite."""
        d = np.asarray(draught, np.float64)
        if d.ndim != 2 or not d.size:
            raise ValueError(f"footprint: must be rows of draughts [y, x], not of shape {d.shape}")
        if not np.isfinite(d).all():
            raise ValueError("footprint: must be finite")
        if not (math.isfinite(spacing) and spacing > 0.0):
            raise ValueError(f"spacing = {spacing!r}: must be a length above 0 m")
        return cls(d, float(spacing))

    def transform(self, kx: Array, ky: Array, heading: float) -> ComplexArray:
        """∫ d e^(-ik·x) dx in m³ of the object turned to a heading; wave vectors (1, X) and (Y, 1) in rad/m.

        What its own samples cannot hold is 0.
        """
        table, step = self._table
        half, width = len(table) // 2, len(table)
        c, s = math.cos(heading) / step, math.sin(heading) / step
        column = (c * kx + s * ky).astype(np.float32)
        row = (c * ky - s * kx).astype(np.float32)
        limit = np.float32(half - 1.01)
        np.clip(column, -limit, limit, out=column)
        np.clip(row, -limit, limit, out=row)
        i, j = np.floor(row), np.floor(column)
        row -= i
        column -= j
        place = ((i + half) * width + (j + half)).astype(np.int32)
        flat = table.ravel()
        near, far = flat[place], flat[place + width]
        near += column * (flat[place + 1] - near)
        far += column * (flat[place + (width + 1)] - far)
        near += row * (far - near)
        return near

    @cached_property
    def _table(self) -> tuple[ComplexArray, float]:
        rows, columns = self.draught.shape
        n = min(_MOST, 2 ** math.ceil(math.log2(_FINER * max(rows, columns, 8))))
        padded = np.zeros((n, n))
        padded[:rows, :columns] = self.draught
        # the middle of the footprint is the object's origin
        k = 2.0 * np.pi * np.fft.fftfreq(n)
        middle = np.exp(1j * k * (rows - 1) / 2.0)[:, np.newaxis] * np.exp(1j * k * (columns - 1) / 2.0)
        table = np.fft.fftshift(np.fft.fft2(padded) * middle) * self.spacing**2
        table[[0, 1, -1]] = table[:, [0, 1, -1]] = 0.0  # what lies beyond is clipped to here
        return table.astype(np.complex64), 2.0 * math.pi / (n * self.spacing)


def hull_footprint(length: float, beam: float, draught: float, shape: Array | None = None) -> Footprint:
    """The footprint of a hull of some m along x, across and in depth.

    shape : (rows, columns) shares of the draught over length and beam, [y, x] from the stern's starboard to
        the bow's port, or None for 1 - r² over an ellipse

    Towards the sides of the box it goes down to 0, and it is softened as by exp(-(0.15 k beam)²): blunt edges
    would make waves of any shortness, which fold.
    """
    spacing = beam / _FINE
    rows, columns = (2 * math.ceil(0.5 * side / spacing + _SOFT_REACH) + 1 for side in (beam, length))
    y = (np.arange(rows) - rows // 2)[:, np.newaxis] * (2.0 * spacing / beam)
    x = (np.arange(columns) - columns // 2) * (2.0 * spacing / length)
    if shape is None:
        depth = np.maximum(1.0 - x * x - y * y, 0.0)
    else:
        inside = (np.abs(x) <= 1.0) & (np.abs(y) <= 1.0)
        across, along = (
            np.clip((0.5 * place + 0.5) * count - 0.5, 0.0, count - 1.0)
            for place, count in zip((y, x), shape.shape, strict=True)
        )
        row, column = np.broadcast_arrays(across, along)
        depth = inside * (1.0 - x * x) * (1.0 - y * y) * between(row, column, shape.shape).read(shape)
    k = np.hypot(
        2.0 * np.pi * np.fft.fftfreq(rows, spacing)[:, np.newaxis],
        2.0 * np.pi * np.fft.rfftfreq(columns, spacing),
    )
    soft = np.exp(-((_SOFTNESS * beam * k) ** 2))
    return Footprint.of(draught * np.fft.irfft2(np.fft.rfft2(depth) * soft, (rows, columns)), spacing)
