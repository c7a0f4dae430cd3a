# SPDX-License-Identifier: GPL-3.0-or-later
"""Upper bounds on the number of particles of a layer, from its parameters alone."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from ...data.errors import ParameterError
from .relations import period

if TYPE_CHECKING:
    from .parameters import WindFieldLayer

#: largest number of particles of all layers together: beyond it a frame takes seconds
MOST_PARTICLES = 2_000_000

#: largest number of births examined to find live waves, and of stored winds (origins times keys)
MOST_BIRTHS, MOST_WINDS = 5_000_000, 8_000_000

#: bytes per particle while particles are created and put on the grid
PARTICLE_BYTES = 400

#: how much larger than its class's radius a particle's radius may be: classes differ by at most a factor of 2
_ROUNDING = math.sqrt(2.0)


def check_bounds(layers: Sequence[WindFieldLayer], gravity: float) -> None:
    """Raise ParameterError, with the number and a remedy, if layers would have too many particles."""
    particles = sum(most_particles(layer) for layer in layers)
    if particles > MOST_PARTICLES:
        raise ParameterError(
            "layers", f"up to {particles} particles",
            f"must have at most {MOST_PARTICLES}: use fewer columns, rows, origins or particles, "
            "a smaller split_angle or a shorter life",
        )  # fmt: skip
    births = sum(most_births(layer, gravity) for layer in layers)
    if births > MOST_BIRTHS:
        raise ParameterError(
            "layers", f"up to {births} waves looked at",
            f"must be at most {MOST_BIRTHS}: use a higher minimum_wind_speed, fewer columns, rows "
            "or origins, or a shorter life",
        )  # fmt: skip
    winds = sum(_origins(layer) * len(layer.keys) for layer in layers)
    if winds > MOST_WINDS:
        raise ParameterError(
            "layers", f"{winds} winds",
            f"must have at most {MOST_WINDS}, keys times origins: use fewer keys, columns, rows or origins",
        )  # fmt: skip


def bytes_of(layers: Sequence[WindFieldLayer], gravity: float) -> tuple[int, int]:
    """Upper bounds on the bytes that layers keep, and on those used in addition while particles are
    created."""
    layers = [layer for layer in layers if not layer.muted]
    kept = sum(_origins(layer) * (24 + 16 * max(1, len(layer.keys))) for layer in layers)
    kept += sum(8 * min(MOST_WINDS, 32 * _origins(layer) * len(layer.keys)) for layer in layers)
    particles = sum(most_particles(layer) for layer in layers)
    births = sum(most_births(layer, gravity) for layer in layers)
    return kept, PARTICLE_BYTES * (particles + births)


def _origins(layer: WindFieldLayer) -> int:
    return layer.columns * layer.rows * layer.origins


def most_particles(layer: WindFieldLayer) -> int:
    """An upper bound on the number of the layer's particles for any wind.

    With a constant wind V and a life of n wavelengths, an origin has n live waves, evenly spread over ages;
    if the wind varies between V_min and V_max, at most n(1 + ln(V_max/V_min)), as waves of a stronger wind
    live on among those of a weaker one. Particles are counted as divided as often as their ages allow.
    """
    speed = layer.greatest_speed
    if layer.muted or speed < layer.minimum_wind_speed:
        return 0
    at_end = 4.0 * layer.life * layer.split_angle * (_ROUNDING if layer.keys else 1.0)
    if layer.crest == "PARALLEL" or not layer.splitting:
        at_end = 0.0
    most, mean = _divided(at_end)
    waves = layer.life * mean + most
    if len(layer.keys) > 1:
        waves += layer.life * most * math.log(speed / layer.minimum_wind_speed)
    return math.ceil(_origins(layer) * layer.particles * waves)


def _divided(ratio: float) -> tuple[int, float]:
    """Number of particles that one becomes by the end of its life, and on average over it, from the ratio of
    the final distance of neighbours to that at which they divide; the distance grows with age."""
    parts, mean, begin = 1, 0.0, 0.0
    while ratio > parts:
        end = parts / ratio
        mean += parts * (end - begin)
        begin, parts = end, 3 * parts
    return parts, mean + parts * (1.0 - begin)


def most_births(layer: WindFieldLayer, gravity: float) -> int:
    """Upper bound on the births examined to find live waves: no wave of an origin lives longer than the
    longest."""
    speed = layer.greatest_speed
    if layer.muted or speed < layer.minimum_wind_speed:
        return 0
    shortest = period(layer.minimum_wind_speed if len(layer.keys) > 1 else speed, gravity)
    waves = layer.life * period(speed, gravity) / shortest + 1.0
    return math.ceil(_origins(layer) * waves)
