# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers of Keith Lantz's page on the fast Fourier transform (2011), by today's code."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ocean_tweak.core import ImageLayer, Ocean, OceanParameters, Raster, Water, WaveLayer

from .measures import bound, direct_sum, seam_steps
from .pages import Table

Array = NDArray[np.float64]

#: his 64 x 64 samples a metre apart; the height is that of a light wind, where his A is free
PATCH = OceanParameters(
    resolution=64, domain_size=64.0, seed=1, dispersion="DEEP", water=Water(depth=11e3),
    layers=(
        WaveLayer(
            spectrum="PHILLIPS", wind_speed=7.0, wind_direction=0.5 * np.pi, spreading="COSINE_SQUARED",
            swell=0.0,
        ),
    ),
)  # fmt: skip


def transforms() -> Table:
    """The two passes, his shifted sum and the sum of cosines, on one sea."""
    parameters = PATCH.replace(resolution=32, domain_size=32.0)
    ocean = Ocean(parameters, "double")
    ours = ocean.surface(3.0).displacement
    shifted, direct = shifted_sum(ocean, 3.0), direct_sum(ocean.initial_state, 3.0)
    single = Ocean(parameters).surface(3.0).displacement

    return [
        ["against our two passes in float64", "largest difference"],
        [
            "his double sum from −N/2 on, with (−1)^(x+z)",
            bound(np.max(np.abs(shifted - ours[..., 2])), 1e-12),
        ],
        ["sum of cosines", bound(np.max(np.abs(direct - ours)), 1e-12)],
        ["our two passes in float32", bound(np.max(np.abs(single - ours)), 1e-6)],
    ]


def shifted_sum(ocean: Ocean, time: float) -> Array:
    """(N, N) elevation by his equations 1 to 4: indices from −N/2 stored from 0, the sign taken out."""
    state = ocean.initial_state
    n = state.grid.resolution
    half = state.h_plus * np.exp(-1j * state.omega * time) + state.h_minus * np.exp(1j * state.omega * time)
    full = np.zeros((n, n), complex)
    full[:, : n // 2] = half[:, : n // 2]
    full[:, n // 2 + 1 :] = np.conj(np.roll(half[::-1], 1, axis=0))[:, n // 2 - 1 : 0 : -1]
    stored = np.fft.fftshift(full)
    index = np.arange(n)
    twiddle = np.exp(2j * np.pi * np.outer(index, index) / n)
    sign = 1.0 - 2.0 * ((index + index[:, np.newaxis]) % 2)
    return (twiddle @ stored @ twiddle.T).real * sign


def crests() -> Table:
    """What D = +i (k/k) h does to one wave of 0.1 m with k = 1/m, seen at fixed places."""
    rows = [["λ", "second harmonic", "mean below 0", "skewness", "Jacobian at the crest"]]
    side, waves = 8.0 * np.pi, 4
    cosine = np.cos(2.0 * np.pi * waves / 64.0 * np.arange(64))
    picture = ImageLayer(
        image=Raster(np.tile(cosine, (64, 1))), filter="FRACTAL", fractal_dimension=4.0,
        significant_wave_height=4.0 * 0.1 / np.sqrt(2.0),
    )  # fmt: skip
    for choppiness in (0.0, 1.0):
        parameters = OceanParameters(
            resolution=64, domain_size=side, dispersion="DEEP", choppiness=choppiness,
            layers=(WaveLayer(muted=True), picture),
        )  # fmt: skip
        ocean = Ocean(parameters, "double")
        height = ocean.height_at(side / 256.0 * np.arange(256), 0.0, 0.0, surface="exact")
        harmonics = np.fft.rfft(height).real / 128.0
        height = height - height.mean()
        skewness = np.mean(height**3) / np.mean(height**2) ** 1.5
        jacobian = ocean.surface(0.0, ("jacobian",)).jacobian.min()
        rows.append(
            [
                f"{choppiness:g}", f"{1e3 * harmonics[2 * waves]:.1f} mm",
                f"{abs(500.0 * harmonics[0]):.1f} mm",
                f"{skewness:.3f}", f"{jacobian:.2f}",
            ]
        )  # fmt: skip
    return rows


def tiling() -> Table:
    """Steps of height from sample to sample, inside a patch and over its rim."""
    return seam_steps(Ocean(PATCH, "double").surface(5.0).displacement[..., 2])


TABLES = {"transforms": transforms, "crests": crests, "tiling": tiling}
