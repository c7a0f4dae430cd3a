# SPDX-License-Identifier: GPL-3.0-or-later
"""Interpolated wind, and rasters of wind sampled from functions."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...data.raster import Raster
from ...numerics.interpolation import between

if TYPE_CHECKING:
    from .parameters import WindFieldLayer

Array = NDArray[np.float64]

#: a function of places x and y in m, arrays of one shape, that returns the wind along x and along y in m/s
WindFunction = Callable[[Array, Array], tuple[ArrayLike, ArrayLike]]


def sampled_wind(wind: WindFunction, domain_size: float, samples: int = 64, name: str = "") -> Raster:
    """The raster of a wind given as a function, with this many samples along each side.

    Raises ParameterError, with the raster's name, if the wind is not finite.
    """
    places = np.arange(samples) * (domain_size / samples)
    x, y = np.meshgrid(places, places)
    components = [np.broadcast_to(np.asarray(component, np.float64), x.shape) for component in wind(x, y)]
    return Raster(np.stack(components, axis=-1), name)


def winds_at(layer: WindFieldLayer, x: Array, y: Array, domain_size: float) -> tuple[Array, Array]:
    """The layer's wind at places in m: times (K,) in s, ascending, and vectors (K, places, 2) in m/s."""
    if not layer.keys:
        direction = np.array([np.cos(layer.wind_direction), np.sin(layer.wind_direction)])
        wind = layer.wind_scale * layer.wind_speed * direction
        return np.zeros(1), np.broadcast_to(wind, (1, len(x), 2))
    times = np.array([key.time for key in layer.keys])
    vectors = np.stack([bilinear(raster, x, y, domain_size) for raster in layer.rasters])
    return times, layer.wind_scale * vectors


def bilinear(raster: Raster, x: Array, y: Array, domain_size: float) -> Array:
    """(places, channels) values of a raster over the patch, bilinear and periodic."""
    rows, columns, _ = raster.shape
    corners, *shares = between(y * (rows / domain_size), x * (columns / domain_size), raster.shape)
    u, v = (share[:, np.newaxis] for share in shares)
    p00, p01, p10, p11 = (raster.values[corner] for corner in corners)
    lower, upper = (1.0 - u) * p00 + u * p01, (1.0 - u) * p10 + u * p11
    return np.asarray((1.0 - v) * lower + v * upper)
