# SPDX-License-Identifier: GPL-3.0-or-later
"""Measured or forecast spectra at one place and several times, with E(f, θ) interpolated in between.

Energies are given per bin. Over frequency, the density is the derivative of a monotone cubic through the
cumulative energy at the bins' edges, so each bin keeps its energy exactly and E is nowhere negative. Between
times it is linear.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..data.errors import ParameterError
from ..data.raster import Raster
from ..data.validation import Validated, number, raster, switch
from .maximum_entropy import feasible, maximum_entropy

Array = NDArray[np.float64]

#: number of directions in a table of E(f, θ), half a degree apart
DIRECTIONS = 720

#: fraction of the way from the centre of a bin to that of the next over which directions change
_BLENDED = 0.5

#: of the frequency of the last bin with energy, from which on bins tell how high the tail is
_NEAR_LAST = 0.85

_TURN = 2.0 * np.pi


@dataclass(frozen=True)
class MeasuredSpectra(Validated):
    """Spectra of one place. Directions are towards which waves travel, counter-clockwise from east.

    Raises ParameterError for invalid spectra.

    Examples
    --------
    >>> from ocean_tweak.core import MeasuredSpectra, Raster
    >>> bins = Raster([[[0.08, 0.02], [0.10, 0.02], [0.12, 0.02]]])  # middles and widths, Hz
    >>> swell = MeasuredSpectra(frequencies=bins, energy=Raster([[5.0, 12.0, 3.0]]))
    >>> float(round(4.0 * swell.table(0.0, np.ones((3, 720)) / 6.283).m0 ** 0.5, 2))
    2.53
    """

    frequencies: Raster = raster(
        "Middle and width of each bin in Hz, one row, ascending", channels=2, optional=False
    )
    energy: Raster = raster(
        "Energy in m²/Hz, a row for each time, a column for each frequency", channels=1, optional=False
    )
    moments: Raster | None = raster(
        "Moments a1, b1, a2, b2 of the directions, rows and columns as the energy", channels=4, left_out=True
    )
    directions: Raster | None = raster(
        "Shares of the energy by direction, evenly around the circle: a row for each frequency of each time",
        channels=1, left_out=True,
    )  # fmt: skip
    first_direction: float = number(
        0.0, -7.0, 7.0, "rad", "Direction of the first column of the shares", "a turn"
    )
    times: Raster | None = raster(
        "Seconds from the first spectrum to each, one row, ascending", channels=1, left_out=True
    )
    wind: Raster | None = raster(
        "Wind in m/s at each time, one row: its x and y, towards which it blows", channels=2, left_out=True
    )
    absolute: bool = switch(
        True,
        "Frequencies are those at a fixed place, which a current changes; otherwise those in still water",
    )
    tail: bool = switch(
        False, "Continue the energy beyond the highest frequency that has some as f⁻⁵, with its directions"
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        self._check_frequencies()
        bins, times = self.frequencies.shape[1], self.energy.shape[0]
        if self.times is None and times > 1:
            raise ParameterError("times", None, f"must be given for {times} spectra")
        if not np.all(np.diff(self.seconds) > 0.0):
            raise ParameterError("times", self.seconds.tolist(), "must ascend")
        if self.moments is not None and self.directions is not None:
            raise ParameterError("directions", self.directions, "must be left out where there are moments")
        directions = 1 if self.directions is None else max(4, self.directions.shape[1])
        for name, shape in (
            ("energy", (times, bins)), ("moments", (times, bins)), ("directions", (times * bins, directions)),
            ("times", (1, times)), ("wind", (1, times)),
        ):  # fmt: skip
            values: Raster | None = getattr(self, name)
            if values is None:
                continue
            if values.shape[:2] != shape:
                raise ParameterError(name, values, f"must have {shape[0]} rows and {shape[1]} columns")
            if name in ("energy", "directions") and np.any(values.values < 0.0):
                raise ParameterError(name, values, "must not be negative anywhere")

    def _check_frequencies(self) -> None:
        f, width = self.bins
        if self.frequencies.shape[0] != 1 or len(f) < 2 or not np.all((f > 0.0) & (width > 0.0)):
            reason = "must be one row of at least 2 frequencies and widths above 0"
            raise ParameterError("frequencies", self.frequencies, reason)
        if not np.all(np.diff(f) > 0.0):
            raise ParameterError("frequencies", self.frequencies, "must ascend")
        if not bin_edges(f, width)[0] > 0.0:
            reason = "must leave the lowest bin above 0 Hz: its width is more than twice its frequency"
            raise ParameterError("frequencies", self.frequencies, reason)

    @property
    def bins(self) -> tuple[Array, Array]:
        """Centres and widths of the bins in Hz."""
        values = self.frequencies.values.astype(np.float64)
        return values[0, :, 0], values[0, :, 1]

    @property
    def seconds(self) -> Array:
        """Time of each spectrum after the first, s."""
        return np.zeros(1) if self.times is None else self.times.values[0, :, 0].astype(np.float64)

    @property
    def has_directions(self) -> bool:
        """Whether it has directions, or energies only."""
        return self.moments is not None or self.directions is not None

    def weights(self, time: float) -> tuple[int, int, float]:
        """Indices of the spectra before and after a time in s, and the weight of the later one; beyond the
        ends a single one."""
        seconds = self.seconds
        later = int(np.clip(np.searchsorted(seconds, time, side="right"), 1, max(1, len(seconds) - 1)))
        if len(seconds) == 1:
            return 0, 0, 0.0
        share = (time - seconds[later - 1]) / (seconds[later] - seconds[later - 1])
        return later - 1, later, float(np.clip(share, 0.0, 1.0))

    def wind_at(self, time: float) -> complex | None:
        """Wind in m/s, x + iy, at a time in s after the first spectrum; None if not measured."""
        if self.wind is None:
            return None
        before, after, share = self.weights(time)
        x, y = self.wind.values[0].astype(np.float64).T
        first, last = complex(x[before], y[before]), complex(x[after], y[after])
        return first + share * (last - first)

    def energy_at(self, time: float) -> Array:
        """(bins,) m²/Hz at a time in s after the first spectrum: linear between spectra."""
        before, after, share = self.weights(time)
        rows = self.energy.values[..., 0].astype(np.float64)
        return rows[before] + share * (rows[after] - rows[before])

    def table(self, time: float, otherwise: Array | None = None) -> EnergyTable:
        """E(f, θ) at a time in s after the first spectrum.

        otherwise : (bins, DIRECTIONS) D in 1/rad for spectra without directions
        """
        before, after, share = self.weights(time)
        parts = [(before, 1.0 - share), (after, share)] if share > 0.0 else [(before, 1.0)]
        rows = self.energy.values[..., 0].astype(np.float64)
        total, of_all = np.zeros(rows.shape[1]), np.zeros((rows.shape[1], DIRECTIONS))
        without_energy = np.zeros_like(of_all)
        for index, weight in parts:
            spread = otherwise if otherwise is not None else self._spread(index)
            total += weight * rows[index]
            of_all += (weight * rows[index])[:, np.newaxis] * spread
            without_energy += weight * spread
        spread = np.divide(of_all, total[:, np.newaxis], out=without_energy, where=total[:, np.newaxis] > 0.0)
        return EnergyTable(*self.bins, total, spread, self.tail)

    def _spread(self, index: int) -> Array:
        """(bins, DIRECTIONS) D in 1/rad of one of the spectra."""
        theta = table_directions()
        if self.moments is not None:
            return maximum_entropy(feasible(self.moments.values[index]), theta)
        assert self.directions is not None
        bins, count = self.frequencies.shape[1], self.directions.shape[1]
        shares = self.directions.values[index * bins : (index + 1) * bins, :, 0].astype(np.float64)
        result = np.maximum(_around(shares, (theta - self.first_direction) * (count / _TURN)), 0.0)
        sums = np.sum(result, axis=-1, keepdims=True) * (_TURN / DIRECTIONS)
        return np.divide(result, sums, out=np.full_like(result, 1.0 / _TURN), where=sums > 0.0)


def table_directions() -> Array:
    """(DIRECTIONS,) rad, the directions of a table's columns."""
    return np.linspace(0.0, _TURN, DIRECTIONS, endpoint=False)


