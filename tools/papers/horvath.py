# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers of Horvath (2015), by today's code."""

from __future__ import annotations

import numpy as np

from ocean_tweak.core import Foam, Ocean, OceanParameters, Water, WaveLayer
from ocean_tweak.core.spectral import constants, dispersion, spectra
from ocean_tweak.core.spectral.directional_spectrum import DirectionalSpectrum
from ocean_tweak.core.spectral.spreading import Spreading, directional_spreading
from ocean_tweak.core.statistics.sea_statistics import Statistics

from .pages import Table

#: the models of § 6, by their titles there
MODELS = {
    "COSINE_SQUARED": "positive cosine squared",
    "MITSUYASU": "Mitsuyasu",
    "HASSELMANN": "Hasselmann",
    "DONELAN_BANNER": "Donelan-Banner",
}
SWELLS = (0.0, 0.25, 0.5, 0.75, 1.0)

#: U ω_p / g of the sea in the plots of directions: a young one
WIND_FREQUENCY = 1.2


def sea(spectrum: str = "TMA", **changes: object) -> OceanParameters:
    """A sea of one layer; names of the layer's fields and of the sea's may be mixed."""
    names = {"resolution", "domain_size", "seed", "water", "foam"}
    of_layer = {name: value for name, value in changes.items() if name not in names}
    of_sea = {name: value for name, value in changes.items() if name in names}
    return OceanParameters(layers=(WaveLayer(spectrum=spectrum, **of_layer),), **of_sea)  # type: ignore[arg-type]


#: figure 3, whose fetch the paper leaves out: ours is 300 km
SHALLOW = {
    spectrum: sea(
        spectrum, wind_speed=25.0, fetch=300e3, swell=0.0, water=Water(depth=15.0), domain_size=250.0,
        resolution=256, seed=1,
    )
    for spectrum in ("PIERSON_MOSKOWITZ", "JONSWAP", "TMA")
}  # fmt: skip

#: figure 5, of which the paper gives the swell alone
SWELL = {
    swell: sea(wind_speed=15.0, fetch=300e3, swell=swell, domain_size=700.0, resolution=256, seed=1)
    for swell in (0.0, 1.0)
}

#: figures 6 and 7; the patches and their samples are ours
FIGURE_6 = sea(
    wind_speed=25.0, fetch=800e3, swell=0.25, water=Water(depth=100.0), domain_size=2000.0, resolution=1024,
    seed=1,
)  # fmt: skip
FIGURE_7 = sea(
    wind_speed=75.0, fetch=1250e3, swell=0.35, water=Water(depth=150.0), domain_size=4000.0, resolution=1024,
    seed=1, foam=Foam(coverage=0.15),  # the law of whitecaps, measured below 20 m/s, leaves no water here
)  # fmt: skip

#: as many m/s as g has m/s²
FULLY_DEVELOPED = DirectionalSpectrum(
    WaveLayer(spectrum="PIERSON_MOSKOWITZ", wind_speed=9.81), Water(depth=11e3), "DEEP"
)


def constants_table() -> Table:
    """Numbers that stand in the text."""
    w = np.linspace(0.5, 1.2, 70001)
    peak = float(w[np.argmax(FULLY_DEVELOPED.frequency_spectrum(w))])
    B = constants.PM_BETA / constants.PM_WIND_FACTOR**4
    wind = (1.0 / B) ** 0.25
    omega_h = np.linspace(0.0, 2.2, 2201)
    off = np.max(np.abs(spectra.thompson_vincent(omega_h) - spectra.kitaigorodskii(omega_h)))
    return [
        ["number", "paper", "here"],
        ["ω_p U/g of Pierson-Moskowitz (eq. 19)", "0.855", f"{peak:.4f}"],
        ["B of Pierson-Moskowitz over (g/U)⁴ (§ 5.1.2)", "0.6858", f"{B:.4f}"],
        ["wind of Tessendorf's over that of Pierson-Moskowitz (§ 5.1.3)", "1.0989", f"{wind:.4f}"],
        ["largest error of the depth factor's approximation (§ 5.1.5)", "below 0.04", f"{off:.3f}"],
    ]


