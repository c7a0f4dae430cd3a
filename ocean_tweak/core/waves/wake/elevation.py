# SPDX-License-Identifier: GPL-3.0-or-later
"""Linear waves of a moving pressure, integrated over its past.

A pressure p(x, t) = ρ g d(x - X(t)), with a draught d in m, excites each wave vector k (Havelock 1908) as

    ĥ'' + ω² ĥ = -ω² d̂ e^(-ik·X),    ĥ(k, t) = -ω d̂(k) ∫ e^(-ik·X(τ)) sin ω(t-τ) e^(-γ(t-τ)) dτ

with ω² = (g k + σ k³/ρ) tanh kh, and a decay γ. For a straight piece of the path the integral is elementary.
With its two exponentials kept separate, the contribution of all earlier pieces is two numbers per wave
vector, which rotate and decay from the end of one piece to that of the next.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...data.errors import ParameterError
from ...data.validation import check_range
from ...numerics.threads import row_blocks, run_blocks
from ...spectral import constants
from .footprint import Footprint
from .track import Piece, Track

Array = NDArray[np.float64]
RealArray = NDArray[np.float32]
ComplexArray = NDArray[np.complex64]

#: below this |z|, e^z - 1 is taken from its series
_SMALL = 1e-3

#: m/s, up to which phases hold in single precision
_FASTEST = 1e9
#: samples along a side of an area, at the most
_MOST_SAMPLES = 8192
#: s, up to which a time is known to some milliseconds
_LATEST = 1e12
#: least and greatest of a basin's numbers, and their units: beyond them single precision holds no wave
_RANGES = {
    "area": (1e-6, 1e9, "m"),
    "depth": (1e-6, math.inf, "m"),
    "gravity": (1e-6, 1e6, "m/s²"),
    "surface_tension": (0.0, 1e6, "N/m"),
    "decay": (1e-12, 1e6, "1/s"),
    "density": (1e-6, 1e6, "kg/m³"),
}


def wake_elevation(
    times: ArrayLike,
    positions: ArrayLike,
    time: float,
    *,
    area: float,
    resolution: int,
    footprint: ArrayLike,
    spacing: float,
    headings: ArrayLike | None = None,
    depth: float = math.inf,
    gravity: float = constants.GRAVITY,
    surface_tension: float = 0.0,
    decay: float = 0.01,
) -> Array:
    """Elevation in m of the waves of an object, (N, N) float64 [y, x] over the square [-area/2, area/2)².

    times, positions : (T,) s and (T, 2) m of its path; before the first sample it has moved at its first
        velocity, and after the last at its last velocity
    time : s
    area, resolution : side in m, and N, an even number
    footprint, spacing : (n, n) draught in m [y, x] in the object's frame, x forward, centred; cell size in m
    headings : (T,) rad, by default along the path
    depth : m
    surface_tension : N/m, for the density of fresh water
    decay : γ, rate at which waves fade, 1/s

    Raises ValueError with the name of an argument that is out of range or of another shape.

    Examples
    --------
    >>> import numpy as np
    >>> y, x = np.mgrid[-2.0:2.25:0.25, -2.0:2.25:0.25]
    >>> bump = 0.2 * np.exp(-(x**2 + y**2))
    >>> h = wake_elevation([0.0, 60.0], [[-120.0, 0.0], [120.0, 0.0]], 60.0, area=512.0, resolution=128,
    ...                    footprint=bump, spacing=0.25)
    >>> h.shape
    (128, 128)
    """
    track = Track.of(times, positions, headings)
    speed, sample = track.fastest
    if not speed <= _FASTEST:
        raise ParameterError(
            f"positions.{sample}", f"{speed:.3g} m/s",
            f"must be reached at {_FASTEST:g} m/s or less: where the object jumps, begin the path after it",
        )  # fmt: skip
    basin = Basin(area, resolution, depth, gravity, surface_tension, decay)
    check_range("time", time, -_LATEST, _LATEST, "s")
    past = Past.until(basin, _square(Footprint.of(footprint, spacing), area), track, time)
    shape = np.fft.irfft2(past.elevation(), basin.shape) * basin.scale
    return np.fft.fftshift(shape).astype(np.float64)  # NumPy 2 transforms in single precision


def _square(footprint: Footprint, area: float) -> Footprint:
    """Raise ValueError for a footprint that is not square, or larger than the area."""
    rows, columns = footprint.draught.shape
    if rows != columns:
        raise ValueError(
            f"footprint: must be square, not of shape {(rows, columns)}: fill it up with zeros around it"
        )
    side = footprint.spacing * rows
    if side > area:
        raise ValueError(
            f"footprint: is {side:g} m wide in an area of {area:g} m: make the area larger, or the spacing "
            "smaller"
        )
    return footprint


@dataclass(frozen=True)
class Basin:
    """The wave vectors of a square of water, with dispersion and decay; see `wake_elevation`.

    density : kg/m³
    """

    area: float
    resolution: int
    depth: float = math.inf
    gravity: float = constants.GRAVITY
    surface_tension: float = 0.0
    decay: float = 0.01
    density: float = constants.WATER_DENSITY

    def __post_init__(self) -> None:
        for name, (least, most, unit) in _RANGES.items():
            check_range(name, getattr(self, name), least, most, unit)
        samples = self.resolution
        if not isinstance(samples, (int, np.integer)) or not 4 <= samples <= _MOST_SAMPLES or samples % 2:
            raise ParameterError("resolution", samples, f"must be an even number from 4 to {_MOST_SAMPLES}")

    @property
    def shape(self) -> tuple[int, int]:
        """(N, N) samples."""
        return self.resolution, self.resolution

    @property
    def scale(self) -> float:
        """Factor from NumPy's transforms to waves in m."""
        return (self.resolution / self.area) ** 2

    @cached_property
    def ky(self) -> Array:
        """(N, 1) rad/m."""
        return 2.0 * np.pi * np.fft.fftfreq(self.resolution, self.area / self.resolution)[:, np.newaxis]

    @cached_property
    def kx(self) -> Array:
        """(1, N/2 + 1) rad/m."""
        return 2.0 * np.pi * np.fft.rfftfreq(self.resolution, self.area / self.resolution)[np.newaxis]

    @cached_property
    def omega(self) -> Array:
        """(N, N/2 + 1) rad/s; 0 at Nyquist."""
        k = np.hypot(self.kx, self.ky)
        tension = self.surface_tension / self.density
        slope = np.tanh(k * self.depth) if math.isfinite(self.depth) else 1.0
        omega = np.sqrt((self.gravity * k + tension * k**3) * slope)
        half = self.resolution // 2
        omega[half] = omega[:, half] = 0.0
        return omega

    def turns(self, span: float) -> tuple[ComplexArray, ComplexArray]:
        """e^((±iω - γ) span): rotation and decay of waves over a span in s."""
        found = self._turns.get(span)
        if found is None:
            self._turns.clear()  # a path has few spans, one after the other
            turn = np.exp((1j * self.omega - self.decay) * span).astype(np.complex64)
            found = self._turns[span] = turn, turn.conj()
        return found

    @cached_property
    def _turns(self) -> dict[float, tuple[ComplexArray, ComplexArray]]:
        return {}


