# SPDX-License-Identifier: GPL-3.0-or-later
"""Relations between a wind and its waves: Li & Wang (2016), eq. 14 to 20. V in m/s, g in m/s²; λ = C·T."""

from __future__ import annotations

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

Number = TypeVar("Number", float, NDArray[np.float64])


def wavelength(V: Number, g: float) -> Number:
    """λ in m. Li & Wang (2016), below eq. 13: the longest of the waves that carry the most energy."""
    return V * V / g


def period(V: Number, g: float) -> Number:
    """T in s, also the interval between births. Li & Wang (2016), eq. 19: the period of λ in deep water."""
    return V * (float(np.sqrt(2.0 * np.pi)) / g)


def phase_speed(V: Number) -> Number:
    """C in m/s. Li & Wang (2016), eq. 20."""
    return V / float(np.sqrt(2.0 * np.pi))
