# SPDX-License-Identifier: GPL-3.0-or-later
"""The waves of one layer that need not repeat with the domain: known at any place, on no grid."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from ..data.errors import ParameterError
from ..masks import weights
from ..parameters.ocean_parameters import OceanParameters
from ..synthesis.transforms import X, Y, Z
from ..waves.contribution import Contribution, Gives
from .sampling import Key, unweighted, weighted
from .surfaces import Field, Values

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]


class PlacedWaves:
    """The waves of a layer that gives fields, in the sea's axes, under its mask."""

    def __init__(self, layer: Contribution, sea: OceanParameters) -> None:
        self._layer = layer
        self._sea = sea

    def at(self, x: Array, y: Array, time: float | Fraction, keys: Iterable[Key]) -> dict[Key, RealArray]:
        """Components of the displacement at rest positions in m, of one flat shape."""
        mask = self._layer.mask
        if mask is None:
            return dict(self._layer.fields(self._sea, x, y, time, frozenset(keys)))
        under = weights((mask,), self._sea.domain_size, x, y)
        return weighted(self._layer.fields(self._sea, x, y, time, unweighted(keys)), under)

    def field(self, time: float | Fraction) -> Field:
        """Their own surface at a time."""

        def surface(x: Array, y: Array, with_velocity: bool) -> tuple[Values, Array | None]:
            wanted = ("", "x", "y", "t") if with_velocity else ("", "x", "y")
            keys = [(component, by) for by in wanted for component in (X, Y, Z)]
            found = self.at(x, y, time, keys)
            columns: list[Array] = [
                np.stack([np.asarray(found[component, by], np.float64) for component in (X, Y, Z)], axis=-1)
                for by in wanted
            ]
            return Values(*columns[:3]), columns[3] if with_velocity else None

        return surface


def placed_waves(sea: OceanParameters) -> tuple[PlacedWaves, ...]:
    """Those of all layers that give fields."""
    return tuple(PlacedWaves(layer, sea) for layer in sea.active() if Gives.FIELDS in layer.gives)


def check_repeats(sea: OceanParameters) -> None:
    """Raise ParameterError, with the remedy, for a sea with waves that do not repeat, which has no tile."""
    for index, layer in enumerate(sea.layers):
        if Gives.FIELDS in layer.gives and not layer.muted:
            raise ParameterError(
                f"layers.{index}", layer.kind,
                "its waves do not repeat with the domain, as all on a Tile do: ask for an Area or Places, "
                "where files are written with --area, or mute the layer",
            )  # fmt: skip


def strain_covariances(sea: OceanParameters, drift: tuple[float, float]) -> list[tuple[Array, Array]]:
    """Of each of these layers that tells them, as `foam_threshold.strain_covariances` has them."""
    told = (layer.strain_covariances(sea, drift) for layer in sea.active() if Gives.FIELDS in layer.gives)
    return [found for found in told if found is not None]
