# SPDX-License-Identifier: GPL-3.0-or-later
"""Summaries of wakes, without computing any: wavelengths and angles."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, NamedTuple

from .elevation import Basin
from .track import Track

if TYPE_CHECKING:
    from ...parameters.ocean_parameters import OceanParameters

#: rad: asin(1/3), half the angle of the wake of what is small (Kelvin 1887)
KELVIN_ANGLE = math.asin(1.0 / 3.0)
#: hull's Froude number from which on a wake is narrower
NARROWS = 0.5
#: samples of a transverse wave, at least, and share of waves that come around an area, at most
_SAMPLES, _AROUND = 4.0, 0.03
#: m/s, below which there is no wake
_SLOW = 0.05
#: draught at a choppiness of 1, in beams, from which the water folds beside hulls that are longer than wide
_FOLDS = 0.7


def froude_number(speed: float, length: float, gravity: float) -> float:
    """Froude number U/√(gL) of a hull's length in m at a speed in m/s.

    Examples
    --------
    >>> round(froude_number(8.0, 60.0, 9.81), 2)
    0.33
    """
    return speed / math.sqrt(gravity * length)


def wake_angle(froude: float) -> float:
    """Half angle in rad of the highest waves, for a hull's Froude number.

    Up to 0.5 it is Kelvin's. A faster hull makes no waves much longer than itself, and its waves spread less:
    tan α = √(2π F² - 1)/(4π F² - 1) (Rabaud & Moisy 2013), about 1/(√(8π) F).

    Examples
    --------
    >>> [round(math.degrees(wake_angle(froude)), 1) for froude in (0.3, 1.0, 2.0)]
    [19.5, 11.2, 5.7]
    """
    if froude < NARROWS:
        return KELVIN_ANGLE
    square = math.pi * froude**2
    return math.atan2(math.sqrt(2.0 * square - 1.0), 4.0 * square - 1.0)


def transverse_wavelength(speed: float, sea: OceanParameters) -> float:
    """Length in m of the transverse waves, which travel with the object; infinite if none is as fast.

    In deep water 2π U²/g; shallow water has none above √(gh).
    """
    gravity, depth, square = sea.water.gravity, sea.water.depth, speed * speed
    if sea.dispersion == "DEEP":
        return 2.0 * math.pi * square / gravity
    if square >= gravity * depth:
        return math.inf
    if square == 0.0:
        return 0.0
    long, short = 1e-9 / depth, gravity / square
    for _ in range(100):  # g tanh(kh)/k falls with k
        k = math.sqrt(long * short)
        long, short = (k, short) if gravity * math.tanh(k * depth) / k > square else (long, k)
    return 2.0 * math.pi / math.sqrt(long * short)


class WakeOutlook(NamedTuple):
    """Summary of the waves of one object, at its fastest.

    number : its number among the sea's wakes
    speed : m/s
    froude : of its hull
    angle : at which its highest waves stand on either side, rad
    wavelength : of its transverse waves, m; infinite where it is too fast for the depth
    spacing : between the samples of its area, m
    around : what is left of waves that have come around the area while the object crossed it, 0 to 1
    pieces : straight ones of its path
    draught, narrow : of its hull at its deepest, and the shorter of its length and beam, m
    choppiness, depth : of the sea, and m of its water
    """

    number: int
    speed: float
    froude: float
    angle: float
    wavelength: float
    spacing: float
    around: float
    pieces: int
    draught: float
    narrow: float
    choppiness: float
    depth: float

    def line(self) -> str:
        """What `info` says."""
        if self.speed < _SLOW:
            return f"wake {self.number}: the object rests, and makes no waves but where it dips"
        waves = (
            f"transverse waves {self.wavelength:.3g} m"
            if math.isfinite(self.wavelength)
            else "no transverse waves, which are slower in this depth"
        )
        return (
            f"wake {self.number}: up to {self.speed:.3g} m/s, Froude number {self.froude:.2g}; {waves}, "
            f"highest waves {math.degrees(self.angle):.1f}° to either side; {self.spacing:.3g} m between "
            f"samples, {self.pieces} pieces of path"
        )

    @property
    def warnings(self) -> tuple[str, ...]:
        """One sentence each, with the remedy."""
        found = []
        if self.speed >= _SLOW and self.wavelength < _SAMPLES * self.spacing:
            found.append(
                f"Wake {self.number}: its waves are {self.wavelength:.3g} m long and its samples "
                f"{self.spacing:.3g} m apart, too coarse. Raise area_resolution, or make area_size smaller"
            )
        if self.speed >= _SLOW and self.around > _AROUND:
            found.append(
                f"Wake {self.number}: {100.0 * self.around:.0f} % of its waves come around the area and show "
                "ahead of it. Make area_size or decay larger"
            )
        if self.choppiness * self.draught > _FOLDS * self.narrow:
            found.append(
                f"Wake {self.number}: its draught of {self.draught:.3g} m is deep for {self.narrow:.3g} m of "
                "width: the water folds beside it. Make draught, immersion, amplitude_scale or choppiness "
                "smaller"
            )
        if self.draught > self.depth:
            found.append(
                f"Wake {self.number}: its draught of {self.draught:.3g} m is more than the water's depth of "
                f"{self.depth:.3g} m. Make the draught smaller, or the water deeper"
            )
        return tuple(found)


class WakeOutlooks(NamedTuple):
    """Summary of all wakes of a sea that are not muted."""

    wakes: tuple[WakeOutlook, ...]

    @property
    def warnings(self) -> tuple[str, ...]:
        """One sentence each, with the remedy."""
        return tuple(warning for wake in self.wakes for warning in wake.warnings)

    def lines(self) -> list[str]:
        """What `info` says."""
        return [*(wake.line() for wake in self.wakes), "wakes belong to no spectrum: no height counts them"]

    def to_plain(self) -> list[dict[str, Any]]:
        """Plain data for JSON."""
        found = []
        for wake in self.wakes:
            length = wake.wavelength if math.isfinite(wake.wavelength) else None
            found.append({**wake._asdict(), "wavelength": length, "warnings": list(wake.warnings)})
        return found


def wake_outlooks(
    sea: OceanParameters, wakes: Iterable[tuple[int, Track, tuple[float, float, float], Basin]]
) -> WakeOutlooks | None:
    """Of objects by number, on tracks, with a length, a beam and a draught in m, in some water; None where
    there are none.
    """
    found = []
    for number, track, (length, beam, draught), basin in wakes:
        speed, _ = track.fastest
        froude = froude_number(speed, length, sea.water.gravity)
        wave = transverse_wavelength(speed, sea)
        around = math.exp(-basin.decay * basin.area / speed) if speed > 0.0 else 0.0
        found.append(
            WakeOutlook(
                number,
                speed,
                froude,
                wake_angle(froude),
                wave,
                basin.area / basin.resolution,
                around,
                len(track.pieces),
                draught,
                min(length, beam),
                sea.choppiness,
                sea.water.depth,
            )
        )
    return WakeOutlooks(tuple(found)) if found else None
