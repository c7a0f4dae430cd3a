# SPDX-License-Identifier: GPL-3.0-or-later
"""The sea on one grid that some parameters mean."""

from __future__ import annotations

from .cascades.joined import JoinedSea
from .grid_sea import GridSea
from .ocean import Ocean
from .parameters import OceanParameters


def grid_sea(parameters: OceanParameters, precision: str = "single", workers: int | None = None) -> GridSea:
    """An Ocean, or where waves are added up in places the sum of several; for the arguments see `GridSea`.

    Raises ValueError for several patches that are not joined: they are a `Cascade`.
    """
    kind = JoinedSea if parameters.is_sum and not parameters.is_cascade else Ocean
    return kind(parameters, precision, workers)
