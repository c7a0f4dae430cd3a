# SPDX-License-Identifier: GPL-3.0-or-later
"""Seas of several patches: every wave once, fields of the sum, and what is refused."""

from __future__ import annotations

import dataclasses
import math
import re
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from scipy import integrate

from ocean_tweak.core import (
    Cascade,
    Foam,
    Ocean,
    OceanParameters,
    ParameterError,
    Patch,
    Raster,
    Water,
    WaveLayer,
    WindFieldLayer,
    WindKey,
)
from ocean_tweak.core.cascades.foam import foam_at
from ocean_tweak.core.cascades.patch_seas import patch_parameters
from ocean_tweak.core.directional_spectrum import DirectionalSpectrum
from ocean_tweak.core.dispersion import angular_frequency
from ocean_tweak.core.fields import OUTPUTS
from ocean_tweak.core.foam import FoamModel
from ocean_tweak.core.foam_threshold import whitecap_coverage
from ocean_tweak.core.memory import memory_need
from ocean_tweak.core.shot import Animation, Shot
from ocean_tweak.core.unresolved_slopes import unresolved_slope_variance
from tests.core import direct_sum
from tests.core.test_fields import outputs_from

LAYER = WaveLayer(wind_speed=10.0, wind_direction=0.4, fetch=100e3)
THREE = (
    Patch(600.0, 0.0, 20.0, 1e6, 128),
    Patch(151.0, 0.7, 5.0, 20.0, 128),
    Patch(33.0, 1.2, 0.9, 5.0, 160),
)
SEA = OceanParameters(seed=3, layers=(LAYER,), patches=THREE)
GENERATOR = np.random.default_rng(11)


def small(**changes: object) -> OceanParameters:
    """Few enough waves to add them up one by one."""
    patches = (Patch(120.0, 0.3, 16.0, 1e6, 32), Patch(37.0, -0.9, 3.0, 16.0, 32))
    sea = OceanParameters(layers=(dataclasses.replace(LAYER, wind_speed=6.0),), patches=patches)
    return sea.replace(**changes)


# energy


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
    cascade = Cascade(SEA.replace(resolution=512))
    expected = cascade.statistics().total.seed.m0
    places = GENERATOR.uniform(0.0, 50e3, (2, 200_000))
    heights = [
        cascade.fields_at(*places, time).displacement[:, 2].astype(float) for time in (0.0, 30.0, 71.0)
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
    for name in OUTPUTS:
        expected = getattr(Ocean(windy).surface(3.0, OUTPUTS), name)
        np.testing.assert_array_equal(getattr(Ocean(alone).surface(3.0, OUTPUTS), name), expected)
        np.testing.assert_array_equal(getattr(Cascade(windy).surfaces(3.0, OUTPUTS)[0], name), expected)


def test_a_turned_patch_keeps_its_sea() -> None:
    """Rotation turns the lattice of wave vectors and not the wind: direction and energy stay."""
    states = [
        Cascade(SEA.replace(patches=(Patch(600.0, rotation, resolution=128),))).statistics().total.resolved
        for rotation in (0.0, 0.5, 3.0)
    ]
    for state in states[1:]:
        assert state.m0 == pytest.approx(states[0].m0, rel=5e-3)
        assert state.mean_direction == pytest.approx(0.4, abs=5e-3)


# fields of the sum


def summed(parameters: OceanParameters, x: np.ndarray, y: np.ndarray, time: float) -> dict[str, np.ndarray]:
    """Position and derivatives at rest positions, wave by wave, each turned by its patch's rotation."""
    result = {c + d: np.zeros(x.shape) for c in "xyz" for d in ("", "_x", "_y", "_t")}
    for of_patch, patch in zip(patch_parameters(parameters), parameters.patches, strict=True):
        state = Ocean(of_patch, precision="double").initial_state
        for kx, ky, omega, a, phase in direct_sum.waves(state):
            k = np.hypot(kx, ky)
            angle = np.arctan2(ky, kx) + patch.rotation
            kx, ky = k * np.cos(angle), k * np.sin(angle)
            sine, cosine = (a * f(kx * x + ky * y - omega * time + phase) for f in (np.sin, np.cos))
            result["z"] += cosine
            for name, rate in (("_x", kx), ("_y", ky), ("_t", -omega)):
                result["z" + name] -= rate * sine
            for component, along in (("x", kx), ("y", ky)):
                factor = parameters.choppiness * along / k
                result[component] -= factor * sine
                for name, rate in (("_x", kx), ("_y", ky), ("_t", -omega)):
                    result[component + name] -= factor * rate * cosine
    return result


@pytest.mark.parametrize("rotation", [0.0, 0.5 * np.pi, -0.5 * np.pi])
def test_every_field_of_the_sum_equals_the_sum_of_waves(rotation: float) -> None:
    """Where samples of both patches coincide nothing is interpolated."""
    patches = (Patch(64.0, 0.0, 12.0, 1e6, 16), Patch(32.0, rotation, 4.5, 12.0, 16))
    sea = small(patches=patches, choppiness=0.8)
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(0.0, 128.0, 4.0), np.arange(-64.0, 64.0, 4.0)))
    fields = Cascade(sea, precision="double").fields_at(x, y, 2.5, OUTPUTS)
    for name, expected in outputs_from(summed(sea, x, y, 2.5)).items():
        actual = getattr(fields, name)
        if name == "min_eigenvector":
            actual = actual * np.sign(np.sum(actual * expected, axis=-1, keepdims=True))
        np.testing.assert_allclose(actual, expected, atol=2e-6, err_msg=name)


