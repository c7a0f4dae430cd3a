# SPDX-License-Identifier: GPL-3.0-or-later
"""Strains of the parts of a sea together: waves are independent, so their covariances add."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from ..foam_threshold import strain_covariances
from ..ocean import Ocean
from .patch_seas import Part

Array = NDArray[np.float64]


def summed_strain_covariances(
    oceans: Sequence[Ocean],
    parts: Sequence[Part],
    drift: tuple[float, float],
    is_read_between: Callable[[Part], bool],
) -> tuple[Array, Array]:
    """Covariances of the strains and of their rates, as `foam_threshold.strain_covariances` has them.

    oceans : that make the parts
    is_read_between : whether a part is read between its samples, where it has less than its waves
    """
    found = [
        strain_covariances(
            ocean.initial_state, part.parameters.choppiness, drift, part.rotation, is_read_between(part)
        )
        for ocean, part in zip(oceans, parts, strict=True)
    ]
    gradients, rates = zip(*found, strict=True)
    return np.sum(gradients, axis=0), np.sum(rates, axis=0)