def depth_factor() -> Table:
    """Figure 2 in numbers."""
    rows = [["ω_h", "exact (eq. 29)", "approximation", "difference"]]
    for omega_h in (0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0, 2.25):
        exact, near = (float(f(omega_h)) for f in (spectra.kitaigorodskii, spectra.thompson_vincent))
        rows.append([f"{omega_h:.2f}", f"{exact:.4f}", f"{near:.4f}", f"{near - exact:.4f}"])
    return rows


def shapes() -> Table:
    """Energy along the wind at the peak, in 1/rad: the peaks of the polar plots."""
    rows = [["D(ω_p, 0) in 1/rad", *(f"swell {swell:g}" for swell in SWELLS)]]
    for model, title in MODELS.items():
        values = [float(directional_spreading(1.0, 0.0, spreading(model, swell))) for swell in SWELLS]
        rows.append([title, *(f"{value:.3f}" for value in values)])
    return rows


def spreading(model: str, swell: float) -> Spreading:
    """A model as the plots show it."""
    return Spreading(model, swell, wind_frequency=WIND_FREQUENCY)


def dispersion_table() -> Table:
    """The three relations of § 4 for waves from 1 cm to 1 km, in 15 m of water."""
    rows = [["wavelength", "deep (eq. 7)", "finite depth (eq. 8)", "capillary (eq. 9)"]]
    for wavelength in (0.01, 0.0173, 0.1, 1.0, 10.0, 100.0, 1000.0):
        k = 2.0 * np.pi / wavelength
        speeds = [
            float(dispersion.angular_frequency(k, relation, Water(depth=15.0))) / k
            for relation in ("DEEP", "FINITE_DEPTH", "CAPILLARY")
        ]
        rows.append([f"{wavelength:g} m", *(f"{speed:.3f} m/s" for speed in speeds)])
    return rows


def shallow() -> Table:
    """Figure 3 in numbers."""
    rows = [["spectrum", "Hs", "Tp", "Hs over depth"]]
    for spectrum, parameters in SHALLOW.items():
        found = statistics(parameters)
        height = found.significant_wave_height
        rows.append([spectrum, f"{height:.2f} m", f"{found.peak_period:.2f} s", f"{height / 15.0:.2f}"])
    return rows


def swell() -> Table:
    """Figure 5 in numbers."""
    rows = [["swell", "Hs", "directional spread"]]
    for amount, parameters in SWELL.items():
        state = statistics(parameters).spectrum
        spread = np.degrees(state.directional_spread)
        rows.append([f"{amount:g}", f"{state.significant_wave_height:.2f} m", f"{spread:.1f}°"])
    return rows


def storms() -> Table:
    """The seas of figures 6 and 7."""
    rows = [["figure", "wind", "fetch", "depth", "Hs", "Tp", "peak wavelength"]]
    for name, parameters in (("6", FIGURE_6), ("7", FIGURE_7)):
        found, layer = statistics(parameters), parameters.layers[0]
        rows.append(
            [
                name, f"{layer.wind_speed:g} m/s", f"{layer.fetch / 1e3:g} km",
                f"{parameters.water.depth:g} m",
                f"{found.significant_wave_height:.1f} m", f"{found.peak_period:.1f} s",
                f"{found.peak_wavelength:.0f} m",
            ]
        )  # fmt: skip
    return rows


def statistics(parameters: OceanParameters) -> Statistics:
    """Of the spectrum: the samples do not matter."""
    return Ocean(parameters.replace(resolution=16)).statistics()


TABLES = {
    "constants": constants_table,
    "depth-factor": depth_factor,
    "shapes": shapes,
    "dispersion": dispersion_table,
    "shallow": shallow,
    "swell": swell,
    "storms": storms,
}
