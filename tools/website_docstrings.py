# SPDX-License-Identifier: GPL-3.0-or-later
"""Docstrings as the site's reference lists them: lines `name : what it is` become a section of parameters."""

from __future__ import annotations

import re
from typing import Any

from griffe import Class, Extension, Object

#: a first line `name : text` or `name, other : text`, and the lines that go on, which are indented
_ENTRY = re.compile(r"^(\*{0,2}[a-z_]\w*(?:, [a-z_]\w*)*) : (.*(?:\n[ ]+\S.*)*)$", re.MULTILINE)
_EXAMPLES = "Examples\n--------"
#: entries that follow each other
_LIST = re.compile(rf"(?:{_ENTRY.pattern}\n?)+", re.MULTILINE)


class ParametersExtension(Extension):
    """What griffe calls for each object that it has read."""

    def on_object(self, *, obj: Object, **_others: Any) -> None:
        """Rewrite the object's docstring, where it has one."""
        if obj.docstring is not None:
            obj.docstring.value = listed(
                obj.docstring.value, "Attributes" if isinstance(obj, Class) else "Parameters"
            )


def listed(docstring: str, title: str) -> str:
    """A docstring with its entries in one section of NumPy's style, after the text and before examples."""
    found = _LIST.search(docstring)
    if found is None:
        return docstring
    text, head, examples = (docstring[: found.start()] + docstring[found.end() :]).partition(_EXAMPLES)
    entries = [f"{name}\n    {_joined(told)}" for name, told in _entries(found[0])]
    section = "\n".join([title, "-" * len(title), *entries])
    return f"{text.rstrip()}\n\n{section}\n\n{head}{examples}"


def _entries(block: str) -> list[tuple[str, str]]:
    return [(match[1], match[2]) for match in _ENTRY.finditer(block)]


def _joined(text: str) -> str:
    return " ".join(line.strip() for line in text.splitlines())