def test_fields_between_the_samples_are_near_the_sum_of_waves() -> None:
    patches = tuple(dataclasses.replace(p, resolution=512) for p in small().patches)
    x, y = GENERATOR.uniform(-200.0, 200.0, (2, 200))
    exact = summed(small(), x, y, 4.0)
    sea = small(patches=patches)  # more samples refine the same sea, within its bands
    fine = Cascade(sea).fields_at(x, y, 4.0, {"displacement", "slope"})
    spread = np.std(exact["z"])
    assert np.std(fine.displacement[:, 2] - exact["z"]) < 0.05 * spread
    assert np.std(fine.slope[:, 0] - exact["z_x"]) < 0.35 * np.std(exact["z_x"])


def test_exact_surface_is_the_sum_of_waves() -> None:
    sea = small()
    x, y = GENERATOR.uniform(-300.0, 300.0, (2, 60))
    sums = summed(sea, x, y, 3.0)
    points = Cascade(sea).points_at(x + sums["x"], y + sums["y"], 3.0, "exact", velocity=True)
    assert np.all(points.found)
    np.testing.assert_allclose(points.height, sums["z"], atol=2e-5)
    np.testing.assert_allclose(points.rest, np.stack([x, y], -1), atol=2e-4)
    np.testing.assert_allclose(points.velocity, np.stack([sums[c + "_t"] for c in "xyz"], -1), atol=2e-4)
    np.testing.assert_allclose(points.normal, outputs_from(sums)["normal"], atol=2e-4)


def test_places_are_found_where_they_went() -> None:
    cascade = Cascade(SEA)
    x, y = GENERATOR.uniform(-5e3, 5e3, (2, 2000))
    points = cascade.points_at(x, y, 4.0, velocity=True)
    assert np.all(points.found)
    rest_x, rest_y = points.rest[:, 0], points.rest[:, 1]
    fields = cascade.fields_at(rest_x, rest_y, 4.0, {"displacement", "velocity"})
    np.testing.assert_allclose(rest_x + fields.displacement[:, 0], x, atol=1e-4)
    np.testing.assert_allclose(rest_y + fields.displacement[:, 1], y, atol=1e-4)
    np.testing.assert_allclose(fields.displacement[:, 2], points.height, atol=1e-4)
    np.testing.assert_allclose(fields.velocity, points.velocity, atol=1e-4)
    assert cascade.height_at(3.0, 4.0, 2.0).shape == ()


def test_velocity_is_the_change_of_the_displacement() -> None:
    cascade = Cascade(SEA, precision="double")
    x, y = GENERATOR.uniform(0.0, 1e3, (2, 300))
    step = 1e-3
    before, after = (cascade.fields_at(x, y, 5.0 + dt).displacement for dt in (-step, step))
    velocity = cascade.fields_at(x, y, 5.0, {"velocity"}).velocity
    np.testing.assert_allclose((after - before) / (2 * step), velocity, atol=1e-4)


def test_the_highest_sheet_of_a_fold() -> None:
    wind = dataclasses.replace(LAYER, wind_speed=14.0)
    cascade = Cascade(SEA.replace(choppiness=3.5, layers=(wind,), patches=THREE[:2]))
    x, y = np.random.default_rng(1).uniform(0.0, 3000.0, (2, 60_000))
    fields = cascade.fields_at(x, y, 1.0, {"displacement", "min_eigenvalue"})
    folded = fields.min_eigenvalue < -0.05
    assert np.count_nonzero(folded) > 20
    moved = fields.displacement[folded].astype(float)
    heights = cascade.height_at(x[folded] + moved[:, 0], y[folded] + moved[:, 1], 1.0)
    # at a fold's very edge a net may miss it; single patches have a quad for each
    assert np.mean(heights >= moved[:, 2] - 1e-3) > 0.8
    wave_height = cascade.statistics().total.significant_wave_height
    assert np.mean(np.maximum(moved[:, 2] - heights, 0.0)) < 0.02 * wave_height
    assert np.any(heights > moved[:, 2] + 1e-3)


