# SPDX-License-Identifier: GPL-3.0-or-later
"""The draught of an object from above, and its Fourier transform at any heading."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...data.validation import check_range, real_array
from ...numerics.interpolation import between

Array = NDArray[np.float64]
RealArray = NDArray[np.float32]
ComplexArray = NDArray[np.complex64]

#: samples of the transform for one of the footprint, along each side; their number is a multiple of one that
#: transforms are quick with, up to a largest
_FINER, _WHOLE, _MOST = 12, 64, 2048

#: of the largest number of a transform, up to which it has no imaginary part
_ALIKE = 1e-9

#: m, the largest draught
_DEEPEST = 1e6

#: of a hull: samples across its beam, how soft its edges are in beams, and beams beyond them by which it
#: has gone down to 0
_FINE, _SOFTNESS, _SOFT_REACH = 8, 0.15, 0.75
#: of a hull of any shape: samples across its beam, and share of its greatest draught from which it is there
_FINE_SHAPE, _THERE = 16, 0.05


@dataclass(frozen=True, eq=False)
class Footprint:
    """Samples of draught in m, [y, x], x forward, about the object's origin; see `of`."""

    draught: Array
    spacing: float

    @classmethod
    def of(cls, draught: ArrayLike, spacing: float) -> Footprint:
        """A checked footprint. Raises ValueError for one without size, or whose numbers are not finite."""
        d = real_array("footprint", draught)
        if d.ndim != 2 or not d.size:
            raise ValueError(f"footprint: must be rows of draughts [y, x], not of shape {d.shape}")
        if not (np.abs(d) <= _DEEPEST).all():
            raise ValueError(f"footprint: must be finite, of draughts up to {_DEEPEST:g} m")
        check_range("spacing", spacing, 1e-6, 1e6, "m")
        return cls(d, float(spacing))

    def transform(self, kx: Array, ky: Array, heading: float) -> RealArray | ComplexArray:
        """∫ d e^(-ik·x) dx in m³ of the object turned to a heading; wave vectors (1, X) and (Y, 1) in rad/m.

        It is real where both halves of the object are alike. What its own samples cannot hold is 0.
        """
        cells, width, step = self._cells
        c, s = np.float32(math.cos(heading) / step), np.float32(math.sin(heading) / step)
        x, y, half = kx.astype(np.float32), ky.astype(np.float32), width // 2
        column, row = c * x + s * y, c * y - s * x
        limit = np.float32(half - 1.01)
        for place in (row, column):
            np.clip(place, -limit, limit, out=place)
        i, j = np.floor(row), np.floor(column)
        row -= i
        column -= j
        i *= np.float32(width)  # whole numbers up to 2^24 are exact
        i += j
        i += np.float32(half * width + half)
        first = i.astype(np.intp)
        parts = []
        for numbers in cells:
            corners = numbers.take(first, mode="clip").view(np.float32).reshape(*row.shape, 4)
            near = corners[..., 1] - corners[..., 0]
            near *= column
            near += corners[..., 0]
            far = corners[..., 3] - corners[..., 2]
            far *= column
            far += corners[..., 2]
            far -= near
            far *= row
            near += far
            parts.append(near)
        return parts[0] if len(parts) == 1 else parts[0] + np.complex64(1j) * parts[1]

    @cached_property
    def _cells(self) -> tuple[list[NDArray[np.complex128]], int, float]:
        """The four samples around each cell as one number, which is quicker to look up: of the transform's
        real part, and of its imaginary part if it has one; samples along each side, and rad/m between.
        """
        rows, columns = self.draught.shape
        n = min(_MOST, _WHOLE * math.ceil(_FINER * max(rows, columns, 8) / _WHOLE))
        padded = np.zeros((n, n))
        padded[:rows, :columns] = self.draught
        # the middle of the footprint is the object's origin
        k = 2.0 * np.pi * np.fft.fftfreq(n)
        middle = np.exp(1j * k * (rows - 1) / 2.0)[:, np.newaxis] * np.exp(1j * k * (columns - 1) / 2.0)
        table = np.fft.fftshift(np.fft.fft2(padded) * middle) * self.spacing**2
        table[[0, 1, -1]] = table[:, [0, 1, -1]] = 0.0  # what lies beyond is clipped to here
        has_two = np.abs(table.imag).max() > _ALIKE * np.abs(table).max()
        cells = []
        for part in (table.real, table.imag) if has_two else (table.real,):
            corners = np.zeros((n, n, 4), np.float32)
            for place, (down, on) in enumerate(((0, 0), (0, 1), (1, 0), (1, 1))):
                corners[: n - down, : n - on, place] = part[down:, on:]
            cells.append(corners.reshape(-1).view(np.complex128))
        return cells, n, 2.0 * math.pi / (n * self.spacing)


