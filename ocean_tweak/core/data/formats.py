# SPDX-License-Identifier: GPL-3.0-or-later
"""Format versions of everything that is written, and how files of a newer version are refused.

A version is raised when older programs would misread the file or could not read it at all; readers use it to
tell old files from new ones. A file without a version has version 1. Each kind of node group has its own
version, next to the code that builds it: see `nodes.versioned`.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from .errors import ParameterError

#: a sea or a shot as JSON, written by `Shot.to_json`, `write_sea`, the panel and presets. In version 1 many
# fields had other names: see `parameters.former_json`
SEA = 2
#: the header of a baked image
IMAGE = 1
#: a bake's job, `bake.json`, and the record of each frame
JOB, RECORD = 1, 1
#: the sea's description in USD layers
LAYER = 1
#: the waves themselves: raised whenever the same parameters give a different surface
SYNTHESIS = 1
#: the foam: raised whenever the same waves get different foam. Only files that hold foam carry it
FOAM = 4
#: the first foam that always tells what breaks now and how old the rest is
FOAM_OF_TWO_AGES = 2
#: the windrows: raised whenever the same foam is drawn out into others. Only files of foam that lies in them
# carry it
WINDROWS = 3
#: the spray: raised whenever the same sea and settings give different particles
SPRAY = 5

#: the encoding of a bake's maps: raised whenever the same fields give a different file. In 1 all had 32 bits
ENCODING = 2


def told_foam(version: int, has_foam: bool) -> dict[str, int]:
    """The foam version as an entry for files and fingerprints; empty for the first version and without
    foam."""
    return {"foam": version} if has_foam and version > 1 else {}


def told_windrows(version: int, has_windrows: bool) -> dict[str, int]:
    """The version of windrows as such an entry; empty for the first version and without windrows."""
    return {"windrows": version} if has_windrows and version > 1 else {}


def told_encoding(version: int, has_halved: bool) -> dict[str, int]:
    """The encoding version as such an entry; empty for the first version and for maps in 32 bits."""
    return {"encoding": version} if has_halved and version > 1 else {}


class NewerFormatError(ParameterError):
    """A file written by a newer version of the program."""

    def __init__(self, name: str, found: int, known: int) -> None:
        super().__init__(
            name, found,
            f"was written by a newer Ocean Tweak, and this one reads up to {known}: update the extension",
        )  # fmt: skip


def checked_sea(data: Any) -> Any:
    """A sea's plain data without its format version. Raises the errors of `check_format`."""
    if not isinstance(data, dict) or "format" not in data:
        return data
    check_format(data, SEA)
    return {key: value for key, value in data.items() if key != "format"}


def check_format(data: Mapping[str, Any], known: int, key: str = "format") -> None:
    """Raise NewerFormatError for a newer version than `known`, ParameterError for an invalid one."""
    found = data.get(key, 1)
    if isinstance(found, bool) or not isinstance(found, int) or found < 1:
        raise ParameterError(key, found, "must be a whole number from 1")
    if found > known:
        raise NewerFormatError(key, found, known)
