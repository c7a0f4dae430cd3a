# SPDX-License-Identifier: GPL-3.0-or-later
"""Wind speed over height above the water."""

from __future__ import annotations

import math

from . import constants


def wind_factor(wind_speed_10: float, height: float) -> float:
    """U_z / U_10 for a wind of U_10 m/s at 10 m and a height in m.

    Horvath (2015), § 5.1.3, corrected: the drag coefficient is (0.8 + 0.065 U_10)·10⁻³, and the log law
    has its 1/κ: 1 + 2.5 √C_10 ln(z/10).
    """
    drag = constants.DRAG_OFFSET + constants.DRAG_SLOPE * wind_speed_10
    return 1.0 + math.sqrt(drag) / constants.KARMAN * math.log(height / 10.0)


def wind_at_10_m(wind_speed: float, height: float) -> float:
    """U_10 in m/s of a wind measured at another height in m: the inverse of `wind_factor`."""
    result = wind_speed
    for _ in range(100):
        result, previous = wind_speed / wind_factor(result, height), result
        if abs(result - previous) <= 1e-15 * result:
            break
    return result


def wind_at(wind_speed_10: float, height: float) -> float:
    """U_z in m/s at a height in m, for a wind of U_10 m/s at 10 m."""
    return wind_speed_10 * wind_factor(wind_speed_10, height)
