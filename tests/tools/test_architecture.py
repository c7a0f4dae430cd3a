# SPDX-License-Identifier: GPL-3.0-or-later
"""The picture of the house is that of its imports, and the document beside it tells of every room."""

from __future__ import annotations

import re

import pytest

from tools import architecture
from tools.project import ROOT, ToolError

DOCUMENT = ROOT / "docs" / "architecture.md"


def test_the_picture_is_that_of_the_imports() -> None:
    drawn = architecture.picture(*architecture.house())
    assert architecture.PICTURE.read_text(encoding="utf-8") == drawn, "make docs"


def test_rooms_stand_above_what_they_use_and_detours_are_left_out() -> None:
    house = {name: frozenset(below) for name, below in {"a": "bc", "b": "c", "c": "", "d": "c"}.items()}
    assert architecture.floors(house) == {"c": 0, "b": 1, "d": 1, "a": 2}
    assert architecture.without_detours(house) == {"a": {"b"}, "b": {"c"}, "c": set(), "d": {"c"}}


def test_rooms_that_use_each_other_are_told() -> None:
    house = {"a": frozenset("b"), "b": frozenset("a"), "c": frozenset()}
    with pytest.raises(ToolError, match="import each other: a, b"):
        architecture.floors(house)


def test_all_that_the_document_names_is_there() -> None:
    text = DOCUMENT.read_text(encoding="utf-8")
    assert len(text.splitlines()) < 150
    paths = re.findall(r"`((?:core|export|nodes|scene|ui|cli|tools|tests)/[\w/.]+)`", text)
    assert len(paths) > 30
    roots = (ROOT / "ocean_tweak", ROOT)
    missing = [
        path
        for path in paths
        if not any((root / path).exists() or (root / path).with_suffix(".py").exists() for root in roots)
    ]
    assert missing == []
    rooms = {room.partition(".")[2] for room in architecture.house()[0] if room.startswith("core.")}
    assert {room for room in rooms if f"`core/{room}`" not in text} == set()
