# SPDX-License-Identifier: GPL-3.0-or-later
"""Foam of one moment, without its history: shown where there is no time to make it all."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..core import OceanParameters
from ..core.foam import FoamModel
from ..core.foam_field import foam_outlook
from ..core.foam_threshold import LEAST_SQUEEZE

RealArray = NDArray[np.float32]

# squeeze over the threshold at which foam has half its strength: the middle of the model's rise
_HALF_STRENGTH = 1.125


def instant_foam(parameters: OceanParameters, cusp: RealArray) -> RealArray:
    """(N, N) 0…1: foam where the (N, N) squeeze is largest, on as much of the sea as foam will cover.

    The threshold is read off this one field: the model's own, from the sea's statistics, takes longer to
    find than a surface takes to make.
    """
    coverage = foam_outlook(parameters).coverage
    covered = round(coverage * cusp.size)
    if covered == 0:
        return np.zeros_like(cusp)
    least = np.partition(cusp, cusp.size - covered, axis=None)[cusp.size - covered]
    if least <= LEAST_SQUEEZE:
        return np.zeros_like(cusp)
    model = FoamModel(float(least) / _HALF_STRENGTH, 0.0, (0.0, 0.0), 1.0)
    return model.strength(cusp).astype(np.float32)
