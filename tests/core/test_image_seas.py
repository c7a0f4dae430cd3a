# SPDX-License-Identifier: GPL-3.0-or-later
"""Images as layers of a sea: beside wave layers, in its statistics, its foam and its shots."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ocean_tweak.core import Ocean, OceanParameters, WaveLayer
from ocean_tweak.core.data.errors import ParameterError
from ocean_tweak.core.data.raster import Raster
from ocean_tweak.core.parameters.shot import Animation, Shot
from ocean_tweak.core.sea.memory import memory_need
from ocean_tweak.core.statistics.unresolved_slopes import total_slope_variance, unresolved_slope_variance
from ocean_tweak.core.synthesis.channels import OF_WAVES
from ocean_tweak.core.waves.image.parameters import ImageLayer
from tests.core.images import L, drawing, single_wave
from tests.layers import layers_of, with_layers

FLAT = WaveLayer(muted=True)


def sea(*images: ImageLayer, **changes: object) -> OceanParameters:
    given = {
        "resolution": 64,
        "domain_size": L,
        "seed": 3,
        "layers": (FLAT,),
        **changes,
    }
    return with_layers(OceanParameters(**given), IMAGE=images)


def test_a_sea_of_images_alone() -> None:
    fields = Ocean(sea(ImageLayer(wind_speed=7.0))).surface(1.0, OF_WAVES)
    assert 0.5 < 4 * fields.displacement[..., 2].std() < 2.0
    assert Ocean(sea()).surface(1.0).displacement.max() == 0.0


def test_images_add_to_the_wave_layers() -> None:
    wind = WaveLayer(wind_speed=8.0)
    images = (
        ImageLayer(wind_speed=6.0),
        ImageLayer(filter="FRACTAL", animation="TRANSLATION", wind_direction=0.5),
        ImageLayer(filter="FRACTAL", animation="DOMINANT_BAND", fractal_dimension=3.0),
    )
    together = sea(*images, layers=(wind,))
    alone = [with_layers(together, IMAGE=()), *(
        with_layers(together.replace(layers=(FLAT,)), IMAGE=tuple(replace(p, muted=i != one) for i, p in
        enumerate(layers_of(together, "IMAGE")))) for one in range(3)
    )]  # fmt: skip
    for output in ("displacement", "velocity", "slope"):
        total, *parts = (
            getattr(Ocean(p, "double").surface(2.3, (output,)), output) for p in (together, *alone)
        )
        np.testing.assert_allclose(total, sum(parts), atol=1e-11)


def test_several_layers_have_noise_of_their_own() -> None:
    twins = sea(ImageLayer(wind_speed=7.0), ImageLayer(wind_speed=7.0))
    assert [layer.id for layer in layers_of(twins, "IMAGE")] == [0, 1]
    first, second = (
        Ocean(with_layers(twins, IMAGE=(layer,))).surface(0.0).displacement[..., 2]
        for layer in layers_of(twins, "IMAGE")
    )
    assert abs(np.corrcoef(first.ravel(), second.ravel())[0, 1]) < 0.3
    same = sea(ImageLayer(wind_speed=7.0, seed=5), seed=99)
    again = sea(ImageLayer(wind_speed=7.0, seed=5, id=4), seed=1)
    np.testing.assert_array_equal(*(Ocean(p).surface(0.0).displacement for p in (same, again)))


def test_json_holds_the_image() -> None:
    parameters = sea(ImageLayer(image=Raster(drawing(9, 7), "ring.png"), filter="FRACTAL"))
    assert OceanParameters.from_json(parameters.to_json()) == parameters
    assert parameters.to_dict(brief=True)["layers"][1]["image"]["name"] == "ring.png"
    with pytest.raises(ParameterError, match=r"layers\.1\.filter = 'FRACTAL2'"):
        OceanParameters.from_dict({"pictures": [{"filter": "FRACTAL2"}]})
    with pytest.raises(ParameterError, match=r"layers\.2\.id = 3: is already the id of another"):
        sea(ImageLayer(id=3), ImageLayer(id=3))
    with pytest.raises(ParameterError, match=r"layers\.1\.translation_speed"):
        sea(ImageLayer(animation="TRANSLATION"), loop_duration=10)


def test_statistics_count_images() -> None:
    """Hs of a layer and two images is the root of the sum of squares; the seed's is what the field has."""
    ring = ImageLayer(image=Raster(drawing()), filter="FRACTAL", significant_wave_height=2.0)
    wind = WaveLayer(definition="SEA_STATE", significant_wave_height=1.5, peak_period=4.0)
    noise = ImageLayer(wind_speed=7.0)
    found = Ocean(sea(ring, noise, layers=(wind,))).statistics()
    expected = np.sqrt(2.0**2 + 1.5**2 + (0.02460 * 49) ** 2)
    assert found.significant_wave_height == pytest.approx(expected, rel=2e-3)
    for layer in (ring, replace(ring, animation="TRANSLATION"), replace(noise, animation="DOMINANT_BAND")):
        parameters = sea(layer, layers=(wind,))
        ocean = Ocean(parameters, "double")
        moments = [ocean.surface(t).displacement[..., 2].var() for t in np.arange(40) * 7.0]
        assert np.mean(moments) == pytest.approx(ocean.statistics().seed.m0, rel=0.1)


def test_noise_too_small_for_its_waves_is_told_the_height_of_its_wind() -> None:
    """0.0246 U² (Pierson & Moskowitz 1964), whether the image holds all of its waves or not."""
    found = Ocean(sea(ImageLayer(wind_speed=15.0, noise_resolution=64))).statistics()
    assert found.significant_wave_height == pytest.approx(0.02460 * 15.0**2, rel=2e-3)


