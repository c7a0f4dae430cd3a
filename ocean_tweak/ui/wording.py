# SPDX-License-Identifier: GPL-3.0-or-later
"""How the window names what parameters hold: labels of fields, and what each choice means.

A field that is not here has its own name. A label is short enough for a narrow sidebar, and says the unit
where Blender has none for the number.
"""

import re
from typing import NamedTuple

#: labels of fields
LABELS = {
    "gravity": "Gravity (m/s²)",
    "density": "Density (kg/m³)",
    "surface_tension": "Tension (N/m)",
    "wind_height": "Wind Height (m)",
    "significant_wave_height": "Wave Height",
    "generalized_a": "A (m²/s⁴)",
    "generalized_b": "B (1/s⁴)",
    "short_wave_cutoff": "Short Cutoff",
    "shortest_wavelength": "Shortest Wave",
    "longest_wavelength": "Longest Wave",
    "band_softness": "Fade (octaves)",
    "band_inverted": "Invert Band",
    "spreading_exponent": "Exponent",
    "second_spreading": "Second Model",
    "spreading_mix": "Mix",
    "domain_size": "Domain Size",
    "texture_wavelength": "Wavelength",
    "noise_resolution": "Noise Samples",
    "fractal_dimension": "Dimension",
    "filter_gain": "Wave Height By",
    "dominant_rate": "Dominant (rad/s)",
    "surrounding_rate": "Others (rad/s)",
    "translation_speed": "Speed",
    "minimum_wind_speed": "Minimum Wind",
    "height": "Height By",
    "height_per_speed": "Per Wind Speed",
    "group_length": "Length",
    "mesh_resolution": "Mesh Quads",
    "law": "Foam Law",
    "noise_size": "Size",
    "noise_coverage": "Coverage",
    "noise_contrast": "Contrast",
    "noise_speed": "Speed",
    "noise_direction": "Direction",
    "noise_evolution": "Evolution",
    "noise_seed": "Seed",
    "longer_3": "8 × (dB)",
    "longer_2": "4 × (dB)",
    "longer_1": "2 × (dB)",
    "peak": "Peak (dB)",
    "shorter_1": "1/2 (dB)",
    "shorter_2": "1/4 (dB)",
    "shorter_3": "1/8 (dB)",
    "shorter_4": "1/16 (dB)",
    "shorter_5": "1/32 (dB)",
    "shorter_6": "1/64 (dB)",
    "measured_time": "Measured Time",
}

#: what stands in the place of a field's number while it is switched off
OFF = {
    "seed": "Auto",
    "resolution": "As the Sea",
    "mesh_resolution": "As the Sea",
    "shortest_wavelength": "All Waves",
    "longest_wavelength": "All Waves",
    "short_wave_cutoff": "None",
    "proxy": "None",
    "noise_evolution": "None",
    "wavelength": "Peak",
    "step": "As the Sea",
}


#: one entry of a list of parameters, by the list's name
_LISTS = {"layers": "Layer", "patches": "Patch", "keys": "Key"}
#: in messages: paths of fields, and names of fields with an underscore
_FIELD = re.compile(r"\b(?:(?:layers|patches)\.\d+(?:\.[a-z_]+)*|[a-z]+(?:_[a-z]+)+)\b")


class Scaled(NamedTuple):
    """How a field is shown in a unit that Blender does not have.

    name : of the property
    label : with the unit
    factor : value of the field for one of that unit
    useful : the range of a slider, in that unit
    """

    name: str
    label: str
    factor: float
    useful: tuple[float, float]


#: by the field's name
SCALED = {
    "fetch": Scaled("fetch_km", "Fetch (km)", 1000.0, (0.1, 1000.0)),
    "drift": Scaled("drift_percent", "Drift (% wind)", 0.01, (0.0, 5.0)),
}

