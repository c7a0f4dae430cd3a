# SPDX-License-Identifier: GPL-3.0-or-later
"""Energy of seas of several patches: every wave once, whatever the bands."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from scipy import integrate

from ocean_tweak.core import Ocean, OceanParameters, Patch, Places, Water, WaveLayer
from ocean_tweak.core.parameters.patch_seas import patch_parameters
from ocean_tweak.core.spectral.directional_spectrum import DirectionalSpectrum
from ocean_tweak.core.spectral.dispersion import angular_frequency
from ocean_tweak.core.synthesis.channels import OF_WAVES
from tests.core.patched_seas import LAYER, SEA, THREE

GENERATOR = np.random.default_rng(11)


LAYERS = {
    "wind sea": (LAYER,),
    "all directions": (dataclasses.replace(LAYER, spreading="FLAT", swell=0.0),),
    "swell and wind": (
        WaveLayer(definition="SEA_STATE", peak_period=8.0, swell=1.0, wind_direction=-2.0),
        LAYER,
    ),
    "soft band": (dataclasses.replace(LAYER, shortest_wavelength=12.0, band_softness=1.5),),
    "inverted band": (
        dataclasses.replace(LAYER, shortest_wavelength=8.0, longest_wavelength=40.0, band_inverted=True),
    ),
    "cut off": (dataclasses.replace(LAYER, short_wave_cutoff=0.4),),
}


def integral(layers: tuple[WaveLayer, ...], shortest: float, longest: float) -> float:
    """∫S dω of waves between two lengths, m²."""
    low, high = (
        float(angular_frequency(2.0 * np.pi / length, "CAPILLARY", Water())) for length in (longest, shortest)
    )
    total = 0.0
    for layer in layers:
        spectrum = DirectionalSpectrum(layer, Water(), "CAPILLARY")
        ends = 2.0 * np.pi / np.array([8.0, 12.0, 40.0, 20.0, 6.0])
        points = [
            w
            for w in (spectrum.peak_frequency, *angular_frequency(ends, "CAPILLARY", Water()))
            if low < w < high
        ]
        total += integrate.quad(
            lambda w, s=spectrum: float(s.frequency_spectrum(w)), low, high, points=points, limit=500
        )[0]
    return total


@pytest.mark.parametrize("name", LAYERS)
def test_bands_hold_every_wave_once(name: str) -> None:
    sea = SEA.replace(layers=LAYERS[name])
    found, wanted = [], []
    for parameters, patch in zip(patch_parameters(sea), sea.patches, strict=True):
        state = Ocean(parameters).initial_state
        found.append(float(np.sum((state.expected_plus + state.expected_minus) * state.grid.multiplicity)))
        wanted.append(integral(sea.layers, patch.shortest_wavelength, min(patch.longest_wavelength, 2000.0)))
    whole = integral(sea.layers, THREE[-1].shortest_wavelength, 2000.0)
    assert sum(found) == pytest.approx(whole, rel=0.01)
    for band, wanted_band in zip(found, wanted, strict=True):
        assert band == pytest.approx(wanted_band, rel=0.01, abs=1e-4 * whole)


@pytest.mark.parametrize("softness", [0.0, 1.0])
def test_no_wave_vector_is_twice_there_or_lost(softness: float) -> None:
    """Shares of the patches add up to the layer's own, at the ends of bands too."""
    layer = dataclasses.replace(LAYER, shortest_wavelength=2.0, band_softness=softness)
    ends = 2.0 * np.pi / np.array([20.0, 5.0])
    k = np.concatenate([GENERATOR.uniform(0.02, 6.9, 5000), ends, ends * (1 + 1e-12), ends * (1 - 1e-12)])
    shares = [DirectionalSpectrum(layer, Water(), "DEEP", patch.band).energy_weight(k) for patch in THREE]
    np.testing.assert_array_equal(sum(shares), DirectionalSpectrum(layer, Water(), "DEEP").energy_weight(k))
    assert np.all(np.count_nonzero(shares, axis=0) <= 1)


def test_a_cell_that_a_band_ends_in_is_shared() -> None:
    """Each patch has the mean of the part of the cell that lies in its band."""
    patches = (Patch(200.0, 0.0, 5.0, 1e6, 128), Patch(200.0, 0.0, 2.0, 5.0, 256))
    sea = SEA.replace(layers=LAYERS["all directions"], patches=patches)
    states = [Ocean(p).initial_state for p in patch_parameters(sea)]
    grid = states[0].grid  # the band ends 40 cells from the origin
    cut = (np.abs(grid.k / grid.spacing - 40.0) < 0.3) & grid.usable
    rows = np.where(np.arange(128) < 64, np.arange(128), np.arange(128) + 128)
    first, second = states[0].expected_plus[cut], states[1].expected_plus[rows, :65][cut]
    share = first / (first + second)
    inside = 0.5 + (40.0 - grid.k[cut] / grid.spacing)  # of a cell whose sides lie along and across
    assert np.std(share - inside) < 0.1
    assert np.all((share > 0.05) & (share < 0.95))


def test_variance_of_the_sum_is_that_of_its_waves() -> None:
    """Sampled in an area much larger than any patch: cross terms vanish as the area grows."""
    cascade = Ocean(SEA.replace(resolution=512))
    expected = cascade.statistics().seed.m0
    places = GENERATOR.uniform(0.0, 50e3, (2, 200_000))
    heights = [
        cascade.surface(time, on=Places(*places)).displacement[:, 2].astype(float)
        for time in (0.0, 30.0, 71.0)
    ]
    assert np.var(heights) == pytest.approx(expected, rel=0.05)


def test_neighbouring_patches_have_random_numbers_of_their_own() -> None:
    """Patches whose wave vectors coincide: the cells at a band's end are in both, and must not be alike."""
    for seed in (-1, 7):
        layer = dataclasses.replace(LAYER, spreading="FLAT", seed=seed)
        patches = (Patch(200.0, 0.0, 15.0, 1e6, 64), Patch(200.0, 0.0, 0.0, 15.0, 64))
        of_patches = [
            Ocean(p).initial_state.h_plus
            for p in patch_parameters(OceanParameters(layers=(layer,), patches=patches))
        ]
        both = np.all([np.abs(h) > 0.0 for h in of_patches], axis=0)
        first, second = (h[both] / np.abs(h[both]) for h in of_patches)
        assert np.count_nonzero(both) > 20
        assert abs(np.mean(first * np.conj(second))) < 3.0 / np.sqrt(np.count_nonzero(both))


def test_one_patch_is_the_sea_without_patches(windy: OceanParameters) -> None:
    alone = windy.replace(patches=(Patch(windy.domain_size, 0.0, resolution=windy.resolution),))
    for name in OF_WAVES:
        expected = getattr(Ocean(windy).surface(3.0, OF_WAVES), name)
        np.testing.assert_array_equal(getattr(Ocean(alone).surface(3.0, OF_WAVES), name), expected)
        (patch,) = Ocean(alone).patches
        np.testing.assert_array_equal(getattr(patch.surface(3.0, OF_WAVES), name), expected)


def test_a_turned_patch_keeps_its_sea() -> None:
    """Rotation turns the lattice of wave vectors and not the wind: direction and energy stay."""
    states = [
        Ocean(SEA.replace(patches=(Patch(600.0, rotation, resolution=128),))).statistics().resolved
        for rotation in (0.0, 0.5, 3.0)
    ]
    for state in states[1:]:
        assert state.m0 == pytest.approx(states[0].m0, rel=5e-3)
        assert state.mean_direction == pytest.approx(0.4, abs=5e-3)
