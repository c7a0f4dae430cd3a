# SPDX-License-Identifier: GPL-3.0-or-later
"""A hero wave to begin with, which fits its patch and its samples."""

from __future__ import annotations

from .parameters import HeroWave

#: wavelengths in a patch; a crest's height and width over the wavelength and the patch
_WAVES, _STEEPNESS, _WIDTH = 6.0, 0.05, 0.4

#: wavelengths that 16 samples hold with a group of two
_WAVES_OF_16 = 3.5


def hero_wave(domain_size: float, resolution: int, time: float) -> HeroWave:
    """A group of two waves along x whose focus is in the middle of the patch, at a time in s."""
    wavelength = domain_size / min(_WAVES, _WAVES_OF_16 * resolution / 16)
    return HeroWave(
        x=0.5 * domain_size, y=0.5 * domain_size, time=time, wavelength=wavelength,
        crest_height=min(100.0, _STEEPNESS * wavelength), group_width=_WIDTH * domain_size,
    )  # fmt: skip
