# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the package's log goes: to the console, a line each, and to a file where one is asked for.

Modules speak through `logging.getLogger(__name__)`. All of those names begin with the package's, which has
another name inside Blender, so what is set up here touches no other program's log.
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

#: of the record of a line that a command has printed itself: it goes to the file alone
PRINTED = {"printed": True}
#: from the quietest, as `--verbose` counts them
LEVELS = (logging.WARNING, logging.INFO, logging.DEBUG)

#: names of the handlers
_CONSOLE, _FILE = "Ocean Tweak console", "Ocean Tweak file"
_PACKAGE = logging.getLogger(__name__.rpartition(".export.")[0])
_PREFIX = "ocean_tweak: "
#: in front of what nobody hears who did not ask for it
_QUIET = {logging.INFO: "info: ", logging.DEBUG: "debug: "}


class _Console(logging.Handler):
    """Standard error as it is at the time, `ocean_tweak: …`."""

    def format(self, record: logging.LogRecord) -> str:
        return f"{_PREFIX}{_QUIET.get(record.levelno, '')}{_line(record)}"

    def emit(self, record: logging.LogRecord) -> None:
        if sys.stderr is not None and not getattr(record, "printed", False):
            with contextlib.suppress(OSError, ValueError):  # nobody listens any more
                print(self.format(record), file=sys.stderr, flush=True)


class _File(logging.StreamHandler[Any]):
    """A file that several processes may append to, also from several machines."""

    def __init__(self, path: Path) -> None:
        # a fifo would wait for a reader, and a link lead elsewhere
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
        """A bake goes on without its log: of a full disk its images tell."""

    def close(self) -> None:
        with contextlib.suppress(OSError):
            self.stream.close()
        super().close()


def to_console(level: int = logging.WARNING) -> None:
    """Let what is said at a level or above be heard on standard error. May be called again and again."""
    _replace(_CONSOLE, _Console(), level)


def to_file(path: Path) -> None:
    """Append to a file what is said from now on, and to none that was named before.

    Raises OSError naming a path that cannot be written or is no file.
    """
    _replace(_FILE, _File(path), min(logging.INFO, level()))


def end() -> None:
    """Let go of the console and of the file."""
    _replace(_CONSOLE)
    end_file()


def end_file() -> None:
    """Let go of the file."""
    _replace(_FILE)


def level() -> int:
    """The level from which somebody hears: console or file."""
    return _PACKAGE.getEffectiveLevel()


def verbose_arguments() -> list[str]:
    """What makes another command of ours as loud as this process is."""
    return ["--verbose"] * max(0, (logging.WARNING - level()) // 10)


def relay(line: str, logger: logging.Logger) -> str:
    """Say what another process of ours has printed to its console. Returns it as it was said.

    What a library had to say is for those who look for more.
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
    """Put a handler in place of the one of its name, and keep the log down to what somebody hears."""
    for old in [old for old in _PACKAGE.handlers if old.name == name]:
        _PACKAGE.removeHandler(old)
        old.close()
    if handler is not None:
        handler.name = name
        handler.setLevel(level)
        _PACKAGE.addHandler(handler)
    own = [handler.level for handler in _PACKAGE.handlers if handler.name in (_CONSOLE, _FILE)]
    _PACKAGE.setLevel(min(own, default=logging.NOTSET))
