# SPDX-License-Identifier: GPL-3.0-or-later
"""docs/scripting.md: its examples run one after another, as a reader would paste them."""

import re
from pathlib import Path

from tests.blender_fixtures import INSTALLED, ROOT

EXAMPLES = re.findall(
    r"^```python\n(.*?)^```", (ROOT / "docs" / "scripting.md").read_text("utf-8"), re.M | re.S
)


def test_examples_run(empty_scene, package, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("OCEAN_TWEAK_CACHE", raising=False)
    names = {}
    for number, example in enumerate(EXAMPLES, start=1):
        # a checkout is an extension of another repository
        exec(compile(example.replace(INSTALLED, package), f"example {number}", "exec"), names)
    assert len(EXAMPLES) == 9
    # Blender lets anything be set on a group of properties: what the page sets must be one
    set_there = re.findall(r"^(sea|wind|swell)\.(\w+) = ", "".join(EXAMPLES), re.M)
    assert len(set_there) > 8
    assert [key for name, key in set_there if key not in names[name].bl_rna.properties] == []
    assert names["facts"]["spectrum"]["significant_wave_height"] > 1.5
    assert len(list(Path("cache").glob("Ocean*/v001-*/*_disp.*.exr"))) == 3
    assert names["surface"].displacement.shape == (128, 128, 3)
