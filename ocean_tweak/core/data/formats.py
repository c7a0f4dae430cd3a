# SPDX-License-Identifier: GPL-3.0-or-later
"""Versions of what is written: all numbers, what each is of, and how a newer file is refused.

A number is raised when the program before would read the file wrongly, or not at all; reading then tells the
old form from the new by it. A file without a number is of version 1. Node groups have numbers of their own,
one a kind, beside what builds them: see `nodes.versioned`.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from .errors import ParameterError

#: a sea or a shot as JSON: `Shot.to_json`, and so what `write_sea` and the panel write, and presets. In 1
#: many fields had other names: see `parameters.former_json`
SEA = 2
#: the header of a baked image
IMAGE = 1
#: a bake's job, `bake.json`, and the record of each of its frames
JOB, RECORD = 1, 1
#: what layers of USD say of their sea
LAYER = 1
#: the waves themselves: raised whenever the same parameters give another surface
SYNTHESIS = 1
#: the foam: raised whenever the same waves get other foam. Only what holds foam is known by it
FOAM = 4
#: the spray: raised whenever the same sea and settings give other particles
SPRAY = 1

#: how a bake's maps are encoded: raised whenever the same fields give another file. In 1 all were 32 bits
ENCODING = 2


def told_foam(version: int, has_foam: bool) -> dict[str, int]:
    """What files and fingerprints tell of their foam; of the first version, as of none, they tell nothing."""
    return {"foam": version} if has_foam and version > 1 else {}


def told_encoding(version: int, has_halved: bool) -> dict[str, int]:
    """What they tell of how maps are encoded; of the first version, as of maps in 32 bits, nothing."""
    return {"encoding": version} if has_halved and version > 1 else {}


class NewerFormatError(ParameterError):
    """Something that a newer version of the program wrote."""

    def __init__(self, name: str, found: int, known: int) -> None:
        super().__init__(
            name, found,
            f"was written by a newer Ocean Tweak, and this one reads up to {known}: update the extension",
        )  # fmt: skip


def checked_sea(data: Any) -> Any:
    """A sea's plain data without its number. Raises as `check_format`."""
    if not isinstance(data, dict) or "format" not in data:
        return data
    check_format(data, SEA)
    return {key: value for key, value in data.items() if key != "format"}


def check_format(data: Mapping[str, Any], known: int, key: str = "format") -> None:
    """Raise NewerFormatError where data are of a newer version, ParameterError where that is no number."""
    found = data.get(key, 1)
    if isinstance(found, bool) or not isinstance(found, int) or found < 1:
        raise ParameterError(key, found, "must be a whole number from 1")
    if found > known:
        raise NewerFormatError(key, found, known)
