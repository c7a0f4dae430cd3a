# SPDX-License-Identifier: GPL-3.0-or-later
"""The particles of a sea's wind fields, and their contributions to the sea's coefficients."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ...numerics.grid import WaveVectorGrid
from .convolution import Points, along_x, deposit, kernel
from .emission import Emission, emission_of
from .life import Particles, joined, particles_of
from .shape import RadiusClasses, radius_classes

if TYPE_CHECKING:
    from ...parameters.ocean_parameters import OceanParameters
    from .parameters import WindFieldLayer

ComplexArray = NDArray[np.complexfloating]

#: samples per shortest wave that is shown
SHORTEST = 4.0


class WindWaves:
    """The waves of some wind fields of a sea."""

    def __init__(self, parameters: OceanParameters, layers: Sequence[WindFieldLayer]) -> None:
        self._parameters = parameters
        self._gravity = parameters.water.gravity
        self._layers = layers
        self._grid = WaveVectorGrid(parameters.resolution, parameters.domain_size)

    @cached_property
    def classes(self) -> RadiusClasses:
        """The radius classes of their particles."""
        return radius_classes(self._layers, self._gravity)

    @cached_property
    def _emissions(self) -> list[Emission]:
        size, seed = self._parameters.domain_size, self._parameters.seed
        return [emission_of(layer, seed, size, self._gravity) for layer in self._layers]

    def particles(self, time: float) -> Particles:
        """All particles at a time in s, layer by layer."""
        shortest = SHORTEST * self._parameters.domain_size / self._parameters.resolution
        current = self._parameters.current
        moving = (0.0, 0.0) if current is None else current.velocity
        parts = [
            particles_of(emission.births(time), layer, self.classes, self._gravity, shortest, moving)
            for emission, layer in zip(self._emissions, self._layers, strict=True)
        ]
        return joined(parts)

    def shares(self, time: float, still: bool, moving: bool, dtype: type, workers: int = 1) -> Shares:
        """The contributions of the particles at a time: to positions if `still`, and to rates if `moving`.

        workers : threads, among which the radii are divided; the result does not depend on their number
        """
        particles = self.particles(time)

        def points_of(index: int) -> Points:
            these = np.nonzero(particles.shape == index)[0]
            own = Particles._make(column[these] for column in particles)
            rates = (
                own.amplitude_rate,
                own.amplitude * own.velocity_x,
                own.amplitude * own.velocity_y,
            )
            weights = [own.amplitude] * still + [*rates] * moving
            grids = deposit(own.x, own.y, weights, self._grid)
            transformed = [along_x(values, dtype) for values in grids]
            return Points(
                kernel(self._grid, float(self.classes.radii[index]), dtype),
                transformed[0] if still else None,
                (transformed[-3], transformed[-2], transformed[-1]) if moving else None,
            )

        present = [int(index) for index in np.unique(particles.shape)]
        if workers == 1 or len(present) < 2:
            return Shares(self._grid, [points_of(index) for index in present])
        with ThreadPoolExecutor(workers) as pool:
            return Shares(self._grid, list(pool.map(points_of, present)))


class Shares:
    """Contributions of the particles at one time."""

    def __init__(self, grid: WaveVectorGrid, points: list[Points]) -> None:
        self._grid = grid
        self._points = points

    def of_block(self, block: slice, scale: float = 1.0) -> BlockShares:
        """Those of a block of columns kx, times `scale`."""
        return BlockShares(self._grid, self._points, block, scale)


class BlockShares:
    """Contributions to a block of columns; the particles of each radius are transformed once."""

    def __init__(self, grid: WaveVectorGrid, points: list[Points], block: slice, scale: float) -> None:
        self._grid = grid
        self._points = points
        self._block = block
        self._scale = scale / grid.resolution**2
        self._made: dict[bool, list[ComplexArray]] = {}

    def add(self, component: int, rate: bool, target: ComplexArray, factor: float = 1.0) -> None:
        """Add the share in P[component], or in its rate, times `factor` to coefficients (columns, N)."""
        if rate not in self._made:
            self._made[rate] = [p.coefficients(rate, self._block, self._grid) for p in self._points]
        scale = factor * self._scale
        for points, coefficients in zip(self._points, self._made[rate], strict=True):
            share = points.kernel.columns(component, self._block, self._grid)
            share *= coefficients
            if scale != 1.0:
                share *= scale
            target += share
