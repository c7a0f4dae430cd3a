# SPDX-License-Identifier: GPL-3.0-or-later
"""One frequency over a varying depth, from the open sea towards the shore.

The bottom does not move, so what a wave of one frequency becomes is a fixed complex picture A(x, y), of which
the elevation is Re A e^(-iωt). It is marched row by row along x (angular spectrum marching: Dalrymple and
Kirby 1988; Dalrymple, Suh, Kirby and Chae 1989), in the amplitude of the energy's flux along x,
F = √(Cg qx/k) A. From a row to the next the phase of a wave (kx, ky) grows by q Δx, q = √(k² - ky²), in which
k differs from place to place. With k̄ the row's mean and δk = k - k̄,

    q ≈ q̄ + δk + (k̄/q̄ - 1) δk - ky²/(2 q̄³) δk²

The first term is a factor of each wave along y, the second one of each place; the last two, by which waves at
an angle differ from those straight on, are both, made symmetric and applied as an exponential's series to the
third order.

What arrives before a wall may be thrown back: from there it runs the other way in the same manner.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...data.validation import check_range, real_array
from ...numerics.threads import run_blocks
from ...spectral import constants
from .wide_angle import Band, series, squares, turned

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complexfloating]

#: m, below which water counts as that deep; radians of a wave in a step
SHALLOWEST, MOST_TURN = 0.05, 1.2
#: largest |δk| that the last terms take, and smallest cosine, as shares of k̄ and 1
_LARGEST_CHANGE, _SMALLEST_COSINE = 0.35, 0.33
#: |ky|/k̄ from which on waves along the shore fade, and how quickly
_FADE_FROM, _FADE_OVER = 0.95, 0.03
#: m, over which the direction of waves at a place is averaged, and a share of the width
_DIRECTION_OVER, _MOST_OF_WIDTH = 60.0, 0.125
#: of row 0, how many times as deep it may be in one place as in another
_UNEVEN = 1.5
#: B and γ of Thornton and Guza (1983)
_INTENSITY, BREAKER_INDEX = 1.0, 0.42
#: rad/s, least and greatest, and m, the highest: beyond them numbers overflow
_SLOWEST, _QUICKEST, _HIGHEST = 1e-6, 1e6, 1e6
#: m, deeper than any wave feels
_DEEPEST = 1e9
#: waves that are marched together
_TOGETHER = 24
#: rise of land over run from which on it is a wall
_STEEP = 1.0


def propagate(
    depth: ArrayLike,
    spacing: float,
    omega: ArrayLike,
    ky: ArrayLike,
    *,
    gravity: float = constants.GRAVITY,
    breaking: ArrayLike | None = None,
    mirror: float = 0.0,
    workers: int = 1,
) -> ComplexArray:
    """Complex pictures (C, Nx, Ny) of incident waves of amplitude 1 and phase 0 at row 0 and y = 0.

    depth : (Nx, Ny) m, row 0 offshore, periodic along y; 0 and less is land, where pictures are 0
    spacing : between samples, m
    omega, ky : (C,) rad/s, and rad/m along y, any real numbers; the phase grows as ky·y
    breaking : (C,) m, amplitudes of the incident waves; with them, all together lose what breaking takes
    mirror : 0…1, share of their height that walls throw back to where they came from

    Raises ValueError for a bed that cannot be marched over and for waves that do not run towards the shore.

    Examples
    --------
    >>> from ocean_tweak.core.waves.coast import propagate
    >>> beach = np.linspace(10.0, 1.0, 91)[:, np.newaxis] * np.ones(16)
    >>> pictures = propagate(beach, 2.0, omega=[0.7], ky=[0.0])
    >>> pictures.shape, round(float(np.abs(pictures[0, -1, 0])), 2)  # so much higher where it is 1 m deep
    ((1, 91, 16), 1.59)
    """
    bed, (w, along) = Bed.of(depth, spacing, gravity), _waves(omega, ky)
    base = 2.0 * np.pi / (bed.depth.shape[1] * bed.spacing)
    order = np.rint(along / base)
    _check_shoreward(bed, w, along)
    incident = np.exp(1j * (order * base)[:, np.newaxis] * bed.spacing * np.arange(bed.depth.shape[1]))
    amplitudes = None if breaking is None else _amplitudes(breaking, len(w))
    # what is left of ky beside a whole multiple is taken off the field, and put onto each wave along y
    check_range("mirror", mirror, 0.0, 1.0, "")
    return march(bed, w, incident, along - order * base, amplitudes, mirror, workers)


def march(
    bed: Bed,
    omega: Array,
    incident: ComplexArray,
    rest: Array | None = None,
    amplitudes: Array | None = None,
    mirror: float = 0.0,
    workers: int = 1,
    tell: Callable[[float], None] = lambda done: None,
) -> ComplexArray:
    """Pictures (C, Nx, Ny) complex64 of fields along row 0, each of one frequency.

    omega : (C,) rad/s
    incident : (C, Ny) of waves that run towards the shore, periodic along y but for a factor e^(i rest y)
    rest : (C,) rad/m, left off `incident`; none by default
    amplitudes : (C,) by which the pictures must be multiplied to be metres; with them, waves break
    mirror : 0…1, share of their height that walls throw back, once: what comes back to another wall is lost
    tell : is told again and again which share is done
    """
    rest = np.zeros(len(omega)) if rest is None else rest
    frequency = 0.0
    if amplitudes is not None:
        energy = amplitudes**2 * np.mean(np.abs(incident) ** 2, axis=1)
        # of all waves by their energy
        frequency = float(energy @ omega) / (2.0 * np.pi * max(float(energy.sum()), 1e-300))
    is_mirrored = mirror > 0.0 and bed.walls.any()
    share = 0.5 if is_mirrored else 1.0
    marching = _March(bed, omega, incident, rest, amplitudes, frequency)
    marching.run(workers, lambda done: tell(share * done))
    if is_mirrored:
        thrown_back = {
            len(bed.depth) - 1 - row: (bed.walls[row], mirror * flux)
            for row, flux in marching.arrived.items()
        }
        # what comes back runs the same way over the bed that lies the other way round
        back = _March(bed.reversed, omega, np.zeros_like(incident), rest, amplitudes, frequency, thrown_back)
        back.run(workers, lambda done: tell(share + share * done))
        marching.pictures += back.pictures[:, ::-1]
    return marching.pictures


@dataclass(frozen=True, eq=False)
class Bed:
    """What waves run over.

    depth : (Nx, Ny) m, of land that of the row's water; water : (Nx, Ny) where there is some
    walls : (Nx, Ny) where there is water before a wall: land that rises out of it steeply
    spacing : m
    gravity : m/s²
    """

    depth: Array
    water: NDArray[np.bool_]
    walls: NDArray[np.bool_]
    spacing: float
    gravity: float

    @property
    def reversed(self) -> Bed:
        """The same from its last row to its first."""
        return Bed(self.depth[::-1], self.water[::-1], self.walls[::-1], self.spacing, self.gravity)

    @classmethod
    def of(cls, depth: ArrayLike, spacing: float, gravity: float) -> Bed:
        """Raises ValueError, with the remedy, for depths that cannot be marched over."""
        h = real_array("depth", depth)
        if h.ndim != 2 or h.shape[0] < 2 or h.shape[1] < 2:
            raise ValueError(f"depth: must be at least 2 rows of 2 depths, not of shape {h.shape}")
        holes = int(np.count_nonzero(~np.isfinite(h)))
        if holes:
            raise ValueError(f"depth: {holes} of {h.size} are no numbers: fill the holes of the bed")
        # no wave feels what lies deeper, and powers of it overflow
        h = np.minimum(h, _DEEPEST)
        check_range("spacing", spacing, 1e-6, 1e6, "m")
        check_range("gravity", gravity, 1e-6, 1e6, "m/s²")
        water = h > 0.0
        if not water[0].all():
            raise ValueError(
                "depth: row 0 must be water all along, for waves come in there: "
                + (
                    "all is dry: depths are positive downwards"
                    if not water.any()
                    else "begin farther offshore"
                )
            )
        if h[0].max() > _UNEVEN * h[0].min():
            raise ValueError(
                f"depth: row 0, where waves come in, is from {h[0].min():g} to {h[0].max():g} m deep: make "
                "the first rows flat, or begin farther offshore"
            )
        wet = np.where(water, np.maximum(h, SHALLOWEST), 0.0)
        count = water.sum(axis=1, keepdims=True)
        mean = np.where(count > 0, wet.sum(axis=1, keepdims=True) / np.maximum(count, 1), SHALLOWEST)
        walls = np.zeros(h.shape, np.bool_)
        walls[:-1] = water[:-1] & ~water[1:] & (h[:-1] - h[1:] >= _STEEP * spacing)
        return cls(np.where(water, wet, mean), water, walls, float(spacing), float(gravity))


def _waves(omega: ArrayLike, ky: ArrayLike) -> tuple[Array, Array]:
    w, k = np.atleast_1d(real_array("omega", omega)), np.atleast_1d(real_array("ky", ky))
    if w.ndim != 1 or w.shape != k.shape:
        raise ValueError(f"omega and ky: must be rows of one length, not of shapes {w.shape} and {k.shape}")
    if not len(w):
        raise ValueError("omega: has no waves: give the frequency of one at least")
    for value in w.tolist():
        check_range("omega", value, _SLOWEST, _QUICKEST, "rad/s")
    if not np.isfinite(k).all():
        raise ValueError("ky: must be finite")
    return w, k


def _check_shoreward(bed: Bed, omega: Array, ky: Array) -> None:
    k = wave_numbers(omega[:, np.newaxis], bed.depth[0], bed.gravity).min(axis=1)
    against = np.abs(ky) >= k
    if against.any():
        index = int(np.argmax(against))
        raise ValueError(
            f"ky = {ky[index]:g} rad/m: wave {index} has {k[index]:g} rad/m at row 0, so it does not run "
            "towards the shore: leave it out"
        )


def _amplitudes(breaking: ArrayLike, count: int) -> Array:
    a = real_array("breaking", breaking)
    if a.shape != (count,):
        raise ValueError(f"breaking: must be {count} amplitudes, one of each wave, not of shape {a.shape}")
    for value in a.tolist():
        check_range("breaking", value, 0.0, _HIGHEST, "m")
    return a


def wave_numbers(omega: Array, depth: Array, gravity: float) -> Array:
    """k in rad/m of ω² = g k tanh kh, of arrays that broadcast, to 1e-12.

    By Halley's method from Eckart's (1952) start: that alone oscillates where depth changes slowly.
    """
    x = omega * omega * depth / gravity
    kh = x / np.sqrt(np.tanh(x))
    for _ in range(2):
        t = np.tanh(kh)
        flat = 1.0 - t * t
        miss, slope = kh * t - x, t + kh * flat
        kh -= miss * slope / (slope * slope - miss * flat * (1.0 - kh * t))
    return kh / depth


def group_speeds(omega: Array, k: Array, depth: Array) -> Array:
    """dω/dk in m/s."""
    kh2 = 2.0 * k * depth
    return omega / k * (0.5 + 0.5 * kh2 / np.sinh(np.minimum(kh2, 300.0)))


class _March:
    """All waves, a row after another; waves lose to breaking what all of them together tell."""

    def __init__(
        self,
        bed: Bed,
        omega: Array,
        incident: ComplexArray,
        rest: Array,
        amplitudes: Array | None,
        frequency: float,
        sources: Mapping[int, tuple[NDArray[np.bool_], ComplexArray]] = MappingProxyType({}),
    ) -> None:
        self._bed, self._omega, self._amplitudes = bed, omega, amplitudes
        self._frequency, self._sources = frequency, sources
        #: by row, (C, places before walls) flux that came to walls
        self.arrived = {
            row: np.zeros((len(omega), int(walls.sum())), np.complex128)
            for row, walls in enumerate(bed.walls) if walls.any()
        }  # fmt: skip
        rows, columns = bed.depth.shape
        along = 2.0 * np.pi * np.fft.fftfreq(columns, bed.spacing)
        self._ky = along + rest[:, np.newaxis]
        self._turn_back = np.exp(1j * rest[:, np.newaxis] * bed.spacing * np.arange(columns))
        half = min(_DIRECTION_OVER, _MOST_OF_WIDTH * columns * bed.spacing)
        self._smooth = np.exp(-0.5 * (along[: columns // 2 + 1] * half) ** 2)
        self.pictures = np.zeros((len(omega), rows, columns), np.complex64)
        self._parts = [slice(i, min(i + _TOGETHER, len(omega))) for i in range(0, len(omega), _TOGETHER)]
        self._k = np.empty((len(omega), columns))
        self._flux = incident.astype(np.complex128)
        #: what is left of all waves at each place of the last row, which they have not lost yet
        self._left = np.ones(columns)
        #: of each part, energy and flux of its waves at the last row
        self._sums = np.zeros((len(self._parts), 2, columns))
        for number, part in enumerate(self._parts):
            self._k[part] = self._at(part, 0)
            mean, speed = self._mean(part, 0)
            waves = np.fft.fft(self._flux[part]) * np.sqrt(_cosines(self._ky[part] ** 2, mean))
            self._flux[part] = np.fft.ifft(waves) * np.sqrt(speed)
            self._draw(number, 0)

    def run(self, workers: int, tell: Callable[[float], None]) -> None:
        """March to the last row."""
        rows = len(self._bed.depth)
        for row in range(1, rows):
            run_blocks(partial(self._step, row=row), range(len(self._parts)), workers)
            if self._amplitudes is not None:
                self._left = self._remaining(row)
                if row in self._sources:  # what begins here has not been on the way
                    self._left[self._sources[row][0]] = 1.0
            tell((row + 1) / rows)
        self.pictures[:, -1] *= self._left.astype(np.float32)

    def _at(self, part: slice, row: int) -> Array:
        k = wave_numbers(self._omega[part, np.newaxis], self._bed.depth[row], self._bed.gravity)
        return np.minimum(k, MOST_TURN / self._bed.spacing)

    def _step(self, number: int, row: int) -> None:
        part, dx = self._parts[number], self._bed.spacing
        if self._amplitudes is not None:
            self.pictures[part, row - 1] *= self._left.astype(np.float32)
        if row - 1 in self.arrived:
            walls = self._bed.walls[row - 1]
            self.arrived[row - 1][part] = self._flux[part][:, walls] * self._left[walls]
        before, after = self._k[part], self._at(part, row)
        k = 0.5 * (before + after)
        self._k[part] = after
        mean = k.mean(axis=1, keepdims=True)
        change = k - mean
        # no wave that is left lies beyond
        band = Band(self._ky[part], float(np.max(mean)) * (_FADE_FROM + 7.0 * _FADE_OVER))
        ky = band.ky
        q = np.sqrt(np.maximum(mean * mean - ky * ky, 0.0))
        share = np.abs(ky) / mean
        keep = np.exp(-((np.maximum(share - _FADE_FROM, 0.0) / _FADE_OVER) ** 2))
        steep = np.maximum(q, _SMALLEST_COSINE * mean)
        first = (mean / steep - 1.0) * keep
        second = -0.5 * ky * ky / steep**3 * keep
        screen, turn = turned(0.5 * dx * change), turned(0.5 * dx * q) * keep
        waves = band.of(np.fft.fft(self._flux[part] * (screen * self._left))) * turn
        d = np.clip(change, -_LARGEST_CHANGE * mean, _LARGEST_CHANGE * mean)
        if np.abs(d).max() * dx > 1e-12:
            waves = series(waves, band, d, first, second, dx)
        self._flux[part] = np.fft.ifft(band.whole(waves * turn)) * (screen * self._bed.water[row])
        if row in self._sources:
            walls, flux = self._sources[row]
            self._flux[part, walls] += flux[part]
        self._draw(number, row)

    def _draw(self, number: int, row: int) -> None:
        """A from F: of each wave along y as over the row's mean depth, and at each place what that leaves.

        The latter asks for the direction there: of all waves around by their energy, so that those that cross
        count each with their own, which a mean direction would not do.
        """
        part = self._parts[number]
        k, flux = self._k[part], self._flux[part]
        mean, speed = self._mean(part, row)
        ky = self._ky[part]
        waves = np.fft.fft(flux)
        waves *= 1.0 / np.sqrt(_cosines(ky * ky, mean))
        amplitude, slope = np.fft.ifft(waves), np.fft.ifft(1j * ky * waves)
        columns = k.shape[1]
        along, energy = (
            np.fft.irfft(np.fft.rfft(squares(each)) * self._smooth, columns) for each in (slope, amplitude)
        )
        along /= np.maximum(energy, 1e-9 * energy.max(axis=1, keepdims=True) + 1e-300)
        amplitude *= np.sqrt(_cosines(along, mean) / (_cosines(along, k) * speed)) * self._bed.water[row]
        if self._amplitudes is not None:
            share = self._amplitudes[part] ** 2
            self._sums[number] = share @ squares(amplitude), share @ squares(flux)
        amplitude *= self._turn_back[part]
        self.pictures[part, row] = amplitude

    def _mean(self, part: slice, row: int) -> tuple[Array, Array]:
        """k̄ of a row, and the speed of groups at each place."""
        k = self._k[part]
        speed = group_speeds(self._omega[part, np.newaxis], k, self._bed.depth[row])
        return k.mean(axis=1, keepdims=True), speed

    def _remaining(self, row: int) -> Array:
        """(columns,) what breaking on the way to a row leaves of all waves alike, taken implicitly or it
        would be stiff.

        Thornton and Guza (1983, eq. 20) for the energy ρ g H²/8, H being the root mean square height, with
        the flux's speed Cg cos θ of all waves together: dA/dx = -A a/2, in which a grows as H⁵.
        """
        energy, flux = self._sums.sum(axis=0)
        depth, height = self._bed.depth[row], np.sqrt(4.0 * energy)
        speed = flux / np.maximum(energy, 1e-300)
        loss = 1.5 * math.sqrt(math.pi) * _INTENSITY**3 * self._frequency * height**5
        loss /= BREAKER_INDEX**4 * depth**5 * np.maximum(speed, 1e-6)
        return (1.0 + 2.5 * loss * self._bed.spacing) ** -0.2


def _cosines(ky2: Array, k: Array) -> Array:
    """qx/k of waves with so much ky², floored."""
    return np.sqrt(np.maximum(1.0 - ky2 / (k * k), _SMALLEST_COSINE**2))
