# SPDX-License-Identifier: GPL-3.0-or-later
"""What docs/python.md documents has examples, and they give what they say."""

from __future__ import annotations

import doctest
import importlib
import inspect
import re
from pathlib import Path

import pytest

PAGE = Path(__file__).resolve().parents[2] / "docs" / "python.md"
#: the name of each entry, and the members that it shows
ENTRIES = re.findall(
    r"^::: (\S+)\n(?:    options:\n(?: {6}.*\n)*? {6}members: (.*)\n)?", PAGE.read_text(), re.M
)


def object_of(name: str) -> object:
    """What a dotted name leads to: a module, or something in one."""
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError:
        module, _, last = name.rpartition(".")
        return getattr(object_of(module), last)


def documented() -> dict[str, object]:
    found = {}
    for name, members in ENTRIES:
        thing = object_of(name)
        if not inspect.ismodule(thing):
            found[name] = thing
        for member in re.findall(r"\w+", "" if members == "false" else members):
            found[f"{name}.{member}"] = inspect.getattr_static(thing, member)
    return found


DOCUMENTED = documented()


def test_the_page_holds_what_the_core_offers() -> None:
    core = importlib.import_module("ocean_tweak.core")
    assert {f"ocean_tweak.core.{name}" for name in core.__all__} - set(DOCUMENTED) == set()
    names = [name for name, _ in ENTRIES]
    assert sorted(set(names)) == sorted(names)


@pytest.mark.parametrize("name", DOCUMENTED)
def test_examples_run(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    thing = DOCUMENTED[name]
    owner = inspect.unwrap(getattr(thing, "fget", None) or getattr(thing, "__func__", thing))
    module = importlib.import_module(owner.__module__)
    tests = doctest.DocTestFinder(recurse=False).find(owner, name, module=False, globs=dict(vars(module)))
    examples = [example for test in tests for example in test.examples]
    assert examples, f"{name} has no example"
    runner = doctest.DocTestRunner(verbose=False)
    told: list[str] = []
    for test in tests:
        runner.run(test, out=told.append)
    assert runner.failures == 0, "".join(told)
