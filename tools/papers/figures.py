# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the plots of docs/papers, with matplotlib: `python -m tools.papers.figures [PAGE ...]`."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.colors import LightSource
from matplotlib.figure import Figure
from numpy.typing import NDArray
from PIL import Image

from ocean_tweak.core import OceanParameters, Water, WindFieldLayer
from ocean_tweak.core.spectral import dispersion, spectra
from ocean_tweak.core.spectral.spreading import directional_spreading
from ocean_tweak.core.statistics.sea_spectrum import SeaSpectrum
from ocean_tweak.core.waves.image import filters, source
from ocean_tweak.core.waves.wind_field.wind import winds_at

from . import chen, horvath, lantz, li_wang, mastin
from .measures import elevation
from .pages import PAGES

Array = NDArray[np.float64]

#: the largest a picture may be
_BYTES = 200_000


def shaded(axes: Axes, elevation: Array, side: float, title: str, exaggeration: float = 1.0) -> None:
    """A sea from above, lit from a side."""
    light = LightSource(azdeg=315, altdeg=35)
    spacing = side / len(elevation)
    image = light.hillshade(elevation, vert_exag=exaggeration, dx=spacing, dy=spacing)
    axes.imshow(image, cmap="gray", origin="lower", extent=(0, side, 0, side), vmin=0, vmax=1)
    axes.set_title(title)


def grey(axes: Axes, image: Array, title: str, low: float | None = None, high: float | None = None) -> None:
    """Numbers as grey levels, without axes."""
    axes.imshow(image, cmap="gray", origin="lower", vmin=low, vmax=high)
    axes.set_title(title)
    axes.set_axis_off()


# Horvath


def horvath_dispersion() -> Figure:
    """The three relations of § 4 in 15 m of water."""
    figure, axes = plt.subplots(figsize=(6, 3.2))
    k = np.geomspace(1e-3, 1e3, 400)
    for relation, style in (("DEEP", ":"), ("FINITE_DEPTH", "--"), ("CAPILLARY", "-")):
        omega = dispersion.angular_frequency(k, relation, Water(depth=15.0))
        axes.loglog(k, omega / k, style, label=relation.lower().replace("_", " "))
    axes.set(xlabel="k, rad/m", ylabel="phase speed, m/s", title="Dispersion in 15 m of water")
    axes.legend()
    return figure


def horvath_spectra() -> Figure:
    """S(ω) of the three spectra, with the wind and depth of figure 3."""
    figure, axes = plt.subplots(figsize=(6, 3.2))
    omega = np.linspace(0.15, 1.6, 600)
    for name, sea in horvath.SHALLOW.items():
        axes.plot(omega, SeaSpectrum(sea).frequency_spectrum(omega), label=name)
    axes.set(xlabel="ω, rad/s", ylabel="S, m²·s/rad", title="25 m/s over 300 km, 15 m deep")
    axes.legend()
    return figure


def horvath_depth_factor() -> Figure:
    """Figure 2."""
    figure, axes = plt.subplots(figsize=(6, 3.2))
    w = np.linspace(0.0, 3.0, 400)
    axes.plot(w, spectra.kitaigorodskii(w), label="exact")
    axes.plot(w, spectra.thompson_vincent(w), "--", label="approximation, capped at 2")
    printed = np.where(w <= 1.0, 0.5 * w**2, 1.0 - 0.5 * (2.0 - w) ** 2)
    axes.plot(w, printed, ":", label="approximation as printed")
    axes.set(xlabel="ω_h", ylabel="Φ", title="Depth factor")
    axes.legend()
    return figure


def horvath_directions() -> Figure:
    """D around the wind at three frequencies, by model and swell."""
    ratios = (0.7, 1.0, 2.0)
    figure, all_axes = plt.subplots(3, 4, figsize=(9, 7), subplot_kw={"projection": "polar"})
    theta = np.linspace(-np.pi, np.pi, 361)
    for row, ratio in zip(all_axes, ratios, strict=True):
        for axes, (model, title) in zip(row, horvath.MODELS.items(), strict=True):
            for swell in horvath.SWELLS:
                curve = directional_spreading(ratio, theta, horvath.spreading(model, swell))
                axes.plot(theta, curve, lw=1, label=f"swell {swell:g}")
            axes.set_xticklabels([])
            axes.set_rmax(1.6)
            axes.tick_params(labelsize=6)
            axes.set_title(f"{title}, ω/ω_p {ratio:g}", fontsize=7)
    all_axes[0, 0].legend(fontsize=5, loc="lower left")
    return figure


