# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a sea has spray, where it is made, and how much of it there will be."""

from __future__ import annotations

import math

from ..data.errors import ParameterError
from ..foam.threshold import foam_outlook, foam_wind
from ..numerics.machine import usable_memory
from ..parameters.ocean_parameters import OceanParameters
from ..parameters.patch_seas import open_sea
from ..parameters.spray import Spray
from ..spray.drops import LEAST_WIND, torn_rate
from ..spray.particles import BYTES, mean_life
from ..waves.contribution import Wind
from .foam_levels import FoamLevels
from .ocean import Ocean
from .placed_waves import check_repeats, has_tile, is_seen_around, makes_foam
from .spray_squares import area_of_squares

#: torn area relative to the mean strength of breaking
_TEARS = 1.7
#: fraction of the machine's memory that spray may use
_SHARE_OF_MEMORY = 0.5


class SprayError(ParameterError):
    """More particles than fit into memory; the message has an amount that fits."""


def why_none(parameters: OceanParameters) -> str | None:
    """Why a sea has no spray; None if it has."""
    if makes_foam(parameters) or breaks_ashore(parameters):  # bows and breakers throw up water in any wind
        return None
    wind = foam_wind(parameters)
    if wind is None:
        return (
            "this sea has no spray, because no layer is given by a wind: define one by wind speed and fetch"
        )
    if foam_outlook(parameters).coverage == 0.0:
        return "this sea has no spray, because it has no foam: give its foam a coverage above 0"
    if wind.speed <= LEAST_WIND:
        return (
            f"this sea has no spray, because its wind of {wind.speed:.3g} m/s tears nothing off: "
            f"spume begins at {LEAST_WIND:g} m/s"
        )
    return None


def breaks_ashore(parameters: OceanParameters) -> bool:
    """Whether waves break over the bed of a sea's coast."""
    return parameters.coast is not None and parameters.has_coast and parameters.coast.breaking


def is_around(parameters: OceanParameters) -> bool:
    """Whether a sea's spray is made around a camera, not on its tile."""
    return is_seen_around(parameters) or parameters.has_coast


def check_spray(parameters: OceanParameters, spray: Spray) -> None:
    """Raise SprayError, before computing any, if a sea's spray needs too much memory.

    Raises ParameterError for a sea without spray, and for one that has neither a tile nor is seen around a
    camera.
    """
    if (why := why_none(parameters)) is not None:
        raise ParameterError("spray", "", why)
    if not is_around(parameters):
        try:
            check_repeats(parameters)
        except ParameterError as error:
            reason = f"is made on the tile of a sea without patches, and with {error.field} this one has none"
            raise ParameterError("spray", "", f"{reason}: leave it out, or give the sea patches") from None
    check_spray_memory(expected_count(parameters, spray), spray)


def expected_count(parameters: OceanParameters, spray: Spray) -> float:
    """Expected number of particles at any time that wind tears off, on the tile or around a place."""
    rate = torn_rate(tearing_wind(parameters).speed)
    if rate == 0.0 or why_none(parameters) is not None:
        return 0.0
    parameters = open_sea(parameters)
    area = parameters.domain_size**2 if has_tile(parameters) else area_of_squares(FoamLevels(parameters))
    tears = _TEARS * Ocean(parameters).mean_breaking
    return area * tears * rate * spray.amount * mean_life(spray)


def tearing_wind(parameters: OceanParameters) -> Wind:
    """That which tears crests and carries spray; none where no layer has any."""
    return foam_wind(parameters) or Wind(0.0, 0.0)


def check_spray_memory(count: float, spray: Spray) -> None:
    """Raise SprayError for more particles than the memory holds."""
    memory = usable_memory()
    if memory is None or count * BYTES <= _SHARE_OF_MEMORY * memory:
        return
    would_do = spray.amount * _SHARE_OF_MEMORY * memory / (count * BYTES)
    last = 10.0 ** (math.floor(math.log10(would_do)) - 1)  # of two figures that are told, which round down
    would_do = last * math.floor(would_do / last)
    raise SprayError(
        "spray.amount", spray.amount,
        f"makes about {count:,.0f} particles, which need {count * BYTES / 2**30:.1f} GB of memory, and spray "
        f"may take {_SHARE_OF_MEMORY * memory / 2**30:.1f} GB here: an amount of {would_do:.2g} would do",
    )  # fmt: skip
