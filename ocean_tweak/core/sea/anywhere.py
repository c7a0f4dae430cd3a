# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts of a sea, and waves on no grid, added up at rest positions anywhere."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..masks.parameters import Mask
from ..masks.weights import Weights, weights
from ..numerics.memo import MEMO, total_bytes
from ..parameters.ocean_parameters import OceanParameters
from ..synthesis.channels import CHANNELS
from .part_waves import PartWaves
from .placed_waves import PlacedWaves
from .query import SurfacePoints, find_summed_points
from .sampling import Components, Grid, Key, Summed, closed, unweighted
from .surfaces import Field, summed_field

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]

#: what the foam of places looks back at: with more than a quarter of the memory it would push out all else
_STRAINS = "strains"
MEMO.limit(_STRAINS, 4)


class AnywhereSum:
    """The sum of a sea's waves at any rest positions: parts are read between their samples.

    parameters, precision : of the sea
    parts, placed : whose sum it is
    """

    def __init__(
        self,
        parameters: OceanParameters,
        parts: Sequence[PartWaves],
        placed: Sequence[PlacedWaves],
        precision: str,
    ) -> None:
        self._parameters = parameters
        self._parts = parts
        self._placed = placed
        self._precision = precision

    def fill(
        self,
        x: Array,
        y: Array,
        time: float | Fraction,
        wanted: Iterable[str],
        fields: Mapping[str, RealArray],
    ) -> None:
        """Fill the arrays of outputs that have no memory, whose first axes hold the flat x and y in m."""
        needs = frozenset().union(*(CHANNELS[name].needs for name in wanted))
        sums = self._sums(x, y, time, needs, self._components(time, needs))
        for name in wanted:
            components = CHANNELS[name].components
            made: RealArray = np.empty((x.size, components) if components else x.size, fields[name].dtype)
            CHANNELS[name].write(sums, made)
            fields[name][...] = made.reshape(fields[name].shape)

    def squeeze_at(self, x: Array, y: Array, time: Fraction) -> RealArray:
        """(places,) float32 of the channel cusp; the strains it is made of are remembered, for the next
        frame's foam looks back at them too.
        """
        needs = CHANNELS["cusp"].needs
        key = (self._parameters, self._precision, time)
        strains = MEMO.get(_STRAINS, key, lambda: _Strains(self._components(time, needs)))
        squeeze = np.empty(x.shape, np.float32)
        CHANNELS["cusp"].write(self._sums(x, y, time, needs, strains.of_parts), squeeze)
        return squeeze

    def exact_field(self, time: float | Fraction) -> Field:
        """The band-limited surface. Raises ValueError with trough damping, which leaves no sum of waves."""
        return summed_field([waves.exact_field(time) for waves in self._parts] + self._placed_fields(time))

    def points_above(
        self, x: ArrayLike, y: ArrayLike, time: float | Fraction, with_velocity: bool
    ) -> tuple[SurfacePoints, float]:
        """Points of the sum of the parts' bilinear surfaces, and the fewest metres between samples."""
        fields, reaches = zip(*(waves.mesh_field(time, with_velocity) for waves in self._parts), strict=True)
        spacings = [waves.part.spacing for waves in self._parts]
        finest, reach = min(spacings), sum(reaches)
        for waves in self._placed:
            moved = waves.at(np.ravel(x), np.ravel(y), time, ((0, ""), (1, "")))
            reach += float(np.max(np.hypot(moved[0, ""], moved[1, ""]), initial=0.0))
        placed = self._placed_fields(time)
        spacings += [finest] * len(placed)
        return find_summed_points(x, y, [*fields, *placed], spacings, reach, with_velocity), finest

    def _placed_fields(self, time: float | Fraction) -> list[Field]:
        return [waves.field(time) for waves in self._placed]

    def _components(self, time: float | Fraction, needs: Iterable[Key]) -> list[Components]:
        """Of each part on its own samples."""
        wanted = closed(needs)
        if not wanted:
            return [{} for _ in self._parts]
        return [
            waves.components(time, unweighted(wanted) if waves.part.masks else wanted)
            for waves in self._parts
        ]

    def _sums(
        self,
        x: Array,
        y: Array,
        time: float | Fraction,
        needs: Iterable[Key],
        components: Sequence[Components],
    ) -> Summed:
        known: dict[tuple[Mask, ...], Weights] = {}
        found = []
        for waves, of_part in zip(self._parts, components, strict=True):
            part = waves.part
            if part.masks and part.masks not in known:
                known[part.masks] = weights(part.masks, self._parameters.domain_size, x, y)
            grid = Grid(of_part, part.parameters.domain_size, part.rotation)
            found.append(grid.read(x, y, known.get(part.masks)))
        return Summed([*found, *(waves.at(x, y, time, needs) for waves in self._placed)])


@dataclass(frozen=True)
class _Strains:
    """Strains of a moment, of each part on its own samples."""

    of_parts: list[Components]

    @property
    def nbytes(self) -> int:
        """Bytes of all."""
        return total_bytes(field for components in self.of_parts for field in components.values())
