# SPDX-License-Identifier: GPL-3.0-or-later
"""Wordings that the lint refuses are found wherever they stand, and nothing like them is."""

import pytest

from tools import words


@pytest.mark.parametrize(
    "text",
    [
        "Waves are told by the distance to it",
        "Let the objects float no more.",
        "| registration | what Blender\nis told |",
        "# on how\n    # many samples",
        '"Noise: number of this "\n        "one among all that are alike"',
        'f"As large as these waves "\n    f"want it"',
    ],
)
def test_a_wording_is_found_across_lines_and_marks(text):
    (hit,) = words.found(f"first line\n{text}")
    assert hit[0] == 2


@pytest.mark.parametrize("text", ["It floats nowhere", "somewhat floats", "told what floating is", "a wish"])
def test_what_only_resembles_one_is_not(text):
    assert list(words.found(text)) == []


def test_the_repository_has_none(capsys):
    assert words.main() == 0, capsys.readouterr().out
