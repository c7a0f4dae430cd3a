# SPDX-License-Identifier: GPL-3.0-or-later
"""The wind at places, and rasters of winds made from functions."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...raster import Raster
from .parameters import WindFieldLayer

Array = NDArray[np.float64]

#: from places x and y in m, arrays of one shape, to the wind along x and along y in m/s there
WindFunction = Callable[[Array, Array], tuple[ArrayLike, ArrayLike]]


def sampled_wind(wind: WindFunction, domain_size: float, samples: int = 64, name: str = "") -> Raster:
    """The raster of a wind that is given as a function, with so many samples along each side.

    Raises ParameterError, naming it, where the wind is not finite.
    """
    places = np.arange(samples) * (domain_size / samples)
    x, y = np.meshgrid(places, places)
    components = [np.broadcast_to(np.asarray(component, np.float64), x.shape) for component in wind(x, y)]
    return Raster(np.stack(components, axis=-1), name)


def winds_at(layer: WindFieldLayer, x: Array, y: Array, domain_size: float) -> tuple[Array, Array]:
    """The layer's wind at places in m: times (K,) in s, ascending, and vectors (K, places, 2) in m/s."""
    if not layer.keys:
        direction = np.array([np.cos(layer.wind_direction), np.sin(layer.wind_direction)])
        wind = layer.strength * layer.wind_speed * direction
        return np.zeros(1), np.broadcast_to(wind, (1, len(x), 2))
    times = np.array([key.time for key in layer.keys])
    vectors = np.stack([bilinear(raster, x, y, domain_size) for raster in layer.rasters])
    return times, layer.strength * vectors


def bilinear(raster: Raster, x: Array, y: Array, domain_size: float) -> Array:
    """(places, channels) values of a raster over the patch, bilinear and periodic."""
    rows, columns, _ = raster.shape
    column, row = x * (columns / domain_size), y * (rows / domain_size)
    left, below = np.floor(column), np.floor(row)
    u, v = (column - left)[:, np.newaxis], (row - below)[:, np.newaxis]
    j, i = left.astype(np.intp), below.astype(np.intp)
    j0, j1, i0, i1 = j % columns, (j + 1) % columns, i % rows, (i + 1) % rows
    values = raster.values
    lower = (1.0 - u) * values[i0, j0] + u * values[i0, j1]
    upper = (1.0 - u) * values[i1, j0] + u * values[i1, j1]
    return np.asarray((1.0 - v) * lower + v * upper)