class Past:
    """The waves of an object at the end of its latest piece: two numbers per wave vector.

    In single precision like the sea's own; phases are float64, along each axis.
    """

    @classmethod
    def until(cls, basin: Basin, footprint: Footprint, track: Track, time: float) -> Past:
        """The past of a track up to a time in s."""
        done, way = track.until(time)
        first = track.first
        past = cls(basin, footprint, first.ending(time) if time < first.end else first)
        past.go_on((*done, *(() if way is None else (way,))))
        return past

    def __init__(self, basin: Basin, footprint: Footprint, first: Piece) -> None:
        self._basin, self._footprint = basin, footprint
        self._omega = basin.omega.astype(np.float32)
        self._left = np.zeros((2, *basin.omega.shape), np.complex64)
        for rows in row_blocks(*basin.omega.shape):
            kv = self._along(first, rows)
            source = self._place(first, rows) * self._draught(first, rows)
            for sign, left in zip((1.0, -1.0), self._left, strict=True):
                left[rows] = source * self._inverse(kv + np.float32(sign) * self._omega[rows])
                np.negative(left[rows], out=left[rows])

    def go_on(self, pieces: Sequence[Piece], workers: int = 1) -> None:
        """Continue along pieces, each of which begins where the previous one ended."""
        begin = pieces[0].start if pieces else (0.0, 0.0)

        def work(rows: slice) -> None:
            place = _wave(-begin[1] * self._basin.ky[rows], -begin[0] * self._basin.kx)
            for piece in pieces:
                place = self._add(piece, rows, place)

        run_blocks(work, row_blocks(*self._omega.shape), workers)

    def elevation(self) -> ComplexArray:
        """ĥ in m³, (N, N/2 + 1)."""
        return (0.5j * self._omega) * (self._left[0] - self._left[1])

    def rate(self) -> ComplexArray:
        """∂ĥ/∂t in m³/s: the object's present contribution cancels in the difference."""
        turned = (-0.5 * self._omega**2) * (self._left[0] + self._left[1])
        return turned - np.float32(self._basin.decay) * self.elevation()

    def _add(self, piece: Piece, rows: slice, begin: ComplexArray) -> ComplexArray:
        """left becomes left e^z + d̂ e^(-ik·x) (e^z' - 1)/z', z' = i(k·v ± ω) - γ over the span.

        begin : e^(-ik·x) where the piece begins; returns that of its end
        """
        basin, span = self._basin, piece.end - piece.begin
        end, kv = self._place(piece, rows), self._along(piece, rows)
        draught = self._draught(piece, rows)
        for sign, left, turns in zip((1.0, -1.0), self._left, basin.turns(span), strict=True):
            turn = turns[rows]
            rate = kv + np.float32(sign) * self._omega[rows]
            integral = begin * turn
            integral -= end
            integral *= self._inverse(rate)
            if basin.decay * span < _SMALL:
                _mend(integral, end, rate, basin.decay, span)
            integral *= draught
            left[rows] *= turn
            left[rows] += integral
        return end

    def copy(self) -> Past:
        """An independent copy."""
        other = copy(self)
        other._left = self._left.copy()
        return other

    @property
    def nbytes(self) -> int:
        """Bytes of the two numbers."""
        return self._left.nbytes

    def _place(self, piece: Piece, rows: slice) -> ComplexArray:
        """e^(-ik·x) of its end."""
        x, y = piece.place
        return _wave(-y * self._basin.ky[rows], -x * self._basin.kx)

    def _draught(self, piece: Piece, rows: slice) -> RealArray | ComplexArray:
        """d̂ in m³."""
        draught = self._footprint.transform(self._basin.kx, self._basin.ky[rows], piece.heading)
        return draught if piece.immersion == 1.0 else draught * np.float32(piece.immersion)

    def _along(self, piece: Piece, rows: slice) -> RealArray:
        """k·v."""
        vx, vy = piece.velocity
        return (vx * self._basin.kx).astype(np.float32) + (vy * self._basin.ky[rows]).astype(np.float32)

    def _inverse(self, rate: RealArray) -> ComplexArray:
        """1/(i rate - γ)."""
        decay = np.float32(self._basin.decay)
        size = rate * rate
        size += decay * decay
        found = np.empty(rate.shape, np.complex64)
        np.divide(-decay, size, out=found.real)
        np.divide(rate, size, out=found.imag)
        np.negative(found.imag, out=found.imag)
        return found


def _wave(down: Array, along: Array) -> ComplexArray:
    """e^(i(down + along)), (Y, 1) and (1, X)."""
    return np.exp(1j * down).astype(np.complex64) * np.exp(1j * along).astype(np.complex64)


def _mend(integral: ComplexArray, end: ComplexArray, rate: RealArray, decay: float, span: float) -> None:
    """Replace end · span (e^z - 1)/z by its series where the difference has lost its digits."""
    small = np.abs(rate) * span < _SMALL
    z = (1j * rate[small] - decay) * span
    integral[small] = end[small] * span * (1.0 + z * (0.5 + z / 6.0))