def _around(values: Array, position: Array) -> Array:
    """(rows, places) periodic interpolation between columns by a Catmull-Rom cubic, which preserves low
    harmonics."""
    below = np.floor(position).astype(np.int64)
    t = position - below
    count = values.shape[-1]
    weights = (
        0.5 * t * (-1.0 + t * (2.0 - t)), 1.0 + 0.5 * t * t * (3.0 * t - 5.0),
        0.5 * t * (1.0 + t * (4.0 - 3.0 * t)), 0.5 * t * t * (t - 1.0),
    )  # fmt: skip
    parts = [w * values[:, (below + step) % count] for step, w in zip((-1, 0, 1, 2), weights, strict=True)]
    return np.asarray(sum(parts))


class EnergyTable:
    """E(f, θ) = S(f)·D(f, θ) at one time, at any frequency and direction.

    f, width : (bins,) Hz
    energy : (bins,) m²/Hz, means over the bins
    spread : (bins, DIRECTIONS) D in 1/rad
    tail : whether S continues beyond the last bin as f⁻⁵
    """

    def __init__(self, f: Array, width: Array, energy: Array, spread: Array, tail: bool) -> None:
        self.f, self.width, self.energy, self._spread, self._tail = f, width, energy, spread, tail
        self.edges = bin_edges(f, width)
        self._slopes = _edge_densities(width, energy)

    @property
    def nbytes(self) -> int:
        """Bytes of the spreading, nearly all of the memory."""
        return int(self._spread.nbytes)

    @property
    def m0(self) -> float:
        """Variance of the elevation in m²: the sum of the bins and of the tail, if there is one."""
        own = float(self.energy @ self.width)
        return own + self._tail_factor / (4.0 * self._tail_from**4)

    @cached_property
    def _last(self) -> int:
        """The number of the last bin that has energy: small energies are rounded to none in files."""
        return int(np.max(np.nonzero(self.energy > 0.0)[0], initial=0))

    @property
    def _tail_from(self) -> float:
        return float(self.edges[self._last + 1])

    @cached_property
    def _tail_factor(self) -> float:
        """S·f⁵ of the tail in m²·Hz⁴: the mean of the last bins with energy, which are rounded too."""
        if not self._tail:
            return 0.0
        f, energy = self.f[: self._last + 1], self.energy[: self._last + 1]
        near = f >= _NEAR_LAST * f[-1]
        return float(np.mean(energy[near] * f[near] ** 5))

    def frequency_spectrum(self, f: Array) -> Array:
        """S in m²/Hz at frequencies in Hz, any shape; 0 outside of the bins."""
        index = np.clip(np.searchsorted(self.edges, f, side="right") - 1, 0, len(self.f) - 1)
        t = np.clip((f - self.edges[index]) / self.width[index], 0.0, 1.0)
        left, right = self._slopes[index], self._slopes[index + 1]
        density = 6.0 * self.energy[index] * t * (1.0 - t)
        density += left * (1.0 - t) * (1.0 - 3.0 * t) + right * t * (3.0 * t - 2.0)
        inside = (f >= self.edges[0]) & (f < self.edges[-1])
        result = np.where(inside, np.maximum(density, 0.0), 0.0)
        if self._tail:
            beyond = f >= self._tail_from
            result[beyond] = self._tail_factor / f[beyond] ** 5
        return result

    def spreading(self, f: Array, theta: Array) -> Array:
        """D in 1/rad at frequencies in Hz and directions in rad, broadcast."""
        below, share = self._between_bins(f)
        position = np.mod(theta, _TURN) * (DIRECTIONS / _TURN)
        column = np.minimum(position.astype(np.int64), DIRECTIONS - 1)
        part = position - column
        after = (column + 1) % DIRECTIONS

        def row(index: NDArray[np.int64]) -> Array:
            low = self._spread[index, column]
            return low + part * (self._spread[index, after] - low)

        first = row(below)
        return first + share * (row(below + 1) - first)

    def mean_vector(self, f: Array) -> NDArray[np.complex128]:
        """∫D e^{iθ} dθ at frequencies in Hz."""
        below, share = self._between_bins(f)
        of_bins = self._vectors
        return of_bins[below] + share * (of_bins[below + 1] - of_bins[below])

    @cached_property
    def sharpest(self) -> float:
        """The largest D in 1/rad of bins with energy; 0 without any."""
        return float(np.max(self._spread[self.energy > 0.0], initial=0.0))

    @cached_property
    def _vectors(self) -> NDArray[np.complex128]:
        return np.asarray(self._spread @ np.exp(1j * table_directions()) * (_TURN / DIRECTIONS), complex)

    def _between_bins(self, f: Array) -> tuple[NDArray[np.int64], Array]:
        """The bin below, and the weight of the next one, which is 0 or 1 within most of a bin."""
        position = np.interp(f, self.f, np.arange(len(self.f)))
        below = np.minimum(position.astype(np.int64), len(self.f) - 2)
        share = np.clip((position - below - 0.5) / _BLENDED + 0.5, 0.0, 1.0)
        return below, share


