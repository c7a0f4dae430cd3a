# SPDX-License-Identifier: GPL-3.0-or-later
"""The three wind fields of Li & Wang (2016), figure 9, as starting points."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ...data.raster import Raster
from .parameters import WindFieldLayer, WindKey

#: number of vectors along each side
_SAMPLES = 16

#: wavelengths per patch, and the weakest and strongest wind in m/s
_WAVES, _LEAST, _STRONGEST = 24.0, 0.5, 40.0


def uniform(speed: float) -> WindFieldLayer:
    """Figure 9 B: the same wind everywhere, along x."""
    return WindFieldLayer(wind_speed=speed)


def opposed_halves(speed: float) -> WindFieldLayer:
    """Figure 9 D: wind to the left in the left half, to the right in the right half."""
    vectors = np.zeros((_SAMPLES, _SAMPLES, 2))
    vectors[:, : _SAMPLES // 2, 0] = -speed
    vectors[:, _SAMPLES // 2 :, 0] = speed
    return _of_vectors(vectors, "Opposed Halves")


def varying_speed(speed: float) -> WindFieldLayer:
    """Figure 9 F: one direction, weak at the lower edge of the patch and strong at the upper one."""
    vectors = np.zeros((_SAMPLES, _SAMPLES, 2))
    vectors[..., 0] = speed * np.linspace(0.4, 1.4, _SAMPLES)[:, np.newaxis]
    return _of_vectors(vectors, "Varying Speed")


#: by name
WIND_FIELDS: dict[str, Callable[[float], WindFieldLayer]] = {
    "UNIFORM": uniform,
    "OPPOSED_HALVES": opposed_halves,
    "VARYING_SPEED": varying_speed,
}


def wind_field(name: str, domain_size: float, gravity: float) -> WindFieldLayer:
    """A layer by name, with a wind whose waves have 1/24 of the patch's length: 13 m/s on 400 m.

    Raises KeyError for a name that is not in WIND_FIELDS.
    """
    speed = math.sqrt(domain_size * gravity / _WAVES)
    speed = float(f"{min(max(speed, _LEAST), _STRONGEST):.2g}")
    layer = WIND_FIELDS[name](speed)
    return dataclasses.replace(layer, minimum_wind_speed=min(layer.minimum_wind_speed, 0.25 * speed))


def _of_vectors(vectors: NDArray[np.float64], name: str) -> WindFieldLayer:
    return WindFieldLayer(keys=(WindKey(vectors=Raster(vectors, name)),))
