# SPDX-License-Identifier: GPL-3.0-or-later
"""Waves of a wind field on top of the spectrum's: displacement, slopes and Jacobian of 20,000 particles."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from ocean_tweak.core import Ocean, OceanParameters, WindFieldLayer, WindKey
from ocean_tweak.core.waves.wind_field.wind import sampled_wind

from .field_sets import SIX, TIME, FieldSet, arrays, surface_maker
from .measure import interleaved
from .plan import Plan, sea
from .rows import Row, ratio_row

GROUP = "wind fields"

FIELDS = FieldSet("displacement, slopes and Jacobian", ("displacement", "slope", "jacobian"), 8)

#: live particles, at least, and their radii in samples
PARTICLES, RADII = 20_000, (8.0, 16.0)


def rows(plan: Plan) -> Iterator[Row]:
    """One and two workers against the spectrum's six fields with as many."""
    resolution = 128 if plan.smoke else 1024
    parameters = windy(resolution)
    count = len(WindFieldLayer.shares(parameters).particles(TIME).x)
    for workers in (1, 2):
        sides = {
            "with particles": _maker(parameters, workers),
            "spectrum": surface_maker(SIX, resolution, workers),
        }
        timings = interleaved(sides, plan.rounds)
        yield ratio_row(
            GROUP,
            f"{count} particles, {FIELDS.name}, {resolution}², {workers} worker{'s' * (workers > 1)}, "
            "against the spectrum's six fields",
            timings, "with particles", "spectrum", target="wind fields" if workers == 1 else None,
        )  # fmt: skip


def windy(resolution: int) -> OceanParameters:
    """The storm and a wind that varies along y, with at least so many particles of those radii."""
    storm = sea(resolution)
    size = storm.domain_size
    # λ = V²/g is two radii
    weak, strong = (np.sqrt(storm.water.gravity * 2.0 * radius * size / resolution) for radius in RADII)
    wind = sampled_wind(
        lambda x, y: (weak + (strong - weak) * (0.5 - 0.5 * np.cos(2.0 * np.pi * y / size)), 0.0), size
    )
    layer = WindFieldLayer(keys=(WindKey(0.0, wind),), rows=8, columns=8)
    for cells in range(4, 64):
        layer = replace(layer, rows=cells, columns=cells)
        parameters = storm.replace(layers=(*storm.layers, layer))
        if len(WindFieldLayer.shares(parameters).particles(TIME).x) >= PARTICLES:
            break
    return parameters


def _maker(parameters: OceanParameters, workers: int) -> Callable[[], object]:
    ocean = Ocean(parameters, workers=workers)
    out = arrays(FIELDS, parameters.resolution)
    return lambda: ocean.surface(TIME, FIELDS.outputs, out=out)
