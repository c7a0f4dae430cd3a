# SPDX-License-Identifier: GPL-3.0-or-later
"""Parameters of waves from an image."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...data.errors import ParameterError
from ...data.raster import Raster
from ...data.validation import choice, integer, nested, number, raster
from ...masks.parameters import Mask
from ..contribution import (
    Contribution,
    Gives,
    MemoryNeed,
    Names,
    Wind,
    amplitude_scale,
    direction,
    identity,
    muted,
    own_seed,
    wave_height,
    wind_speed,
)
from .animation import angular_frequency
from .source import side
from .state import filtered, image_waves, peak_wavelength, state_of, wanted_variance

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from ...numerics.grid import WaveVectorGrid
    from ...parameters.ocean_parameters import OceanParameters
    from ...spectral.sea_state import SeaState
    from ...synthesis.coefficients import Coefficients

FILTERS = ("MODIFIED_PIERSON_MOSKOWITZ", "FRACTAL", "WATER_TEXTURE")
FILTER_GAINS = ("PHYSICAL", "PAPER")
ANIMATIONS = ("DISPERSION", "DOMINANT_BAND", "TRANSLATION")

#: how far from a whole number of patches a loop's translation may be: rounding, no more
_WHOLE = 1e-6

#: complex arrays of half an image's plane that live while it is filtered
_WORKING_ARRAYS = 3


@dataclass(frozen=True)
class ImageLayer(Contribution):
    """Waves out of one image, which is stretched over the patch and filtered there.

    Examples
    --------
    >>> import numpy as np
    >>> from ocean_tweak.core import ImageLayer, OceanParameters, Raster, WaveLayer
    >>> drawing = ImageLayer(image=Raster(np.random.default_rng(1).random((64, 64))))
    >>> [layer.kind for layer in OceanParameters(layers=(WaveLayer(wind_speed=0.0), drawing)).layers]
    ['WAVES', 'IMAGE']
    """

    kind = "IMAGE"
    gives = Gives.COEFFICIENTS | Gives.STATE | Gives.LOOPS
    names = Names(
        2, "image_waves", "image", "Image", "Waves from an image, or from white noise", "IMAGE_DATA",
        entry="Image or Noise",
    )  # fmt: skip
    former_list = "pictures"
    constant = "an image keeps its waves; animate ocean_time to change how fast they move"

    image: Raster | None = raster(
        "Image whose phases and magnitudes become waves; none for white noise",
        channels=1,
    )  # fmt: skip
    filter: str = choice(
        "MODIFIED_PIERSON_MOSKOWITZ",
        FILTERS,
        "Which wavelengths and directions of the image are kept: those of a wind, a fractal or a texture",
    )
    filter_gain: str = choice(
        "PHYSICAL", FILTER_GAINS,
        "Modified Pierson-Moskowitz: waves with the height of the wind, or the paper's filter "
        "with significant_wave_height",
    )  # fmt: skip
    wind_speed: float = wind_speed("Mean wind at 10 m that shapes the modified Pierson-Moskowitz filter")
    wind_direction: float = direction()
    significant_wave_height: float = wave_height(
        1.0,
        "Significant wave height Hs for every filter but the physical one: four standard deviations",
    )
    amplitude_scale: float = amplitude_scale("Multiplies the layer's wave height")
    fractal_dimension: float = number(
        2.1, 2.0, 4.0, "", "Dimension D of the filters 1/f^β with β = 8 - 2D: 2 is smooth, 3 rough, 4 no "
        "filter",
        "a surface's dimension, and beyond",
    )  # fmt: skip
    texture_wavelength: float = number(
        2.0, 1e-3, 1e5, "m", "Wavelength of the water texture's peak: 1/f^β below, a Gaussian above",
        "from ripples to the largest domain",
    )  # fmt: skip
    animation: str = choice(
        "DISPERSION",
        ANIMATIONS,
        "How the waves move: each at its own speed, the highest apart from the rest, or all as one",
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
        1.0, 0.0, 1000.0, "m/s", "Translation: how fast the whole image moves along the wind",
        "beyond the fastest wave",
    )  # fmt: skip
    noise_resolution: int = integer(
        1024, 16, 2048, "Samples along each side of the white noise, an even number; another number is "
        "another sea",
        "from the coarsest sea to the largest image that is not made smaller", even_from=16,
    )  # fmt: skip
    muted: bool = muted()
    id: int = identity()
    seed: int = own_seed("Seed of the white noise")
    mask: Mask | None = nested(Mask, optional=True)

    def __post_init__(self) -> None:
        if isinstance(self.image, Raster):
            object.__setattr__(self, "image", _grey(self.image))
        super().__post_init__()

    @property
    def is_physical(self) -> bool:
        """Whether the wind sets the wave height."""
        return self.filter == "MODIFIED_PIERSON_MOSKOWITZ" and self.filter_gain == "PHYSICAL"

    def check(self, sea: OceanParameters, path: str) -> None:
        """Check that a translation returns to its start at the end of the loop, as the image would otherwise
        be distorted.

        It does where it moves by whole patches both ways.
        """
        if sea.loop_duration is None or self.animation != "TRANSLATION":
            return
        duration = float(sea.loop_duration)
        patches = self.translation_speed * duration / sea.domain_size
        moved = [patches * part(self.wind_direction) for part in (math.cos, math.sin)]
        nearest = [round(distance) for distance in moved]
        if any(abs(a - b) > _WHOLE * max(1.0, patches) for a, b in zip(moved, nearest, strict=True)):
            speed = math.hypot(*nearest) * sea.domain_size / duration
            direction = math.atan2(nearest[1], nearest[0]) if any(nearest) else self.wind_direction
            raise ParameterError(
                f"{path}.translation_speed", self.translation_speed,
                f"moves the image by {moved[0]:.4g} and {moved[1]:.4g} patches during the loop, "
                f"not by whole ones: use {speed:.9g} m/s towards {direction:.9g} rad, another "
                "animation, or no loop",
            )  # fmt: skip

    def add(self, sea: OceanParameters, to: Coefficients) -> None:
        """Add its waves: to the sea's own if they have the same frequencies, which costs nothing per
        frame."""
        waves = image_waves(
            self, to.grid, sea.dispersion, sea.water, sea.seed, sea.loop_duration, sea.match_height, to.dtype
        )
        if self.animation == "DISPERSION":
            for target, part in (
                (to.h_plus, waves.h_plus), (to.h_minus, waves.h_minus),
                (to.expected_plus, waves.expected_plus), (to.expected_minus, waves.expected_minus),
            ):  # fmt: skip
                target += part
        else:
            to.set_apart(self, *waves, mirrored=self.animation != "TRANSLATION")

    def frequencies(self, sea: OceanParameters, grid: WaveVectorGrid) -> NDArray[np.float64] | None:
        """Angular frequencies of its waves without a loop."""
        return angular_frequency(self, grid, sea.dispersion, sea.water)

    def state(self, sea: OceanParameters) -> SeaState:
        """State of all modes of the image."""
        return state_of(sea.alone(self), self)

    def longest_random_wave(self, sea: OceanParameters) -> float:
        """The peak wavelength of noise with the physical filter; other images have a fixed height."""
        if self.image is not None or not self.is_physical or not wanted_variance(self, sea.water) > 0.0:
            return float("nan")
        return peak_wavelength(self, sea.dispersion, sea.water)

    def slope_variance(self, sea: OceanParameters, resolution: int | None) -> float:
        """Mean square slope of all modes of the image, or of those on a grid with this many samples."""
        made = filtered(self, sea.domain_size, resolution, sea.dispersion, sea.water, sea.seed)
        return made.slope_variance

    def wind(self, sea: OceanParameters) -> Wind | None:
        """The wind of the modified Pierson-Moskowitz filter."""
        if self.filter != "MODIFIED_PIERSON_MOSKOWITZ" or not wanted_variance(self, sea.water) > 0.0:
            return None
        return Wind(self.wind_speed, self.wind_direction)

    @classmethod
    def memory(cls, sea: OceanParameters, real: int, moving: bool) -> MemoryNeed:
        """Coefficients of waves with frequencies of their own, and the memory for filtering."""
        layers = sea.active(cls)
        apart = sum(layer.animation != "DISPERSION" for layer in layers)
        half_plane = sea.resolution * (sea.resolution // 2 + 1)
        filtering = max((16 * _WORKING_ARRAYS * side(layer) ** 2 for layer in layers), default=0)
        return MemoryNeed(half_plane * (3 * 2 * real + 8) * apart, filtering, 0)

    def warnings(self, sea: OceanParameters) -> Iterator[str]:
        """A warning for an image of which the filter leaves nothing."""
        if wanted_variance(self, sea.water) > 0.0 and not self.state(sea).m0 > 0.0:
            yield f"Image {self.id}: its filter leaves nothing of it. Use another filter, wind or image"


def _grey(image: Raster) -> Raster:
    """One channel: the luminance of a colour image; the fourth is transparency, which is left out.

    Raises ParameterError, naming the image, where it holds no waves.
    """
    image = image.grey()
    if np.ptp(image.values) == 0.0:
        what = f"image ({image.name})" if image.name else "image"
        raise ParameterError(
            what, float(image.values.flat[0]), "everywhere, so it holds no waves: use an image with contrast"
        )
    return image
