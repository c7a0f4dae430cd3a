# SPDX-License-Identifier: GPL-3.0-or-later
"""The bump of water that a particle carries, and the radius classes of particles."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .relations import wavelength

if TYPE_CHECKING:
    from .parameters import WindFieldLayer

Array = NDArray[np.float64]

#: largest number of radii, smallest ratio of the smallest to the largest, and the ratio of neighbours below
# which there are fewer radii: rounding by less than a fifth is not visible, and each radius costs time
MOST_CLASSES, _WIDEST, _FINEST = 4, 16.0, 2.0**0.5

#: number of raster samples examined, and the fraction of them whose waves may be rounded up
_SAMPLES, _SHORTEST_SHARE = 65536, 0.05


class RadiusClasses(NamedTuple):
    """Radii in m, ascending: (at most 4,)."""

    radii: Array

    def nearest(self, radius: Array) -> NDArray[np.intp]:
        """The nearest class of radii in m, by ratio."""
        return np.searchsorted(np.sqrt(self.radii[1:] * self.radii[:-1]), radius)


def radius_classes(layers: Iterable[WindFieldLayer], gravity: float) -> RadiusClasses:
    """The particle radii of some layers, from their winds: half the wavelengths.

    The exact radii if there are at most four, else four with equal ratios. They do not depend on the
    resolution.
    """
    speeds = np.concatenate([np.zeros(0), *(_speeds(layer) for layer in layers)])
    radii = np.unique(0.5 * wavelength(speeds, gravity))
    if len(radii) == 0:
        return RadiusClasses(np.ones(1))
    if len(radii) <= MOST_CLASSES:
        return RadiusClasses(radii)
    largest = radii[-1]
    all_radii = 0.5 * wavelength(speeds, gravity)
    smallest = max(float(np.quantile(all_radii, _SHORTEST_SHARE)), largest / _WIDEST)
    count = int(np.clip(np.ceil(np.log(largest / smallest) / np.log(_FINEST) - 1e-9), 1, MOST_CLASSES))
    return RadiusClasses(smallest * (largest / smallest) ** ((np.arange(count) + 0.5) / count))


def _speeds(layer: WindFieldLayer) -> Array:
    """Speeds in m/s of a layer's winds that raise waves, at some of the samples of all keys."""
    if not layer.keys:
        speeds = np.array([layer.wind_scale * layer.wind_speed])
    else:
        parts = []
        for raster in layer.rasters:
            vectors = raster.values.reshape(-1, 2)
            some = vectors[:: max(1, len(vectors) // _SAMPLES)].astype(np.float64)
            parts.append(layer.wind_scale * np.hypot(some[:, 0], some[:, 1]))
        speeds = np.concatenate(parts)
    return speeds[speeds >= layer.minimum_wind_speed]


class Bump(NamedTuple):
    """The displacement around a particle of height 1, and its derivatives.

    position, by_x, by_y : (…, 3), of x, y and z
    """

    position: Array
    by_x: Array
    by_y: Array


def bump(dx: Array, dy: Array, radius: float) -> Bump:
    """The bump at places (dx, dy) in m from its centre; 0, with zero slope, from the radius outwards.

    W = ½(cos(π d/r) + 1): Li & Wang (2016), eq. 6, corrected (as printed there is a step at the rim);
    sideways -sin(π Δx/r)·W and -sin(π Δy/r)·W, eq. 23, which moves the water towards the crest.
    """
    distance = np.hypot(dx, dy)
    inside = distance < radius
    turn = np.pi / radius
    height = np.where(inside, 0.5 * (np.cos(turn * distance) + 1.0), 0.0)
    # dW/dd / d, which is finite at the centre
    steep = np.where(inside, -0.5 * turn * turn * np.sinc(distance / radius), 0.0)
    slope_x, slope_y = steep * dx, steep * dy
    sine_x, sine_y = np.sin(turn * dx), np.sin(turn * dy)
    position = (-sine_x * height, -sine_y * height, height)
    by_x = (-turn * np.cos(turn * dx) * height - sine_x * slope_x, -sine_y * slope_x, slope_x)
    by_y = (-sine_x * slope_y, -turn * np.cos(turn * dy) * height - sine_y * slope_y, slope_y)
    return Bump(*(np.stack(values, axis=-1) for values in (position, by_x, by_y)))