def test_the_sum_repeats_with_no_patch() -> None:
    cascade = Cascade(SEA)
    x, y = GENERATOR.uniform(0.0, 600.0, (2, 4000))
    here = cascade.fields_at(x, y, 1.0, {"slope"}).slope[:, 0]
    for patch in THREE:
        c, s = np.cos(patch.rotation), np.sin(patch.rotation)
        there = cascade.fields_at(x + c * patch.domain_size, y + s * patch.domain_size, 1.0, {"slope"}).slope[
            :, 0
        ]
        # slopes are spread over all bands: what one patch repeats is not the sum
        assert np.corrcoef(here, there)[0, 1] < 0.6


# foam


def test_foam_of_one_patch_is_that_of_its_ocean() -> None:
    sea = OceanParameters(
        resolution=64, domain_size=200.0, layers=(dataclasses.replace(LAYER, wind_speed=16.0),),
        foam=Foam(drift=0.0, coverage=3.0, half_life=1.0),
    )  # fmt: skip
    expected = Ocean(sea).surface(2.3, {"foam"}).foam
    assert 0.02 < np.mean(expected > 0.1) < 0.9
    np.testing.assert_allclose(Cascade(sea).area(200.0, 64, 2.3, {"foam"}).foam, expected, atol=1e-5)


def test_foam_of_the_sum_covers_what_the_wind_leaves() -> None:
    wind = dataclasses.replace(LAYER, wind_speed=15.0)
    sea = SEA.replace(layers=(wind,), foam=Foam(half_life=1.0, coverage=2.0))
    cascade = Cascade(sea)
    x, y = GENERATOR.uniform(0.0, 20e3, (2, 20_000))
    foam = cascade.fields_at(x, y, 4.0, {"foam"}).foam
    assert np.all((foam >= 0.0) & (foam <= 1.0))
    assert np.mean(foam >= 0.5) == pytest.approx(2.0 * whitecap_coverage(15.0), rel=0.25)
    # a frame alone is that of a sequence
    cascade.fields_at(x, y, 4.125, {"foam"})
    np.testing.assert_array_equal(cascade.fields_at(x, y, 4.0, {"foam"}).foam, foam)
    np.testing.assert_array_equal(Cascade(sea).fields_at(x[:5], y[:5], 4.0, {"foam"}).foam, foam[:5])


def test_foam_drifts_along_the_wind() -> None:
    """Foam that is born once, in a spot at the origin, lies downwind of it later, and fades."""
    model = FoamModel(threshold=0.5, half_life=2.0, drift=(1.5, -0.5), spacing=1.0)

    def spot(x: np.ndarray, y: np.ndarray, time: Fraction) -> np.ndarray:
        return np.where((np.hypot(x, y) < 0.4) & (time == 1), 1.0, 0.0)

    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(-6.0, 6.1, 0.25), np.arange(-6.0, 6.1, 0.25)))
    foam = foam_at(model, spot, x, y, 3.0)
    covered = foam > 0.0
    assert np.mean(x[covered]) == pytest.approx(2.0 * 1.5, abs=0.1)
    assert np.mean(y[covered]) == pytest.approx(2.0 * -0.5, abs=0.1)
    np.testing.assert_allclose(foam[covered], 0.5, rtol=1e-6)
    assert np.all(foam_at(model, spot, x, y, 1.0) == (np.hypot(x, y) < 0.4))
    assert not np.any(foam_at(model, spot, x, y, 0.5))


# parameters


def test_json_round_trip_and_the_size_of_the_first_patch() -> None:
    again = OceanParameters.from_json(SEA.to_json())
    assert again == SEA
    assert (SEA.domain_size, SEA.resolution) == (600.0, 128)
    assert "patches" not in OceanParameters().to_dict()
    halved = SEA.replace(resolution=64)
    assert [patch.resolution for patch in halved.patches] == [64, 64, 80]
    assert halved.resolution == 64
    with pytest.raises(ParameterError, match=r"domain_size = 50\.0: is that of the first of the patches"):
        SEA.replace(domain_size=50.0)


def patches_between(*bands: tuple[float, float]) -> tuple[Patch, ...]:
    return tuple(Patch(100.0, 0.0, shortest, longest, 64) for shortest, longest in bands)


