# SPDX-License-Identifier: GPL-3.0-or-later
"""Parameters of a hero wave: time and place of its focus, and its size there."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

from ...data.errors import ParameterError
from ...data.validation import angle, moment, number, place
from ..contribution import Contribution, Gives, Names, muted, wave_height
from .group import add_hero_wave, check_hero_wave, needed_samples
from .outlook import HeroWaveOutlooks, hero_wave_outlooks

if TYPE_CHECKING:
    from ...parameters.ocean_parameters import OceanParameters
    from ...synthesis.coefficients import Coefficients

#: smallest width of a crest in wavelengths: a narrower hump spreads in all directions
NARROWEST = 0.5

#: defaults of a new wave: wavelengths per patch, crest height over wavelength, width over patch
_WAVES, _STEEPNESS, _WIDTH = 6.0, 0.05, 0.4

#: wavelengths per patch that 16 samples can hold for a group of length two
_WAVES_OF_16 = 3.5


@dataclass(frozen=True)
class HeroWave(Contribution):
    """A group of waves under a bell-shaped (Gaussian) envelope, which adds to the sea.

    Its waves obey the sea's dispersion relation: at its focus the group has the shape given here; before and
    after, it travels along its direction, and is longer, wider and lower.

    Examples
    --------
    >>> from ocean_tweak.core import HeroWave, Ocean, OceanParameters, WaveLayer
    >>> wave = HeroWave(x=200.0, y=200.0, time=5.0, wavelength=40.0, crest_height=1.5)
    >>> sea = Ocean(OceanParameters(resolution=128, layers=(WaveLayer(wind_speed=0.0), wave)))
    >>> round(float(sea.surface(5.0).displacement[..., 2].max()), 1)
    1.5
    """

    kind = "HERO_WAVE"
    gives = Gives.COEFFICIENTS | Gives.LOOPS
    names = Names(
        3, "hero_wave", "hero wave", "Hero Wave", "A single group of waves, placed by hand", "SMOOTHCURVE"
    )
    former_list = "hero_waves"
    constant = "a free wave keeps its properties; place a second one, or animate ocean_time"

    x: float = place(200.0, "Place of the focus along x; the patch repeats, and the wave with it")
    y: float = place(200.0, "Place of the focus along y")
    time: float = moment(0.0, "Ocean time at which the group is at its focus")
    direction: float = angle("Direction towards which the wave runs, counter-clockwise from +x")
    wavelength: float = number(
        60.0, 1e-3, 1e5, "m", "Distance from crest to crest; sets the speed, with depth and gravity",
        "from ripples to the largest patch",
    )  # fmt: skip
    crest_height: float = wave_height(
        3.0, "Height of the crest above calm water at the focus; elsewhere it is lower"
    )
    group_length: float = number(
        2.0, 1.0, 1000.0, "wavelengths",
        "Length of the group along its direction, between the places where its waves are half as high; "
        "1 is a single crest",
        "a shorter one is no wave",
    )  # fmt: skip
    group_width: float = number(
        150.0, 1e-3, 1e5, "m",
        "Width of the crests across the direction, between the places where they are half as high",
        "from ripples to the largest patch",
    )  # fmt: skip
    phase: float = angle("Phase of the wave at the focus: 0 for a crest, π for a trough")
    muted: bool = muted()

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.group_width < NARROWEST * self.wavelength:
            raise ParameterError(
                "group_width", self.group_width,
                f"must be at least {NARROWEST * self.wavelength:.4g} m, {NARROWEST:g} of its "
                "wavelength: a narrower hump spreads in all directions",
            )  # fmt: skip

    def check(self, sea: OceanParameters, path: str) -> None:
        """Check that the patch and its grid can hold its waves."""
        check_hero_wave(self, sea.domain_size, sea.resolution, path)

    def is_held(self, sea: OceanParameters, resolution: int) -> bool:
        """Whether a grid with this many samples holds all of the group's waves."""
        return needed_samples(self, sea.domain_size) <= resolution

    def add(self, sea: OceanParameters, to: Coefficients) -> None:
        """Add its waves; none of their energy is expected, which no seed changes."""
        against = to.omega if to.omega_against is None else to.omega_against
        add_hero_wave(self, to.grid, (to.omega, against), to.h_plus, to.h_minus, to.carried)

    @classmethod
    def to_begin_with(cls, sea: OceanParameters, time: float) -> Self:
        """A group of two waves along x with its focus in the middle of the patch."""
        size = sea.domain_size
        wavelength = size / min(_WAVES, _WAVES_OF_16 * sea.resolution / 16)
        return cls(
            x=0.5 * size, y=0.5 * size, time=time, wavelength=wavelength,
            crest_height=min(100.0, _STEEPNESS * wavelength), group_width=_WIDTH * size,
        )  # fmt: skip

    @classmethod
    def outlook(cls, sea: OceanParameters) -> HeroWaveOutlooks | None:
        """Time and place of their focus."""
        return hero_wave_outlooks(sea, sea.of(cls))
