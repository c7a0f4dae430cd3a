# SPDX-License-Identifier: GPL-3.0-or-later
"""A folder counts as made only when its stamp says by which recipe, and the stamp is written last."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from .project import ToolError

STAMP = ".made-by"
MOUNTS = Path("/proc/self/mounts")


def is_made(folder: Path, recipe: str) -> bool:
    """Whether `folder` was completed by exactly this recipe, at this very place."""
    try:
        return (folder / STAMP).read_text() == _text(folder, recipe)
    except OSError:
        return False


@contextmanager
def making(folder: Path, recipe: str) -> Iterator[Path]:
    """Give an empty place to make `folder` in; stamp it if the block ends well."""
    remove(folder)
    folder.parent.mkdir(parents=True, exist_ok=True)
    yield folder
    (folder / STAMP).write_text(_text(folder, recipe))


def remove(folder: Path) -> None:
    """Delete a folder and what is in it, but never through a mount."""
    inside = f"{folder}/"
    mounted = [line.split()[1] for line in MOUNTS.read_text().splitlines()] if MOUNTS.exists() else []
    for place in mounted:
        if place.startswith(inside):
            raise ToolError(f"{folder} cannot be replaced while {place} is mounted: umount it first")
    (folder / STAMP).unlink(missing_ok=True)
    shutil.rmtree(folder, ignore_errors=True)
    if folder.exists():
        raise ToolError(f"{folder} cannot be deleted: check who owns what is in it, then delete it by hand")


def _text(folder: Path, recipe: str) -> str:
    return f"{folder}\n{recipe}"
