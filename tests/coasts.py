# SPDX-License-Identifier: GPL-3.0-or-later
"""Seas over a beach, for tests of what is made of them."""

from __future__ import annotations

import numpy as np

from ocean_tweak.core import Coast, OceanParameters, Patch, Raster, Water, WaveLayer

SIDE, SAMPLES, DEEP = 200.0, 64, 20.0
#: a beach of 200 m from 12 m of water to land, along +x
BEACH = np.repeat(np.linspace(12.0, -1.0, 101)[np.newaxis], 101, axis=0)


def sea(bed: np.ndarray = BEACH, patches: tuple[Patch, ...] = (), **of_coast: object) -> OceanParameters:
    coast = Coast(
        **{
            "depth": Raster(bed),
            "spacing": 2.0,
            "x": 0.0,
            "rim": 40.0,
            "shortest_wavelength": 35.0,
            **of_coast,
        }
    )
    size = {} if patches else {"resolution": SAMPLES, "domain_size": SIDE}
    layer = WaveLayer(wind_speed=11.0, fetch=60e3, wind_direction=0.2)
    return OceanParameters(
        water=Water(depth=DEEP), coast=coast, layers=(layer,), seed=3, patches=patches, **size
    )


#: on few samples, whose coast comes in early: quickly made
SMALL_SEA = OceanParameters(
    resolution=32, domain_size=SIDE, water=Water(depth=DEEP),
    layers=(WaveLayer(wind_speed=9.0, fetch=60e3),),
    coast=Coast(depth=Raster(BEACH[::2, ::2], "bed"), spacing=4.0, rim=80.0, shortest_wavelength=40.0),
)  # fmt: skip
