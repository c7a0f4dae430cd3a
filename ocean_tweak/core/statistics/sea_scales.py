# SPDX-License-Identifier: GPL-3.0-or-later
"""The Beaufort scale of winds, and the WMO's of sea states."""

from __future__ import annotations

import bisect

#: WMO-No. 306, code table 1100: mean wind speeds in m/s at which Beaufort numbers 1…12 begin
BEAUFORT_FROM = (0.3, 1.6, 3.4, 5.5, 8.0, 10.8, 13.9, 17.2, 20.8, 24.5, 28.5, 32.7)

#: names of Beaufort numbers 0…12
BEAUFORT_NAMES = (
    "Calm", "Light air", "Light breeze", "Gentle breeze", "Moderate breeze", "Fresh breeze", "Strong breeze",
    "Near gale", "Gale", "Strong gale", "Storm", "Violent storm", "Hurricane",
)  # fmt: skip

#: WMO-No. 306, code table 3700: significant wave heights in m at which sea states 1…9 begin
SEA_STATE_FROM = (0.0, 0.1, 0.5, 1.25, 2.5, 4.0, 6.0, 9.0, 14.0)

SEA_STATE_NAMES = (
    "Calm (glassy)",
    "Calm (rippled)",
    "Smooth",
    "Slight",
    "Moderate",
    "Rough",
    "Very rough",
    "High",
    "Very high",
    "Phenomenal",
)


def beaufort_number(wind_speed: float) -> int:
    """Beaufort number 0…12 of a mean wind in m/s at 10 m. Raises ValueError for a negative or NaN wind."""
    return bisect.bisect_right(BEAUFORT_FROM, _not_negative("wind_speed", wind_speed))


def sea_state(significant_wave_height: float) -> int:
    """WMO sea state code 0…9 of a significant wave height in m; only a flat sea is 0."""
    height = _not_negative("significant_wave_height", significant_wave_height)
    return 0 if height == 0.0 else max(1, bisect.bisect_left(SEA_STATE_FROM, height))


def _not_negative(name: str, value: float) -> float:
    if not value >= 0.0:
        raise ValueError(f"{name} = {value!r}: must be 0 or more")
    return float(value)
