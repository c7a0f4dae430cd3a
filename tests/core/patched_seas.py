# SPDX-License-Identifier: GPL-3.0-or-later
"""Seas of several patches for tests, and their waves one by one."""

from __future__ import annotations

import dataclasses

import numpy as np

from ocean_tweak.core import Ocean, OceanParameters, Patch, WaveLayer
from ocean_tweak.core.parameters.patch_seas import patch_parameters
from tests.core import direct_sum

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


def summed(parameters: OceanParameters, x: np.ndarray, y: np.ndarray, time: float) -> dict[str, np.ndarray]:
    """Position and derivatives at rest positions, wave by wave, each turned by its patch's rotation."""
    result = {c + d: np.zeros(x.shape) for c in "xyz" for d in ("", "_x", "_y", "_t")}
    for of_patch, patch in zip(patch_parameters(parameters), parameters.patches, strict=True):
        state = Ocean(of_patch, precision="double").initial_state
        for kx, ky, omega, a, phase in direct_sum.waves(state):
            k = np.hypot(kx, ky)
            angle = np.arctan2(ky, kx) + patch.rotation
            kx, ky = k * np.cos(angle), k * np.sin(angle)
            sine, cosine = (a * f(kx * x + ky * y - omega * time + phase) for f in (np.sin, np.cos))
            result["z"] += cosine
            for name, rate in (("_x", kx), ("_y", ky), ("_t", -omega)):
                result["z" + name] -= rate * sine
            for component, along in (("x", kx), ("y", ky)):
                factor = parameters.choppiness * along / k
                result[component] -= factor * sine
                for name, rate in (("_x", kx), ("_y", ky), ("_t", -omega)):
                    result[component + name] -= factor * rate * cosine
    return result
