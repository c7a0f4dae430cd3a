# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables inside pages of text: found by their marks, made anew, and compared number by number."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path

from ..project import ROOT

PAGES = ROOT / "docs" / "papers"

#: cells of a table, the head first; numbers are text already, with as many digits as they are worth
Table = Sequence[Sequence[str]]
Tables = Mapping[str, Callable[[], Table]]

_MARKED = re.compile(
    r"(<!-- table (\S+): written by `make papers` -->\n)(.*?)(<!-- end of table -->)", re.DOTALL
)
_NUMBER = re.compile(r"[-−]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def updated(text: str, tables: Tables) -> str:
    """The page with the given tables made anew between their marks; other marked ones stay."""

    def anew(found: re.Match[str]) -> str:
        before, name, old, after = found.groups()
        return before + (markdown(tables[name]()) if name in tables else old) + after

    return _MARKED.sub(anew, text)


def marked(text: str) -> dict[str, str]:
    """The tables that stand in a page, by name."""
    return {found[2]: found[3] for found in _MARKED.finditer(text)}


def markdown(table: Table) -> str:
    """A table as Markdown, with blank lines around it."""
    head, *rows = ("| " + " | ".join(row) + " |" for row in table)
    return "\n".join(["", head, "|" + "---|" * len(table[0]), *rows, "", ""])


def differences(written: str, made: str) -> Iterator[str]:
    """Where two tables differ: in their words, or in numbers by more than one of the last digit."""
    if _NUMBER.sub("#", written) != _NUMBER.sub("#", made):
        yield f"{written!r} has other words than {made!r}"
        return
    for old, new in zip(_NUMBER.findall(written), _NUMBER.findall(made), strict=True):
        last_digit = max(_last_digit(old), _last_digit(new))
        if abs(_value(old) - _value(new)) > 1.001 * last_digit:
            yield f"{old} is {new} today"


def _value(text: str) -> float:
    return float(text.replace("−", "-"))


def _last_digit(text: str) -> float:
    """What one more in the last digit adds."""
    mantissa, _, exponent = text.partition("e")
    decimals = len(mantissa.partition(".")[2])
    return 10.0 ** (int(exponent or 0) - decimals)


def page(name: str) -> Path:
    """The page of a paper."""
    return PAGES / f"{name}.md"
