# SPDX-License-Identifier: GPL-3.0-or-later
"""A sea whose waves are added up on the samples of one grid: of patches that are joined, or under masks.

The first patch's own samples are the grid's; the others are read between theirs. Waves shorter than two
samples of the grid are left out, or they would show as longer ones.

A patch that does not fit the square is made to repeat with it: along the far sides it goes over into what
lies before the near ones. Both are of the same spectrum and independent, so shares whose squares add up to 1
keep the variance.
"""

from __future__ import annotations

from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from fractions import Fraction
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..channels import CHANNELS, memory_groups
from ..foam import FoamModel
from ..foam_field import foam_model_of
from ..foam_threshold import Strains, sampled_strains
from ..grid_sea import GridSea
from ..masks.parameters import Mask
from ..masks.weights import Weights, weights_on_grid
from ..memory import check_memory, memory_need
from ..ocean import Ocean
from ..parameters import OceanParameters
from ..statistics import Statistics
from ..surface_query import Field
from .cascade import Cascade
from .patch_seas import Part, joined_bands, parts
from .sampling import Components, Grid, Key, Summed, closed, unweighted, weighted
from .strains import summed_strain_covariances

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]

#: rows of the grid that are read at once between the samples of another
_ROWS = 64

#: width in which a patch goes over at the far sides: in its longest waves, and in sides of the square at most
_BORDER_WAVES, _WIDEST_BORDER = 2.0, 0.1


class JoinedSea(GridSea):
    """The sea of some parameters on the samples of one grid; for the arguments see `GridSea`.

    Raises ValueError for several patches that are not joined: each has a grid of its own.
    """

    def __init__(
        self, parameters: OceanParameters, precision: str = "single", workers: int | None = None
    ) -> None:
        super().__init__(parameters, precision, workers)
        if parameters.is_cascade:
            raise ValueError(
                f"joined = 0: this sea has {len(parameters.patches)} patches; say of how many samples"
            )
        self._apart = joined_bands(parameters) if parameters.joined else parameters
        self._parts = parts(self._apart)
        self._oceans = tuple(Ocean(part.parameters, precision, workers) for part in self._parts)
        self._kept_weights: dict[tuple[Mask, ...], Weights] = {}

    def prepare(self) -> None:
        """Make the waves of all parts. Raises MemoryError, before that, where the machine is too small."""
        need = memory_need(self.parameters, precision=self.precision).peak()
        check_memory(need, f"A sea of {self.parameters.resolution}² samples")
        for ocean in self._oceans:
            ocean.prepare()

    def exact_field(self, time: float | Fraction) -> Field:
        """The band-limited surface of the sum of all patches; see `Cascade`."""
        return Cascade(self._apart, self.precision, self.workers).exact_field(time)

    def statistics(self) -> Statistics:
        """Wave height, period and wavelength, of the waves that the grid holds, without their masks."""
        return Cascade(self._apart, self.precision, self.workers).statistics().total

    @cached_property
    def foam_model(self) -> FoamModel:
        """How foam is born and lives: its threshold is that of the sea without masks."""

        def strains_of(drift: tuple[float, float]) -> Strains:
            return sampled_strains(*self.strain_covariances(drift))

        return foam_model_of(self.parameters, strains_of, self._spacing)

    def strain_covariances(self, drift: tuple[float, float]) -> tuple[Array, Array]:
        """Of the strains on the grid and of their rates; see `summed_strain_covariances`."""
        return summed_strain_covariances(
            self._oceans, self._parts, drift, lambda part: not self._is_on_grid(part)
        )

    @property
    def _spacing(self) -> float:
        return self.parameters.domain_size / self.parameters.resolution

    def _is_on_grid(self, part: Part) -> bool:
        return part.patch == 0 and not part.rotation

    def _fill(self, time: float | Fraction, wanted: frozenset[str], fields: Mapping[str, RealArray]) -> None:
        for group in memory_groups(wanted):
            needs = frozenset().union(*(CHANNELS[name].needs for name in group))
            sums = Summed(
                self._on_grid(ocean, part, time, needs)
                for ocean, part in zip(self._oceans, self._parts, strict=True)
            )
            for name in group:
                CHANNELS[name].write(sums, fields[name])

    def _on_grid(
        self, ocean: Ocean, part: Part, time: float | Fraction, needs: frozenset[Key]
    ) -> dict[Key, RealArray]:
        """The (N, N) components of a part."""
        is_on_grid = self._is_on_grid(part)
        wanted = needs if is_on_grid else unweighted(closed(needs))
        components = ocean.components(time, unweighted(wanted) if part.masks else wanted)
        on_grid = components if is_on_grid else self._read(components, part)
        return weighted(on_grid, self._weights(part.masks))

    def _read(self, components: Components, part: Part) -> dict[Key, RealArray]:
        """A patch between its samples, in the sea's axes, made to repeat with the square."""
        n, side = self.parameters.resolution, self.parameters.domain_size
        longest = self._apart.patches[part.patch].longest_wavelength
        border = min(_BORDER_WAVES * longest, _WIDEST_BORDER * side)
        grid = Grid(components, part.parameters.domain_size, part.rotation)
        result: dict[Key, RealArray] = {key: np.empty((n, n), self.dtype) for key in components}
        along = self._spacing * np.arange(n)
        inner = int(np.searchsorted(along, side - border))

        def fill(rows: slice, columns: slice, within: bool) -> None:
            x, y = (place.ravel() for place in np.meshgrid(along[columns], along[rows]))
            found = grid.read(x, y) if within else _repeating(grid, x, y, side, border)
            for key, value in found.items():
                result[key][rows, columns] = value.reshape(result[key][rows, columns].shape)

        blocks = [slice(first, min(first + _ROWS, inner)) for first in range(0, inner, _ROWS)]
        beyond = slice(inner, n)
        areas = [(rows, slice(0, inner), True) for rows in blocks]
        areas += [(slice(0, inner), beyond, False), (beyond, slice(0, n), False)]
        with ThreadPoolExecutor(self.workers) as pool:
            list(pool.map(lambda area: fill(*area), areas))
        return result

    def _weights(self, masks: tuple[Mask, ...]) -> Weights | None:
        if masks and masks not in self._kept_weights:
            made = weights_on_grid(masks, self.parameters.domain_size, self.parameters.resolution)
            self._kept_weights[masks] = Weights(*(part.astype(self.dtype) for part in made))
        return self._kept_weights.get(masks)


