# SPDX-License-Identifier: GPL-3.0-or-later
"""The pages about the papers: their tables are those of today's code, their pictures are there and small."""

from __future__ import annotations

import re

import pytest

from tools.papers import pages
from tools.papers.__main__ import TABLES, frame_times

MEASURED = "frame-times"


@pytest.mark.parametrize(
    ("name", "table"), [(name, table) for name, tables in TABLES.items() for table in tables]
)
def test_tables_are_those_of_today(name: str, table: str) -> None:
    written = pages.marked(pages.page(name).read_text(encoding="utf-8"))
    made = pages.markdown(TABLES[name][table]())
    assert list(pages.differences(written[table], made)) == [], "run make papers"


@pytest.mark.parametrize("name", TABLES)
def test_pages_hold_their_tables_and_pictures(name: str) -> None:
    text = pages.page(name).read_text(encoding="utf-8")
    assert set(pages.marked(text)) - {MEASURED} == set(TABLES[name])
    shown = set(re.findall(r"!\[[^\]]+\]\(([^)]+)\)", text))
    there = {f"{name}/{path.name}" for path in (pages.PAGES / name).iterdir()}
    assert shown == there
    links = [link for link in re.findall(r"(?<!!)\[[^\]]+\]\(([^)#]+)[^)]*\)", text) if "://" not in link]
    assert [link for link in links if not (pages.PAGES / link).resolve().exists()] == []


def test_pictures_are_small() -> None:
    sizes = [path.stat().st_size for path in pages.PAGES.glob("*/*.*")]
    assert max(sizes) < 200_000
    assert sum(sizes) < 3_000_000


def test_differences_are_found() -> None:
    table = pages.markdown([["a", "b"], ["wave of 1.50 m", "2e-3"]])
    assert list(pages.differences(table, table)) == []
    assert list(pages.differences(table, table.replace("1.50", "1.51"))) == []  # one of the last digit
    assert list(pages.differences(table, table.replace("1.50", "1.52"))) == ["1.50 is 1.52 today"]
    assert list(pages.differences(table, table.replace("1.50", "-1.50"))) == ["1.50 is -1.50 today"]
    assert list(pages.differences(table, table.replace("2e-3", "4e-3"))) == ["2e-3 is 4e-3 today"]
    assert len(list(pages.differences(table, table.replace("wave", "waves")))) == 1


def test_only_given_tables_are_renewed() -> None:
    text = "x\n<!-- table one: written by `make papers` -->\nold\n<!-- end of table -->\ny"
    assert pages.updated(text, {}) == text
    renewed = pages.updated(text, {"one": lambda: [["head"], ["cell"]]})
    assert pages.marked(renewed)["one"] == "\n| head |\n|---|\n| cell |\n\n"
    assert pages.updated(renewed, {"one": lambda: [["head"], ["cell"]]}) == renewed


def test_frame_times_are_told_both_ways() -> None:
    assert frame_times({"128": 20.0, "256": 50.0})[1][-1] == "20 ms, 50 frames/s"
