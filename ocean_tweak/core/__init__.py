# SPDX-License-Identifier: GPL-3.0-or-later
"""The sea itself. Depends on NumPy and the standard library only."""

from .data.raster import Raster
from .parameters.ocean_parameters import (
    Coast,
    Current,
    Equaliser,
    Foam,
    HeroWave,
    ImageLayer,
    Mask,
    MeasuredSpectra,
    OceanParameters,
    ParameterError,
    Patch,
    PathSample,
    Spray,
    Timing,
    WakeLayer,
    Water,
    WaveLayer,
    WindFieldLayer,
    WindKey,
)
from .sea.ocean import Ocean
from .sea.regions import Area, Places, Tile
from .statistics.sea_state_match import layer_for_sea_state
from .waves.wake.elevation import wake_elevation

__all__ = [
    "Area",
    "Coast",
    "Current",
    "Equaliser",
    "Foam",
    "HeroWave",
    "ImageLayer",
    "Mask",
    "MeasuredSpectra",
    "Ocean",
    "OceanParameters",
    "ParameterError",
    "Patch",
    "PathSample",
    "Places",
    "Raster",
    "Spray",
    "Tile",
    "Timing",
    "WakeLayer",
    "Water",
    "WaveLayer",
    "WindFieldLayer",
    "WindKey",
    "layer_for_sea_state",
    "wake_elevation",
]
