# SPDX-License-Identifier: GPL-3.0-or-later
"""Plans patches from three numbers: the finest detail, the area without repetition, and memory.

The first patch is as large as the area, so it does not repeat there. The others do, but together they hold at
most a tenth of the variance, so the autocorrelation of the sea at the distance of one of their domains is at
most a tenth. They are rotated by different fractions of a quarter turn, and the ratios of their sides are not
ratios of small integers, so their repetitions do not coincide.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations_with_replacement

import numpy as np
from numpy.typing import NDArray

from ..data.errors import ParameterError
from ..parameters.ocean_parameters import OceanParameters
from ..parameters.patch import LEAST_CELLS, LEAST_SAMPLES, MOST_PATCHES, REPEATING_SHARE, Patch
from ..spectral import dispersion
from ..statistics.sea_spectrum import SeaSpectrum
from ..waves.contribution import NO_LONGEST
from .memory import memory_need

Array = NDArray[np.float64]

#: allowed targets: minimum, maximum and unit
WISHES = {"finest": (1e-3, 1e4, "m"), "area": (0.1, 1e5, "m"), "memory": (1e6, 1e15, "bytes")}

#: resolutions that are tried
RESOLUTIONS = (64, 128, 192, 256, 384, 512, 768, 1024, 1536, 2048, 3072, 4096, 6144, 8192)

#: longest waves along a side, as many as memory allows, because repetition is less visible with more waves
_CELLS = (18.0, 12.0, 9.0, LEAST_CELLS)

#: resolution up to which a single patch, which does not repeat, is preferred to several
_ONE_PATCH = 1024

#: safety margin for rounding and for adjusting ratios
SPARE = 1.06
#: ratios of sides keep away from p/q with integers up to this
_WHOLE = 8
#: significant digits of lengths in m
_DIGITS = 4

_QUARTER = 0.5 * math.pi
_GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)


@dataclass(frozen=True)
class Wish:
    """The targets of a plan.

    finest : length in m of the shortest waves
    area : side in m of the square without repetition
    memory : bytes that the sea may use

    Raises ParameterError for numbers out of range.
    """

    finest: float
    area: float
    memory: float = 2.0**31

    def __post_init__(self) -> None:
        for name, (low, high, unit) in WISHES.items():
            value = getattr(self, name)
            if isinstance(value, bool) or not isinstance(value, (int, float)) or not low <= value <= high:
                raise ParameterError(f"plan.{name}", value, f"must be from {low:g} to {high:g} {unit}")
        if self.finest >= self.area:
            raise ParameterError("plan.finest", self.finest, f"must be below the area of {self.area:g} m")


def planned(parameters: OceanParameters, wish: Wish) -> OceanParameters:
    """The sea with patches that meet the targets: the largest that memory allows, and of those the cheapest.

    Raises ParameterError, with limits that would work, if no plan fits.
    """
    planner = _Planner(parameters)
    patches = planner.widest(wish)
    if patches is None:
        raise _refusal(planner, wish)
    return parameters.replace(patches=patches, trough_damping=0.0)


class _Planner:
    """Finds patches for a sea's spectrum."""

    def __init__(self, parameters: OceanParameters) -> None:
        self._parameters = parameters.without_patches
        sea = SeaSpectrum(self._parameters)
        self._longest = 0.0
        if np.isfinite(sea.peak_frequency):
            # of the layer with the longest waves: there must be enough cells around its peak
            slowest = min(layer.peak_frequency for layer in sea.layers)
            self._longest = 2.0 * math.pi / float(_wave_number(slowest, self._parameters))
        self._lengths, self._shares = _shares(sea)

    def widest(self, wish: Wish) -> tuple[Patch, ...] | None:
        """The patches that meet the targets with the most waves along a side; None if no plan fits."""
        for memory, resolutions in self._choices:
            if len(resolutions) == 1 and memory <= wish.memory and resolutions[0] <= _ONE_PATCH:
                patches = self._patches(wish, resolutions, LEAST_CELLS)
                if patches is not None:
                    return patches
        for cells in _CELLS:
            for memory, resolutions in self._choices:
                if memory > wish.memory:
                    break
                patches = self._patches(wish, resolutions, cells)
                if patches is not None:
                    return patches
        return None

    def least_memory(self, wish: Wish) -> int | None:
        """Smallest memory in bytes that meets the targets; None if no amount is enough."""
        for memory, resolutions in self._choices:
            if self._patches(wish, resolutions, LEAST_CELLS) is not None:
                return memory
        return None

    @cached_property
    def _choices(self) -> list[tuple[int, tuple[int, ...]]]:
        """Memory and resolutions of each patch, cheapest first."""
        cost = {resolution: self._memory(resolution) for resolution in RESOLUTIONS}
        choices = [
            (first, other, count)
            for count in range(1, MOST_PATCHES + 1)
            for other, first in combinations_with_replacement(RESOLUTIONS, 2)
            if count > 1 or first == other
        ]
        found = [
            (sum(cost[n][0] for n in sizes) + max(cost[n][1] for n in sizes), sizes)
            for sizes in ((first, *(other,) * (count - 1)) for first, other, count in choices)
        ]
        return sorted(found)

    def _memory(self, resolution: int) -> tuple[int, int]:
        """Bytes that each patch keeps, plus those that only one uses at a time."""
        need = memory_need(self._parameters.at_resolution(resolution))
        return need.state + need.surface, max(0, need.building - need.surface)

    def _patches(self, wish: Wish, resolutions: tuple[int, ...], cells: float) -> tuple[Patch, ...] | None:
        first, *others = resolutions
        side = rounded(max(wish.area, SPARE * LEAST_CELLS * self._longest))
        end = SPARE * LEAST_SAMPLES * side / first
        if not others:
            enough = end <= wish.finest * SPARE
            return (Patch(side, 0.0, wish.finest, NO_LONGEST, first),) if enough else None
        if end <= wish.finest or self._share_below(end) > REPEATING_SHARE:
            return None
        return _finer(Patch(side, 0.0, rounded(end), NO_LONGEST, first), wish.finest, others, cells)

    def _share_below(self, wavelength: float) -> float:
        """Fraction of the variance in waves shorter than a length in m."""
        return float(np.interp(wavelength, self._lengths, self._shares))


