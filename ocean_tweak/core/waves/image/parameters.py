# SPDX-License-Identifier: GPL-3.0-or-later
"""What a picture needs to become waves."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from ...errors import ParameterError
from ...layer_fields import direction, identity, muted, own_seed
from ...masks.parameters import Mask
from ...raster import Raster
from ...validation import Validated, choice, integer, nested, number, raster

FILTERS = ("MODIFIED_PIERSON_MOSKOWITZ", "FRACTAL", "WATER_TEXTURE")
FILTER_GAINS = ("PHYSICAL", "PAPER")
ANIMATIONS = ("DISPERSION", "DOMINANT_BAND", "TRANSLATION")

#: how far from a whole number of patches a loop's translation may be: rounding, no more
_WHOLE = 1e-6


@dataclass(frozen=True)
class PictureLayer(Validated):
    """Waves out of one picture, which is stretched over the patch and filtered there."""

    picture: Raster | None = raster(
        "Picture whose phases and magnitudes become the waves'; none for white noise",
        channels=1,
    )  # fmt: skip
    filter: str = choice(
        "MODIFIED_PIERSON_MOSKOWITZ",
        FILTERS,
        "Which wavelengths and directions of the picture stay: a wind's, a fractal's or a texture's",
    )
    filter_gain: str = choice(
        "PHYSICAL", FILTER_GAINS,
        "Modified Pierson-Moskowitz: waves as high as the wind makes them, or the paper's filter with "
        "significant_wave_height",
    )  # fmt: skip
    wind_speed: float = number(
        12.0, 0.0, 100.0, "m/s", "Mean wind at 10 m that shapes the modified Pierson-Moskowitz filter",
        "from calm to beyond the strongest hurricane", useful=(0.0, 50.0),
    )  # fmt: skip
    wind_direction: float = direction()
    significant_wave_height: float = number(
        1.0, 0.0, 100.0, "m", "Wave height Hs of every filter but the physical one: four standard deviations",
        "thrice the largest measured",
    )  # fmt: skip
    gain: float = number(
        1.0, 0.0, 100.0, "", "Multiplies the layer's wave height", "an artist's gain", useful=(0.0, 2.0)
    )
    fractal_dimension: float = number(
        2.1, 2.0, 4.0, "", "D of the filters 1/f^β with β = 8 - 2D: 2 is smooth, 3 rough, 4 no filter at all",
        "a surface's dimension, and beyond",
    )  # fmt: skip
    texture_wavelength: float = number(
        2.0, 1e-3, 1e5, "m", "Wavelength at the water texture's peak: 1/f^β is below, a Gaussian above",
        "from ripples to the largest domain",
    )  # fmt: skip
    animation: str = choice(
        "DISPERSION",
        ANIMATIONS,
        "How the waves move: each at its own speed, the highest apart from the others, or all as one",
    )
    dominant_rate: float = number(
        1.5, 0.0, 100.0, "rad/s", "Dominant band: how fast the phases of the highest waves turn",
        "a wave of a twentieth of a second",
    )  # fmt: skip
    surrounding_rate: float = number(
        0.09, 0.0, 100.0, "rad/s", "Dominant band: how fast the phases of all other waves turn",
        "a wave of a twentieth of a second",
    )  # fmt: skip
    translation_speed: float = number(
        1.0, 0.0, 1000.0, "m/s", "Translation: how fast the whole picture moves along the wind",
        "beyond the fastest wave",
    )  # fmt: skip
    noise_resolution: int = integer(
        1024, 16, 2048, "Samples along each side of the white noise, an even number; others are another sea",
        "from the coarsest sea to the largest picture that is not made smaller",
    )  # fmt: skip
    muted: bool = muted()
    id: int = identity()
    seed: int = own_seed("Seed of the white noise")
    mask: Mask | None = nested(Mask, optional=True)

    def __post_init__(self) -> None:
        if isinstance(self.picture, Raster):
            object.__setattr__(self, "picture", _grey(self.picture))
        super().__post_init__()
        if self.noise_resolution % 2:
            raise ParameterError(
                "noise_resolution", self.noise_resolution, "must be an even number from 16 to 2048"
            )

    @property
    def is_physical(self) -> bool:
        """Whether the wind sets the wave height."""
        return self.filter == "MODIFIED_PIERSON_MOSKOWITZ" and self.filter_gain == "PHYSICAL"


def _grey(picture: Raster) -> Raster:
    """One channel: the luminance of a colour picture; the fourth is transparency, which is left out.

    Raises ParameterError, naming the picture, where it holds no waves.
    """
    picture = picture.grey()
    if np.ptp(picture.values) == 0.0:
        what = f"picture ({picture.name})" if picture.name else "picture"
        raise ParameterError(
            what, float(picture.values.flat[0]), "everywhere: it holds no waves; give one with contrast"
        )
    return picture


def check_loop(pictures: Sequence[PictureLayer], domain_size: float, loop_duration: Fraction | None) -> None:
    """Raise ParameterError for a translation that does not end where it began when the loop does.

    It does where it moves by whole patches both ways; any other would have to bend the picture.
    """
    if loop_duration is None:
        return
    for index, layer in enumerate(pictures):
        if layer.animation != "TRANSLATION" or layer.muted:
            continue
        patches = layer.translation_speed * float(loop_duration) / domain_size
        moved = [patches * part(layer.wind_direction) for part in (math.cos, math.sin)]
        nearest = [round(distance) for distance in moved]
        if any(abs(a - b) > _WHOLE * max(1.0, patches) for a, b in zip(moved, nearest, strict=True)):
            speed = math.hypot(*nearest) * domain_size / float(loop_duration)
            direction = math.atan2(nearest[1], nearest[0]) if any(nearest) else layer.wind_direction
            raise ParameterError(
                f"pictures.{index}.translation_speed", layer.translation_speed,
                f"moves the picture by {moved[0]:.4g} and {moved[1]:.4g} patches in the loop, not by whole "
                f"ones: take {speed:.9g} m/s towards {direction:.9g} rad, another animation, or no loop",
            )  # fmt: skip
