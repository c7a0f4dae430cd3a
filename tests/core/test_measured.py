# SPDX-License-Identifier: GPL-3.0-or-later
"""Wave layers whose spectrum was measured: energy, directions, times, and what a grid leaves out."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ocean_tweak.core import Current, Ocean, OceanParameters, ParameterError, WaveLayer
from ocean_tweak.core.data.raster import Raster
from ocean_tweak.core.foam.threshold import foam_wind, has_windrows
from ocean_tweak.core.parameters.ocean_parameters import MeasuredSpectra, Patch
from ocean_tweak.core.parameters.shot import Animation, Shot
from ocean_tweak.core.spectral.maximum_entropy import feasible, maximum_entropy
from ocean_tweak.core.spectral.measured import EnergyTable, bin_edges, bin_widths, table_directions
from ocean_tweak.core.statistics.sea_spectrum import SeaSpectrum
from ocean_tweak.core.statistics.sea_statistics import spectrum_state

F = np.geomspace(0.06, 0.6, 24)
WIDTH = np.gradient(F)
S = np.exp(-((np.log(F / 0.13) / 0.3) ** 2))
S *= (2.0 / 4.0) ** 2 / (S @ WIDTH)  # Hs 2 m


def measured(
    energy: np.ndarray = S, towards: float = 0.7, r1: float = 0.9, r2: float = 0.7, **others: object
) -> MeasuredSpectra:
    """Spectra with the same directions at all frequencies and times."""
    rows = np.atleast_2d(energy)
    moments = np.empty((*rows.shape, 4))
    moments[:] = (r1 * math.cos(towards), r1 * math.sin(towards),
                  r2 * math.cos(2 * towards), r2 * math.sin(2 * towards))  # fmt: skip
    return MeasuredSpectra(
        frequencies=Raster(np.stack([F, WIDTH], axis=-1)[np.newaxis]),
        energy=Raster(rows[..., np.newaxis]),
        **{"moments": Raster(moments), **others},
    )


def sea_of(
    spectra: MeasuredSpectra, resolution: int = 128, size: float = 500.0, **layer: object
) -> OceanParameters:
    own = WaveLayer(definition="MEASURED", measured=spectra, wind_speed=0.0, **layer)
    return OceanParameters(resolution=resolution, domain_size=size, layers=(own,))


HOURS = {"times": Raster([[0.0, 3600.0]])}


def test_maximum_entropy_has_the_moments_and_no_negative_lobes() -> None:
    """Random positive distributions give feasible moments: D has them to 1e-6, and is what a wrapped normal's
    neighbours are where the two harmonics tell all (r₂ = r₁² of its own class).
    """
    chance = np.random.default_rng(3)
    fine = np.linspace(0.0, 2.0 * np.pi, 720, endpoint=False)
    shapes = np.exp(4.0 * np.cos(fine - chance.uniform(0, 6, (200, 1)))) * chance.uniform(0, 1, (200, 1))
    shapes = shapes + np.exp(6.0 * np.cos(fine - chance.uniform(0, 6, (200, 1))))
    shapes /= shapes.mean(axis=1, keepdims=True) * 2.0 * np.pi
    harmonic = [2.0 * np.pi * np.mean(shapes * np.exp(1j * n * fine), axis=1) for n in (1, 2)]
    moments = np.stack([harmonic[0].real, harmonic[0].imag, harmonic[1].real, harmonic[1].imag], axis=-1)
    np.testing.assert_allclose(feasible(moments), moments, atol=1e-9)
    density = maximum_entropy(moments, fine)
    assert density.min() > 0.0
    for n, expected in zip((1, 2), harmonic, strict=True):
        np.testing.assert_allclose(
            2.0 * np.pi * np.mean(density * np.exp(1j * n * fine), axis=1), expected, atol=1e-6
        )


def test_moments_that_no_sea_has_are_made_feasible() -> None:
    theta = np.linspace(0.0, 2.0 * np.pi, 720, endpoint=False)
    for impossible in ([0.9, 0.0, -0.9, 0.0], [1.2, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.5]):
        density = maximum_entropy(feasible(impossible), theta)
        assert np.all(np.isfinite(density))
        assert density.min() >= 0.0


def test_widths_of_bins_of_which_only_the_middles_are_told() -> None:
    """NDBC's 46 bins, printed with three decimals, and a geometric series."""
    true = [0.0325 + 0.005 * i for i in range(13)] + [0.1 + 0.01 * i for i in range(26)]
    true += [0.365 + 0.02 * i for i in range(7)]
    printed = np.array([float(f"{f + 1e-9:.3f}") for f in true])
    np.testing.assert_allclose(bin_widths(printed), [0.005] * 13 + [0.01] * 26 + [0.02] * 7)
    edges = bin_edges(printed, bin_widths(printed))
    assert edges[[0, 13, 39, 46]] == pytest.approx([0.03, 0.095, 0.355, 0.495])
    np.testing.assert_allclose(bin_widths(F), np.gradient(F))


