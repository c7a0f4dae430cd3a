# SPDX-License-Identifier: GPL-3.0-or-later
"""What files of spectra hold: a record for each place, in the program's own conventions."""

from __future__ import annotations

import datetime
import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from ...core.data.errors import ParameterError
from ...core.data.raster import LARGEST_SIDE, Raster
from ...core.spectral.measured import DIRECTIONS, MeasuredSpectra, bin_widths, table_directions
from ...core.spectral.spectra import refined_peak

Array = NDArray[np.float64]

#: frequencies, directions and numbers of all spectra of a file together
MOST_FREQUENCIES, MOST_DIRECTIONS, MOST_NUMBERS = 1000, 720, 40_000_000

#: how times are written
TIME_FORMAT = "%Y-%m-%d %H:%M"


@dataclass(frozen=True)
class Record:
    """Spectra of one place. Directions are towards, in rad counter-clockwise from east.

    place : its name
    times : UTC, ascending; None for a spectrum without one
    f : (frequencies,) Hz, ascending
    energy : (times, frequencies) m²/Hz
    moments : (times, frequencies, 4) a₁, b₁, a₂, b₂, where that is what is told of directions
    shares : (times, frequencies, directions) of the energy, evenly around the circle, where those are told
    first_direction : of the shares, rad
    wind : (times,) complex m/s, x + iy
    absolute : whether frequencies are those that a fixed place sees
    notes : what was left out or filled in, one sentence each
    """

    place: str
    times: tuple[datetime.datetime | None, ...]
    f: Array
    energy: Array
    moments: Array | None = None
    shares: Array | None = None
    first_direction: float = 0.0
    wind: NDArray[np.complex128] | None = None
    absolute: bool = True
    notes: tuple[str, ...] = field(default=())

    def at(self, indices: Sequence[int]) -> Record:
        """Some of its spectra."""
        chosen = list(indices)
        return replace(
            self, times=tuple(self.times[index] for index in chosen), energy=self.energy[chosen],
            moments=None if self.moments is None else self.moments[chosen],
            shares=None if self.shares is None else self.shares[chosen],
            wind=None if self.wind is None else self.wind[chosen],
        )  # fmt: skip

    @property
    def seconds(self) -> Array:
        """Of each spectrum, after the first."""
        first = self.times[0]
        return np.array([(t - first).total_seconds() if t and first else 0.0 for t in self.times])

    def spectra(self, tail: bool = False) -> MeasuredSpectra:
        """What a wave layer takes. Raises ParameterError for more spectra than it can hold."""
        times, bins = self.energy.shape
        rows = times if self.shares is None else times * bins
        if rows > LARGEST_SIDE:
            most = LARGEST_SIDE // (rows // times)
            raise ParameterError(
                "time",
                f"{times} spectra",
                f"are more than the {most} that a layer can hold: choose fewer of them",
            )
        several = times > 1
        return MeasuredSpectra(
            frequencies=Raster(np.stack([self.f, bin_widths(self.f)], axis=-1)[np.newaxis]),
            energy=Raster(self.energy[..., np.newaxis], name=self.label),
            moments=None if self.moments is None else Raster(self.moments),
            directions=None if self.shares is None else Raster(self.shares.reshape(rows, -1, 1)),
            first_direction=self.first_direction,
            times=Raster(self.seconds[np.newaxis, :, np.newaxis]) if several else None,
            wind=None
            if self.wind is None
            else Raster(np.stack([self.wind.real, self.wind.imag], axis=-1)[np.newaxis]),
            absolute=self.absolute,
            tail=tail,
        )

    @property
    def label(self) -> str:
        """The place and the first of the times."""
        return " ".join([self.place, *(time_text(t) for t in self.times[:1] if t is not None)])

    def summary(self, index: int) -> Summary:
        """Heights, period and directions of one of the spectra: sums over its bins."""
        energy = self.energy[index] * bin_widths(self.f)
        m0 = float(np.sum(energy))
        peak = refined_peak(self.f, self.energy[index])
        if m0 <= 0.0 or (self.moments is None and self.shares is None):
            return Summary(4.0 * math.sqrt(m0), 1.0 / peak, math.nan, math.nan)
        vector = complex(np.sum(energy * self._vectors(index))) / m0
        spread = math.sqrt(max(0.0, 2.0 - 2.0 * abs(vector)))
        return Summary(4.0 * math.sqrt(m0), 1.0 / peak, math.atan2(vector.imag, vector.real), spread)

    def _vectors(self, index: int) -> NDArray[np.complex128]:
        """∫D e^{iθ} dθ of each frequency."""
        if self.moments is not None:
            return np.asarray(self.moments[index, :, 0] + 1j * self.moments[index, :, 1])
        assert self.shares is not None
        shares = self.shares[index]
        step = DIRECTIONS / shares.shape[1]
        theta = self.first_direction + table_directions()[: shares.shape[1]] * step
        return np.asarray(shares @ np.exp(1j * theta))


