# SPDX-License-Identifier: GPL-3.0-or-later
"""Output of the package's log: to the console, one line each, and optionally to a file.

Modules log through `logging.getLogger(__name__)`. All these names begin with that of the package, which
differs inside Blender, so other loggers are not affected.
"""

from __future__ import annotations

import contextlib
import logging
import os
import platform
import stat
import sys
from pathlib import Path
from typing import Any

from ..core.data.printable import LONGEST, printable

#: attribute of a record that a command has already printed: it goes to the file only
PRINTED = {"printed": True}
#: from the quietest, as `--verbose` counts them
LEVELS = (logging.WARNING, logging.INFO, logging.DEBUG)

#: names of the handlers
_CONSOLE, _FILE = "Ocean Tweak console", "Ocean Tweak file"
_PACKAGE = logging.getLogger(__name__.rpartition(".export.")[0])
_PREFIX = "ocean_tweak: "
#: prefix of messages that are shown only on request
_QUIET = {logging.INFO: "info: ", logging.DEBUG: "debug: "}


class _Console(logging.Handler):
    """Standard error as it is at the time, `ocean_tweak: …`."""

    def format(self, record: logging.LogRecord) -> str:
        return f"{_PREFIX}{_QUIET.get(record.levelno, '')}{_line(record)}"

    def emit(self, record: logging.LogRecord) -> None:
        if sys.stderr is not None and not getattr(record, "printed", False):
            with contextlib.suppress(OSError, ValueError):  # the reader has gone
                print(self.format(record), file=sys.stderr, flush=True)


class _File(logging.StreamHandler[Any]):
    """A log file to which several processes and machines may append."""

    def __init__(self, path: Path) -> None:
        # a fifo would wait for a reader, and a link could lead elsewhere
        flags = os.O_WRONLY | os.O_APPEND | os.O_CREAT
        flags |= getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_NOFOLLOW", 0)
        descriptor = os.open(path, flags, 0o666)
        if not stat.S_ISREG(os.fstat(descriptor).st_mode):
            os.close(descriptor)
            raise OSError(None, "is not a file, so no log is written to it", str(path))
        super().__init__(open(descriptor, "a", encoding="utf-8", errors="backslashreplace"))  # noqa: PTH123, SIM115

    def format(self, record: logging.LogRecord) -> str:
        formatter = logging.Formatter()
        time = formatter.formatTime(record, "%Y-%m-%d %H:%M:%S")
        line = f"{time} {platform.node()} {record.process} {record.levelname} {_line(record)}"
        return f"{line}\n{formatter.formatException(record.exc_info)}" if record.exc_info else line

    def handleError(self, record: logging.LogRecord) -> None:
        """A bake continues without its log; a full disk is reported by its images."""

    def close(self) -> None:
        with contextlib.suppress(OSError):
            self.stream.close()
        super().close()


def to_console(level: int = logging.WARNING) -> None:
    """Print messages of a level and above to standard error. May be called repeatedly."""
    _replace(_CONSOLE, _Console(), level)


def to_file(path: Path) -> None:
    """Append messages to a file from now on, instead of to any earlier one.

    Raises OSError, with the path, if it cannot be written or is not a file.
    """
    _replace(_FILE, _File(path), min(logging.INFO, level()))


def end() -> None:
    """Close the console and the file."""
    _replace(_CONSOLE)
    end_file()


def end_file() -> None:
    """Close the file."""
    _replace(_FILE)


def level() -> int:
    """The lowest level shown on the console or in the file."""
    return _PACKAGE.getEffectiveLevel()


def verbose_arguments() -> list[str]:
    """Arguments that give another of our commands the same verbosity."""
    return ["--verbose"] * max(0, (logging.WARNING - level()) // 10)


def relay(line: str, logger: logging.Logger) -> str:
    """Log what another of our processes has printed. Returns the text unchanged.

    Output of libraries is logged at a lower level.
    """
    text, level = line.strip(), logging.DEBUG
    if text.startswith(_PREFIX):
        text, level = text.removeprefix(_PREFIX), logging.WARNING
        for quiet, word in _QUIET.items():
            if text.startswith(word):
                text, level = text.removeprefix(word), quiet
    if text:
        logger.log(level, "%s", text)
    return text


def _line(record: logging.LogRecord) -> str:
    return printable(" ".join(record.getMessage().split()), LONGEST)


def _replace(name: str, handler: logging.Handler | None = None, level: int = logging.NOTSET) -> None:
    """Replace the handler of the same name, and set the log's level to the lowest one shown."""
    for old in [old for old in _PACKAGE.handlers if old.name == name]:
        _PACKAGE.removeHandler(old)
        old.close()
    if handler is not None:
        handler.name = name
        handler.setLevel(level)
        _PACKAGE.addHandler(handler)
    own = [handler.level for handler in _PACKAGE.handlers if handler.name in (_CONSOLE, _FILE)]
    _PACKAGE.setLevel(min(own, default=logging.NOTSET))
