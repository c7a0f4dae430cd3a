# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers of Chen, Jin & Yin (2014), by today's code."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ocean_tweak.core import Ocean, OceanParameters, Water, WaveLayer
from ocean_tweak.core.spectral import spectra, wave_number_spectra

from .measures import bound, direct_sum
from .pages import Table

Array = NDArray[np.float64]

#: wind at 19.5 m of figures 1 and 2
WIND = 10.0

#: program → L of the sea and of the geometry in m, factor on heights, A, and the paper's variance ratio
PROGRAMS = {
    "osgOcean": (256.0, 256.0, 1.0, 0.64e-6, "1.64"),
    "oceanFFT": (100.0, 2.0, 0.5, 1.0e-8, "1.10"),
    "fftrefraction": (128.0, 128.0, 0.1, 0.8e-4, "0.52"),
    "fftrefraction with A = 0.8e-3": (128.0, 128.0, 0.1, 0.8e-3, "0.52"),
}

#: the patch of figure 3
PATCH = OceanParameters(
    resolution=128, domain_size=256.0, seed=1, dispersion="DEEP", water=Water(depth=11e3),
    layers=(
        WaveLayer(spectrum="PHILLIPS", wind_speed=WIND / 1.026, spreading="COSINE_SQUARED", swell=0.0),
    ),
)  # fmt: skip

#: figure 5
DEVELOPING = OceanParameters(
    resolution=256, domain_size=256.0, seed=1, dispersion="DEEP", water=Water(depth=11e3),
    layers=(
        WaveLayer(
            spectrum="JONSWAP", wind_speed=11.0, fetch=50e3, spreading="COSINE_2S", spreading_exponent=1.0,
            swell=0.0,
        ),
    ),
)  # fmt: skip


def malformed(L: float, n: int, corrected: bool, seed: int = 1) -> Array:
    """Elevation (N, N) in m by eq. 3, with A the spectrum's own constant; corrected as eq. 25 has it."""
    index = np.fft.fftfreq(n, 1.0 / n)
    kx, ky = np.meshgrid(2.0 * np.pi / L * index, 2.0 * np.pi / L * index)
    k = np.maximum(np.hypot(kx, ky), 1e-9)
    psi = wave_number_spectra.phillips(k, np.arctan2(ky, kx), WIND)
    psi[0, 0] = 0.0
    noise = np.random.default_rng(seed).normal(size=(2, n, n))
    area = 0.5 * (2.0 * np.pi / L) ** 2 if corrected else 1.0
    h0 = (noise[0] + 1j * noise[1]) * np.sqrt(0.5 * psi * area)
    opposite = np.roll(h0[::-1, ::-1], 1, axis=(0, 1))
    return np.fft.ifft2(h0 + np.conj(opposite)).real * n * n


def variances() -> Table:
    """Equations 20 to 22, measured on fields."""
    head = ["L", "samples", "Hs by eq. 3", "Hs corrected", "variance by eq. 3 over m0", "2/Δs (eq. 22)"]
    rows = [head]
    m0 = Ocean(PATCH.replace(resolution=16)).statistics().m0
    for L in (128.0, 256.0, 512.0):
        n = int(L / 2.0)
        wrong, right = (
            np.mean([np.var(malformed(L, n, corrected, seed)) for seed in range(20)])
            for corrected in (False, True)
        )
        rows.append(
            [
                f"{L:g} m", f"{n} x {n}", f"{4 * np.sqrt(wrong):.1f} m", f"{4 * np.sqrt(right):.2f} m",
                f"{wrong / m0:.0f}", f"{2.0 / (2.0 * np.pi / L) ** 2:.0f}",
            ]
        )  # fmt: skip
    return rows


def programs() -> Table:
    """Table 1."""
    rows = [["program", "Var/Var_OS, paper", "here (eq. 27)", "A_ij/A_ij,OS here"]]
    for name, (L, geometry, factor, A, printed) in PROGRAMS.items():
        ratio = wave_number_spectra.tessendorf_constant(L) / (A * (factor * L / geometry) ** 2)
        rows.append([name, printed, f"{ratio:.2f}", f"{np.sqrt(ratio):.2f}"])
    return rows


def constants() -> Table:
    """Constants, and the two exponents of the peak."""
    X = 9.81 * 50e3 / 11.0**2
    phillips = float(wave_number_spectra.phillips(1e3, 0.0, WIND) * 1e12)
    ours, printed = spectra.jonswap_peak(11.0, 50e3), 22.0 * 9.81 / 11.0 * X**-0.33
    seas = {
        name: Ocean(PATCH.replace(resolution=16, layers=(WaveLayer(spectrum=name, wind_speed=WIND / 1.026),)))
        for name in ("PHILLIPS", "PIERSON_MOSKOWITZ")
    }
    developing = Ocean(DEVELOPING.replace(resolution=16)).statistics().significant_wave_height
    heights = [sea.statistics().significant_wave_height for sea in seas.values()]
    return [
        ["number", "paper", "here"],
        ["A of Phillips with the energy of Pierson-Moskowitz", "3.48e-3", f"{phillips * 1e3:.2f}e-3"],
        ["Hs of both at 10 m/s (at 19.5 m)", "the same", f"{heights[0]:.3f} m and {heights[1]:.3f} m"],
        ["ω_p of figure 5 with the exponent printed, −0.33", "", f"{printed:.4f} rad/s"],
        ["ω_p of figure 5 with −1/3, as elsewhere", "", f"{ours:.4f} rad/s"],
        ["Hs of figure 5", "", f"{developing:.2f} m"],
    ]  # fmt: skip


def gerstner() -> Table:
    """The transform against the sum of cosines, at all samples of small patches."""
    rows = [["samples", "cosines", "Hs", "largest difference, float64", "float32"]]
    for n in (16, 32):
        parameters = PATCH.replace(resolution=n, domain_size=4.0 * n)
        ocean = Ocean(parameters, "double")
        direct = direct_sum(ocean.initial_state, 7.3)
        off = [
            np.max(np.abs(Ocean(parameters, precision).surface(7.3).displacement - direct))
            for precision in ("double", "single")
        ]
        found = ocean.initial_state
        waves = np.count_nonzero(found.h_plus) + np.count_nonzero(found.h_minus[:, 1:])
        rows.append(
            [f"{n} x {n}", f"{waves}", f"{ocean.statistics().seed.significant_wave_height:.2f} m",
             bound(off[0], 1e-12), bound(off[1], 1e-5)]
        )  # fmt: skip
    return rows


TABLES = {"variances": variances, "programs": programs, "constants": constants, "gerstner": gerstner}
