# SPDX-License-Identifier: GPL-3.0-or-later
"""Text files line by line, with whose errors say where they are."""

from __future__ import annotations

import codecs
import gzip
import math
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import NoReturn

from ...core.data.errors import ParameterError
from ...core.data.printable import printable
from ..files import open_file

#: bytes of a file's text, unpacked: a year of a buoy's spectra has a tenth of it
LARGEST_TEXT = 64_000_000

#: marks at the start of a text, which editors put there, and the encodings that they stand for
_MARKS = {codecs.BOM_UTF8: "utf-8", codecs.BOM_UTF16_LE: "utf-16-le", codecs.BOM_UTF16_BE: "utf-16-be"}

#: letters of a line
_LONGEST_LINE = 200_000


class Lines:
    """The lines of a text file, one after the other; `number` is that of the last one read."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.number = 0
        self._rest = iter(_text(path).replace("\r\n", "\n").replace("\r", "\n").split("\n"))

    def __iter__(self) -> Iterator[str]:
        while (line := self.next_line()) is not None:
            yield line

    def next_line(self) -> str | None:
        """The next line, without its end; None after the last."""
        line = next(self._rest, None)
        if line is None:
            return None
        self.number += 1
        if len(line) > _LONGEST_LINE:
            self.refuse("is longer than a line of any such file: it may be of another kind")
        return line

    def needed(self, what: str) -> str:
        """The next line that is not empty. Raises ParameterError where the file ends before it."""
        while True:
            line = self.next_line()
            if line is None:
                self.refuse(f"the file ends where {what} should follow: it is cut off, fetch it again")
            if line.strip():
                return line

    def decimal(self, text: str, what: str) -> float:
        """A finite number. Raises ParameterError."""
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            self.refuse(f"{printable(text, 30)} is no number, where {what} should stand")
        return value

    def whole(self, text: str, what: str, least: int, most: int) -> int:
        """A whole number in a range. Raises ParameterError."""
        value = self.decimal(text, what)
        if value != int(value) or not least <= value <= most:
            self.refuse(f"{printable(text, 30)} must be a whole number from {least} to {most}: {what}")
        return int(value)

    def refuse(self, reason: str) -> NoReturn:
        """Raise ParameterError that names the file and the last line read."""
        raise ParameterError("file", f"{self.path.name}, line {self.number}", reason)


def refuse_file(path: Path, reason: str) -> NoReturn:
    """Raise ParameterError for a whole file."""
    raise ParameterError("file", path.name, reason)


def _text(path: Path) -> str:
    """A file's text, unpacked if it is packed by gzip. Raises ParameterError for one that is too large."""
    try:
        with open_file(path) as file:
            packed = file.read(2) == b"\x1f\x8b"
            file.seek(0)
            if packed:
                with gzip.GzipFile(fileobj=file) as unpacked:
                    content = unpacked.read(LARGEST_TEXT + 1)
            else:
                content = file.read(LARGEST_TEXT + 1)
    except (EOFError, zlib.error, gzip.BadGzipFile) as error:
        refuse_file(path, f"cannot be unpacked ({error}): it is cut off or damaged, fetch it again")
    except OSError as error:
        refuse_file(path, f"cannot be read: {error.strerror or error}")
    except ValueError as error:  # letters that no path holds
        refuse_file(path, f"cannot be read: {error}")
    if len(content) > LARGEST_TEXT:
        refuse_file(path, f"is larger than {LARGEST_TEXT / 1e6:g} MB: cut out the times that are wanted")
    for mark, encoding in _MARKS.items():
        if content.startswith(mark):
            return content[len(mark) :].decode(encoding, "replace")
    return content.decode("latin-1")