def test_periods_are_those_that_a_place_sees() -> None:
    """Waves of 20 m that move at 4 m/s pass every 5 s, whatever gravity would have them do."""
    moving = single_wave(0, 10, 64, animation="TRANSLATION", translation_speed=4.0)
    found = Ocean(sea(moving)).statistics()
    assert found.peak_wavelength == pytest.approx(20.0, rel=0.02)
    assert found.seed.peak_period == pytest.approx(5.0)
    assert found.seed.zero_crossing_period == pytest.approx(5.0)
    assert found.seed.mean_direction == pytest.approx(0.0)
    still = Ocean(sea(replace(moving, translation_speed=0.0))).statistics()
    assert still.to_dict()["seed"]["peak_period"] is None
    assert still.warnings == ()


def test_memory_while_an_image_is_filtered_is_told_beside_other_layers() -> None:
    wind, image = WaveLayer(wind_speed=8.0), ImageLayer(wind_speed=7.0, noise_resolution=256)
    beside, alone = (memory_need(sea(image, layers=(layer,))).building for layer in (wind, FLAT))
    assert beside == alone > memory_need(sea(layers=(wind,))).building


def test_warnings_do_not_misfire() -> None:
    """An image has its height in every seed and patch; noise with the wind's height does not."""
    image = ImageLayer(image=Raster(drawing(32, 32)), filter="FRACTAL")
    assert Ocean(sea(image)).statistics().warnings == ()
    (warning,) = Ocean(sea(ImageLayer(wind_speed=15.0, noise_resolution=64))).statistics().warnings
    assert "holds only 0.93 of the longest waves (216 m)" in warning
    (warning,) = Ocean(sea()).statistics().warnings
    assert "flat" in warning


def test_beside_an_image_it_is_the_waves_of_the_wind_that_a_domain_is_too_small_for() -> None:
    """As the same sea without the image tells it in another test."""
    layers = (WaveLayer(), ImageLayer(image=Raster(drawing(32, 32)), filter="FRACTAL"))
    windy = OceanParameters(resolution=256, domain_size=200.0, layers=layers)
    (warning,) = Ocean(windy).statistics().warnings
    assert "holds only 2.2 of the longest waves (89.7 m)" in warning
    smooth = ImageLayer(image=Raster(np.tile(np.sin(np.arange(64) * np.pi / 32), (64, 1))), wind_speed=0.5)
    warnings = Ocean(sea(smooth)).statistics().warnings
    assert any("Image 0: its filter leaves nothing" in warning for warning in warnings)


def test_loop_speeds_are_told() -> None:
    layer = ImageLayer(filter="FRACTAL", animation="DOMINANT_BAND", dominant_rate=1.0, surrounding_rate=1.0)
    found = Ocean(sea(layer, loop_duration=8)).statistics()
    assert found.loop_speed_change == pytest.approx(1 - np.pi / 4)  # one turn in 8 s


def test_foam_follows_the_strains_of_images() -> None:
    """Noise through the physical filter is a wind sea: its foam covers what that wind's should."""
    parameters = sea(ImageLayer(wind_speed=14.0), domain_size=600.0)
    foam = Ocean(parameters).surface(20.0, ("foam",)).foam
    assert 0.0 < np.mean(foam > 0.5) < 0.2
    assert np.all(Ocean(sea(ImageLayer(filter="FRACTAL"))).surface(3.0, ("foam",)).foam == 0.0)


def test_finest_waves_become_roughness() -> None:
    """What a coarse grid leaves out, a fine one has as slopes."""
    noise = ImageLayer(wind_speed=7.0, noise_resolution=256)
    coarse, fine = sea(noise), sea(noise, resolution=256)
    slopes = Ocean(fine, "double").surface(0.0, ("slope",)).slope
    assert unresolved_slope_variance(fine) == pytest.approx(0.0, abs=1e-9)
    total = total_slope_variance(fine)
    assert np.mean(np.sum(slopes**2, axis=-1)) == pytest.approx(total, rel=0.1)
    resolved = Ocean(coarse).statistics().resolved.mean_square_slope
    assert unresolved_slope_variance(coarse) == pytest.approx(total - resolved, rel=1e-6)


def test_a_shot_keeps_its_images() -> None:
    """What is animated moves, the image stays as it is: the same object, not its numbers read anew."""
    parameters = sea(ImageLayer(image=Raster(drawing()), filter="FRACTAL"), layers=(WaveLayer(),))
    shot = Shot(parameters, Animation(1, (("layers.0.amplitude_scale", (0.0, 1.0)),)))
    moved = shot.at(2).parameters
    assert moved.layers[0].amplitude_scale == 1.0
    assert layers_of(moved, "IMAGE")[0].image is layers_of(parameters, "IMAGE")[0].image
    with pytest.raises(ParameterError, match=r"pictures\.0\.gain.*an image keeps its waves"):
        Animation(1, (("pictures.0.gain", (0.0, 1.0)),))


def test_an_image_of_two_samples_holds_no_waves_and_says_so() -> None:
    image = Raster(np.array([[0.0, 1.0], [2.0, 5.0]]))
    told = Ocean(sea(ImageLayer(filter="FRACTAL", image=image))).statistics()
    assert told.spectrum.m0 == 0.0
    assert "Image 0: its filter leaves nothing of it" in told.warnings[0]
