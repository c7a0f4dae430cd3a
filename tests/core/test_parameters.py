# SPDX-License-Identifier: GPL-3.0-or-later
"""Parameters: what is refused and how it is said, and JSON both ways."""

from __future__ import annotations

import dataclasses
import json
import math
from fractions import Fraction

import numpy as np
import pytest

from ocean_tweak.core import OceanParameters, ParameterError, Timing, Water, WaveLayer
from ocean_tweak.core.data.raster import Raster


def test_json_round_trip_keeps_every_field() -> None:
    parameters = OceanParameters(
        resolution=128,
        domain_size=123.456,
        seed=7,
        choppiness=0.7,
        dispersion="DEEP",
        water=Water(depth=12.5, gravity=3.7, density=1025.0, surface_tension=0.05),
        layers=(
            WaveLayer(wind_speed=0.1 + 0.2, wind_direction=math.pi / 4),
            WaveLayer(swell=1.0, amplitude_scale=0.5),
        ),
        timing=Timing(fps=Fraction(24000, 1001), start_frame=1001),
    )
    again = OceanParameters.from_json(parameters.to_json())
    assert again == parameters
    assert hash(again) == hash(parameters)


def test_missing_keys_keep_their_defaults() -> None:
    parameters = OceanParameters.from_json('{"layers": [{"wind_speed": 20}]}')
    assert parameters == OceanParameters(layers=(WaveLayer(wind_speed=20.0),))


def test_parameters_cannot_be_changed() -> None:
    with pytest.raises(dataclasses.FrozenInstanceError):
        OceanParameters().seed = 3  # type: ignore[misc]


def test_numpy_numbers_are_numbers() -> None:
    parameters = OceanParameters(resolution=np.int64(64), domain_size=np.float32(400.0), seed=np.uint8(3))
    assert json.loads(parameters.to_json())["resolution"] == 64
    assert type(parameters.domain_size) is float


@pytest.mark.parametrize(
    ("data", "field", "said"),
    [
        ({"layers": [{"wind_speed": math.nan}]}, "layers.0.wind_speed", "finite number from 0 to 100 m/s"),
        ({"layers": [{}, {"fetch": math.inf}]}, "layers.1.fetch", "finite"),
        ({"layers": [{"wind_speed": -0.1}]}, "layers.0.wind_speed", "from 0 to 100 m/s"),
        ({"water": {"depth": -5}}, "water.depth", "from 0.1 to 11000 m"),
        ({"water": {"depth": 0}}, "water.depth", "from 0.1 to 11000 m"),
        ({"resolution": 17}, "resolution", "even number"),
        ({"domain_size": 10**400}, "domain_size", "finite"),
        ({"timing": {"fps": "1e999999999"}}, "timing.fps", "from 0.01 to 1000 frames per second"),
        ({"resolution": 14}, "resolution", "from 16 to 8192"),
        ({"resolution": 8194}, "resolution", "from 16 to 8192"),
        ({"resolution": 64.5}, "resolution", "whole number"),
        ({"resolution": True}, "resolution", "whole number"),
        ({"domain_size": "400"}, "domain_size", "must be a number"),
        ({"seed": -1}, "seed", "from 0"),
        ({"dispersion": "deep"}, "dispersion", "CAPILLARY, FINITE_DEPTH, DEEP"),
        ({"layers": [{"spectrum": "SWELL"}]}, "layers.0.spectrum", "TMA"),
        ({"layers": [{"limit_fetch": 1}]}, "layers.0.limit_fetch", "true or false"),
        ({"layers": []}, "layers", "from 1 to 64"),
        ({"layers": {"wind_speed": 3}}, "layers", "sequence of WaveLayer"),
        ({"water": 3}, "water.Water", "JSON object"),
        ({"timing": {"fps": 0}}, "timing.fps", "24000/1001"),
        ({"timing": {"fps": "fast"}}, "timing.fps", "24000/1001"),
        ({"timing": {"fps": "1/0"}}, "timing.fps", "24000/1001"),
        ({"timing": {"start_frame": 1.5}}, "timing.start_frame", "whole number"),
        ({"layers": [{"wind_sped": 3}]}, "layers.0.wind_sped", "did you mean wind_speed?"),
        ({"depth": 3}, "depth", "unknown key"),
    ],
)  # fmt: skip
def test_bad_values_are_refused_by_name(data: dict, field: str, said: str) -> None:
    with pytest.raises(ParameterError) as caught:
        OceanParameters.from_dict(data)
    assert caught.value.field == field
    assert said in str(caught.value)
    assert str(caught.value).startswith(f"{field} = ")
    assert "\n" not in str(caught.value)