@pytest.mark.parametrize(
    ("bands", "said"),
    [
        (((20.0, 1e6), (2.0, 25.0)), "patches.0 ends at 20 m and patches.1 begins at 25 m: .* twice"),
        (((20.0, 1e6), (2.0, 15.0)), "patches.0 ends at 20 m and patches.1 begins at 15 m: .* lost"),
        (((20.0, 1e6), (5.0, 20.0), (1.0, 4.0)), "patches.2 begins at 4 m: .* one value"),
        (((2.0, 20.0), (20.0, 1e6)), "order the patches from long waves to short"),
    ],
)
def test_bands_that_do_not_join_are_refused(bands: tuple[tuple[float, float], ...], said: str) -> None:
    with pytest.raises(ParameterError, match=said):
        OceanParameters(patches=patches_between(*bands))


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"trough_damping": 0.5}, "trough_damping = 0.5: must be 0 in a sea of patches"),
        ({"patches": THREE + THREE}, "patches = '6 entries': must have from 0 to 4 entries"),
        ({"patches": "many"}, "must be a sequence of Patch"),
    ],
)
def test_what_patches_cannot_have(changes: dict[str, object], said: str) -> None:
    with pytest.raises(ParameterError, match=said):
        SEA.replace(**changes)


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"resolution": 31}, "resolution = 31: must be an even number"),
        ({"shortest_wavelength": 9.0, "longest_wavelength": 9.0}, "must be below longest_wavelength = 9 m"),
        ({"domain_size": 0.0}, "domain_size = 0.0: must be from 0.1"),
        ({"rotation": math.nan}, "rotation = nan: must be a finite number"),
    ],
)
def test_bad_patches_are_refused(values: dict[str, object], said: str) -> None:
    with pytest.raises(ParameterError, match=said):
        Patch(**values)  # type: ignore[arg-type]


def wind_field() -> WindFieldLayer:
    return WindFieldLayer(keys=(WindKey(0.0, Raster(np.full((4, 4, 2), 4.0))),))


def test_wind_fields_are_on_the_first_patch() -> None:
    sea = SEA.replace(wind_fields=(wind_field(),))
    assert [len(patch.wind_fields) for patch in patch_parameters(sea)] == [1, 0, 0]
    turned = (dataclasses.replace(THREE[0], rotation=0.1), *THREE[1:])
    with pytest.raises(
        ParameterError, match=r"patches\.0\.rotation = 0\.1: must be 0 in a sea with wind_fields"
    ):
        sea.replace(patches=turned)


def test_an_ocean_is_one_patch() -> None:
    for patches in (THREE, (Patch(100.0, 0.2, resolution=64),)):
        with pytest.raises(ValueError, match="use Cascade"):
            Ocean(SEA.replace(patches=patches))
    cascade = Cascade(SEA)
    with pytest.raises(ValueError, match="surface = 'nurbs'"):
        cascade.height_at(0.0, 0.0, 1.0, "nurbs")
    with pytest.raises(ValueError, match="outputs = 'curl'"):
        cascade.fields_at(0.0, 0.0, 1.0, {"curl"})
    with pytest.raises(ValueError, match="time = nan"):
        cascade.fields_at(0.0, 0.0, math.nan)
    with pytest.raises(ValueError, match="finite places"):
        cascade.fields_at([0.0, math.inf], 0.0, 1.0)
    with pytest.raises(TypeError, match="Cascade wants OceanParameters"):
        Cascade({})  # type: ignore[arg-type]


def test_a_loop_ends_where_it_began() -> None:
    cascade = Cascade(small(loop_duration=Fraction(10)), precision="double")
    x, y = GENERATOR.uniform(0.0, 500.0, (2, 100))
    first, last = (cascade.fields_at(x, y, time).displacement for time in (0.0, 10.0))
    np.testing.assert_allclose(first, last, atol=1e-9)


def test_a_shot_animates_layers_and_not_patches() -> None:
    shot = Shot(SEA, Animation(1, (("layers.0.wind_direction", (0.4, 0.5)),)))
    assert shot.at(2).parameters.patches == THREE
    with pytest.raises(ParameterError, match="is constant over a shot"):
        Animation(1, (("patches.0.rotation", (0.4, 0.5)),))


# statistics and memory


