# SPDX-License-Identifier: GPL-3.0-or-later
"""Layers of waves from a wind field as parameters: JSON both ways, what is refused, what stays as it was."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from ocean_tweak.core import OceanParameters, ParameterError, Raster, WindFieldLayer, WindKey
from ocean_tweak.core.parameters.fingerprint import frame_fingerprint
from ocean_tweak.core.parameters.shot import Animation, Shot
from ocean_tweak.core.waves.wind_field.presets import wind_field
from tests.layers import layers_of, with_layers

CALM = np.zeros((1, 1, 2))


def sea(**layer: Any) -> OceanParameters:
    return with_layers(OceanParameters(), WIND_FIELD=(WindFieldLayer(**layer),))


def test_a_keyed_wind_survives_json() -> None:
    winds = np.random.default_rng(3).normal(0.0, 5.0, (3, 4, 2))
    parameters = sea(keys=(WindKey(0.0, Raster(winds)), WindKey(2.5, Raster(CALM))), crest="PARALLEL")
    back = OceanParameters.from_json(parameters.to_json())
    assert back == parameters
    assert layers_of(back, "WIND_FIELD")[0].id == 0
    np.testing.assert_array_equal(
        layers_of(back, "WIND_FIELD")[0].rasters[0].values, winds.astype(np.float32)
    )
    written = OceanParameters.from_dict({"wind_fields": [{"keys": [{"vectors": {"values": [[[3, 4]]]}}]}]})
    assert layers_of(written, "WIND_FIELD")[0].greatest_speed == 5.0
    brief = parameters.to_dict(brief=True)["layers"][1]["keys"][0]["vectors"]
    assert set(brief) == {"name", "shape", "sha256"}


def test_fields_of_the_start_have_the_winds_of_their_figure() -> None:
    """Winds whose waves, of V²/g, are a 24th of the patch: 12.8 m/s on 400 m, in two digits."""
    assert wind_field("UNIFORM", 400.0, 9.81).wind_speed == 13.0
    varying = wind_field("VARYING_SPEED", 400.0, 9.81).rasters[0].values
    assert float(varying[0, 0, 0]) == pytest.approx(0.4 * 13.0)
    assert float(varying[-1, 0, 0]) == pytest.approx(1.4 * 13.0)
    assert not np.any(varying[..., 1])
    halves = wind_field("OPPOSED_HALVES", 400.0, 9.81).rasters[0].values
    assert float(halves[0, 0, 0]) == -13.0
    assert float(halves[0, -1, 0]) == 13.0


def test_a_sea_without_wind_fields_is_written_as_before_there_were_any() -> None:
    assert "wind_fields" not in OceanParameters().to_dict()
    assert OceanParameters.from_dict({"wind_fields": []}) == OceanParameters()
    muted = with_layers(OceanParameters(), WIND_FIELD=(WindFieldLayer(muted=True),))
    assert muted.to_dict()["layers"][1]["muted"] is True
    assert not muted.active(WindFieldLayer)


@pytest.mark.parametrize(
    ("layer", "where", "reason"),
    [
        ({"keys": [{"time": 0.0}]}, "layers.1.keys.0.vectors", "must be a Raster"),
        ({"keys": [{"vectors": {"values": [[1.0]]}}]}, "layers.1.keys.0.vectors", "must have 2"),
        ({"keys": [{"vectors": {"values": [[[1.0, float("nan")]]]}}]}, "layers.1.keys.0.vectors.raster",
         "row 0, column 0"),
        ({"keys": [{"vectors": {"values": [[[1, 0]]]}}] * 2}, "layers.1.keys.1.time", "later than the key"),
        ({"keys": [{"vectors": {"values": [[[1e30, 0]]]}}]}, "layers.1", "at most 62.64 m/s"),
        ({"wind_speed": 63.0}, "layers.1", "waves of this wind are 404"),
        ({"wind_speed": 50.0, "wind_scale": 2.0}, "layers.1", "100 m/s"),
        ({"particles": 0}, "layers.1.particles", "from 1 to 99"),
        ({"crest": "ROUND"}, "layers.1.crest", "ARC, PARALLEL"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused_by_name(layer: dict[str, Any], where: str, reason: str) -> None:
    with pytest.raises(ParameterError) as caught:
        OceanParameters.from_dict({"wind_fields": [layer]})
    assert caught.value.field == where
    assert reason in str(caught.value)


def test_a_loop_is_refused_until_the_layer_is_muted() -> None:
    looped = OceanParameters(loop_duration=Fraction(10))
    with pytest.raises(ParameterError, match="do not repeat: mute it"):
        with_layers(looped, WIND_FIELD=(WindFieldLayer(),))
    with_layers(looped, WIND_FIELD=(WindFieldLayer(muted=True),))


def test_layers_have_ids_of_their_own() -> None:
    twice = with_layers(OceanParameters(), WIND_FIELD=(WindFieldLayer(), WindFieldLayer(id=0)))
    assert [layer.id for layer in layers_of(twice, "WIND_FIELD")] == [1, 0]
    with pytest.raises(ParameterError, match=r"layers\.2\.id"):
        with_layers(OceanParameters(), WIND_FIELD=(WindFieldLayer(id=4), WindFieldLayer(id=4)))


def test_an_animated_shot_keeps_the_wind_and_says_that_it_cannot_be_animated() -> None:
    parameters = sea(keys=(WindKey(0.0, Raster(np.ones((2, 2, 2)))),))
    shot = Shot(parameters, Animation(1, (("choppiness", (0.5, 1.0)),)))
    assert shot.at(1).parameters == parameters.replace(choppiness=0.5)
    assert Shot.from_json(shot.to_json()) == shot
    with pytest.raises(ParameterError, match="keeps the wind it was born with"):
        Animation(1, (("wind_fields.0.strength", (1.0, 2.0)),))


def test_another_wind_is_another_frame() -> None:
    prints = {
        frame_fingerprint(Shot(with_layers(sea(), WIND_FIELD=fields)), 1)
        for fields in (
            (),
            (WindFieldLayer(),),
            (WindFieldLayer(keys=(WindKey(0.0, Raster(CALM)),)),),
            (WindFieldLayer(keys=(WindKey(1.0, Raster(CALM)),)),),
        )
    }
    assert len(prints) == 4
