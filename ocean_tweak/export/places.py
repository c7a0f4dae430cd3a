# SPDX-License-Identifier: GPL-3.0-or-later
"""Interprets paths on this system, and the cache folder from the environment."""

from __future__ import annotations

import os
import re
from pathlib import Path

CACHE_VARIABLE = "OCEAN_TWEAK_CACHE"
#: the folder for what takes long to compute
SHELF_VARIABLE = "OCEAN_TWEAK_COASTS"

_OF_WINDOWS = re.compile(r"[A-Za-z]:([\\/]|$)|\\\\")


def is_foreign(text: str) -> bool:
    """Whether a path begins with a Windows drive or server on another system."""
    return os.name != "nt" and _OF_WINDOWS.match(text) is not None


def path_of(text: str) -> Path:
    """The path, with `~` expanded. Raises ValueError for a path of another system."""
    if is_foreign(text):
        raise ValueError(
            f"{text!r} is a Windows path, with a drive or server that this system does not have: "
            "choose it again on this system"
        )
    try:
        return Path(text).expanduser()
    except RuntimeError:
        raise ValueError(
            f"{text!r} lies in the home of a user that this system does not know: write ./{text} "
            "for a name that begins with ~"
        ) from None


def environment_cache() -> Path | None:
    """The absolute cache folder from the environment. Raises ValueError as `path_of`."""
    text = os.environ.get(CACHE_VARIABLE)
    if not text:
        return None
    try:
        return path_of(text).absolute()
    except ValueError as error:
        raise ValueError(f"{CACHE_VARIABLE}: {error}") from None