def bin_edges(f: Array, width: Array) -> Array:
    """(bins + 1,) Hz: edges of adjacent bins, shifted as a whole to match most of the centres."""
    edges = np.concatenate(([0.0], np.cumsum(width)))
    return edges + float(np.median(f - 0.5 * (edges[1:] + edges[:-1])))


def bin_widths(f: Array) -> Array:
    """(bins,) widths in Hz of bins of which only the centres are known.

    If the distance to a neighbour equals that of the neighbour to the next, it is the width, as instruments
    use runs of equal bins. Otherwise it is half the distance between both neighbours.
    """
    step = np.diff(f)
    width = np.gradient(f)
    same = np.abs(np.diff(step)) < 1e-6
    width[:-2][same] = step[:-1][same]
    width[2:][same] = step[1:][same]
    width[1:-1][same] = step[:-1][same]
    width[0] = min(width[0], f[0])  # it must end above 0
    return width


def _edge_densities(width: Array, energy: Array) -> Array:
    """(bins + 1,) density at each edge, of fourth order over the number of the bin (Colella & Woodward 1984,
    eq. 1.6), so that a peak lies where the bins around it say; held to where a cubic is monotone (Fritsch &
    Carlson 1980), nowhere more than three times what is in either bin."""

    def at_edges(values: Array) -> Array:
        v = np.pad(values, 2, mode="edge")
        return 7.0 * (v[1:-2] + v[2:-1]) - (v[:-3] + v[3:])

    s = np.pad(energy, 1, mode="edge")
    return np.clip(at_edges(energy * width) / at_edges(width), 0.0, 3.0 * np.minimum(s[:-1], s[1:]))
