# SPDX-License-Identifier: GPL-3.0-or-later
"""Writing files so that nobody ever sees half of one."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator
from pathlib import Path


@contextlib.contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """A path beside `path` to write to; on success it is synced and takes the place of `path`.

    On any error the old file stays as it was and what was written is removed.
    """
    beside = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        yield beside
        with beside.open("rb+") as file:
            os.fsync(file.fileno())
        beside.replace(path)
    except BaseException:
        with contextlib.suppress(OSError):
            beside.unlink(missing_ok=True)
        raise


def writable_folder(path: Path) -> Path:
    """The folder, made if it is missing. Raises OSError naming it when files cannot be written there."""
    path.mkdir(parents=True, exist_ok=True)
    probe = path / f".ocean_tweak.{os.getpid()}.part"
    try:
        probe.touch()
    finally:
        with contextlib.suppress(OSError):
            probe.unlink()
    return path
