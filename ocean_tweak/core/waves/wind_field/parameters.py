# SPDX-License-Identifier: GPL-3.0-or-later
"""Parameters of waves from a wind field."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from ...data.errors import ParameterError
from ...data.raster import Raster
from ...data.validation import Validated, choice, integer, moment, nested, number, raster, switch
from ...masks.parameters import Mask
from ..contribution import (
    Contribution,
    Gives,
    MemoryNeed,
    Names,
    amplitude_scale,
    direction,
    identity,
    muted,
    own_seed,
    wind_speed,
)
from .bounds import bytes_of, check_bounds
from .outlook import WindWaveOutlook, wind_wave_outlook
from .shape import MOST_CLASSES
from .wind_waves import WindWaves

if TYPE_CHECKING:
    from ...parameters.ocean_parameters import OceanParameters

CRESTS = ("ARC", "PARALLEL")
HEIGHTS = ("STEEPNESS", "WIND_SPEED")

#: largest number of keys of a wind
MOST_KEYS = 1024


@dataclass(frozen=True)
class WindKey(Validated):
    """The wind over the patch at one key time.

    Examples
    --------
    >>> WindKey(30.0, Raster([[[18.0, 0.0]]])).time
    30.0
    """

    time: float = moment(0.0, "Ocean time at which the wind is this; linear between two, held outside")
    vectors: Raster | None = raster(
        "Wind in m/s along x and y, towards which it blows: sample (i, j) of R rows and C columns is at "
        "y = i·size/R, x = j·size/C; bilinear between them, and around the edges",
        channels=2,
        optional=False,
    )


@dataclass(frozen=True)
class WindFieldLayer(Contribution):
    """Waves that follow a wind field. Each wave is determined by the wind at the place and time of its birth.

    A wave of wind V has the length λ = V²/g, the period T = √(2π)·V/g and the speed V/√(2π).

    Examples
    --------
    >>> from ocean_tweak.core import Raster, WindFieldLayer, WindKey
    >>> calm, gale = Raster([[[0.0, 0.0]]]), Raster([[[18.0, 0.0]]])
    >>> WindFieldLayer(keys=(WindKey(0.0, calm), WindKey(30.0, gale))).keys[1].time
    30.0
    """

    kind = "WIND_FIELD"
    gives = Gives.SHARES
    names = Names(
        1, "wind_field", "wind field", "Wind Field",
        "Waves from a wind that varies from place to place", "FORCE_WIND",
    )  # fmt: skip
    former_list = "wind_fields"
    constant = "a wave keeps the wind it was born with; give the wind keys at several times instead"

    wind_speed: float = wind_speed("Wind speed, the same everywhere, where there are no keys")
    wind_direction: float = direction("Direction towards which it blows, counter-clockwise from +x")
    keys: tuple[WindKey, ...] = nested(WindKey, many=True, empty=True, most=MOST_KEYS)
    wind_scale: float = number(1.0, 0.0, 100.0, "", "Multiplies the wind", "an artist's scale")
    start_time: float = moment(
        -120.0, "Ocean time at which the wind begins to raise waves; before it there are none"
    )
    minimum_wind_speed: float = number(
        2.0, 0.1, 100.0, "m/s", "Wind below which no wave is born", "waves of a millimetre, to none at all"
    )
    columns: int = integer(16, 1, 512, "Cells along x, each with as many origins of waves", "a cell a metre")
    rows: int = integer(16, 1, 512, "Cells along y", "a cell a metre")
    origins: int = integer(1, 1, 16, "Places in each cell where waves are born", "for more, use more cells")
    jitter: float = number(
        1.0,
        0.0,
        1.0,
        "",
        "How far origins stray from the middle of their cell: 1 is anywhere in it",
        "a share",
    )
    phase_jitter: float = number(
        1.0, 0.0, 1.0, "", "How far origins are out of step: 0 is all at once, 1 at any time within the "
        "period",
        "a share",
    )  # fmt: skip
    crest: str = choice("ARC", CRESTS, "How a wave begins: as an arc that widens, or straight and parallel")
    particles: int = integer(5, 1, 99, "Particles of a wave at its birth, side by side", "a half circle")
    split_angle: float = number(
        0.1,
        0.0,
        1.0,
        "rad",
        "Angle between neighbouring particles of an arc",
        "beyond it, a wave does not hold together",
    )
    splitting: bool = switch(
        True, "Split a particle in three where neighbours are half a radius apart; without it, arcs break up"
    )
    life: float = number(
        8.0, 0.5, 100.0, "wavelengths", "How far a wave runs before it is gone", "a long swell"
    )
    height: str = choice("STEEPNESS", HEIGHTS, "What sets a particle's height")
    steepness: float = number(
        0.1, 0.0, 2.0, "", "Steepness s of the height s·λ/2π of a particle, to which its neighbours add "
        "theirs",
        "waves break near 0.44",
    )  # fmt: skip
    height_per_speed: float = number(
        0.05,
        0.0,
        10.0,
        "s",
        "Factor k of the height k·V of a particle, V being the wind speed",
        "an artist's scale",
    )
    amplitude_scale: float = amplitude_scale()
    muted: bool = muted()
    id: int = identity()
    seed: int = own_seed()
    mask: Mask | None = nested(Mask, optional=True)

    def __post_init__(self) -> None:
        super().__post_init__()
        times = [key.time for key in self.keys]
        for index in range(1, len(times)):
            if times[index] <= times[index - 1]:
                raise ParameterError(
                    f"keys.{index}.time",
                    times[index],
                    f"must be later than the key before it, {times[index - 1]:g} s",
                )

    @cached_property
    def greatest_speed(self) -> float:
        """The strongest wind at any place and time, m/s; interpolation never exceeds it."""
        speeds = [float(np.hypot(*np.moveaxis(raster.values, -1, 0)).max()) for raster in self.rasters]
        return self.wind_scale * max(speeds, default=self.wind_speed)

    @property
    def rasters(self) -> tuple[Raster, ...]:
        """The rasters of all keys, in the order of their times."""
        return tuple(key.vectors for key in self.keys if key.vectors is not None)

    def check(self, sea: OceanParameters, path: str) -> None:
        """Check that its waves fit into the patch."""
        size, speed = sea.domain_size, self.greatest_speed
        longest = speed**2 / sea.water.gravity
        if longest > size:
            fitting = (size * sea.water.gravity) ** 0.5
            raise ParameterError(
                path, f"{speed:g} m/s",
                f"the waves of this wind are {longest:.4g} m long and the domain is {size:g} m: "
                f"make the domain larger, or the wind at most {fitting:.4g} m/s (wind_scale, for "
                "one)",
            )  # fmt: skip

    @classmethod
    def check_together(cls, sea: OceanParameters) -> None:
        """Check the number of particles."""
        check_bounds(sea.active(cls), sea.water.gravity)

    @classmethod
    def shares(cls, sea: OceanParameters) -> WindWaves:
        """The contributions of their particles to the sea's coefficients."""
        return WindWaves(sea, sea.active(cls))

    @classmethod
    def memory(cls, sea: OceanParameters, real: int, moving: bool) -> MemoryNeed:
        """Each radius keeps two quarter planes; each weight needs a grid, and half a plane per radius."""
        n = sea.resolution
        of_radii = MOST_CLASSES * n * (n // 2 + 1) * 2 * real
        kept, making = bytes_of(sea.active(cls), sea.water.gravity)
        return MemoryNeed(kept + of_radii, 40 * n * n, making + (3 if moving else 1) * (8 * n * n + of_radii))

    @classmethod
    def outlook(cls, sea: OceanParameters) -> WindWaveOutlook | None:
        """Their number of particles and longest wavelength."""
        return wind_wave_outlook(sea, sea.of(cls))
