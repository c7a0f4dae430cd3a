# SPDX-License-Identifier: GPL-3.0-or-later
"""Heights by octave of wavelength: 0 dB changes nothing, 6 dB doubles, and all else stays."""

from __future__ import annotations

import numpy as np
import pytest

from ocean_tweak.core import Ocean, OceanParameters, ParameterError, WaveLayer
from ocean_tweak.core.parameters.ocean_parameters import Equaliser, Mask, Patch
from ocean_tweak.core.parameters.shot import Animation, Shot
from ocean_tweak.core.spectral.equaliser import GAINS, OCTAVES, Equalising
from ocean_tweak.core.statistics.sea_spectrum import SeaSpectrum

SEA = OceanParameters(resolution=64, domain_size=300.0, seed=3)
SIX_DB = 20.0 * np.log10(2.0)


def test_0_db_changes_no_byte() -> None:
    outputs = {"displacement", "velocity", "foam", "normal"}
    plain = Ocean(SEA).surface(4.0, outputs)
    flat = Equaliser()
    for sea in (SEA.replace(equaliser=flat), SEA.replace(layers=(WaveLayer(equaliser=flat),))):
        same = Ocean(sea).surface(4.0, outputs)
        for name in outputs:
            np.testing.assert_array_equal(getattr(same, name), getattr(plain, name))
    assert "equaliser" not in SEA.to_json()


def test_all_bands_at_6_db_double_the_sea() -> None:
    louder = Equaliser(**dict.fromkeys(GAINS, SIX_DB))
    plain = Ocean(SEA, precision="double").surface(4.0).displacement
    for sea in (SEA.replace(equaliser=louder), SEA.replace(layers=(WaveLayer(equaliser=louder),))):
        np.testing.assert_allclose(
            Ocean(sea, precision="double").surface(4.0).displacement, 2.0 * plain, atol=1e-6
        )


def test_bands_are_octaves_of_wavelength_around_the_peak() -> None:
    """At its own wavelength each band has its own gain; half-way to the next their mean."""
    gains = dict(zip(GAINS, (3.0, -6.0, 0.0, 12.0, -24.0, 5.0, 1.0, -1.0, 2.0, -3.0), strict=True))
    at_work = Equalising(Equaliser(**gains), 0.1)
    values = np.array(list(gains.values()))
    np.testing.assert_allclose(at_work.gain(0.1 * 2.0**OCTAVES), values, atol=1e-12)
    between = at_work.gain(0.1 * 2.0 ** (OCTAVES[:-1] + 0.5))
    np.testing.assert_allclose(between, 0.5 * (values[:-1] + values[1:]), atol=1e-9)
    quarter = at_work.gain(0.1 * 2.0 ** (OCTAVES[:-1] + 0.25))  # and smooth, as 3t² - 2t³
    np.testing.assert_allclose(quarter, values[:-1] + 0.15625 * np.diff(values), atol=1e-9)
    assert at_work.gain(1e-6) == values[0]
    assert at_work.gain(1e6) == values[-1]
    with np.errstate(divide="raise", invalid="raise"):
        assert at_work.gain(0.0) == values[0]
        # beside a wavelength of which the wave number is beyond all floats, all are long
        assert Equalising(Equaliser(**gains), np.inf).gain(0.1) == values[0]
    fine = at_work.gain(0.1 * np.geomspace(2.0**-4, 2.0**8, 10_001))
    assert np.abs(np.diff(fine)).max() < 0.1  # smooth: no step


def test_the_peak_of_the_spectrum_is_where_the_band_peak_is() -> None:
    sea = SEA.replace(equaliser=Equaliser(peak=-12.0))
    before, after = SeaSpectrum(SEA), SeaSpectrum(sea)
    omega = np.array([before.peak_frequency])
    ratio = after.frequency_spectrum(omega) / before.frequency_spectrum(omega)
    assert ratio[0] == pytest.approx(10.0**-1.2, rel=1e-3)
    named = SEA.replace(equaliser=Equaliser(peak=-12.0, wavelength=2.0 * np.pi / before.peak_wave_number))
    np.testing.assert_allclose(SeaSpectrum(named).frequency_spectrum(omega), after.frequency_spectrum(omega))


def test_the_whole_sea_has_one_peak_in_all_patches_and_under_all_masks() -> None:
    """A part that holds short waves alone counts its bands from the same wavelength."""
    swell = WaveLayer(definition="SEA_STATE", significant_wave_height=3.0, peak_period=9.0)
    masked = WaveLayer(wind_speed=6.0, fetch=20e3, mask=Mask(inner_radius=10.0, outer_radius=20.0))
    equaliser = Equaliser(shorter_1=6.0, shorter_2=6.0, peak=-6.0)
    sea = SEA.replace(layers=(swell, masked), equaliser=equaliser)
    everywhere = SEA.replace(layers=(swell, masked.changed(mask=None)), equaliser=equaliser)
    far = np.array([[120.0, 150.0, 200.0], [130.0, 100.0, 150.0]])  # where the mask takes nothing
    np.testing.assert_allclose(
        Ocean(sea).height_at(*far, 2.0), Ocean(everywhere).height_at(*far, 2.0), atol=2e-3
    )
    patches = (Patch(domain_size=300.0, resolution=64, shortest_wavelength=20.0),
               Patch(domain_size=60.0, resolution=64, longest_wavelength=20.0))  # fmt: skip
    parts = OceanParameters(layers=everywhere.layers, patches=patches, equaliser=equaliser)
    state = Ocean(parts).statistics()
    whole = Ocean(everywhere.replace(resolution=512)).statistics()
    assert state.resolved.m0 == pytest.approx(whole.resolved.m0, rel=0.02)


def test_bands_of_the_sea_count_from_its_peak_and_those_of_a_layer_from_its_own() -> None:
    """In a patch too, which holds a part of the layer alone."""
    own = Equaliser(shorter_2=6.0)
    swell = WaveLayer(definition="SEA_STATE", significant_wave_height=3.0, peak_period=9.0, equaliser=own)
    sea = SEA.replace(layers=(swell, WaveLayer(wind_speed=6.0, fetch=20e3)), equaliser=own)
    first, second = SeaSpectrum(sea).layers
    of_sea = 2.0 * np.pi / 9.0
    assert (
        first.equalisers[-1].peak == second.equalisers[-1].peak == pytest.approx(of_sea**2 / 9.81, rel=0.02)
    )
    patches = (Patch(domain_size=60.0, resolution=64, longest_wavelength=20.0),)
    short = OceanParameters(layers=sea.layers, equaliser=own, patches=patches)
    assert SeaSpectrum(short).layers[0].equalisers[0].peak == first.equalisers[0].peak


def test_gains_can_be_keyed() -> None:
    shot = Shot(
        SEA.replace(equaliser=Equaliser(), layers=(WaveLayer(equaliser=Equaliser()),)),
        Animation(1, (("equaliser.peak", (0.0, 6.0)), ("layers.0.equaliser.shorter_3", (-24.0, 0.0)))),
    )
    middle = shot.at(1.5).parameters
    assert middle.equaliser == Equaliser(peak=3.0)
    assert middle.layers[0].equaliser == Equaliser(shorter_3=-12.0)
    assert Shot.from_json(shot.to_json()) == shot
    with pytest.raises(ParameterError, match="there is no equaliser"):
        Shot(SEA, Animation(1, (("equaliser.peak", (0.0, 6.0)),)))
    with pytest.raises(ParameterError, match="from -24 to 12 dB"):
        Equaliser(peak=13.0)
