# SPDX-License-Identifier: GPL-3.0-or-later
"""Seas of several patches for tests."""

from __future__ import annotations

import dataclasses

from ocean_tweak.core import OceanParameters, Patch, WaveLayer

LAYER = WaveLayer(wind_speed=10.0, wind_direction=0.4, fetch=100e3)
THREE = (
    Patch(600.0, 0.0, 20.0, 1e6, 128),
    Patch(151.0, 0.7, 5.0, 20.0, 128),
    Patch(33.0, 1.2, 0.9, 5.0, 160),
)
SEA = OceanParameters(seed=3, layers=(LAYER,), patches=THREE)


def small(**changes: object) -> OceanParameters:
    """Few enough waves to add them up one by one."""
    patches = (Patch(120.0, 0.3, 16.0, 1e6, 32), Patch(37.0, -0.9, 3.0, 16.0, 32))
    sea = OceanParameters(layers=(dataclasses.replace(LAYER, wind_speed=6.0),), patches=patches)
    return sea.replace(**changes)
