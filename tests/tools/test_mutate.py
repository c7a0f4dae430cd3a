# SPDX-License-Identifier: GPL-3.0-or-later
"""How a constant is found in a source and changed there."""

from __future__ import annotations

import pytest

from tools import mutate
from tools.project import ToolError

SOURCE = '''"""α, a module."""
FIRST = 9.81  # m/s²
SECOND = -2.5; ω = 4.0

def function():
    inner = 3.0
    return inner
'''


def test_every_number_at_the_top_is_found() -> None:
    found = mutate.constants(SOURCE)
    assert [(constant.name, constant.value) for constant in found] == [
        ("FIRST", 9.81),
        ("SECOND", -2.5),
        ("ω", 4.0),
    ]


@pytest.mark.parametrize(
    ("index", "before", "after"),
    [
        (0, "FIRST = 9.81  #", "FIRST = 10.0062  #"),
        (1, "= -2.5;", "= -2.55;"),
        (2, "ω = 4.0\n", "ω = 4.08\n"),
    ],
)
def test_only_the_one_number_changes(index: int, before: str, after: str) -> None:
    constant = mutate.constants(SOURCE)[index]
    assert mutate.changed(SOURCE, constant) == SOURCE.replace(before, after)


def test_what_is_no_number_on_one_line_is_refused() -> None:
    with pytest.raises(ToolError, match="line 2"):
        mutate.constants("\nA = (1.0,\n2.0)\n")


def test_unknown_names_are_refused(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as end:
        mutate.main(["GRAVITIY"])
    assert end.value.code == 2
    assert "GRAVITIY" in capsys.readouterr().err