def horvath_shallow() -> Figure:
    """Figure 3 from above."""
    figure, all_axes = plt.subplots(1, 3, figsize=(9, 3.2))
    for axes, (name, sea) in zip(all_axes, horvath.SHALLOW.items(), strict=True):
        shaded(axes, elevation(sea), 250.0, name)
    return figure


def horvath_swell() -> Figure:
    """Figure 5 from above."""
    figure, all_axes = plt.subplots(1, 2, figsize=(7, 3.6))
    for axes, (swell, sea) in zip(all_axes, horvath.SWELL.items(), strict=True):
        shaded(axes, elevation(sea), 700.0, f"swell {swell:g}", 3.0)
    return figure


# Chen


def chen_profiles() -> Figure:
    """Figures 1 and 2 as cuts, in true proportion of height to height."""
    figure, all_axes = plt.subplots(2, 2, figsize=(8, 4), sharey="row")
    for column, L in enumerate((256.0, 512.0)):
        for row, corrected in enumerate((False, True)):
            cut = chen.malformed(L, int(L / 2.0), corrected)[0]
            axes = all_axes[row, column]
            axes.plot(np.arange(len(cut)) * 2.0, cut, lw=0.8)
            axes.set_title(
                f"{'corrected (fig. 2)' if corrected else 'eq. 3 (fig. 1)'}, L = {L:g} m", fontsize=9
            )
            axes.set_ylabel("m")
    return figure


def chen_developing() -> Figure:
    """Figure 5 from above."""
    figure, axes = plt.subplots(figsize=(4, 4))
    shaded(axes, elevation(chen.DEVELOPING), 256.0, "JONSWAP, 11 m/s, 50 km", 3.0)
    return figure


# Mastin


def mastin_fractal() -> Figure:
    """Figures 2 and 3: the filters along one axis."""
    figure, all_axes = plt.subplots(1, 2, figsize=(8, 2.8))
    grid = mastin.grid()
    for axes, layer, title in (
        (all_axes[0], mastin.MOUNTAINS, "1/f (fig. 2)"),
        (all_axes[1], mastin.TEXTURE, "1/f with a Gaussian below its peak (fig. 3)"),
    ):
        power = filters.filter_power(layer, grid, "DEEP", mastin.DEEP)[0]
        axes.plot(np.arange(1, 200), np.sqrt(power[1:200]))
        axes.set(xlabel="waves a side", title=title)
        axes.title.set_fontsize(9)
    return figure


def mastin_spectrum() -> Figure:
    """Figure 4."""
    figure, axes = plt.subplots(figsize=(6, 3))
    ratio = np.linspace(0.01, 5.0, 500)
    f_m = filters.peak_frequency(15.0)
    axes.plot(ratio, filters.pierson_moskowitz(ratio * f_m, 15.0) * filters.directional_spreading(ratio, 0.0))
    axes.set(xlabel="f/f_m", ylabel="F(f, 0), m²·s/rad", title="15 m/s, downwind (fig. 4)")
    return figure


def mastin_images() -> Figure:
    """Figures 5 to 8."""
    figure, all_axes = plt.subplots(2, 2, figsize=(7, 7.2))
    noise = source.white_noise(mastin.SAMPLES, mastin.SEED)[:256, :256]
    grey(all_axes[0, 0], noise[::2, ::2], "white noise, a part (fig. 5)", 0, 255)
    magnitude = np.abs(np.fft.fftshift(np.fft.fft2(noise - noise.mean())))[::2, ::2]
    grey(all_axes[0, 1], np.log(magnitude + 1.0), "its FFT magnitude (fig. 6)")
    power = filters.filter_power(mastin.WIND, mastin.grid(), "DEEP", mastin.DEEP)
    near = 40
    rows = np.r_[-near : near + 1]
    half = power[np.ix_(rows, range(near + 1))]
    plane = np.hstack([half[::-1, :0:-1], half])
    grey(all_axes[1, 0], np.sqrt(plane), f"filter, {near} waves each way (fig. 7)")
    grey(all_axes[1, 1], mastin.filtered_noise(mastin.WIND)[::2, ::2], "filtered (fig. 8)", 0, 255)
    return figure


# Lantz


def lantz_tiles() -> Figure:
    """Nine patches side by side."""
    figure, axes = plt.subplots(figsize=(4.4, 4.6))
    shaded(axes, np.tile(elevation(lantz.PATCH, 5.0), (3, 3)), 192.0, "3 x 3 patches of 64 m", 2.0)
    for edge in (64, 128):
        axes.axvline(edge, color="tab:orange", lw=0.5, ls=":")
        axes.axhline(edge, color="tab:orange", lw=0.5, ls=":")
    return figure


