# SPDX-License-Identifier: GPL-3.0-or-later
"""Time, place and speed of a sea's hero waves at their focus, without computing any."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from ...spectral import constants, dispersion
from .group import wave_number

if TYPE_CHECKING:
    from ...parameters.ocean_parameters import OceanParameters
    from .parameters import HeroWave


class HeroWaveOutlook(NamedTuple):
    """Summary of one hero wave.

    number : its number among the sea's hero waves
    time, frame : of the focus, in s and as a frame of the shot
    x, y : of the focus, m, within the patch
    direction : towards which it travels, rad
    wavelength, period : m and s
    crest_height : at the focus, m
    phase_speed, group_speed : of the crests and of the group, m/s
    domain_size : side of the patch, m
    warnings : one sentence each, with the remedy
    """

    number: int
    time: float
    frame: float
    x: float
    y: float
    direction: float
    wavelength: float
    period: float
    crest_height: float
    phase_speed: float
    group_speed: float
    domain_size: float
    warnings: tuple[str, ...]

    def place(self, time: float) -> tuple[float, float]:
        """Position (x, y) in m, within the patch, of the centre of the group at an ocean time in s."""
        way = self.group_speed * (time - self.time)
        return (
            (self.x + way * math.cos(self.direction)) % self.domain_size,
            (self.y + way * math.sin(self.direction)) % self.domain_size,
        )

    def line(self) -> str:
        """What `info` says."""
        return (
            f"hero wave {self.number}: {self.crest_height:.3g} m high at x = {self.x:.4g}, y = {self.y:.4g} "
            f"m at {self.time:.4g} s (frame {self.frame:.6g}), {self.wavelength:.4g} m and {self.period:.3g} "
            f"s long, towards {math.degrees(self.direction):.0f}°; crests run {self.phase_speed:.3g} m/s, "
            f"the group {self.group_speed:.3g} m/s and {self.domain_size / self.group_speed:.3g} s through "
            "the patch"
        )


class HeroWaveOutlooks(NamedTuple):
    """Summary of all hero waves of a sea that are not muted."""

    waves: tuple[HeroWaveOutlook, ...]

    @property
    def warnings(self) -> tuple[str, ...]:
        """One sentence each, with a remedy."""
        return tuple(warning for wave in self.waves for warning in wave.warnings)

    def lines(self) -> list[str]:
        """What `info` says."""
        alone = "hero waves count in the row of the seed only: they belong to no spectrum"
        return [*(wave.line() for wave in self.waves), alone]

    def to_plain(self) -> list[dict[str, Any]]:
        """Plain data for JSON."""
        return [{**wave._asdict(), "warnings": list(wave.warnings)} for wave in self.waves]


def hero_wave_outlooks(parameters: OceanParameters, waves: Sequence[HeroWave]) -> HeroWaveOutlooks | None:
    """Summary of a sea's hero waves that are not muted; None if there are none."""
    found = (_outlook(parameters, index, wave) for index, wave in enumerate(waves) if not wave.muted)
    return HeroWaveOutlooks(tuple(found)) if any(not wave.muted for wave in waves) else None


def _outlook(parameters: OceanParameters, index: int, wave: HeroWave) -> HeroWaveOutlook:
    k, size, timing = wave_number(wave), parameters.domain_size, parameters.timing
    omega = float(dispersion.angular_frequency(k, parameters.dispersion, parameters.water))
    group_speed = float(dispersion.group_velocity(k, parameters.dispersion, parameters.water))
    return HeroWaveOutlook(
        index, wave.time, timing.frame(wave.time), wave.x % size, wave.y % size,
        wave.direction, wave.wavelength, 2.0 * math.pi / omega, wave.crest_height, omega / k, group_speed,
        size, tuple(_warnings(parameters, index, wave, group_speed)),
    )  # fmt: skip


def _warnings(parameters: OceanParameters, index: int, wave: HeroWave, group_speed: float) -> list[str]:
    warnings = []
    steepest = constants.BREAKING_STEEPNESS * wave.wavelength
    steepest *= 0.5 * math.tanh(wave_number(wave) * parameters.water.depth)
    if wave.crest_height > steepest:
        warnings.append(
            f"Hero wave {index}: waves {wave.wavelength:.4g} m long break before their "
            f"crests reach {wave.crest_height:.4g} m. Lower the crest to {steepest:.3g} m, or "
            "make the wave longer"
        )
    if parameters.loop_duration is not None:
        around = parameters.domain_size / group_speed
        if float(parameters.loop_duration) < around:
            warnings.append(
                f"Hero wave {index}: its group takes {around:.4g} s to cross the patch, longer "
                "than the loop, so it breaks up between two focuses. Make the loop longer, or "
                "the domain smaller"
            )
    return warnings
