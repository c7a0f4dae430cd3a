# SPDX-License-Identifier: GPL-3.0-or-later
"""The seas of the open file's oceans and their latest surfaces, kept from one frame to the next."""

from __future__ import annotations

import json
from collections import OrderedDict
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from ..core import Ocean, OceanParameters
from .settings import all_oceans

# a frame with motion blur asks for n, n - ¼, n + ¼ and n again
_MOST_SURFACES = 4
_MOST_SURFACE_BYTES = 256 * 2**20
# of one ocean: for the viewport, for the render, and the coarse one while a parameter is dragged
_SEAS_OF_AN_OCEAN = 3


class Sea:
    """An ocean and its latest surfaces."""

    def __init__(self, parameters: OceanParameters) -> None:
        self.ocean = Ocean(parameters)
        self._surfaces: OrderedDict[Fraction, NDArray[np.float32]] = OrderedDict()

    def surface(self, frame: Fraction) -> NDArray[np.float32]:
        """Displacement at a frame: (N+1, N+1, 3), m; the last row and column are the first ones again.

        A surface that was made before is not made again. The array is overwritten by one that is asked for
        later, so it must be used up at once.
        """
        time = self.ocean.parameters.timing.time(frame)
        if time in self._surfaces:
            self._surfaces.move_to_end(time)
            return self._surfaces[time]
        closed = self._array()
        self.ocean.surface(time, out={"displacement": closed[:-1, :-1]})
        closed[-1, :-1] = closed[0, :-1]
        closed[:, -1] = closed[:, 0]
        self._surfaces[time] = closed
        return closed

    def _array(self) -> NDArray[np.float32]:
        """An array for one more surface: the oldest one's where there are enough."""
        samples = self.ocean.parameters.resolution
        shape = (samples + 1, samples + 1, 3)
        most = min(max(_MOST_SURFACE_BYTES // (4 * int(np.prod(shape))), 1), _MOST_SURFACES)
        if len(self._surfaces) >= most:
            return self._surfaces.popitem(last=False)[1]
        return np.empty(shape, np.float32)


# Caches: what was used last, so that playback neither makes an initial state again nor, where the same frame
# is asked for several times, its surface. They hold nothing that cannot be computed.
_seas: OrderedDict[OceanParameters, Sea] = OrderedDict()
_statistics: OrderedDict[OceanParameters, str] = OrderedDict()


def sea_of(parameters: OceanParameters) -> Sea:
    """The sea with these parameters; oceans that are alike share it."""
    if parameters not in _seas:
        _make_room(_seas)
        _seas[parameters] = Sea(parameters)
    _seas.move_to_end(parameters)
    return _seas[parameters]


def known_statistics(parameters: OceanParameters) -> str | None:
    """The sea's statistics as JSON where they are known already."""
    return _statistics.get(_statistical(parameters))


def statistics_of(parameters: OceanParameters) -> str:
    """The sea's statistics as JSON. Raises MemoryError for a sea too large."""
    known = known_statistics(parameters)
    return known if known is not None else computed_statistics(parameters)


def computed_statistics(parameters: OceanParameters) -> str:
    """The sea's statistics as JSON, computed; touches no data of Blender and may run on any thread."""
    cached = _seas.get(parameters)
    ocean = cached.ocean if cached is not None else Ocean(parameters)
    return json.dumps(ocean.statistics().to_dict())


def keep_statistics(parameters: OceanParameters, statistics: str) -> None:
    """Remember what `computed_statistics` gave."""
    _make_room(_statistics)
    _statistics[_statistical(parameters)] = statistics


def forget_all() -> None:
    """Drop the caches: another file is opened, or the extension is disabled."""
    _seas.clear()
    _statistics.clear()


def _statistical(parameters: OceanParameters) -> OceanParameters:
    """What statistics depend on: heights, not what is done with them."""
    return parameters.replace(choppiness=0.0, trough_damping=0.0, orbits="DEEP")


def _make_room(cache: OrderedDict[OceanParameters, object]) -> None:
    while len(cache) >= max(sum(1 for _ in all_oceans()), 1) * _SEAS_OF_AN_OCEAN:
        cache.popitem(last=False)