def test_the_lowest_bin_ends_above_0() -> None:
    """Though the next is far: a layer refuses one that does not."""
    assert bin_widths(np.array([0.01, 0.05, 0.06]))[0] == 0.01


def test_directions_change_in_the_middle_between_two_bins() -> None:
    """Within a quarter of the way from either they are those of the bin."""
    f, width = np.array([0.1, 0.2, 0.3]), np.full(3, 0.1)
    theta = table_directions()
    spread = np.stack([1.0 + np.cos(theta), 1.0 - np.cos(theta), 1.0 - np.cos(theta)]) / (2.0 * np.pi)
    vectors = EnergyTable(f, width, np.ones(3), spread, False).mean_vector(np.array([0.124, 0.15, 0.176]))
    np.testing.assert_allclose(vectors, [0.5, 0.0, -0.5], atol=1e-6)


def test_each_bin_keeps_its_energy() -> None:
    """∫S df over a bin is S·Δf of the file, by a sum over a million frequencies; nowhere negative."""
    chance = np.random.default_rng(0)
    energy = chance.exponential(1.0, len(F)) * (chance.uniform(size=len(F)) > 0.3)
    table = measured(energy).table(0.0)
    f = np.linspace(table.edges[0], table.edges[-1], 1_000_001)
    density = table.frequency_spectrum(f)
    assert density.min() >= 0.0
    cumulated = np.concatenate(([0.0], np.cumsum(0.5 * (density[1:] + density[:-1]) * np.diff(f))))
    np.testing.assert_allclose(np.diff(np.interp(table.edges, f, cumulated)), energy * WIDTH, atol=2e-6)
    assert table.m0 == pytest.approx(float(np.sum(energy * WIDTH)), rel=1e-6)
    with_tail = measured(energy + 0.1, tail=True).table(0.0)
    rounded = np.where(F > 0.3, 0.0, S)  # what small energies are in files
    table = measured(rounded, tail=True).table(0.0)
    f = np.array([0.35, 0.5, 1.0])
    np.testing.assert_allclose(table.frequency_spectrum(2.0 * f) * 32.0, table.frequency_spectrum(f))
    assert 0.0 < table.m0 - rounded @ WIDTH < 0.01 * table.m0
    beyond = np.geomspace(with_tail.edges[-1], 50.0, 100_001)
    density = with_tail.frequency_spectrum(beyond)
    tail = float(np.sum(0.5 * (density[1:] + density[:-1]) * np.diff(beyond)))
    assert with_tail.m0 == pytest.approx(float(np.sum((energy + 0.1) * WIDTH)) + tail, rel=1e-5)


def test_a_tail_begins_as_high_as_the_last_bins_are() -> None:
    """Even where these fall less steeply than it does; not as high as the spectrum's middle."""
    table = measured(F**-3.5, tail=True).table(0.0)
    edge = float(table.edges[-1])
    assert table.frequency_spectrum(np.array([edge]))[0] == pytest.approx(edge**-3.5, rel=0.15)


