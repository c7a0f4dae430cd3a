# SPDX-License-Identifier: GPL-3.0-or-later
"""Published tables, typed in with their source in the first line."""

from __future__ import annotations

import csv
from pathlib import Path


def rows(name: str) -> list[dict[str, str]]:
    """The rows of a table in this folder."""
    lines = (Path(__file__).parent / name).read_text(encoding="utf-8").splitlines()
    assert lines[0].startswith("#"), "a reference table names its source"
    return list(csv.DictReader(lines[1:]))
