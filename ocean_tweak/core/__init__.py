# SPDX-License-Identifier: GPL-3.0-or-later
"""The sea itself: NumPy and the standard library, nothing else."""

from .cascades.cascade import Cascade
from .ocean import Ocean
from .parameters import (
    Foam,
    HeroWave,
    Mask,
    OceanParameters,
    ParameterError,
    Patch,
    PictureLayer,
    Timing,
    Water,
    WaveLayer,
    WindFieldLayer,
    WindKey,
)
from .raster import Raster
from .sea_state_match import layer_for_sea_state
from .seas import grid_sea

__all__ = [
    "Cascade",
    "Foam",
    "HeroWave",
    "Mask",
    "Ocean",
    "OceanParameters",
    "ParameterError",
    "Patch",
    "PictureLayer",
    "Raster",
    "Timing",
    "Water",
    "WaveLayer",
    "WindFieldLayer",
    "WindKey",
    "grid_sea",
    "layer_for_sea_state",
]
