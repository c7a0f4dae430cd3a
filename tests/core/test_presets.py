# SPDX-License-Identifier: GPL-3.0-or-later
"""Presets: the seas of the published table, as data that nothing executes."""

from __future__ import annotations

import dataclasses
import json
import random
from fractions import Fraction
from pathlib import Path

import pytest

from ocean_tweak.core import Ocean, OceanParameters, ParameterError, Timing
from ocean_tweak.core.parameters.presets import Preset, built_in

from ..reference import rows

#: keys of presets and their rows in the table
TABLE = {
    "open_sea": "default", "shallow_storm": "shallow storm", "wind_chop": "chop to swell", "gale": "gale",
    "hurricane": "hurricane", **{f"beaufort_{n:02d}": f"Beaufort {n}" for n in range(2, 12)},
}  # fmt: skip
#: from the models' formulas, by hand: 2.5 m and 0.59 m, 2 m and 2.14 m, 2.16 m and 1.2 m, in energy
OTHERS = {"beaufort_01": (0.03, 0.7), "harbour": (0.17, 1.4), "long_swell": (2.57, 14.0),
          "crossing_seas": (2.93, 11.0), "drawn_out_swell": (5.65, 10.3), "horizon": (2.47, 6.4)}  # fmt: skip


@pytest.mark.parametrize("key", TABLE)
def test_presets_are_the_tables_seas(key: str) -> None:
    row = next(row for row in rows("reference_seas.csv") if row["name"] == TABLE[key])
    statistics = Ocean(built_in()[key].parameters.replace(resolution=128)).statistics()
    assert statistics.spectrum.significant_wave_height == pytest.approx(float(row["Hs"]), rel=0.03, abs=0.006)
    assert statistics.spectrum.peak_period == pytest.approx(float(row["Tp"]), abs=0.06)
    assert built_in()[key].parameters.domain_size == float(row["domain_size"])


@pytest.mark.parametrize("key", OTHERS)
def test_the_other_presets(key: str) -> None:
    statistics = Ocean(built_in()[key].parameters.replace(resolution=128)).statistics()
    height, period = OTHERS[key]
    assert statistics.spectrum.significant_wave_height == pytest.approx(height, abs=0.006)
    assert statistics.spectrum.peak_period == pytest.approx(period, abs=0.06)


def test_every_preset_is_tested_and_warns_of_nothing() -> None:
    assert set(built_in()) == {*TABLE, *OTHERS}
    assert len(built_in()) >= 18
    for key, preset in built_in().items():
        small = (
            preset.parameters
            if preset.parameters.resolution < 1024
            else preset.parameters.replace(resolution=512)
        )
        statistics = Ocean(small).statistics()
        assert not statistics.warnings, (key, statistics.warnings)
        assert statistics.wavelengths_per_domain > 3.5


def test_json_both_ways() -> None:
    for preset in built_in().values():
        assert Preset.from_json(preset.to_json()) == preset


def test_a_shot_keeps_its_timing() -> None:
    shot = OceanParameters(timing=Timing(fps=Fraction(30000, 1001), start_frame=1001), seed=4)
    taken = built_in()["gale"].for_shot(shot)
    assert taken.timing == shot.timing
    assert dataclasses.replace(taken, timing=Timing()) == built_in()["gale"].parameters


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("{", "not valid JSON"),
        ("[]", "must be an object"),
        ('{"title": "a", "description": "", "parameters": {}, "script": "x"}', "title, description and"),
        ('{"title": "a", "description": "", "parameters": {"windspeed": 3}}', "parameters.windspeed"),
        ('{"title": "a", "description": "", "parameters": {"seed": -1}}', "parameters.seed = -1"),
        ('{"title": " ", "description": "", "parameters": {}}', "empty"),
        ('{"title": "a\\nb", "description": "", "parameters": {}}', "a line of at most 60"),
        ('{"title": 3, "description": "", "parameters": {}}', "a line of at most 60"),
        (f'{{"title": "{"x" * 61}", "description": "", "parameters": {{}}}}', "at most 60"),
        (" " * 200_001, "larger than 200 kB"),
    ],
)  # fmt: skip
def test_what_is_no_preset_is_refused(text: str, said: str) -> None:
    with pytest.raises(ParameterError) as raised:
        Preset.from_json(text)
    assert said in str(raised.value)


def test_300_mutated_presets_are_read_or_refused() -> None:
    chance = random.Random(5)
    texts = [preset.to_json() for preset in built_in().values()]
    tokens = [
        '"',
        "{",
        "}",
        "[",
        "1e999",
        "-1",
        "null",
        "NaN",
        "true",
        "__import__",
        "\\u0000",
        "é",
        "0",
        ",",
    ]
    outcomes = {"read": 0, "refused": 0}
    for _ in range(300):
        text = list(chance.choice(texts))
        for _ in range(chance.randint(1, 2)):
            place = chance.randrange(len(text))
            # half of them change a digit only, so that some are still seas
            if chance.random() < 0.5:
                text = ["7" if letter == "2" and chance.random() < 0.3 else letter for letter in text]
            else:
                text[place : place + chance.randint(0, 6)] = chance.choice(tokens)
        try:
            preset = Preset.from_json("".join(text))
        except ParameterError:
            outcomes["refused"] += 1
        else:
            outcomes["read"] += 1
            assert Preset.from_json(preset.to_json()) == preset
            assert json.loads(preset.to_json())["title"] == preset.title
    assert min(outcomes.values()) > 10, outcomes


def test_the_example_to_the_horizon_is_the_preset() -> None:
    """One press in Blender and the example on the command line make one sea."""
    text = (Path(__file__).parents[2] / "examples" / "horizon.json").read_text(encoding="utf-8")
    example = OceanParameters.from_json(text)
    assert built_in()["horizon"].for_shot(example) == example
