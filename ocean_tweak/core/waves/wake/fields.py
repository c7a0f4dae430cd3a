# SPDX-License-Identifier: GPL-3.0-or-later
"""The waves of one object as fields at any places of a sea."""

from __future__ import annotations

import threading
from collections.abc import Iterable
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...masks.weights import Weights, unweighted, weighted
from ...numerics.interpolation import Reader, smoothstep, smoothstep_slope, wrapped
from ...numerics.memo import MEMO, total_bytes
from .elevation import Basin, Past
from .footprint import Footprint
from .track import Track

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]
ComplexArray = NDArray[np.complexfloating]
#: a component of the displacement, 0…2, and what it is differentiated by: "", "x", "y" or "t"
Key = tuple[int, str]

_Z = 2
#: width in which waves go down to 0 at the end of their area, in its side
_RIM = 0.25
#: of a path, how many pasts are kept at the ends of pieces, from which a frame goes on, and after how many
#: pieces at least there is one
_PASTS, _STRIDE = 8, 32

#: fields, of which a frame wants up to twelve, and what they are made of
_FIELDS, _MOMENTS = "wakes' fields", "wakes"
MEMO.limit(_FIELDS, 4)


class Where(NamedTuple):
    """Centre of an object's waves: (x, y) in m, or the object itself."""

    x: float
    y: float
    follows: bool


class _Moment(NamedTuple):
    """ĥ and ∂ĥ/∂t at one time."""

    elevation: ComplexArray
    rate: ComplexArray

    @property
    def nbytes(self) -> int:
        """Bytes of both."""
        return total_bytes(self)


class WakeWaves:
    """The waves of an object that moves along a track and presses its footprint into the water.

    orbit_depth : depth in m for the horizontal orbital motion; infinite for deep water
    """

    def __init__(
        self, basin: Basin, track: Track, footprint: Footprint, where: Where, orbit_depth: float
    ) -> None:
        self._basin, self._track, self._footprint, self._where = basin, track, footprint, where
        self._orbit_depth = orbit_depth
        self._pasts: dict[int, Past] = {}
        self._stride = _STRIDE
        self._busy = threading.Lock()

    @property
    def nbytes(self) -> int:
        """Bytes of the cached pasts."""
        return total_bytes(tuple(self._pasts.values()))  # another thread may be adding one

    def at(
        self, x: Array, y: Array, time: float, keys: Iterable[Key], choppiness: float
    ) -> dict[Key, RealArray]:
        """Components of the displacement at rest positions in m, of one flat shape; 0 outside the area."""
        keys = frozenset(keys)
        place, velocity = self._middle(time)
        side = self._basin.area
        off_x, off_y = x - place[0], y - place[1]
        inside = np.flatnonzero(off_x * off_x + off_y * off_y < 0.25 * side * side)
        result: dict[Key, RealArray] = {key: np.zeros(x.size, np.float32) for key in keys}
        if not inside.size:
            return result
        reader = Reader(x[inside], y[inside], side, self._basin.resolution)
        found: dict[Key, RealArray] = {}
        for key in sorted(unweighted(keys, moves=self._where.follows)):
            found[key] = reader.read(self._field(time, key))
            if key[0] != _Z:
                found[key] *= np.float32(choppiness)
        under = _rim(off_x[inside], off_y[inside], side, velocity)
        for key, field in weighted(found, under).items():
            if key in result:
                result[key][inside] = field
        return result

    def _middle(self, time: float) -> tuple[tuple[float, float], tuple[float, float]]:
        """Centre of the area in m, and its velocity in m/s."""
        if self._where.follows:
            return self._track.place(time)
        return (self._where.x, self._where.y), (0.0, 0.0)

    def _field(self, time: float, key: Key) -> RealArray:
        """(N+1)² flat float32, before choppiness."""
        return MEMO.get(_FIELDS, (self, time, key), lambda: self._made(time, key))

    def _made(self, time: float, key: Key) -> RealArray:
        """The displacement has k/|k| of the elevation, a quarter of a wave on: D = i k/|k| ĥ."""
        component, by = key
        basin, moment = self._basin, self._moment(time)
        spectrum = moment.rate if by == "t" else moment.elevation
        along = (basin.kx, basin.ky)
        spectrum = spectrum * np.float32(basin.scale)
        if component != _Z:
            spectrum *= self._orbits
            spectrum *= (1j * along[component]).astype(np.complex64)
        if by in ("x", "y"):
            spectrum *= (1j * along["xy".index(by)]).astype(np.complex64)
        field = np.fft.irfft2(spectrum, basin.shape)
        return wrapped(field, np.float32).reshape(-1)

    def _moment(self, time: float) -> _Moment:
        def make() -> _Moment:
            past = self._past(time)
            return _Moment(past.elevation(), past.rate())

        return MEMO.get(_MOMENTS, (self, time), make)

    @cached_property
    def _orbits(self) -> RealArray:
        """1/|k|, wider in shallow water by coth kh where orbits are."""
        k = np.hypot(self._basin.kx, self._basin.ky)
        k = np.maximum(k, np.pi / self._basin.area)  # the mean is no wave
        return (1.0 / (k * np.tanh(k * self._orbit_depth))).astype(np.float32)

    def _past(self, time: float) -> Past:
        """The waves at a time, with the same bytes from any cached past."""
        done, way = self._track.until(time)
        if time < self._track.first.end:
            return Past(self._basin, self._footprint, self._track.first.ending(time))
        with self._busy:
            begin = max((count for count in self._pasts if count <= len(done)), default=-1)
            if begin < 0:
                past, begin = Past(self._basin, self._footprint, self._track.first), 0
            else:
                past = self._pasts[begin].copy()
            while begin < len(done):
                end = min((begin // self._stride + 1) * self._stride, len(done))
                past.go_on(done[begin:end])
                begin = end
                self._keep(begin, past.copy())
        if way is not None:
            past.go_on([way])
        return past

    def _keep(self, count: int, past: Past) -> None:
        """Thin out cached pasts: drop every other one, except the newest."""
        self._pasts[count] = past
        while len(self._pasts) > _PASTS:
            self._stride *= 2
            kept = [each for each in self._pasts if each % self._stride == 0 or each == count]
            self._pasts = {each: self._pasts[each] for each in kept}


def _rim(off_x: Array, off_y: Array, side: float, velocity: tuple[float, float]) -> Weights:
    """1 around the middle of an area that moves, 0 from half its side on, and smooth between: a square would
    show in its corners what has come around the area's sides.
    """
    distance = np.hypot(off_x, off_y)
    part = (0.5 - distance / side) / _RIM
    slope = -smoothstep_slope(part) / (_RIM * side) / np.maximum(distance, 1e-9 * side)
    by_x, by_y = slope * off_x, slope * off_y
    by_t = -(velocity[0] * by_x + velocity[1] * by_y)
    return Weights(smoothstep(part), by_x, by_y, by_t)