#: label of a choice and what it means, by the field's name
CHOICES = {
    "dispersion": {
        "CAPILLARY": ("Full", "Depth slows long waves, surface tension speeds up ripples, as in real water"),
        "FINITE_DEPTH": ("Gravity Only", "Depth slows long waves; ripples run without surface tension"),
        "DEEP": ("Deep Water", "As if the water had no bottom"),
    },
    "amplitudes": {
        "RANDOM": ("Random", "Random wave heights, as at sea: some seeds are higher than others"),
        "DETERMINISTIC": (
            "Deterministic",
            "Each wave with the height of the spectrum and a random phase: all seeds are equally high",
        ),
    },
    "orbital_motion": {
        "DEEP": ("Deep Water", "Water moves in circles, as far sideways as up and down"),
        "FINITE_DEPTH": (
            "Finite Depth",
            "Water moves in ellipses, wider in shallow water, as in linear wave theory",
        ),
    },
    "definition": {
        "WIND": ("Wind", "Wind speed and fetch"),
        "SEA_STATE": ("Sea State", "Wave height and period, from a forecast or a buoy"),
        "MEASURED": ("Measured", "A spectrum from a file: File > Import > Measured Sea"),
    },
    "spectrum": {
        "TMA": ("TMA", "JONSWAP, lower where the water is shallow (Bouws and others 1985)"),
        "JONSWAP": ("JONSWAP", "A young sea that grows with the fetch (Hasselmann and others 1973)"),
        "PIERSON_MOSKOWITZ": ("Pierson-Moskowitz", "A fully developed sea; fetch has no effect"),
        "PHILLIPS": ("Phillips", "Tessendorf's spectrum, used in many films; fetch has no effect"),
        "GENERALIZED_AB": ("Generalized A, B", "A/ω⁵ exp(-B/ω⁴) with your own A and B; no wind"),
    },
    "depth_factor": {
        "KITAIGORODSKII": ("Exact", "Kitaigorodskii's shallow-water factor"),
        "THOMPSON_VINCENT": ("Approximate", "Thompson and Vincent's approximation by parabolas"),
    },
    "law": {
        "CALLAGHAN_2008": (
            "Callaghan 2008",
            "Callaghan and others (2008), measured in winds of 3.7 to 23 m/s",
        ),
        "MONAHAN_1980": (
            "Monahan 1980",
            "Monahan and O'Muircheartaigh (1980), measured below 20 m/s: twice as much foam in a storm",
        ),
    },
    "filter": {
        "MODIFIED_PIERSON_MOSKOWITZ": ("Wind", "Modified Pierson-Moskowitz: what a wind would raise"),
        "FRACTAL": ("Fractal", "1/f^β: equally rough at all scales"),
        "WATER_TEXTURE": ("Water Texture", "One wavelength dominates, as in a water texture"),
    },
    "filter_gain": {
        "PHYSICAL": ("Wind", "The height of the wind sea"),
        "PAPER": ("Wave Height", "The filter of Mastin and others (1987), at the wave height below"),
    },
    "animation": {
        "DISPERSION": ("Dispersion", "Each wave runs at its own speed, as water waves do"),
        "DOMINANT_BAND": ("Dominant Band", "The highest waves turn at one rate, all others at another"),
        "TRANSLATION": ("Translation", "The whole image slides along the wind"),
    },
    "crest": {
        "ARC": ("Arc", "Waves widen into arcs as they run"),
        "PARALLEL": ("Parallel", "Waves stay straight and parallel"),
    },
    "height": {
        "STEEPNESS": ("Steepness", "With the steepness set below, whatever their length"),
        "WIND_SPEED": ("Wind Speed", "In proportion to the wind speed"),
    },
}


def label(name: str, unit: str = "") -> str:
    """The label of a field, which says its unit where that is a number of waves."""
    own = LABELS.get(name, name.replace("_", " ").title())
    return f"{own} (waves)" if unit == "wavelengths" else own


def place(path: str) -> str:
    """Where a field is: `Layer 2, Wind Speed` of `layers.1.wind_speed`."""
    parts = []
    for part in path.split("."):
        if part.isdigit() and parts:
            parts[-1] += f" {int(part) + 1}"
        else:
            parts.append(_LISTS.get(part, label(part)))
    return ", ".join(parts)


def readable(error: str) -> str:
    """A message of parameters that cannot be used, with the names that the window has for them."""
    return _FIELD.sub(lambda found: place(found[0]), error)


def number_range(low: float, high: float, unit: str) -> str:
    """A range as a tooltip says it; empty where it tells an artist nothing."""
    if unit == "rad" or (low <= -1e5 and high >= 1e5):
        return ""
    name = f" {unit}" if unit else ""
    if high >= 1e5:
        return f" (from {_plain(low)}{name} on)" if low > 0.0 else ""
    return f" ({_plain(low)} to {_plain(high)}{name})"


def _plain(number: float) -> str:
    """Without an exponent."""
    return f"{number:.12f}".rstrip("0").rstrip(".")
