# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes examples/wind-front.json: a front that crosses the patch over a spectral sea.

Run from the project's folder: `python -m examples.wind_front`.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from ocean_tweak.core import OceanParameters, Timing, Water, WaveLayer, WindFieldLayer, WindKey
from ocean_tweak.core.waves.wind_field.wind import sampled_wind

JSON = Path(__file__).parent / "wind-front.json"

SIZE = 240.0
STRONG, WEAK = 12.0, 1.0  # m/s behind the front and before it
SPEED = 8.0  # of the front, m/s
WIDTH = 12.0  # over which the wind rises, m


def wind(time: float, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The wind in m/s: behind the front it blows across it, in gusts, and fades far behind."""
    bow = 14.0 * np.sin(2.0 * np.pi * y / SIZE) + 6.0 * np.sin(4.0 * np.pi * y / SIZE + 1.0)
    behind = SPEED * time + bow - x
    rise = 0.5 + 0.5 * np.tanh(behind / WIDTH)
    fade = 0.5 - 0.5 * np.tanh((behind - SIZE) / (2.0 * WIDTH))
    gusts = 1.0 + 0.25 * np.sin(2.0 * np.pi * (2.0 * x - y) / SIZE) * np.sin(2.0 * np.pi * 3.0 * y / SIZE)
    # the patch repeats, the front does not: at the edge it comes from, calm wins
    edge = np.clip(np.minimum(x, SIZE - x) / 10.0, 0.0, 1.0)
    speed = WEAK + (STRONG * gusts - WEAK) * rise * fade * edge
    angle = 0.35 * np.sin(2.0 * np.pi * y / SIZE + 0.4)
    return speed * np.cos(angle), speed * np.sin(angle)


def parameters() -> OceanParameters:
    """The sea: a light swell of its own, and what the front raises."""
    keys = []
    for time in np.arange(-4.0, 29.1, 1.5):
        raster = sampled_wind(lambda x, y, t=time: wind(t, x, y), SIZE, 32)  # type: ignore[misc]
        rounded = np.rint(raster.values * 8.0) / 8.0  # what half precision holds, for a shorter file
        keys.append(WindKey(float(time), type(raster)(rounded, f"{time:g} s")))
    return OceanParameters(
        resolution=512,
        domain_size=SIZE,
        seed=4,
        choppiness=1.2,
        water=Water(depth=60.0),
        layers=(
            WaveLayer(wind_speed=4.0, wind_direction=-0.5, fetch=40e3, spreading="HASSELMANN"),
            WindFieldLayer(
                keys=tuple(keys), start_time=-4.0, minimum_wind_speed=3.0, columns=12, rows=20, jitter=0.7,
                phase_jitter=0.2, particles=7, split_angle=0.1, life=4.0, steepness=0.09,
            ),
        ),
        timing=Timing(fps=24, start_frame=1),
    )  # fmt: skip


def main() -> int:
    """Write the file."""
    JSON.write_text(parameters().to_json() + "\n", encoding="utf-8")
    print(f"written: {JSON}, {JSON.stat().st_size / 1024:.0f} kB")
    return 0


if __name__ == "__main__":
    sys.exit(main())
