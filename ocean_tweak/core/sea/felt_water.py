# SPDX-License-Identifier: GPL-3.0-or-later
"""What a hull feels of a sea: at each moment the plane through the water over its waterline, and how far that
water has gone from where it rests."""

from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..parameters.ocean_parameters import OceanParameters
from .ocean import Ocean
from .placed_waves import repeating
from .regions import Places
from .waterline import fitted_plane, stencil

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]

#: moments and places that are kept of a sea, and the bytes of one
_MOST, _BYTES = 50_000, 400
#: samples of a sea in a beam, of which hulls feel no more
_IN_BEAM = 3.0


class Footprint(NamedTuple):
    """Where a waterline lies in the ocean's space, m and rad.

    heading : of its bow or stern, from the x axis
    drift : how much it goes along with the water
    sways : whether it feels how far the water has gone
    """

    x: float
    y: float
    heading: float
    half_length: float
    half_beam: float
    drift: float
    sways: bool = False


class Felt(NamedTuple):
    """The plane through the water under a hull, and how far this has gone: m, slopes dimensionless."""

    height: float
    slope_along: float
    slope_across: float
    gone_along: float = 0.0
    gone_across: float = 0.0


def felt(
    place: Footprint, carried: Callable[[Array, Array], RealArray], height: Callable[[Array, Array], Array]
) -> Felt:
    """What a hull feels of water in m.

    carried : (points, 2) how far the water of places at rest has gone
    height : (points,) of the surface above places
    """
    half = place.half_length, place.half_beam
    along, across = (np.array(half) * stencil()).T
    cosine, sine = math.cos(place.heading), math.sin(place.heading)
    x = place.x + along * cosine - across * sine
    y = place.y + along * sine + across * cosine
    gone_x = gone_y = 0.0
    if place.drift or place.sways:
        gone_x, gone_y = carried(x, y).mean(axis=0).tolist()
        x, y = x + place.drift * gone_x, y + place.drift * gone_y
    level, slope_along, slope_across = (float(part) for part in fitted_plane(height(x, y), half))
    if not place.sways:
        return Felt(level, slope_along, slope_across)
    along_hull, across_hull = gone_x * cosine + gone_y * sine, gone_y * cosine - gone_x * sine
    return Felt(level, slope_along, slope_across, along_hull, across_hull)


class FeltWater:
    """What hulls felt of a sea, by moment and place; kept, as moments are asked for again and again."""

    def __init__(self, parameters: OceanParameters) -> None:
        self._ocean = Ocean(parameters)
        self._waters: dict[tuple[Fraction, Footprint], Felt] = {}

    @property
    def nbytes(self) -> int:
        """Bytes of what is kept."""
        return _BYTES * len(self._waters)

    def at(self, time: Fraction, place: Footprint) -> Felt:
        """What a hull feels at a time in s."""
        known = self._waters.get((time, place))
        if known is None:
            while len(self._waters) >= _MOST:
                del self._waters[next(iter(self._waters))]
            known = self._waters[time, place] = self._new(time, place)
        return known

    def _new(self, time: Fraction, place: Footprint) -> Felt:
        return felt(
            place,
            lambda x, y: self._ocean.surface(time, on=Places(x, y)).displacement[:, :2],
            lambda x, y: self._ocean.height_at(x, y, time),
        )


def felt_sea(parameters: OceanParameters, beam: float) -> OceanParameters:
    """The same sea on as many samples as a hull feels whose beam is given in m.

    It is without what hulls make, or one would lie in the dent that it makes itself.
    """
    sea = repeating(parameters)
    wanted = 2 ** math.ceil(math.log2(max(_IN_BEAM * sea.domain_size / beam, 16.0)))
    return sea.at_resolution(min(wanted, sea.resolution))
