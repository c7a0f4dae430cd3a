# SPDX-License-Identifier: GPL-3.0-or-later
"""Patches from three numbers: the finest detail, the area that does not repeat, and memory.

The first patch is as large as the area, so nothing of it repeats there. The others do; but all waves that
they hold are a tenth of the variance at most, so the autocorrelation of the sea a domain of theirs away is a
tenth at most. Their sides are turned against each other by parts of a quarter turn, of which no two are
alike, and stand in no ratio of small whole numbers, so that what repeats in one does not in another.
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
from ..parameters.patch import LEAST_CELLS, LEAST_SAMPLES, MOST_PATCHES, NO_LONGEST, REPEATING_SHARE, Patch
from ..spectral import dispersion
from ..statistics.sea_spectrum import SeaSpectrum
from .memory import memory_need

Array = NDArray[np.float64]

#: what can be wished for: least, most and unit
WISHES = {"finest": (1e-3, 1e4, "m"), "area": (0.1, 1e5, "m"), "memory": (1e6, 1e15, "bytes")}

#: samples along a side that are tried
RESOLUTIONS = (64, 128, 192, 256, 384, 512, 768, 1024, 1536, 2048, 3072, 4096, 6144, 8192)

#: how often the longest wave of a band goes into a side: as often as memory allows, because what repeats is
#: seen less the more waves it has
_CELLS = (18.0, 12.0, 9.0, LEAST_CELLS)

#: samples along a side with which one patch, which repeats nothing, is preferred to several
_ONE_PATCH = 1024

#: a little more than is promised, which rounding and ratios may take
SPARE = 1.06
#: ratios of sides stay away from p/q with whole numbers up to this
_WHOLE = 8
#: digits of lengths in m
_DIGITS = 4

_QUARTER = 0.5 * math.pi
_GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)


@dataclass(frozen=True)
class Wish:
    """What patches are planned for.

    finest : length in m of the shortest waves
    area : side in m of the square that is not to repeat
    memory : bytes that the sea may take

    Raises ParameterError for numbers that are no lengths or bytes.
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
    """The sea with patches for a wish: the widest that memory allows, and of those the cheapest.

    Raises ParameterError, with the numbers that would do, for a wish that no patches can fill.
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
            # of the layer with the longest waves: the cells around its peak must not be too few
            slowest = min(layer.peak_frequency for layer in sea.layers)
            self._longest = 2.0 * math.pi / float(_wave_number(slowest, self._parameters))
        self._lengths, self._shares = _shares(sea)

    def widest(self, wish: Wish) -> tuple[Patch, ...] | None:
        """The patches that fill a wish with the most waves a side; None where none do."""
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
        """Bytes that a wish takes; None where no memory is enough."""
        for memory, resolutions in self._choices:
            if self._patches(wish, resolutions, LEAST_CELLS) is not None:
                return memory
        return None

    @cached_property
    def _choices(self) -> list[tuple[int, tuple[int, ...]]]:
        """Memory and samples along the side of each patch, cheapest first."""
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
        """Bytes that each patch keeps, and those that only one takes at a time."""
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
        """Share of the variance in waves shorter than a length in m."""
        return float(np.interp(wavelength, self._lengths, self._shares))


def _finer(first: Patch, finest: float, others: list[int], cells: float) -> tuple[Patch, ...] | None:
    """The patches of the shorter waves, each with its share of what is left, counted in octaves."""
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
    """Turn in rad of a sea's patch by its number: each stands well away from all others."""
    return round(_QUARTER * math.fmod(index * _GOLDEN, 1.0), _DIGITS)


def wavelength_with_share_below(parameters: OceanParameters, share: float) -> float:
    """Length in m of the waves below which a share of the sea's variance is; 0 for a flat sea."""
    lengths, shares = _shares(SeaSpectrum(parameters.without_patches))
    return float(np.interp(share, shares, lengths)) if shares[-1] > 0.0 else 0.0


def _wave_number(omega: float, parameters: OceanParameters) -> float:
    return float(dispersion.wave_number(omega, parameters.dispersion, parameters.water))


def _shares(sea: SeaSpectrum) -> tuple[Array, Array]:
    """Wavelengths in m, ascending, and the share of the variance in waves shorter than each."""
    omega, weight = sea.rule
    k = dispersion.wave_number(omega, sea.parameters.dispersion, sea.parameters.water)
    energy = (sea.frequency_spectrum(omega) * weight)[::-1]
    total = float(np.sum(energy))
    return 2.0 * np.pi / k[::-1], np.cumsum(energy) / (total if total > 0.0 else 1.0)


def rounded(length: float) -> float:
    """A length in m with few digits, never shorter."""
    unit = 10.0 ** (math.floor(math.log10(length)) - _DIGITS + 1)
    return float(f"{math.ceil(length / unit - 1e-9) * unit:.{_DIGITS}g}")


def odd_side(low: float, high: float, patches: Sequence[Patch]) -> float | None:
    """A side in m between two lengths, the rather large, in no ratio of small whole numbers to the others."""
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
    """Distance of a ratio from the nearest p/q with q up to 8, as a share of the smaller side."""
    return min(abs(ratio * q - round(ratio * q)) for q in range(1, _WHOLE + 1))


def _refusal(planner: _Planner, wish: Wish) -> ParameterError:
    """What is said of a wish that cannot be filled, with what would do instead."""
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
    """The number nearest to the one wanted, on the way to a limit, that fits; None where none does."""
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
