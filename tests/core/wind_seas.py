# SPDX-License-Identifier: GPL-3.0-or-later
"""Seas of wind fields for tests, and the numbers of a wind of 10 m/s."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ocean_tweak.core import OceanParameters, Raster, WaveLayer, WindFieldLayer, WindKey
from ocean_tweak.core.waves.wind_field.life import Particles
from tests.layers import with_layers

G = 9.81
FLAT = (WaveLayer(muted=True),)
OUTPUTS = {"displacement", "slope", "jacobian", "velocity"}

#: one origin in the middle of the patch, in step, from time 0 on
LONE = {
    "rows": 1, "columns": 1, "jitter": 0.0, "phase_jitter": 0.0, "start_time": 0.0, "wind_speed": 10.0,
}  # fmt: skip
PERIOD = math.sqrt(2.0 * math.pi) * 10.0 / G
LENGTH = 100.0 / G
SPEED = 10.0 / math.sqrt(2.0 * math.pi)


def sea(resolution: int = 256, size: float = 160.0, **layer: Any) -> OceanParameters:
    return with_layers(
        OceanParameters(resolution=resolution, domain_size=size, layers=FLAT),
        WIND_FIELD=(WindFieldLayer(**layer),),
    )


def particles(parameters: OceanParameters, time: float) -> Particles:
    return WindFieldLayer.shares(parameters).particles(time)


def keyed(*winds: tuple[float, Any]) -> tuple[WindKey, ...]:
    return tuple(WindKey(time, Raster(np.array(vectors, float))) for time, vectors in winds)


def random_wind(seed: int, **layer: Any) -> dict[str, Any]:
    vectors = np.random.default_rng(seed).normal(0.0, 6.0, (5, 7, 2))
    return {"keys": (WindKey(0.0, Raster(vectors)),), "rows": 5, "columns": 4, **layer}
