# SPDX-License-Identifier: GPL-3.0-or-later
"""How a command ends."""

from __future__ import annotations

import errno
import shlex
from pathlib import Path

from ..core.data.printable import LONGEST, printable

DONE, FAILED, WRONG_ARGUMENTS = 0, 1, 2

_NOT_ALLOWED = "get permission to write there, or choose another folder with --out"
#: remedies for errors of the operating system
_REMEDIES = {
    errno.ENOSPC: "make room on the disk",
    errno.EDQUOT: "make room, or ask for a larger quota",
    errno.EFBIG: "the disk or the shell's limits do not allow a larger file",
    errno.EACCES: _NOT_ALLOWED,
    errno.EPERM: _NOT_ALLOWED,
    errno.EROFS: _NOT_ALLOWED,
    errno.ENAMETOOLONG: "choose a shorter --name, or a folder with a shorter path",
    errno.EIO: "the disk or the network failed",
}


class UsageError(ValueError):
    """Arguments that do not fit together."""


def message_of(error: BaseException) -> str:
    """The message of an error, on one line."""
    if isinstance(error, KeyboardInterrupt):
        return "interrupted; the frames written so far are complete"
    if isinstance(error, OSError) and error.filename:
        return printable(f"{error.filename}: {error.strerror}", LONGEST)
    if isinstance(error, MemoryError) and not str(error):
        return "there is not enough memory: lower the resolution"
    return printable(" ".join(str(error).split()), LONGEST)


def shell_word(path: Path) -> str:
    """A path quoted for a shell, and never taken for an option."""
    text = str(path)
    return shlex.quote(f"./{text}" if text.startswith("-") else text)


def remedy_of(error: BaseException) -> str:
    """The remedy, preceded by a colon; "" if the message already contains it."""
    remedy = _REMEDIES.get(error.errno or 0) if isinstance(error, OSError) else None
    return f": {remedy}" if remedy else ""
