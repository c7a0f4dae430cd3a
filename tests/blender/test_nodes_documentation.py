# SPDX-License-Identifier: GPL-3.0-or-later
"""docs/nodes.md names what there is."""

import itertools
import re
from pathlib import Path

from .surfaces import CONTRACT

TEXT = (Path(__file__).parents[2] / "docs" / "nodes.md").read_text(encoding="utf-8")


def first_column(after):
    """The names in the first column of the table behind a text."""
    lines = TEXT.partition(after)[2].splitlines()
    start = next(index for index, line in enumerate(lines) if line.startswith("|"))
    rows = itertools.takewhile(lambda line: line.startswith("|"), lines[start + 2 :])
    return [name for row in rows for name in re.findall(r"`([^`]+)`", row.split("|")[1])]


def test_every_input_of_the_group(extension, empty_scene):
    group = extension("nodes.versioned").node_group(extension("nodes.ocean").ocean_group(1))
    inputs = [item.name for item in group.interface.items_tree if getattr(item, "in_out", "") == "INPUT"]
    assert first_column("<!-- inputs:") == inputs


def test_every_input_of_the_camera_surface(extension, empty_scene):
    kind = extension("nodes.camera_surface").CAMERA_SURFACE
    group = extension("nodes.versioned").node_group(kind)
    inputs = [item.name for item in group.interface.items_tree if getattr(item, "in_out", "") == "INPUT"]
    assert first_column("<!-- camera surface:") == inputs


def test_every_attribute():
    assert first_column("in a render.") == list(CONTRACT)
