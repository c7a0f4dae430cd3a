# SPDX-License-Identifier: GPL-3.0-or-later
"""Python on pages runs as it is printed; that of docs/scripting.md, which wants Blender, has a test there."""

import json
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGES = [
    page for page in (ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))) if page.stem != "scripting"
]
EXAMPLES = [
    pytest.param(code, id=f"{page.stem}-{number}")
    for page in PAGES
    for number, code in enumerate(re.findall(r"^```python\n(.*?)^```", page.read_text("utf-8"), re.M | re.S))
]


def test_there_are_examples() -> None:
    assert len(EXAMPLES) >= 4


@pytest.mark.parametrize("code", EXAMPLES)
def test_an_example_runs(code: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """With the seas of examples/ on fewer samples."""
    (tmp_path / "examples").mkdir()
    for file in (ROOT / "examples").glob("*.json"):
        told = json.loads(file.read_text("utf-8"))
        for grid in (told, *told.get("patches", ())):
            if "resolution" in grid:
                grid["resolution"] = 64
        (tmp_path / "examples" / file.name).write_text(json.dumps(told), "utf-8")
    monkeypatch.chdir(tmp_path)  # from where a reader of a clone starts
    exec(compile(code, "page", "exec"), {})
