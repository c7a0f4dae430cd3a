# SPDX-License-Identifier: GPL-3.0-or-later
"""Words of strangers, such as keys and names out of files, as a message may repeat them; numbers in words."""

from __future__ import annotations

import reprlib

import numpy as np

#: characters of a whole message
LONGEST = 4000


def printable(text: object, most: int = 80) -> str:
    """The text in one line of at most so many characters, with an escape for each that is no print.

    Control characters would move a terminal's cursor or colour it, and others turn the direction of writing.
    """
    whole = str(text)
    # what is far too long is not looked at whole
    shown = "".join(
        letter if letter.isprintable() else letter.encode("unicode_escape").decode("ascii")
        for letter in whole[: most + 1]
    )
    return shown if len(shown) <= most else shown[: most - 3] + "..."


def shown(value: object) -> str:
    """A value as Python writes it, in one line of at most 80 characters."""
    return printable(_WRITER.repr(value))


class _Writer(reprlib.Repr):
    """Writes values as Python does, but of many entries only some: what a file gives may be huge or deep."""

    def __init__(self) -> None:
        super().__init__()
        self.maxtuple = self.maxlist = self.maxdict = self.maxset = 40
        self.maxstring = self.maxlong = self.maxother = 200

    def repr_int(self, x: int, level: int) -> str:
        """Digits by the thousand are not written at all: Python refuses to."""
        return super().repr_int(x, level) if x.bit_length() < 10_000 else f"({x.bit_length()} bits)"


_WRITER = _Writer()


def readable_bytes(size: float) -> str:
    """The size as an artist reads it: `1.5 GB`."""
    for unit in ("bytes", "kB", "MB", "GB"):
        if size < 1000.0 or unit == "GB":
            return f"{size:.0f} {unit}" if unit == "bytes" else f"{size:.3g} {unit}"
        size /= 1000.0
    raise AssertionError


def without_exponent(number: float) -> str:
    """A number as the command line takes it: it would take -1e-05 for an option."""
    return np.format_float_positional(number, trim="-")
