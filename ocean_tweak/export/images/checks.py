# SPDX-License-Identifier: GPL-3.0-or-later
"""What every reader of images asks before it reads: whether it is a file, and of which size."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import BinaryIO

from ...core.data.printable import printable
from ...core.data.raster import LARGEST_SIDE
from ..files import open_file


class UnusableError(ValueError):
    """An image that cannot be used: the reason, without the name of its file."""


def opened(path: Path) -> BinaryIO:
    """A file, to read its bytes. Raises UnusableError for one that is missing, or a pipe or device."""
    try:
        return open_file(path)
    except OSError as error:
        raise UnusableError(f"cannot be read: {error.strerror or error}") from None
    except ValueError as error:  # letters that no path holds
        raise UnusableError(f"cannot be read: {error}") from None


def check_size(rows: int, columns: int) -> None:
    """Raise UnusableError for more samples a side than a raster has, or none."""
    if not (1 <= rows <= LARGEST_SIDE and 1 <= columns <= LARGEST_SIDE):
        raise UnusableError(
            f"has {columns} x {rows} samples; must have from 1 to {LARGEST_SIDE} a side: make it smaller"
        )


def listed(names: Iterable[str]) -> str:
    """Names that a file gives, as a list that a line can hold."""
    names = tuple(names)
    shown = [printable(name, 40) for name in names[:24]]
    more = [f"{len(names) - len(shown)} more"] if len(names) > len(shown) else []
    return ", ".join(shown + more) or "none"
