# SPDX-License-Identifier: GPL-3.0-or-later
"""What a path that somebody wrote means on this system, and the cache that the environment names."""

from __future__ import annotations

import os
import re
from pathlib import Path

CACHE_VARIABLE = "OCEAN_TWEAK_CACHE"

_OF_WINDOWS = re.compile(r"[A-Za-z]:([\\/]|$)|\\\\")


def is_foreign(text: str) -> bool:
    """Whether a path begins with a drive or a server of Windows and this system has neither."""
    return os.name != "nt" and _OF_WINDOWS.match(text) is not None


def path_of(text: str) -> Path:
    """The path, `~` being the user's home. Raises ValueError, in a line, for one of another system."""
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
    """The folder of all bakes that the environment names, absolute. Raises ValueError like `path_of`."""
    text = os.environ.get(CACHE_VARIABLE)
    if not text:
        return None
    try:
        return path_of(text).absolute()
    except ValueError as error:
        raise ValueError(f"{CACHE_VARIABLE}: {error}") from None