@dataclass(frozen=True)
class Summary:
    """What a spectrum's bins add up to: m, s and rad; NaN for what is not known.

    mean_direction : towards, counter-clockwise from east
    directional_spread : √(2 - 2r) (Kuik, van Vledder & Holthuijsen 1988)
    """

    significant_wave_height: float
    peak_period: float
    mean_direction: float
    directional_spread: float

    @property
    def comes_from(self) -> float:
        """Degrees clockwise from north, as sailors say it."""
        return (270.0 - math.degrees(self.mean_direction)) % 360.0


def time_text(time: datetime.datetime | None) -> str:
    """As it is printed; "no time" for none."""
    return "no time" if time is None else time.strftime(TIME_FORMAT)


def towards(degrees_from: Array) -> Array:
    """rad counter-clockwise from east, towards, of degrees clockwise from north from where waves come."""
    return np.radians(270.0 - degrees_from)


def filled_moments(
    first: NDArray[np.complex128], second: NDArray[np.complex128], energy: Array
) -> tuple[Array, list[str]]:
    """Moments with those of the nearest frequencies where they are missing, and what to tell of it.

    first, second, energy : (times, frequencies) a₁ + ib₁ and a₂ + ib₂, NaN where they are missing; m²/Hz

    Returns (times, frequencies, 4) a₁, b₁, a₂, b₂.
    """
    first, second = first.copy(), second.copy()
    known = np.isfinite(first) & np.isfinite(second)
    nowhere = ~known.any(axis=1)
    first[nowhere] = second[nowhere] = 0.0  # of all directions
    for index in np.nonzero(~nowhere)[0]:
        nearest, unknown = np.nonzero(known[index])[0], np.nonzero(~known[index])[0]
        source = nearest[np.argmin(np.abs(unknown[:, np.newaxis] - nearest), axis=1)]
        first[index, unknown], second[index, unknown] = first[index, source], second[index, source]
    notes = []
    filled = int(np.count_nonzero((energy > 0.0) & ~known & ~nowhere[:, np.newaxis]))
    if filled:
        notes.append(f"{filled} frequencies with energy had no direction: they have that of the nearest")
    if nowhere.any():
        notes.append(
            f"{np.count_nonzero(nowhere)} spectra had no direction at all: their waves go everywhere"
        )
    return np.stack([first.real, first.imag, second.real, second.imag], axis=-1), notes


def ordered(record: Record) -> Record:
    """The same spectra in the order of their times; of two at the same time the first."""
    if any(time is None for time in record.times):
        return record
    first: dict[datetime.datetime, int] = {}
    for index, time in enumerate(record.times):
        assert time is not None
        first.setdefault(time, index)
    result = record.at([first[time] for time in sorted(first)])
    left_out = len(record.times) - len(first)
    if left_out:
        result = replace(
            result, notes=(*result.notes, f"{left_out} spectra of times that stand twice are left out")
        )
    return result