def _repeating(grid: Grid, x: Array, y: Array, side: float, border: float) -> dict[Key, RealArray]:
    """A grid at places in a square, near whose far sides it goes over into what lies before the near ones."""
    along_x, along_y = border_shares(x, side, border), border_shares(y, side, border)
    total: dict[Key, RealArray] = {}
    for share_x, slope_x, back_x in along_x:
        for share_y, slope_y, back_y in along_y:
            there = (share_x > 0.0) & (share_y > 0.0)
            weights = Weights(share_x * share_y, slope_x * share_y, share_x * slope_y)
            inside = Weights(*(part[there] for part in weights))
            for key, value in grid.read(x[there] - back_x, y[there] - back_y, inside).items():
                if key not in total:
                    total[key] = np.zeros(x.shape, value.dtype)
                total[key][there] += value
    return total


def border_shares(place: Array, side: float, border: float) -> tuple[tuple[Array, Array, float], ...]:
    """How much counts of what is there and of what is a side before, the derivative of that, and the side.

    Shares are cosine and sine of an angle that rises smoothly from 0 to a quarter turn within the border.
    """
    part = np.clip((place - (side - border)) / border, 0.0, 1.0)
    angle = 0.5 * np.pi * part * part * (3.0 - 2.0 * part)
    rate = 3.0 * np.pi * part * (1.0 - part) / border
    cosine, sine = np.cos(angle), np.sin(angle)
    return (cosine, -sine * rate, 0.0), (sine, cosine * rate, side)