# Li & Wang


def levels(axes: Axes, field: Array, limit: float) -> None:
    """Heights of a patch in m as grey levels, from −limit to limit."""
    side = li_wang.SIDE
    axes.imshow(field, cmap="gray", origin="lower", extent=(0, side, 0, side), vmin=-limit, vmax=limit)


def side_by_side(seas: dict[str, OceanParameters], time: float) -> Figure:
    """Heights of several seas."""
    figure, all_axes = plt.subplots(1, len(seas), figsize=(3.2 * len(seas), 3.4))
    for axes, (title, sea) in zip(all_axes, seas.items(), strict=True):
        field = elevation(sea, time)
        levels(axes, field, float(np.abs(field).max()))
        axes.set_title(title)
    return figure


def li_wang_fronts() -> Figure:
    """Figure 4 b and d."""
    fronts = li_wang.CRESTS
    return side_by_side({"arc (fig. 4b)": fronts["ARC"], "parallel (fig. 4d)": fronts["PARALLEL"]}, 25.0)


def li_wang_splitting() -> Figure:
    """Figure 5."""
    seas = li_wang.SPLITTING
    return side_by_side({"without splitting (fig. 5a)": seas[False], "with (fig. 5b)": seas[True]}, 25.0)


def li_wang_tiles() -> Figure:
    """Figure 7 b: four patches side by side."""
    figure, axes = plt.subplots(figsize=(4.2, 4.2))
    field = elevation(li_wang.WINDS["the same everywhere"], 60.0)
    limit = 2.5 * float(np.std(field))
    grey(axes, np.tile(field, (2, 2)), "2 x 2 patches (fig. 7b)", -limit, limit)
    axes.axvline(256, lw=0.4, ls=":")
    axes.axhline(256, lw=0.4, ls=":")
    return figure


def li_wang_winds() -> Figure:
    """Figure 9: the winds above, their seas below."""
    figure, all_axes = plt.subplots(2, 3, figsize=(9, 6.4))
    places = li_wang.SIDE / 8 * np.arange(8)
    x, y = (axis.ravel() for axis in np.meshgrid(places, places))
    for (above, below), (kind, sea) in zip(all_axes.T, li_wang.WINDS.items(), strict=True):
        _, (winds,) = winds_at(sea.of(WindFieldLayer)[0], x, y, li_wang.SIDE)
        above.quiver(*winds.T.reshape(2, 8, 8), pivot="middle")
        above.set_title(kind)
        above.set_aspect("equal")
        field = elevation(sea, 60.0)
        levels(below, field, 2.5 * float(np.std(field)))
    return figure


FIGURES: dict[str, dict[str, Callable[[], Figure]]] = {
    "horvath-2015": {
        "dispersion": horvath_dispersion,
        "spectra": horvath_spectra,
        "depth-factor": horvath_depth_factor,
        "directions": horvath_directions,
        "shallow": horvath_shallow,
        "swell": horvath_swell,
    },
    "chen-2014": {"profiles": chen_profiles, "developing": chen_developing},
    "mastin-1987": {"fractal": mastin_fractal, "spectrum": mastin_spectrum, "images": mastin_images},
    "lantz": {"tiles": lantz_tiles},
    "li-wang-2016": {
        "fronts": li_wang_fronts,
        "splitting": li_wang_splitting,
        "tiles": li_wang_tiles,
        "winds": li_wang_winds,
    },
}


def save(figure: Figure, path: Path) -> None:
    """The figure with few colours; raises RuntimeError for one that is too large."""
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.tight_layout()
    figure.savefig(path, dpi=90)
    plt.close(figure)
    with Image.open(path) as image:
        small = image.convert("RGB").quantize(48)
    small.save(path, optimize=True)
    if path.stat().st_size > _BYTES:
        raise RuntimeError(f"{path} has {path.stat().st_size} bytes")


def main() -> None:
    """Draw the figures of all pages, or of those named."""
    mpl.rcParams.update({"font.size": 8, "savefig.facecolor": "white"})
    for name in sys.argv[1:] or FIGURES:
        for title, draw in FIGURES[name].items():
            save(draw(), PAGES / name / f"{title}.png")
            print(f"{name}/{title}.png", flush=True)


if __name__ == "__main__":
    mpl.use("Agg")
    main()