def test_heights_and_directions_of_a_sea() -> None:
    sea = sea_of(measured(), resolution=256, size=900.0)
    statistics = Ocean(sea).statistics()
    for state in (statistics.spectrum, statistics.resolved):
        assert state.significant_wave_height == pytest.approx(2.0, rel=0.01)
        assert state.mean_direction == pytest.approx(0.7, abs=0.02)
        assert state.directional_spread == pytest.approx(math.sqrt(2.0 - 1.8), abs=0.02)
    turned = sea.replace(layers=(sea.layers[0].changed(wind_direction=1.0),))
    assert spectrum_state(SeaSpectrum(turned)).mean_direction == pytest.approx(1.7, abs=0.001)


def test_a_layer_scales_turns_and_makes_foam_along_what_was_measured() -> None:
    sea = sea_of(measured(), wind_direction=1.0, amplitude_scale=2.0)
    plain, scaled = (
        Ocean(sea.replace(layers=(sea.layers[0].changed(amplitude_scale=scale),))).statistics()
        for scale in (1.0, 2.0)
    )
    assert scaled.spectrum.significant_wave_height == pytest.approx(4.0, rel=0.01)
    for state in ("resolved", "seed"):
        before, after = (getattr(each, state).significant_wave_height for each in (plain, scaled))
        assert after == pytest.approx(2.0 * before, rel=1e-4)
    wind = sea.layers[0].changed(wind_speed=9.0).wind(sea)
    assert wind is not None
    assert (wind.speed, wind.direction) == pytest.approx((9.0, 1.7), abs=1e-3)


def test_long_waves_far_below_the_peak_count() -> None:
    """A low swell at 0.07 Hz under a wind sea at 0.55 Hz has a tenth of the energy."""
    swell, wind_sea = (np.exp(-((np.log(F / peak) / 0.08) ** 2)) for peak in (0.07, 0.55))
    energy = 0.01 * swell / (swell @ WIDTH) + 0.09 * wind_sea / (wind_sea @ WIDTH)
    state = spectrum_state(SeaSpectrum(sea_of(measured(energy))))
    assert state.significant_wave_height == pytest.approx(4.0 * math.sqrt(0.1), rel=0.005)


@pytest.mark.parametrize("towards", [0.0, 45.0, 47.3])
def test_waves_of_a_single_direction_keep_their_height_on_any_lattice(towards: float) -> None:
    """Directions narrower than the angle between two cells, along its axes, its diagonal, and neither."""
    sea = sea_of(measured(towards=math.radians(towards), r1=1.0, r2=1.0), resolution=256, size=900.0)
    statistics = Ocean(sea).statistics()
    assert statistics.resolved.significant_wave_height == pytest.approx(2.0, rel=0.03)
    assert statistics.resolved.mean_direction == pytest.approx(math.radians(towards), abs=0.01)
    carried = SeaSpectrum(
        sea.replace(current=Current(1.2, 1.0))
    )  # the same waves, as a fixed place sees them
    assert spectrum_state(carried).significant_wave_height == pytest.approx(2.0, rel=0.01)


def test_the_variance_of_seeds_is_the_measured_one() -> None:
    sea = sea_of(measured(), resolution=64, size=400.0)
    heights = [Ocean(sea.replace(seed=seed)).surface(0.0).displacement[..., 2].var() for seed in range(60)]
    error = float(np.std(heights)) / math.sqrt(len(heights))
    resolved = Ocean(sea).statistics().resolved.m0
    assert resolved == pytest.approx(0.25, rel=0.02)
    assert np.mean(heights) == pytest.approx(resolved, abs=4.0 * error)


