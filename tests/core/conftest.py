# SPDX-License-Identifier: GPL-3.0-or-later
"""Small seas shared by the core's tests."""

from __future__ import annotations

import pytest

from ocean_tweak.core import OceanParameters, Water, WaveLayer
from ocean_tweak.core.sea import spray_squares


@pytest.fixture
def windy() -> OceanParameters:
    """A wind of 17 m/s over 300 km: waves of 190 m, half of them lost or doubled by careless sampling."""
    return OceanParameters(
        resolution=64,
        domain_size=800.0,
        seed=1,
        water=Water(depth=100.0),
        layers=(WaveLayer(wind_speed=17.0, wind_direction=0.4, fetch=300e3, swell=0.3),),
    )


@pytest.fixture
def only_near(monkeypatch: pytest.MonkeyPatch) -> None:
    """Spray in the two finest squares alone, 44 m around the camera: all squares are looked at elsewhere."""
    monkeypatch.setattr(spray_squares, "STANDS_FOR", spray_squares.STANDS_FOR[:2])