def test_what_is_said_of_a_huge_or_strange_value_is_one_short_line() -> None:
    deep: list = []
    for _ in range(500):
        deep = [deep]
    for value in ("x" * 10**6, "\x1b[31m\nred", [[0] * 10**5] * 5, {"a" * 10**5: 1}, deep, 10**4999):
        for data in ({"seed": value}, {"layers": value}, {"x" * 10**5: value}, {"a\n\x1b": value}):
            with pytest.raises(ParameterError) as caught:
                OceanParameters.from_dict(data)
            assert len(str(caught.value)) < 1000
            assert str(caught.value).isprintable()


def test_entries_of_lists_are_counted_before_they_are_made(monkeypatch: pytest.MonkeyPatch) -> None:
    def made(*_: object) -> None:
        raise AssertionError("a layer was made")

    monkeypatch.setattr(WaveLayer, "__post_init__", made)
    with pytest.raises(ParameterError, match="layers = '65 entries': must have from 1 to 64"):
        OceanParameters.from_dict({"layers": [{}] * 65})


def test_rasters_of_a_sea_are_counted_before_they_are_unpacked(monkeypatch: pytest.MonkeyPatch) -> None:
    plain = Raster(np.zeros((10, 10))).to_plain()
    monkeypatch.setattr("ocean_tweak.core.data.raster.MOST_NUMBERS", 350)

    def unpacked(_: object) -> None:
        raise AssertionError("a raster was made")

    with monkeypatch.context() as patched:
        patched.setattr(Raster, "from_plain", unpacked)
        data = {
            "pictures": [{"image": plain, "mask": {"source": "IMAGE", "image": plain}}] * 2,
            "resolution": 32,
        }
        with pytest.raises(ParameterError, match="'400 numbers': must hold at most 350 together"):
            OceanParameters.from_dict(data)
    mask = {"source": "IMAGE", "image": plain}
    assert OceanParameters.from_dict({"resolution": 32, "layers": [{"mask": mask}] * 3}).is_masked


def test_direct_construction_is_validated_too() -> None:
    with pytest.raises(ValueError, match="wind_speed = -1"):
        WaveLayer(wind_speed=-1)
    with pytest.raises(ValueError, match="water"):
        OceanParameters(water=None)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "text", ["", "{", "[]", '{"seed": 1, "seed": 2}', '{"seed": NaN}', "[" * 100_000, "9" * 5000]
)
def test_text_that_is_not_a_sea_is_refused(text: str) -> None:
    with pytest.raises(ParameterError):
        OceanParameters.from_json(text)


def test_frames_become_seconds_exactly() -> None:
    timing = Timing(fps=Fraction(24000, 1001), start_frame=1001)
    assert timing.time(1001) == 0.0
    assert timing.time(1001 + 24000) == 1001.0
    assert timing.time(1001.5) == Fraction(1001, 48000)
    assert Timing(fps=24).time(25) == 1.0  # type: ignore[arg-type]
    assert Timing(fps=Fraction(1, 100)).time(2) == 100
    assert Timing(fps=23.976).fps == Fraction(23976, 1000)  # type: ignore[arg-type]
