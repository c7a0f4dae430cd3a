# SPDX-License-Identifier: GPL-3.0-or-later
"""Which functions of a package nothing in it uses."""

from __future__ import annotations

from pathlib import Path

import pytest

from tools import unused

PACKAGE = {
    "__init__.py": "from .shapes import Box\n",
    "shapes.py": """
from . import lengths
from .lengths import metre as unit

class Box:
    def side(self): return lengths.double(unit())
    def _hidden(self): return 1
    def poll(self): return True
    @property
    def area(self): return self.side() ** 2

class Ball: ...
""",
    "lengths.py": """
def metre(): return 1.0
def double(x): return 2.0 * x
def triple(x): return 3.0 * triple(x)
def side(): return 0.0
TABLE = {"by name": lambda: half}
def half(x): return 0.5 * x
""",
    "inner/__init__.py": "",
    "inner/use.py": "from .. import Box\n\ndef run(): return getattr(Box(), 'area')\n",
    "inner/go.py": "def later():\n    from .use import run\n    return run\n",
}


@pytest.fixture
def modules(tmp_path: Path) -> dict:
    for name, text in PACKAGE.items():
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)
    return unused.read_package(tmp_path)


def test_what_nothing_uses_is_found(modules: dict) -> None:
    assert sorted(unused.unused_names(modules)) == [
        "inner.go.later",  # nothing asks for it
        "lengths.side",  # a method of that name is another thing
        "lengths.triple",  # it calls itself only
        "shapes.Ball",
        "shapes.Box._hidden",
    ]


def test_a_listed_name_must_be_unused(
    modules: dict, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(unused, "read_package", lambda _folder: modules)
    found = dict.fromkeys(unused.unused_names(modules), "a reason")
    monkeypatch.setattr(unused, "PUBLIC", found)
    assert unused.main() == 0
    monkeypatch.setattr(unused, "PUBLIC", {**found, "lengths.metre": "it is used"})
    assert unused.main() == 1
    assert "lengths.metre: is listed" in capsys.readouterr().out
    monkeypatch.setattr(unused, "PUBLIC", {})
    assert unused.main() == 1
    assert "lengths.triple: nothing in ocean_tweak uses it" in capsys.readouterr().out


def test_every_reason_is_one() -> None:
    assert all(len(reason) > 15 for reason in unused.PUBLIC.values())
