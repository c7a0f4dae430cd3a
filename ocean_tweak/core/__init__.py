# SPDX-License-Identifier: GPL-3.0-or-later
"""The sea itself: NumPy and the standard library, nothing else."""

from .data.raster import Raster
from .parameters.ocean_parameters import (
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
from .sea.ocean import Ocean
from .sea.on import Area, Places, Tile
from .statistics.sea_state_match import layer_for_sea_state

__all__ = [
    "Area",
    "Foam",
    "HeroWave",
    "Mask",
    "Ocean",
    "OceanParameters",
    "ParameterError",
    "Patch",
    "PictureLayer",
    "Places",
    "Raster",
    "Tile",
    "Timing",
    "Water",
    "WaveLayer",
    "WindFieldLayer",
    "WindKey",
    "layer_for_sea_state",
]