def hull_footprint(length: float, beam: float, draught: float, shape: Array | None = None) -> Footprint:
    """The footprint of a hull of some m along x, across and in depth.

    shape : (rows, columns) shares of the draught over length and beam, [y, x] from the stern's starboard to
        the bow's port, or None for 1 - r² over an ellipse

    Towards its edges it goes down to 0 as 1 - r², over half the breadth b of its widest part, and it is
    softened as by exp(-(0.15 k b)²): blunt edges would make waves of any shortness, which fold.
    """
    spacing = beam / (_FINE if shape is None else _FINE_SHAPE)
    reach = _SOFT_REACH * beam / spacing
    rows, columns = (2 * math.ceil(0.5 * side / spacing + reach) + 1 for side in (beam, length))
    y = (np.arange(rows) - rows // 2)[:, np.newaxis] * (2.0 * spacing / beam)
    x = (np.arange(columns) - columns // 2) * (2.0 * spacing / length)
    if shape is None:
        breadth = beam
        depth = np.maximum(1.0 - x * x - y * y, 0.0)
    else:
        depth = _between_samples(shape, x, y)
        edge = _from_edge(depth > _THERE * np.max(depth), 0.5 * beam / spacing)
        half = float(np.max(edge))
        breadth = 2.0 * half * spacing
        depth *= 1.0 - (1.0 - edge / half) ** 2
    k = np.hypot(
        2.0 * np.pi * np.fft.fftfreq(rows, spacing)[:, np.newaxis],
        2.0 * np.pi * np.fft.rfftfreq(columns, spacing),
    )
    soft = np.exp(-((_SOFTNESS * breadth * k) ** 2))
    return Footprint.of(draught * np.fft.irfft2(np.fft.rfft2(depth) * soft, (rows, columns)), spacing)


def _between_samples(shape: Array, x: NDArray[np.floating], y: NDArray[np.floating]) -> Array:
    """Shares (Y, X) over -1…1 either way, x (X,) and y (Y, 1); 0 beyond."""
    across, along = (
        np.clip((0.5 * place + 0.5) * count - 0.5, 0.0, count - 1.0)
        for place, count in zip((y, x), shape.shape, strict=True)
    )
    row, column = np.broadcast_arrays(across, along)
    inside = (np.abs(x) <= 1.0) & (np.abs(y) <= 1.0)
    found: Array = inside * between(row, column, shape.shape).read(shape)
    return found


def _from_edge(there: NDArray[np.bool_], most: float) -> Array:
    """Distance in samples of those that are there from the nearest edge, half a sample off what is not."""
    reach = math.ceil(most + 0.5)
    rows, columns = there.shape
    beyond = np.pad(~there, reach, constant_values=True)
    nearest = np.full(there.shape, most)
    for down in range(2 * reach + 1):
        for right in range(2 * reach + 1):
            off = math.hypot(down - reach, right - reach) - 0.5
            if off < most:
                near = beyond[down : down + rows, right : right + columns]
                np.minimum(nearest, max(off, 0.0), out=nearest, where=near)
    return nearest
