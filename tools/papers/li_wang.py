# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers and seas of Li & Wang (2016), by today's code."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np

from ocean_tweak.core import Ocean, OceanParameters, WaveLayer, WindFieldLayer
from ocean_tweak.core.waves.wind_field import presets

from .measures import elevation, seam_steps
from .pages import Table

SIDE = 400.0


def sea(*fields: WindFieldLayer, resolution: int = 256) -> OceanParameters:
    """A sea of wind fields alone."""
    return OceanParameters(
        resolution=resolution, domain_size=SIDE, seed=2, layers=(WaveLayer(muted=True), *fields)
    )


def one_origin(**changes: object) -> WindFieldLayer:
    """One place from which waves come, one of them at a time: 12 m/s along +x."""
    given: dict[str, Any] = {
        "wind_speed": 12.0, "columns": 1, "rows": 1, "jitter": 0.0, "phase_jitter": 0.0, "start_time": 0.0,
        "particles": 5, "split_angle": 0.12, "life": 12.0, "steepness": 0.1, **changes,
    }  # fmt: skip
    return WindFieldLayer(**given)


#: figure 4: the two shapes of a front
CRESTS = {front: sea(one_origin(crest=front)) for front in ("ARC", "PARALLEL")}

#: figure 5: the same arcs with and without splitting
SPLITTING = {splitting: sea(one_origin(splitting=splitting, split_angle=0.3)) for splitting in (False, True)}


#: figure 9, around 10 m/s
WINDS = {
    kind: sea(
        dataclasses.replace(
            field(10.0), columns=16, rows=16, particles=5, split_angle=0.1, life=8.0, steepness=0.1,
            minimum_wind_speed=2.0, start_time=-120.0,
        )
    )
    for kind, field in {
        "the same everywhere": presets.uniform,
        "apart, to the left and to the right": presets.opposed_halves,
        "weak below, strong above": presets.varying_speed,
    }.items()
}  # fmt: skip


def relations() -> Table:
    """Equations 14, 19 and 20, and the period that a sea shows at a place."""
    rows = [["wind", "λ = V²/g", "T (eq. 19)", "C (eq. 20)", "period at a place downwind"]]
    for wind in (6.0, 10.0, 14.0):
        wavelength, period = wind**2 / 9.81, np.sqrt(2.0 * np.pi) * wind / 9.81
        rows.append(
            [
                f"{wind:g} m/s", f"{wavelength:.2f} m", f"{period:.3f} s", f"{wavelength / period:.3f} m/s",
                f"{_measured_period(wind):.2f} s",
            ]
        )  # fmt: skip
    return rows


def _measured_period(wind: float) -> float:
    """Mean time between up-crossings three wavelengths downwind of the only origin, s."""
    wavelength, period = wind**2 / 9.81, np.sqrt(2.0 * np.pi) * wind / 9.81
    parameters = sea(one_origin(wind_speed=wind), resolution=128).replace(domain_size=24.0 * wavelength)
    ocean = Ocean(parameters)
    times = period * (12.0 + np.arange(240) / 40.0)
    heights = np.array([ocean.surface(time).displacement[64, 64 + 16, 2] for time in times])
    heights -= heights.mean()
    rising = np.nonzero((heights[:-1] < 0.0) & (heights[1:] >= 0.0))[0]
    share = heights[rising] / (heights[rising] - heights[rising + 1])
    crossings = times[rising] + share * (times[1] - times[0])
    return float(np.mean(np.diff(crossings)))


def splitting() -> Table:
    """Figure 5 in numbers: particles, and how even the front is."""
    rows = [["splitting", "particles after 25 s", "sum of amplitudes over that without"]]
    sums = {}
    for on, parameters in SPLITTING.items():
        particles = WindFieldLayer.shares(parameters).particles(25.0)
        sums[on] = float(np.sum(particles.amplitude))
        rows.append(["on" if on else "off", f"{len(particles.amplitude)}", f"{sums[on] / sums[False]:.3f}"])
    return rows


def seams() -> Table:
    """Figure 7 in numbers: steps from sample to sample within and between patches."""
    return seam_steps(elevation(WINDS["the same everywhere"], 60.0))


def fields() -> Table:
    """Figure 9 in numbers: wave heights of the halves."""
    rows = [["wind field", "4σ of the lower half", "of the upper half"]]
    for kind, parameters in WINDS.items():
        field = elevation(parameters, 60.0)
        halves = [4.0 * np.std(half) for half in (field[:128], field[128:])]
        rows.append([kind, *(f"{height:.2f} m" for height in halves)])
    return rows


TABLES = {"relations": relations, "splitting": splitting, "seams": seams, "fields": fields}
