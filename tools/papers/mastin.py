# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers of Mastin, Watterberg & Mareda (1987), by today's code."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ocean_tweak.core import ImageLayer, Water
from ocean_tweak.core.numerics.grid import WaveVectorGrid
from ocean_tweak.core.waves.image import animation, filters, source
from ocean_tweak.core.waves.image.state import filtered

from .pages import Table

Array = NDArray[np.float64]

#: samples of the paper's images; their metres are ours, with which the peak has 6 waves along the diagonal
SAMPLES, SIDE = 512, 1800.0
SEED = 1
DEEP = Water(depth=11e3)

WIND = ImageLayer(
    wind_speed=15.0, wind_direction=np.pi / 4, filter_gain="PAPER", noise_resolution=SAMPLES, seed=SEED,
    significant_wave_height=5.5,
)  # fmt: skip
MOUNTAINS = ImageLayer(filter="FRACTAL", fractal_dimension=2.1, noise_resolution=SAMPLES, seed=SEED)
TEXTURE = ImageLayer(
    filter="WATER_TEXTURE",
    fractal_dimension=2.1,
    texture_wavelength=30.0,
    noise_resolution=SAMPLES,
    seed=SEED,
)


def grid() -> WaveVectorGrid:
    """Wave vectors of the paper's image."""
    return WaveVectorGrid(SAMPLES, SIDE)


def filtered_noise(layer: ImageLayer) -> Array:
    """(512, 512): the white noise after the filter of unit gain, around 128 as the paper's images are."""
    power = filters.unit_gain(filters.filter_power(layer, grid(), "DEEP", DEEP), grid())
    coefficients = source.noise_coefficients(SAMPLES, SEED) * np.sqrt(power * source.noise_variance())
    return source.NOISE_MEAN + np.fft.irfft2(coefficients, s=(SAMPLES, SAMPLES)) * SAMPLES**2


def heights() -> Array:
    """(512, 512) m: the sea of figure 9."""
    made = filtered(WIND, SIDE, SAMPLES, "DEEP", DEEP)
    return np.fft.irfft2(made.coefficients, s=(SAMPLES, SAMPLES)) * SAMPLES**2


def spectrum() -> Table:
    """Equations 1 to 6 at 15 m/s."""
    f_m = filters.peak_frequency(15.0)
    rows = [
        [
            "f/f_m",
            "F_PM over its peak",
            "p (eq. 5)",
            "D downwind, 1/rad",
            "D at 90°, 1/rad",
            "F at 90° over downwind",
        ]
    ]
    peak = float(filters.pierson_moskowitz(f_m, 15.0))
    for ratio in (0.6, 0.8, 1.0, 1.5, 2.0, 3.0, 5.0):
        F = float(filters.pierson_moskowitz(ratio * f_m, 15.0)) / peak
        along, across = (float(filters.directional_spreading(ratio, t)) for t in (0.0, np.pi / 2))
        p = float(filters.spreading_power(ratio))
        rows.append(
            [f"{ratio:g}", f"{F:.4f}", f"{p:.3f}", f"{along:.4f}", f"{across:.4f}", f"{across / along:.4f}"]
        )
    return rows  # fmt: skip


def numbers() -> Table:
    """What the text says in numbers."""
    f_m = filters.peak_frequency(15.0)
    noise = source.white_noise(SAMPLES, SEED)
    levels = f"{noise.min():.0f} to {noise.max():.0f}, mean {noise.mean():.1f}"
    magnitude = np.abs(source.noise_coefficients(SAMPLES, SEED)[1:200, 1:200]) * SAMPLES
    inner, outer = magnitude[:60, :60].mean(), magnitude[120:, 120:].mean()
    sea = filtered_noise(WIND)
    band = animation.dominant_band(WIND, grid(), "DEEP", DEEP)
    f = np.sqrt(9.81 * grid().k[band]) / (2.0 * np.pi * f_m)
    power = filters.filter_power(WIND, grid(), "DEEP", DEEP)
    mode = round(SIDE / (2.0 * np.pi) * (2.0 * np.pi * f_m) ** 2 / 9.81 / np.sqrt(2.0))
    passed = power[mode, mode] / power[-mode, mode]
    physical = 4.0 * np.sqrt(filters.total_energy(15.0))
    return [
        ["number", "paper", "here"],
        ["peak frequency at 15 m/s (eq. 2)", "0.13 g/u", f"{f_m:.4f} Hz"],
        ["grey levels of the noise (fig. 5)", "0 to 255, evenly", levels],
        ["its standard deviation", "", f"{noise.std():.2f}; {np.sqrt(source.noise_variance()):.2f} expected"],
        ["magnitudes of its transform, long waves over short (fig. 6)", "white", f"{inner / outer:.3f}"],
        ["energy that passes at 45° over that at 135° (fig. 7)", "white against black", f"{passed:.0f}"],
        ["deviation of the filtered image over the noise's (gain)", "1", f"{sea.std() / noise.std():.3f}"],
        ["dominant band, f/f_m", "two thirds of the peak's energy", f"{f.min():.2f} to {f.max():.2f}"],
        ["wave height of this wind with √Ψ", "", f"{physical:.2f} m"],
    ]  # fmt: skip


def slopes() -> Table:
    """The exponents of the 1/f filters, fitted to the power of the filtered noise."""
    rows = [["filter", "D", "β = 8 − 2D", "fitted to the image"]]
    for title, layer, shortest in (
        ("fractal (fig. 2)", MOUNTAINS, 4),
        ("beyond the peak (fig. 3)", TEXTURE, 70),
    ):
        rows.append(
            [title, "2.1", f"{filters.spectral_exponent(2.1):.1f}", f"{fitted_exponent(layer, shortest):.2f}"]
        )
    return rows


def fitted_exponent(layer: ImageLayer, shortest: int) -> float:
    """β of the power of the filtered image, from so many waves a side on."""
    image = filtered_noise(layer)
    power = np.abs(np.fft.rfft2(image - image.mean())) ** 2
    index = grid().k / grid().spacing
    rings = np.geomspace(shortest, 250.0, 24)
    which = np.digitize(index.ravel(), rings)
    count = np.bincount(which, minlength=25)[1:24]
    mean, centre = (np.bincount(which, v.ravel(), minlength=25)[1:24] / count for v in (power, index))
    slope, _ = np.polyfit(np.log(centre), np.log(mean), 1, w=np.sqrt(count))
    return -float(slope)


def phases() -> Table:
    """How far two waves of the sea go in a second under each animation."""
    f_m = filters.peak_frequency(15.0)
    longest = 9.81 / (2.0 * np.pi * f_m**2)
    rows = [["animation", f"wave at the peak, {longest:.0f} m", f"wave of {longest / 4:.0f} m"]]
    settings = {
        "translation at 5 m/s": ("TRANSLATION", {"translation_speed": 5.0}),
        "dominant band, 0.05 and 0.003 rad a frame at 30 frames a second": ("DOMINANT_BAND", {}),
        "dispersion (eq. 10)": ("DISPERSION", {}),
    }
    for title, (name, more) in settings.items():
        layer = ImageLayer(wind_speed=15.0, animation=name, **more)  # type: ignore[arg-type]
        speeds = []
        for wavelength in (longest, longest / 4.0):
            one = WaveVectorGrid(16, wavelength)
            omega = animation.angular_frequency(layer, one, "DEEP", DEEP)
            speeds.append(f"{omega[0, 1] * wavelength / (2.0 * np.pi):.2f} m")
        rows.append([title, *speeds])
    return rows


TABLES = {"spectrum": spectrum, "numbers": numbers, "slopes": slopes, "phases": phases}
