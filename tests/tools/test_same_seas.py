# SPDX-License-Identifier: GPL-3.0-or-later
import json

import numpy as np
import pytest

from tools.project import ROOT, ToolError
from tools.same_seas import __main__ as comparing
from tools.same_seas import made


@pytest.fixture(scope="module")
def sea():
    return json.loads(comparing.SEAS.read_text(encoding="utf-8"))["masks by distance"]


def test_a_copy_with_another_constant_makes_another_sea(tmp_path, sea):
    comparing.unpack("HEAD", tmp_path)
    (constants,) = (tmp_path / "ocean_tweak/core").rglob("constants.py")
    before = constants.read_text()
    constants.write_text(before.replace("0.076", "0.0760001"))
    assert constants.read_text() != before
    now = comparing.imported("tests_ocean_tweak", ROOT / "ocean_tweak")
    other = comparing.imported("tests_changed_ocean_tweak", tmp_path / "ocean_tweak")
    pairs = list(zip(made.of_sea(now, sea), made.of_sea(other, sea), strict=True))
    found = [text for one, two in pairs if (text := made.difference(one[0], one[1], two[1]))]
    assert any(text.startswith("double displacement at 13/4 s by up to ") for text in found)
    assert any(text.startswith("statistics: ") for text in found)
    again = list(made.of_sea(now, sea))
    assert [made.difference(one[0], one[1], two[1]) for (one, _), two in zip(pairs, again, strict=True)] == [
        ""
    ] * len(pairs)


@pytest.mark.parametrize(
    ("before", "after", "said"),
    [
        (np.zeros(3), np.array([0.0, -0.0, 0.0]), "x by up to 0"),  # the sign of a zero is a bit too
        (np.zeros(3), np.zeros(3, np.float32), "x is float32 (3,), was float64 (3,)"),
        (np.array([np.nan]), np.array([np.nan]), ""),
        ({"a": 1.0}, {"a": 1.5}, "x: …\"{'a': 1.0}\" is …\"{'a': 1.5}\" now"),
        (None, 1, "x is new"),
        (1, None, "x is gone"),
    ],
)
def test_differences_are_told(before, after, said):
    assert made.difference("x", before, after) == said


def test_a_commit_that_is_not_there_is_told(tmp_path):
    with pytest.raises(ToolError, match="git archive no-such-commit"):
        comparing.unpack("no-such-commit", tmp_path)


def test_each_kind_of_sea_is_among_them():
    seas = json.loads(comparing.SEAS.read_text(encoding="utf-8")).values()
    for key in (
        "pictures",
        "wind_fields",
        "hero_waves",
        "patches",
        "joined",  # as those files have it
        "loop_duration",
        "match_height",
    ):
        assert any(sea.get(key) for sea in seas), key
