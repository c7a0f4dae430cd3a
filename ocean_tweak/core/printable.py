# SPDX-License-Identifier: GPL-3.0-or-later
"""Words of strangers, such as keys and names out of files, as a message may repeat them."""

from __future__ import annotations


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