def test_spectra_in_time_blend_in_energy_with_the_same_random_numbers() -> None:
    spectra = measured(np.stack([S, 9.0 * S]), **HOURS)
    seas = [sea_of(spectra, resolution=64, measured_time=t) for t in (0.0, 1800.0, 3600.0, 9000.0)]
    fields = [Ocean(sea, precision="double").surface(3.0).displacement for sea in seas]
    np.testing.assert_allclose(fields[1], math.sqrt(5.0) * fields[0], atol=1e-6)
    np.testing.assert_allclose(fields[2], 3.0 * fields[0], atol=1e-6)
    np.testing.assert_array_equal(fields[3], fields[2])  # after the last it stays
    shot = Shot(seas[0], Animation(1, (("layers.0.measured_time", (0.0, 1800.0, 3600.0)),)))
    assert shot.at(2).parameters.layers[0].measured_time == 1800.0
    assert Shot.from_json(shot.to_json()) == shot


def test_keys_of_a_time_that_changes_nothing_are_refused() -> None:
    """Of a layer whose spectra lie by while it is defined by its wind, and of one that has none."""
    kept = sea_of(measured(np.stack([S, S]), **HOURS)).layers[0].changed(definition="WIND", wind_speed=9.0)
    keys = Animation(1, (("layers.0.measured_time", (0.0, 1800.0)),))
    for layer in (kept, WaveLayer()):
        with pytest.raises(ParameterError, match="set its definition to MEASURED, or leave this out"):
            Shot(OceanParameters(layers=(layer,)), keys)


def test_a_wind_that_is_measured_later_may_draw_the_foam_out() -> None:
    """A bake tells the version of its windrows for all of its frames, not for the first alone."""
    gale = measured(np.stack([S, S]), wind=Raster([[[4.0, 0.0], [0.0, 25.0]]]), **HOURS)
    breeze = measured(np.stack([S, S]), wind=Raster([[[4.0, 0.0], [0.0, 8.0]]]), **HOURS)
    keys = Animation(1, (("layers.0.measured_time", (0.0, 3600.0)),))
    assert [has_windrows(Shot(sea_of(spectra), keys)) for spectra in (gale, breeze)] == [True, False]
    assert not has_windrows(Shot(sea_of(gale)))  # it stays at the first


def test_heights_without_directions_take_the_layers_own() -> None:
    spectra = measured(moments=None)
    assert not spectra.has_directions
    sea = sea_of(spectra, wind_direction=2.0, spreading="COSINE_2S", spreading_exponent=9.0, swell=0.0)
    state = spectrum_state(SeaSpectrum(sea))
    assert state.significant_wave_height == pytest.approx(2.0, rel=0.005)
    assert state.mean_direction == pytest.approx(2.0, abs=1e-3)
    assert state.directional_spread == pytest.approx(math.sqrt(2.0 - 2.0 * 0.9), abs=0.01)  # r₁ = s/(s+1)


def test_shares_by_direction_are_read_around_the_circle() -> None:
    theta = 0.3 + np.arange(24) * 2.0 * np.pi / 24
    shares = np.tile(np.maximum(np.cos((theta - 5.9) / 2.0), 0.0) ** 2**5, (len(F), 1))
    spectra = measured(moments=None, directions=Raster(shares[..., np.newaxis]), first_direction=0.3)
    expected = np.sum(shares[0] * np.exp(1j * theta)) / np.sum(shares[0])
    state = spectrum_state(SeaSpectrum(sea_of(spectra)))
    assert state.mean_direction % (2.0 * np.pi) == pytest.approx(
        np.angle(expected) % (2.0 * np.pi), abs=0.005
    )
    assert state.directional_spread == pytest.approx(math.sqrt(2.0 - 2.0 * abs(expected)), abs=0.01)


