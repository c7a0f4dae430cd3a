# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers and seas of Li & Wang (2016), by today's code."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ocean_tweak.core import Ocean, OceanParameters, Raster, WaveLayer, WindFieldLayer, WindKey
from ocean_tweak.core.wave_particles.wind_waves import WindWaves

from .pages import Table

Array = NDArray[np.float64]

SIDE = 400.0


def sea(*fields: WindFieldLayer, resolution: int = 256) -> OceanParameters:
    """A sea of wind fields alone."""
    return OceanParameters(
        resolution=resolution, domain_size=SIDE, seed=2, layers=(WaveLayer(muted=True),), wind_fields=fields
    )


def one_origin(**changes: object) -> WindFieldLayer:
    """One place from which waves come, one of them at a time: 12 m/s along +x."""
    given: dict[str, Any] = {
        "wind_speed": 12.0, "columns": 1, "rows": 1, "jitter": 0.0, "phase_jitter": 0.0, "start_time": 0.0,
        "particles": 5, "split_angle": 0.12, "life": 12.0, "steepness": 0.1, **changes,
    }  # fmt: skip
    return WindFieldLayer(**given)


#: figure 4: the two shapes of a front
FRONTS = {front: sea(one_origin(front=front)) for front in ("ARC", "PARALLEL")}

#: figure 5: the same arcs with and without splitting
SPLITTING = {splitting: sea(one_origin(splitting=splitting, split_angle=0.3)) for splitting in (False, True)}


def _winds(kind: str) -> Raster:
    """16 x 16 vectors of figure 9's three fields."""
    vectors = np.zeros((16, 16, 2))
    if kind == "the same everywhere":
        vectors[..., 0] = 10.0
    elif kind == "apart, to the left and to the right":
        vectors[:, :8, 0], vectors[:, 8:, 0] = -10.0, 10.0
    else:
        vectors[..., 0] = np.linspace(4.0, 14.0, 16)[:, np.newaxis]
    return Raster(vectors, kind)


#: figure 9
WINDS = {
    kind: sea(
        WindFieldLayer(
            keys=(WindKey(vectors=_winds(kind)),), columns=16, rows=16, particles=5, split_angle=0.1,
            life=8.0, steepness=0.1, calm=2.0, start_time=-120.0,
        )
    )
    for kind in ("the same everywhere", "apart, to the left and to the right", "weak below, strong above")
}  # fmt: skip


def elevation(parameters: OceanParameters, time: float) -> Array:
    """Heights in m."""
    return Ocean(parameters).surface(time).displacement[..., 2].astype(float)


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
        particles = WindWaves(parameters).particles(25.0)
        sums[on] = float(np.sum(particles.amplitude))
        rows.append(["on" if on else "off", f"{len(particles.amplitude)}", f"{sums[on] / sums[False]:.3f}"])
    return rows


def seams() -> Table:
    """Figure 7 in numbers: steps from sample to sample within and between patches."""
    field = elevation(WINDS["the same everywhere"], 60.0)
    inside = np.sqrt(np.mean(np.diff(field, axis=1) ** 2))
    over = np.sqrt(np.mean((field[:, 0] - field[:, -1]) ** 2))
    return [
        ["step from sample to sample", "rms"],
        ["inside the patch", f"{inside:.3f} m"],
        ["from one patch to the next", f"{over:.3f} m"],
    ]


def fields() -> Table:
    """Figure 9 in numbers: wave heights of the halves."""
    rows = [["wind field", "4σ of the lower half", "of the upper half"]]
    for kind, parameters in WINDS.items():
        field = elevation(parameters, 60.0)
        halves = [4.0 * np.std(half) for half in (field[:128], field[128:])]
        rows.append([kind, *(f"{height:.2f} m" for height in halves)])
    return rows


TABLES = {"relations": relations, "splitting": splitting, "seams": seams, "fields": fields}


def figures(plt: Any) -> dict[str, Callable[[], Any]]:
    """The plots, drawn with matplotlib's pyplot."""

    def side_by_side(seas: dict[str, OceanParameters], time: float) -> Any:
        figure, all_axes = plt.subplots(1, len(seas), figsize=(3.2 * len(seas), 3.4))
        for axes, (title, parameters) in zip(all_axes, seas.items(), strict=True):
            field = elevation(parameters, time)
            limit = float(np.abs(field).max())
            axes.imshow(
                field, cmap="gray", origin="lower", extent=(0, SIDE, 0, SIDE), vmin=-limit, vmax=limit
            )
            axes.set_title(title)
        return figure

    def fronts() -> Any:
        return side_by_side({"arc (fig. 4b)": FRONTS["ARC"], "parallel (fig. 4d)": FRONTS["PARALLEL"]}, 25.0)

    def split() -> Any:
        named = {"without splitting (fig. 5a)": SPLITTING[False], "with (fig. 5b)": SPLITTING[True]}
        return side_by_side(named, 25.0)

    def winds() -> Any:
        figure, all_axes = plt.subplots(2, 3, figsize=(9, 6.4))
        for (above, below), (kind, parameters) in zip(all_axes.T, WINDS.items(), strict=True):
            vectors = parameters.wind_fields[0].keys[0].vectors
            above.quiver(vectors.values[::2, ::2, 0], vectors.values[::2, ::2, 1], pivot="middle")
            above.set_title(kind)
            above.set_aspect("equal")
            field = elevation(parameters, 60.0)
            limit = 2.5 * float(np.std(field))
            below.imshow(
                field, cmap="gray", origin="lower", extent=(0, SIDE, 0, SIDE), vmin=-limit, vmax=limit
            )
        return figure

    def tiles() -> Any:
        figure, axes = plt.subplots(figsize=(4.2, 4.2))
        field = elevation(WINDS["the same everywhere"], 60.0)
        limit = 2.5 * float(np.std(field))
        axes.imshow(np.tile(field, (2, 2)), cmap="gray", origin="lower", vmin=-limit, vmax=limit)
        axes.axvline(256, lw=0.4, ls=":")
        axes.axhline(256, lw=0.4, ls=":")
        axes.set_title("2 x 2 patches (fig. 7b)")
        axes.set_axis_off()
        return figure

    return {"fronts": fronts, "splitting": split, "tiles": tiles, "winds": winds}
