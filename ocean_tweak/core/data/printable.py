# SPDX-License-Identifier: GPL-3.0-or-later
"""Text from files, such as keys and names, made safe to repeat in messages; numbers formatted for reading."""

from __future__ import annotations

import reprlib

import numpy as np

#: maximum length of a message, in characters
LONGEST = 4000


def printable(text: object, most: int = 80) -> str:
    """The text on one line of at most `most` characters, with non-printable characters escaped.

    Control characters could move a terminal's cursor or change its colours, and others reverse the writing
    direction.
    """
    whole = str(text)
    # do not process all of a text that is far too long
    shown = "".join(
        letter if letter.isprintable() else letter.encode("unicode_escape").decode("ascii")
        for letter in whole[: most + 1]
    )
    return shown if len(shown) <= most else shown[: most - 3] + "..."


def shown(value: object) -> str:
    """The `repr` of a value, on one line of at most 80 characters."""
    return printable(_WRITER.repr(value))


class _Writer(reprlib.Repr):
    """A `repr` that abbreviates long containers: values from files may be huge or deeply nested."""

    def __init__(self) -> None:
        super().__init__()
        self.maxtuple = self.maxlist = self.maxdict = self.maxset = 40
        self.maxstring = self.maxlong = self.maxother = 200

    def repr_int(self, x: int, level: int) -> str:
        """Python refuses to convert integers with thousands of digits."""
        return super().repr_int(x, level) if x.bit_length() < 10_000 else f"({x.bit_length()} bits)"


_WRITER = _Writer()


def readable_bytes(size: float) -> str:
    """A size for display, such as `1.5 GB`."""
    for unit in ("bytes", "kB", "MB", "GB"):
        if size < 1000.0 or unit == "GB":
            return f"{size:.0f} {unit}" if unit == "bytes" else f"{size:.3g} {unit}"
        size /= 1000.0
    raise AssertionError


def without_exponent(number: float) -> str:
    """A number as the command line accepts it: argparse mistakes -1e-05 for an option."""
    return np.format_float_positional(number, trim="-")
