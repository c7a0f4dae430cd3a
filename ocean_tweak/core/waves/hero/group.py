# SPDX-License-Identifier: GPL-3.0-or-later
"""The Fourier coefficients of a hero wave, which are added to the sea's initial state.

At its focus the surface is A·exp(-ξ²/2σ² - ζ²/2τ²)·cos(k0 ξ + φ), with ξ along and ζ across the direction.
Its transform is a Gaussian around k0 with standard deviations 1/σ and 1/τ. Each wave has the sea's own ω(k),
so crests travel at ω/k and the group at dω/dk.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...data.errors import ParameterError
from ...numerics.grid import WaveVectorGrid

if TYPE_CHECKING:
    from .parameters import HeroWave

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complexfloating]

#: full width at half maximum of a Gaussian, in standard deviations
HALF_HEIGHT_WIDTH = 2.0 * math.sqrt(2.0 * math.log(2.0))

#: cut-off of the Gaussian, in standard deviations: waves beyond are less than 1/20,000 of the highest
REACH = 4.5

#: least number of samples per wavelength
FEWEST_SAMPLES = 4

#: modes of a block computed at a time
_BLOCK = 2**17


class Bandwidth(NamedTuple):
    """Standard deviations of a group's wave vectors around k0, rad/m: along its direction and across."""

    along: float
    across: float


def bandwidth(wave: HeroWave) -> Bandwidth:
    """1/σ and 1/τ: the longer and wider a group, the narrower its bandwidth."""
    length = wave.group_length * wave.wavelength
    return Bandwidth(HALF_HEIGHT_WIDTH / length, HALF_HEIGHT_WIDTH / wave.group_width)


def wave_number(wave: HeroWave) -> float:
    """k0 = 2π/λ, rad/m."""
    return 2.0 * math.pi / wave.wavelength


def largest_wave_number(wave: HeroWave) -> float:
    """Largest wave number of a group, rad/m: the point of its ellipse of wave vectors farthest from 0."""
    k0, (along, across) = wave_number(wave), bandwidth(wave)
    cosine = 1.0
    if across > along:
        cosine = min(1.0, along * k0 / (REACH * (across**2 - along**2)))
    return math.hypot(k0 + REACH * along * cosine, REACH * across * math.sqrt(1.0 - cosine**2))


def needed_samples(wave: HeroWave, domain_size: float) -> int:
    """Smallest even number of samples along a side that holds all of a group's waves, in any direction."""
    spacing = 2.0 * math.pi / domain_size
    of_group = math.ceil(largest_wave_number(wave) / spacing) + 1  # the Nyquist modes are not used
    return 2 * max(of_group, math.ceil(0.5 * FEWEST_SAMPLES * domain_size / wave.wavelength))


def check_hero_wave(wave: HeroWave, domain_size: float, resolution: int, path: str) -> None:
    """Raise ParameterError, with a remedy, for a wave that the patch or its grid cannot hold."""
    length = wave.group_length * wave.wavelength
    for name, value, size, smaller in (
        ("wavelength", wave.wavelength, wave.wavelength, "shorter"),
        ("group_length", wave.group_length, length, "smaller"),
        ("group_width", wave.group_width, wave.group_width, "smaller"),
    ):
        if size > domain_size:
            raise ParameterError(
                f"{path}.{name}", value,
                f"is {size:.4g} m in a domain of {domain_size:g} m: make it {smaller}, or the "
                "domain larger",
            )  # fmt: skip
    needed = needed_samples(wave, domain_size)
    if needed > resolution:
        raise ParameterError(
            f"{path}.wavelength", wave.wavelength,
            f"needs {needed} samples along each side for a group of this length and width, and "
            f"the resolution is {resolution}: raise it, make the wave or its group longer, or the "
            "domain smaller",
        )  # fmt: skip


class _Waves(NamedTuple):
    """Modes of a block: wave vectors in units of 2π/L, (M,) integers, and weights, (M,)."""

    i: NDArray[Any]
    j: NDArray[Any]
    weight: Array


def _blocks(wave: HeroWave, spacing: float) -> Iterator[_Waves]:
    """A group's modes, independent of the resolution: kx = i·Δk of either sign, ky = j·Δk."""
    k0, (along, across) = wave_number(wave), bandwidth(wave)
    cosine, sine = math.cos(wave.direction), math.sin(wave.direction)
    i = _between(k0 * cosine, REACH * math.hypot(along * cosine, across * sine), spacing)
    j = _between(k0 * sine, REACH * math.hypot(along * sine, across * cosine), spacing)
    width = max(1, _BLOCK // len(j))
    for first in range(0, len(i), width):
        kx, ky = spacing * i[first : first + width, np.newaxis], spacing * j
        distance = ((kx * cosine + ky * sine - k0) / along) ** 2 + ((ky * cosine - kx * sine) / across) ** 2
        distance[(kx == 0.0) & (ky == 0.0)] = np.inf  # the mean is not a wave
        rows, columns = np.nonzero(distance <= REACH**2)
        yield _Waves(i[first + rows], j[columns], np.exp(-0.5 * distance[rows, columns]))


def _between(centre: float, reach: float, spacing: float) -> NDArray[Any]:
    return np.arange(math.ceil((centre - reach) / spacing), math.floor((centre + reach) / spacing) + 1)


def add_hero_wave(
    wave: HeroWave,
    grid: WaveVectorGrid,
    omega: tuple[Array, Array],
    h_plus: ComplexArray,
    h_minus: ComplexArray,
    carried: tuple[float, float] = (0.0, 0.0),
) -> None:
    """Add a group's waves to coefficients (N, N//2+1) in m of those along +k and along -k.

    omega : (N, N//2+1) rad/s, of the sea's waves along +k and along -k
    carried : x and y in m that a current has carried them by time 0

    The modes are in phase at the focus, where their heights add up exactly to the crest height. The grid must
    hold all of them.
    """
    n, spacing = grid.resolution, grid.spacing
    height = 0.5 * wave.crest_height / sum(float(np.sum(some.weight)) for some in _blocks(wave, spacing))
    for i, j, weight in _blocks(wave, spacing):
        side = np.where(i < 0, -1, 1)  # of two opposite wave vectors the half plane holds one
        x, y = wave.x - carried[0], wave.y - carried[1]
        turns = i * (x / grid.domain_size % 1.0) + j * (y / grid.domain_size % 1.0)
        at = side * j % n, side * i
        own = np.where(side > 0, omega[0][at], omega[1][at])
        angle = own * wave.time + wave.phase - 2.0 * np.pi * (turns - np.rint(turns))
        coefficients = height * weight * np.exp(1j * angle)
        along, against = i >= 0, i <= 0
        h_plus[j[along] % n, i[along]] += coefficients[along]
        h_minus[-j[against] % n, -i[against]] += np.conj(coefficients[against])
