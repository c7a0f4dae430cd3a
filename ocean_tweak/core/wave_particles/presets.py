# SPDX-License-Identifier: GPL-3.0-or-later
"""The three wind fields of Li & Wang (2016), figure 9, as layers to begin with."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ..raster import Raster
from .parameters import WindFieldLayer, WindKey

#: m/s, and vectors along each side
_SPEED, _SAMPLES = 10.0, 16

#: the share of the wind whose waves are as long as the patch that a preset's may have
_ROOM = 0.5


def uniform(speed: float) -> WindFieldLayer:
    """Figure 9 B: the same wind everywhere, along x."""
    return WindFieldLayer(wind_speed=speed)


def opposed_halves(speed: float) -> WindFieldLayer:
    """Figure 9 D: to the left in the left half, to the right in the right half."""
    vectors = np.zeros((_SAMPLES, _SAMPLES, 2))
    vectors[:, : _SAMPLES // 2, 0] = -speed
    vectors[:, _SAMPLES // 2 :, 0] = speed
    return _of_vectors(vectors, "Opposed Halves")


def varying_speed(speed: float) -> WindFieldLayer:
    """Figure 9 F: one direction, weak at the patch's lower edge and strong at its upper one."""
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
    """A layer by its name, of 10 m/s, or less where the patch is too small for such waves.

    Raises KeyError for a name that is none of WIND_FIELDS.
    """
    fitting = _ROOM * math.sqrt(domain_size * gravity)
    return WIND_FIELDS[name](_SPEED if fitting >= _SPEED else float(f"{fitting:.2g}"))


def _of_vectors(vectors: NDArray[np.float64], name: str) -> WindFieldLayer:
    return WindFieldLayer(keys=(WindKey(vectors=Raster(vectors, name)),))