def test_the_wind_beside_the_waves_makes_the_whitecaps() -> None:
    sea = sea_of(measured(np.stack([S, S]), wind=Raster([[[4.0, 0.0], [0.0, 8.0]]]), **HOURS))
    late = sea.replace(layers=(sea.layers[0].changed(measured_time=3600.0),))
    winds = [foam_wind(each) for each in (sea, late)]
    assert winds[0] == pytest.approx((4.0, 0.0))
    assert winds[1] == pytest.approx((8.0, math.pi / 2))
    turned = late.replace(layers=(late.layers[0].changed(wind_direction=0.4),))
    assert foam_wind(turned) == pytest.approx((8.0, math.pi / 2 + 0.4))
    assert foam_wind(sea_of(measured())) is None
    own = sea_of(measured())
    windy = foam_wind(own.replace(layers=(own.layers[0].changed(wind_speed=12.0),)))
    assert windy is not None
    assert windy == pytest.approx((12.0, 0.7), abs=1e-3)  # along the waves


def test_what_a_grid_leaves_out_is_told() -> None:
    long = Ocean(sea_of(measured(), size=60.0)).statistics().warnings
    assert any("longer than the domain of 60 m" in warning for warning in long)
    lengths, shares = sea_of(measured()).layers[0].plain_spectrum(sea_of(measured())).shares_of_lengths
    beyond = np.cumsum(shares)  # from the longest on
    for share, told in ((0.003, False), (0.02, True)):
        size = float(lengths[np.searchsorted(beyond, share)]) * 1.001
        warned = sea_of(measured(), size=size).layers[0].warnings(sea_of(measured(), size=size))
        assert any("longer than the domain" in warning for warning in warned) is told
    coarse = Ocean(sea_of(measured(), resolution=32, size=900.0)).statistics().warnings
    assert any("shorter than two samples, 56.2 m" in warning for warning in coarse)
    assert Ocean(sea_of(measured(), resolution=512, size=900.0)).statistics().warnings == ()


def test_patches_hold_the_same_waves_in_their_axes() -> None:
    """A patch that is turned has the mean direction in its own axes, and all together the measured energy."""
    patches = (Patch(domain_size=700.0, resolution=128, shortest_wavelength=30.0),
               Patch(domain_size=90.0, resolution=128, longest_wavelength=30.0, rotation=0.5))  # fmt: skip
    sea = sea_of(measured()).replace(patches=patches)
    statistics = Ocean(sea).statistics()
    assert statistics.resolved.significant_wave_height == pytest.approx(2.0, rel=0.02)
    assert statistics.resolved.mean_direction == pytest.approx(0.7, abs=0.02)


def test_a_file_holds_its_spectra() -> None:
    sea = sea_of(measured(np.stack([S, S]), **HOURS))
    assert OceanParameters.from_json(sea.to_json()) == sea
    assert "measured" not in OceanParameters().to_json()


@pytest.mark.parametrize(
    ("changes", "what"),
    [
        ({"times": Raster([[5.0, 5.0]])}, "ascend"),
        ({"times": None}, "must be given for 2 spectra"),
        ({"energy": Raster(np.ones((2, 3, 1)))}, "24 columns"),
        ({"energy": Raster(-np.ones((2, 24, 1)))}, "negative"),
        ({"moments": Raster(np.ones((1, 24, 4)))}, "2 rows"),
        ({"wind": Raster(np.ones((1, 3, 2)))}, "2 columns"),
        ({"frequencies": Raster(np.ones((1, 24, 2)))}, "ascend"),
        ({"frequencies": Raster(-np.ones((1, 1, 2)))}, "at least 2"),
        ({"frequencies": Raster(np.stack([F, 9.0 * F], axis=-1)[np.newaxis])}, "above 0 Hz"),
        ({"directions": Raster(np.ones((48, 8, 1)))}, "left out where there are moments"),
        ({"energy": None}, "must be a Raster"),
    ],
)
def test_what_is_no_spectrum(changes: dict[str, object], what: str) -> None:
    good = measured(np.stack([S, S]), **HOURS)
    with pytest.raises(ParameterError, match=what):
        MeasuredSpectra(**{**vars(good), **changes})


def test_a_measured_layer_needs_its_spectrum() -> None:
    with pytest.raises(ParameterError, match="command `spectrum`"):
        WaveLayer(definition="MEASURED")
