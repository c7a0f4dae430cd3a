# SPDX-License-Identifier: GPL-3.0-or-later
"""The surface of particles by adding one after the other: slow, exact, and what the quick way is held to."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ocean_tweak.core.waves.wind_field.life import Particles
from ocean_tweak.core.waves.wind_field.shape import RadiusClasses, bump

Array = NDArray[np.float64]


class Stamped(NamedTuple):
    """(N, N, 3) each, [y, x], without choppiness: the position, its derivatives in m/m and m/s."""

    position: Array
    by_x: Array
    by_y: Array
    by_time: Array


def stamp(
    particles: Particles,
    classes: RadiusClasses,
    resolution: int,
    domain_size: float,
    mirrors: bool = True,
    without_mean: bool = True,
) -> Stamped:
    """The sum of all particles on the samples of the patch.

    mirrors : whether what leaves the patch on one side comes in on the other, Li & Wang (2016), figure 8
    without_mean : whether the mean height is taken away: particles only lift
    """
    spacing = domain_size / resolution
    result = Stamped(*(np.zeros((resolution, resolution, 3)) for _ in range(4)))
    for x, y, along, up, amplitude, rate, shape in zip(*particles, strict=True):
        radius = float(classes.radii[shape])
        x, y = x % domain_size, y % domain_size
        columns = np.arange(int(np.ceil((x - radius) / spacing)), int((x + radius) // spacing) + 1)
        rows = np.arange(int(np.ceil((y - radius) / spacing)), int((y + radius) // spacing) + 1)
        if not mirrors:
            columns = columns[(columns >= 0) & (columns < resolution)]
            rows = rows[(rows >= 0) & (rows < resolution)]
        dx, dy = np.meshgrid(columns * spacing - x, rows * spacing - y)
        values = bump(dx, dy, radius)
        moved = rate * values.position - amplitude * (along * values.by_x + up * values.by_y)
        where = np.ix_(rows % resolution, columns % resolution)
        for target, value in zip(result, (*(amplitude * part for part in values), moved), strict=True):
            target[where] += value
    if without_mean:
        for target in (result.position, result.by_time):
            target[..., 2] -= target[..., 2].mean()
    return result
