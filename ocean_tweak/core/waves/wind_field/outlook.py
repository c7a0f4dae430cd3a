# SPDX-License-Identifier: GPL-3.0-or-later
"""What waves the wind fields of a sea will raise, told without making any."""

from __future__ import annotations

from typing import NamedTuple

from ...parameters import OceanParameters
from .bounds import most_particles
from .relations import wavelength
from .wind_waves import SHORTEST


class WindWaveOutlook(NamedTuple):
    """What to expect.

    most_particles : more there never are
    longest_wavelength : of the strongest wind, m; 0 where it is calm
    warnings : one sentence each, with the remedy
    """

    most_particles: int
    longest_wavelength: float
    warnings: tuple[str, ...]


def wind_wave_outlook(parameters: OceanParameters) -> WindWaveOutlook | None:
    """Of all wind fields that are not muted; None where there are none."""
    if not parameters.active_wind_fields:
        return None
    spacing = parameters.domain_size / parameters.resolution
    longest, warnings = 0.0, []
    for index, layer in enumerate(parameters.wind_fields):
        if layer.muted:
            continue
        speed = layer.greatest_speed
        length = wavelength(speed, parameters.water.gravity) if speed >= layer.calm else 0.0
        longest = max(longest, length)
        if length == 0.0:
            warnings.append(
                f"Wind field {index}: {speed:.3g} m/s is calm and raises no waves. "
                f"Raise its strength, or lower its calm of {layer.calm:g} m/s"
            )
        elif length < SHORTEST * spacing:
            warnings.append(
                f"Wind field {index}: its waves of {length:.3g} m are shorter than {SHORTEST:g} samples of "
                f"{spacing:.3g} m and are left out. Raise the resolution or make the domain smaller"
            )
    particles = sum(most_particles(layer) for layer in parameters.wind_fields)
    return WindWaveOutlook(particles, longest, tuple(warnings))
