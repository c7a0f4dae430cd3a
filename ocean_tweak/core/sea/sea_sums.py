# SPDX-License-Identifier: GPL-3.0-or-later
"""What a sea's waves are a sum of, and how it is computed: on the samples of its tile, and at any places."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..foam.threshold import Strains, gaussian_strains
from ..parameters.ocean_parameters import OceanParameters
from ..parameters.patch_seas import merged_bands, parts
from .coast_waves import CoastWaves
from .memory import check_memory, memory_need
from .part_waves import PartWaves, real_type, strain_covariances
from .placed_waves import check_repeats, has_tile, placed_waves
from .placed_waves import strain_covariances as placed_strain_covariances
from .regions import TILE
from .sums import AnywhereSum, TileSum

Array = NDArray[np.float64]


class SeaSums:
    """The sums of a sea; see `Ocean`. Each is made when it is first wanted."""

    def __init__(self, parameters: OceanParameters, precision: str, workers: int | None) -> None:
        self._parameters, self._precision, self._workers = parameters, precision, workers

    @cached_property
    def added_up(self) -> OceanParameters:
        """The sea with its merged patches on the separate grids from which they are summed."""
        return merged_bands(self._parameters) if self._parameters.merged_resolution else self._parameters

    @cached_property
    def parts(self) -> tuple[PartWaves, ...]:
        """The waves of each patch under each mask. Raises MemoryError where the machine has too little."""
        sides = [patch.resolution for patch in self._parameters.patches if self._parameters.is_cascade]
        samples = " and ".join(f"{side}²" for side in sides or [self._parameters.resolution])
        need = memory_need(self._parameters, ("displacement",), self._precision, TILE)
        check_memory(need.peak(), f"A sea of {samples} samples")
        side = self._parameters.domain_size
        return tuple(PartWaves(part, side, self._precision, self._workers) for part in parts(self.added_up))

    @cached_property
    def tile(self) -> PartWaves | TileSum:
        """Computes the samples of the tile. Raises ValueError for a sea without one."""
        check_repeats(self._parameters)
        if self._parameters.is_cascade:
            raise ValueError(
                f"on = Tile(): patches that are separate, here {len(self._parameters.patches)}, have a tile "
                "each, in axes of their own: ask those in `patches`, ask for an Area or Places of their sum, "
                "or merge them with `parameters.on_one_grid(samples)`"
            )
        if not self._parameters.needs_summation:
            return self.parts[0]
        return TileSum(self._parameters, self.parts, real_type(self._precision), self._workers)

    @cached_property
    def anywhere(self) -> AnywhereSum:
        """Computes the sum at any places."""
        placed = placed_waves(self._parameters)
        return AnywhereSum(self._parameters, self.parts, placed, self._precision, self.coast)

    @cached_property
    def coast(self) -> CoastWaves | None:
        """What the waves are over the sea's bed; None for the open sea."""
        return CoastWaves(self._parameters, self.parts) if self._parameters.has_coast else None

    @property
    def has_tile(self) -> bool:
        """Whether the sea repeats on one grid."""
        return has_tile(self._parameters)

    @property
    def spacing(self) -> float:
        """Between samples of the tile, m."""
        return self._parameters.domain_size / self._parameters.resolution

    def strains(self, drift: tuple[float, float]) -> Strains:
        """Strain statistics of all parts together, seen from a point with this drift."""
        return gaussian_strains(*self._strain_covariances(drift))

    def _strain_covariances(self, drift: tuple[float, float]) -> tuple[Array, Array]:
        """Of the gradient's xx, yy and xy, and of their rates, (3, 3) each."""
        gradient, rates = strain_covariances(self.parts, drift, between_samples=not self.has_tile)
        for of_gradient, of_rates in placed_strain_covariances(self._parameters, drift):
            gradient, rates = gradient + of_gradient, rates + of_rates
        return gradient, rates

    @cached_property
    def divergence_variance(self) -> float:
        """Mean square of ∂Dx/∂x + ∂Dy/∂y, bilinear between samples, without masks."""
        (xx, yy, _), _ = self._strain_covariances((0.0, 0.0))
        return float(xx[0] + 2.0 * xx[1] + yy[1])