def _finer(first: Patch, finest: float, others: list[int], cells: float) -> tuple[Patch, ...] | None:
    """The patches of the shorter waves, each with an equal part of the remaining octaves."""
    patches = [first]
    ratio = (first.shortest_wavelength / finest) ** (1.0 / len(others))
    for index, resolution in enumerate(others, 1):
        longest = patches[-1].shortest_wavelength
        shortest = rounded(longest / ratio) if index < len(others) else finest
        low = SPARE * cells * longest
        high = shortest * resolution / LEAST_SAMPLES
        if low > high or shortest >= longest:
            return None
        side = odd_side(low, min(high, 0.8 * patches[-1].domain_size), patches)
        if side is None:
            return None
        patches.append(Patch(side, rotation_of(index), shortest, longest, resolution))
    return tuple(patches)


def rotation_of(index: int) -> float:
    """Rotation in rad of a patch by its index, well apart from those of all others."""
    return round(_QUARTER * math.fmod(index * _GOLDEN, 1.0), _DIGITS)


def wavelength_with_share_below(parameters: OceanParameters, share: float) -> float:
    """Wavelength in m below which a fraction of the sea's variance lies; 0 for a flat sea."""
    lengths, shares = _shares(SeaSpectrum(parameters.without_patches))
    return float(np.interp(share, shares, lengths)) if shares[-1] > 0.0 else 0.0


def _wave_number(omega: float, parameters: OceanParameters) -> float:
    return float(dispersion.wave_number(omega, parameters.dispersion, parameters.water))


def _shares(sea: SeaSpectrum) -> tuple[Array, Array]:
    """Wavelengths in m, ascending, and the fraction of the variance in waves shorter than each."""
    omega, weight = sea.rule
    k = dispersion.wave_number(omega, sea.parameters.dispersion, sea.parameters.water)
    energy = (sea.frequency_spectrum(omega) * weight)[::-1]
    total = float(np.sum(energy))
    return 2.0 * np.pi / k[::-1], np.cumsum(energy) / (total if total > 0.0 else 1.0)


def rounded(length: float) -> float:
    """A length in m rounded up to few digits."""
    unit = 10.0 ** (math.floor(math.log10(length)) - _DIGITS + 1)
    return float(f"{math.ceil(length / unit - 1e-9) * unit:.{_DIGITS}g}")


def odd_side(low: float, high: float, patches: Sequence[Patch]) -> float | None:
    """A side in m between two lengths, preferably large, whose ratio to the others is not one of small
    integers."""
    if low > high:
        return None
    unit = 10.0 ** (math.floor(math.log10(high)) - _DIGITS + 1)
    sides = [
        float(f"{math.floor(side / unit) * unit:.{_DIGITS}g}")
        for side in np.linspace(high, max(low, 0.9 * high), 64)
    ]
    sides = [side for side in sides if side >= low / SPARE]
    return max(sides, key=lambda side: min(_oddness(patch.domain_size / side) for patch in patches))


def _oddness(ratio: float) -> float:
    """Distance of a ratio from the nearest p/q with q up to 8, as a fraction of the smaller side."""
    return min(abs(ratio * q - round(ratio * q)) for q in range(1, _WHOLE + 1))


def _refusal(planner: _Planner, wish: Wish) -> ParameterError:
    """The error for targets that cannot be met, with limits that would work."""
    remedies = []
    memory = planner.least_memory(wish)
    if memory is not None:
        remedies.append(f"memory of {math.ceil(memory / 1e6)} MB")
    finest = _nearest(lambda finest: _fits(planner, finest, wish.area, wish.memory), wish.finest, wish.area)
    if finest is not None:
        remedies.append(f"a finest wave of {rounded(finest):g} m")
    area = _nearest(lambda area: _fits(planner, wish.finest, area, wish.memory), wish.area, wish.finest)
    if area is not None:
        remedies.append(f"an area of {math.floor(area * 100) / 100:g} m")
    asked = f"finest {wish.finest:g} m, area {wish.area:g} m, memory {wish.memory / 1e6:.0f} MB"
    would = f"; {', or '.join(remedies)} would do" if remedies else "; ask for less detail in a smaller area"
    reason = "needs more memory" if memory is not None else f"is too much for {MOST_PATCHES} patches"
    return ParameterError("plan", asked, reason + would)


def _fits(planner: _Planner, finest: float, area: float, memory: float) -> bool:
    try:
        return planner.widest(Wish(finest, area, memory)) is not None
    except ParameterError:
        return False


def _nearest(fits: Callable[[float], bool], wanted: float, limit: float) -> float | None:
    """The number nearest to a target, in the direction of a limit, that fits; None if none does."""
    steps = [wanted * (limit / wanted) ** share for share in _ways()]
    good = next((index for index, value in enumerate(steps) if fits(value)), None)
    if good is None:
        return None
    bad, fitting = steps[max(0, good - 1)], steps[good]
    for _ in range(12):
        middle = math.sqrt(bad * fitting)
        bad, fitting = (bad, middle) if fits(middle) else (middle, fitting)
    return fitting


def _ways() -> Iterator[float]:
    return (index / 40.0 for index in range(1, 40))
