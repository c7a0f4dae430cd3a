# SPDX-License-Identifier: GPL-3.0-or-later
"""Images and layers of them for tests, and what waves these make."""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from ocean_tweak.core import OceanParameters, Water
from ocean_tweak.core.data.raster import Raster
from ocean_tweak.core.numerics.grid import WaveVectorGrid
from ocean_tweak.core.synthesis.coefficients import InitialState
from ocean_tweak.core.synthesis.transforms import Synthesis, Z
from ocean_tweak.core.waves.image.parameters import ImageLayer
from ocean_tweak.core.waves.image.state import image_waves

DEEP = Water(depth=11e3)
N, L = 128, 200.0


def drawing(rows: int = 96, columns: int = 96) -> np.ndarray:
    """A bright ring off the middle on a ramp, [y, x] in 0…1."""
    y, x = np.mgrid[0:rows, 0:columns] / max(rows, columns)
    ring = np.exp(-(((np.hypot(x - 0.4, y - 0.6) - 0.2) / 0.02) ** 2))
    return 0.2 + 0.6 * ring + 0.1 * np.sin(2 * np.pi * x)


def state(layer: ImageLayer, n: int = N, size: float = L, seed: int = 3, **more: object) -> InitialState:
    grid = WaveVectorGrid(n, size)
    loop = more.pop("loop", None)
    waves = image_waves(layer, grid, "DEEP", DEEP, seed, loop, bool(more.pop("match", False)))
    return InitialState(
        grid, waves.h_plus, waves.h_minus, waves.omega, waves.expected_plus, waves.expected_minus,
        loop_duration=loop, mirrored=layer.animation != "TRANSLATION",
    )  # fmt: skip


def elevation(of: InitialState, time: float | Fraction = 0.0, by: str = "") -> np.ndarray:
    n = of.grid.resolution
    field = np.empty((n, n))

    def write(block: slice, rows: object) -> None:
        field[block] = rows.position(Z, by)

    Synthesis(of, OceanParameters(), dtype=np.complex128).fill(time, [(Z, by)], write)
    return field


def spectrum(field: np.ndarray) -> np.ndarray:
    """Coefficients of exp(ik·x) over the whole plane."""
    return np.fft.fft2(field) / field.size


def single_wave(i: int, j: int, n: int = 32, **layer: object) -> ImageLayer:
    """A layer whose image is one cosine, i waves along y and j along x."""
    y, x = np.arange(n)[:, np.newaxis] / n, np.arange(n) / n
    image = Raster(np.cos(2 * np.pi * (i * y + j * x)))
    return ImageLayer(image=image, filter="FRACTAL", fractal_dimension=4.0, **layer)
