# SPDX-License-Identifier: GPL-3.0-or-later
"""The sea itself: NumPy and the standard library, nothing else."""

from .ocean import Ocean
from .parameters import (
    Foam,
    HeroWave,
    OceanParameters,
    ParameterError,
    PictureLayer,
    Timing,
    Water,
    WaveLayer,
    WindFieldLayer,
    WindKey,
)
from .raster import Raster
from .sea_state_match import layer_for_sea_state

__all__ = [
    "Foam",
    "HeroWave",
    "Ocean",
    "OceanParameters",
    "ParameterError",
    "PictureLayer",
    "Raster",
    "Timing",
    "Water",
    "WaveLayer",
    "WindFieldLayer",
    "WindKey",
    "layer_for_sea_state",
]