def test_statistics_of_the_sum_and_of_its_patches() -> None:
    found = Cascade(SEA).statistics()
    whole = Ocean(SEA.replace(patches=())).statistics()
    assert found.total.spectrum == whole.spectrum
    assert found.total.resolved.m0 == pytest.approx(sum(p.statistics.resolved.m0 for p in found.patches))
    assert sum(patch.share for patch in found.patches) == pytest.approx(1.0)
    assert found.total.resolved.mean_direction == pytest.approx(0.4, abs=0.01)
    assert found.total.resolved.mean_square_slope == pytest.approx(
        sum(p.statistics.resolved.mean_square_slope for p in found.patches)
    )
    assert found.total.sample_spacing == pytest.approx(33.0 / 160)
    told = found.to_dict()["patches"]
    assert [patch["domain_size"] for patch in told] == [600.0, 151.0, 33.0]  # type: ignore[attr-defined]
    assert told[2]["samples_a_wave"] == pytest.approx(0.9 * 160 / 33.0)  # type: ignore[index]
    assert found.total.warnings == ()


def test_statistics_of_one_patch_are_those_of_its_sea() -> None:
    whole = SEA.replace(patches=(), resolution=32, domain_size=200.0)
    for sea in (
        whole,
        whole.replace(seed=8),
        whole.replace(layers=(dataclasses.replace(LAYER, muted=True),)),
    ):
        assert Cascade(sea).statistics().total.to_dict() == Ocean(sea).statistics().to_dict()


def test_statistics_warn_of_patches_that_are_too_small_or_too_coarse() -> None:
    first, second, third = THREE
    coarse = Cascade(SEA.replace(patches=(first, second, dataclasses.replace(third, resolution=64))))
    (warning,) = coarse.statistics().total.warnings
    assert "Patch 3: its shortest wave, 0.9 m, has only 1.7 samples. Give it 148 samples" in warning
    near = Cascade(SEA.replace(patches=(first, dataclasses.replace(second, domain_size=80.0), third)))
    assert any(
        "Patch 2: its longest wave, 20 m, goes only 4 times" in w for w in near.statistics().total.warnings
    )
    early = (
        dataclasses.replace(first, shortest_wavelength=60.0),
        dataclasses.replace(second, longest_wavelength=60.0),
    )
    shown = Cascade(SEA.replace(patches=early)).statistics().total.warnings
    assert any("Patch 2: it repeats every 151 m with" in warning for warning in shown)


def test_memory_is_that_of_all_patches() -> None:
    whole = memory_need(SEA)
    parts = [memory_need(patch) for patch in patch_parameters(SEA)]
    assert whole.state == sum(part.state for part in parts)
    assert whole.surface == sum(part.surface for part in parts)


def test_unresolved_slopes_begin_where_the_last_patch_ends() -> None:
    """Ripples shorter than 0.9 m: ∫k²S dω, up to the shortest gravity waves."""
    limit = np.sqrt(1000.0 * 9.80665 / 0.074)
    shortest = 2.0 * np.pi / 0.9
    spectrum = DirectionalSpectrum(LAYER, Water(), "CAPILLARY")

    def density(log_k: float) -> float:
        k = math.exp(log_k)
        step = 1e-5
        omega, above = (float(angular_frequency(k * f, "CAPILLARY", Water())) for f in (1.0, 1.0 + step))
        return k**2 * float(spectrum.frequency_spectrum(omega)) * (above - omega) / step

    expected, _ = integrate.quad(density, math.log(shortest), math.log(limit))
    assert unresolved_slope_variance(SEA) == pytest.approx(expected, rel=0.02)


# documents and examples

ROOT = Path(__file__).resolve().parents[2]


def test_the_example_is_a_plan_without_warnings() -> None:
    sea = OceanParameters.from_json((ROOT / "examples" / "horizon.json").read_text(encoding="utf-8"))
    found = Cascade(sea).statistics()
    assert len(sea.patches) == 4
    assert found.total.warnings == ()
    assert found.total.resolved_share == pytest.approx(1.0, abs=0.01)
    assert sea.patches[-1].shortest_wavelength == 0.1


def test_the_document_shows_a_sea() -> None:
    text = (ROOT / "docs" / "cascades.md").read_text(encoding="utf-8")
    (patches,) = re.findall(r"^```json\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    sea = OceanParameters.from_json(f"{{{patches}}}")
    assert Cascade(sea).statistics().total.warnings == ()


def test_cusp_of_the_sum_is_made_of_strains_as_the_document_says() -> None:
    cascade = Cascade(SEA)
    x, y = GENERATOR.uniform(0.0, 500.0, (2, 200))
    fields = cascade.fields_at(x, y, 2.0, {"strain", "cusp"})
    xx, yy, xy = np.moveaxis(fields.strain, -1, 0)
    cusp = np.maximum(0.0, 1 - (1 + (xx + yy) / 2) + np.sqrt(((xx - yy) / 2) ** 2 + xy**2))
    np.testing.assert_allclose(fields.cusp, cusp, atol=1e-6)
