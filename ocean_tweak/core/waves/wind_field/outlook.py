# SPDX-License-Identifier: GPL-3.0-or-later
"""Summary of the waves of a sea's wind fields, without computing any."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from .bounds import most_particles
from .relations import wavelength
from .wind_waves import SHORTEST

if TYPE_CHECKING:
    from ...parameters.ocean_parameters import OceanParameters
    from .parameters import WindFieldLayer


class WindWaveOutlook(NamedTuple):
    """Summary of a sea's wind fields.

    most_particles : upper bound on the number of particles
    longest_wavelength : of the strongest wind, m; 0 in a calm
    warnings : one sentence each, with the remedy
    """

    most_particles: int
    longest_wavelength: float
    warnings: tuple[str, ...]

    def lines(self) -> list[str]:
        """What `info` says."""
        return [
            f"wind fields: waves up to {self.longest_wavelength:.3g} m long, at most "
            f"{self.most_particles} particles at once; not counted in the heights above"
        ]

    def to_plain(self) -> dict[str, Any]:
        """Plain data for JSON."""
        return self._asdict()


def wind_wave_outlook(
    parameters: OceanParameters, layers: Sequence[WindFieldLayer]
) -> WindWaveOutlook | None:
    """Summary of a sea's wind fields that are not muted; None if there are none."""
    if all(layer.muted for layer in layers):
        return None
    spacing = parameters.domain_size / parameters.resolution
    longest, warnings = 0.0, []
    for index, layer in enumerate(layers):
        if layer.muted:
            continue
        speed = layer.greatest_speed
        length = wavelength(speed, parameters.water.gravity) if speed >= layer.minimum_wind_speed else 0.0
        longest = max(longest, length)
        if length == 0.0:
            warnings.append(
                f"Wind field {index}: {speed:.3g} m/s raises no waves. Raise its wind_scale, or "
                f"lower its minimum_wind_speed of {layer.minimum_wind_speed:g} m/s"
            )
        elif length < SHORTEST * spacing:
            warnings.append(
                f"Wind field {index}: its waves of {length:.3g} m are shorter than {SHORTEST:g} "
                f"samples of {spacing:.3g} m and are left out. Raise the resolution, or make the "
                "domain smaller"
            )
    particles = sum(most_particles(layer) for layer in layers)
    return WindWaveOutlook(particles, longest, tuple(warnings))
