# SPDX-License-Identifier: GPL-3.0-or-later
"""Converts option values. Each function raises ArgumentTypeError for invalid text."""

from __future__ import annotations

import argparse
import math
import re
from pathlib import Path

from ..core.data.errors import ParameterError
from ..core.data.frames import Frame, parse_frames
from ..core.sea.patch_plan import Wish
from ..core.sea.regions import Area
from ..export.cache.job import UID
from ..export.frame_files import BAKED
from ..export.places import path_of

_BYTES = {"": 1.0, "b": 1.0, "kb": 1e3, "mb": 1e6, "gb": 1e9, "tb": 1e12}
#: largest distance from the origin in m, beyond which 32-bit positions no longer resolve metres
_FARTHEST = 1e7
_WISHED = re.compile(r"(finest|area|memory)=(\d+(?:\.\d*)?|\.\d+)([a-z]*)", re.IGNORECASE)


def path(text: str) -> Path:
    """a path of this system; ~ is the user's home, even if no shell expanded it."""
    try:
        return path_of(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def wish(text: str) -> Wish:
    """finest=0.1,area=4000,memory=2GB."""
    values: dict[str, float] = {}
    for part in text.split(","):
        match = _WISHED.fullmatch(part.strip())
        units = _BYTES if match and match[1].lower() == "memory" else {"": 1.0, "m": 1.0}
        if not match or match[3].lower() not in units or match[1].lower() in values:
            raise argparse.ArgumentTypeError(f"{text!r} must look like finest=0.1,area=4000,memory=2GB")
        values[match[1].lower()] = float(match[2]) * units[match[3].lower()]
    if not {"finest", "area"} <= values.keys():
        raise argparse.ArgumentTypeError(f"{text!r} must give finest and area, in metres")
    try:
        return Wish(**values)
    except ParameterError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def frames(text: str) -> tuple[Frame, ...]:
    """1-48,60."""
    try:
        return parse_frames(text)
    except ParameterError as error:
        raise argparse.ArgumentTypeError(f"{text!r} {error.reason}") from None


def maps(text: str) -> tuple[str, ...]:
    """disp,foam: some of BAKED, each once."""
    names = tuple(dict.fromkeys(name.strip() for name in text.split(",")))
    unknown = [name for name in names if name not in BAKED]
    if unknown:
        raise argparse.ArgumentTypeError(f"{unknown[0]!r} is not a map; maps are {', '.join(BAKED)}")
    return names


def attributes(text: str) -> tuple[str, ...]:
    """names between commas, each once."""
    return tuple(dict.fromkeys(name.strip() for name in text.split(",") if name.strip()))


class AreaAction(argparse.Action):
    """SIZE SAMPLES, or SIZE SAMPLES X Y, as an Area."""

    def __call__(self, parser, namespace, values, option_string=None):  # type: ignore[no-untyped-def]
        """Store the area. Exits with the parser's error for an invalid one."""
        try:
            setattr(namespace, self.dest, Area.of_words(values))
        except ValueError as error:
            parser.error(f"argument {option_string}: {error}")


def coordinate(text: str) -> float:
    """a place along an axis, m."""
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not abs(number) <= _FARTHEST:
        raise argparse.ArgumentTypeError(
            f"{text!r} must be a number of metres from {-_FARTHEST:.0f} to {_FARTHEST:.0f}"
        )
    return number


def tiles(text: str) -> tuple[int, int]:
    """3x3."""
    match = re.fullmatch(r"(\d{1,4})x(\d{1,4})", text)
    if not match:
        raise argparse.ArgumentTypeError(f"{text!r} must look like 3x3")
    return int(match[1]), int(match[2])


def resolutions(text: str) -> tuple[int, ...]:
    """512,256."""
    if not re.fullmatch(r"\d{1,6}(,\d{1,6})*", text):
        raise argparse.ArgumentTypeError(f"{text!r} must look like 512,256")
    return tuple(map(int, text.split(",")))


def uid(text: str) -> str:
    """letters and digits."""
    if not UID.fullmatch(text):
        raise argparse.ArgumentTypeError(f"{text!r} must be 1 to 32 letters and digits")
    return text


def count(text: str) -> int:
    """a whole number from 1."""
    if not (text.isdecimal() and 1 <= int(text) <= 1_000_000):
        raise argparse.ArgumentTypeError(f"{text!r} must be a whole number from 1")
    return int(text)


def workers(text: str) -> int:
    """a whole number from 1 to 256."""
    if not (text.isdecimal() and 1 <= int(text) <= 256):
        raise argparse.ArgumentTypeError(f"{text!r} must be a whole number from 1 to 256")
    return int(text)
