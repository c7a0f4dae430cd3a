# SPDX-License-Identifier: GPL-3.0-or-later
"""Frame numbers and frame ranges, including negative frames, frames beyond 9999 and subframes."""

from __future__ import annotations

import math
import re
from bisect import bisect_right
from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction

from .errors import ParameterError

#: a whole frame is an int; a subframe, for motion blur, is a Fraction with a finite decimal form
Frame = int | Fraction

_NUMBER = r"-?\d{1,20}(?:\.\d{1,6})?"
_RANGE = re.compile(rf"({_NUMBER})(?:-({_NUMBER})(?:[x:](\d{{1,20}}(?:\.\d{{1,6}})?))?)?")
#: the most that one range, list or bake may hold
MOST_FRAMES = 1_000_000
#: how far from 0 a frame may lie
LARGEST_FRAME = 10**9


def parse_frames(text: str) -> tuple[Frame, ...]:
    """The frames of text such as `1-48`, `1-100x2`, `1001,1005-1010`, `-5--1` or `1-2x0.25`, ascending, each
    once.

    A step may also follow a colon, `1-100:2`, as render farms write it.

    Raises ParameterError.
    """
    total = 0
    parts: list[tuple[Fraction, Fraction, int]] = []
    for part in text.split(","):
        match = _RANGE.fullmatch(part.strip())
        if not match:
            raise ParameterError("frames", text, "must look like 1-48, 1-100x2 or 1001,1005-1010")
        first = Fraction(match[1])
        last = Fraction(match[2]) if match[2] else first
        step = Fraction(match[3]) if match[3] else Fraction(1)
        if last < first or step <= 0:
            raise ParameterError("frames", text, f"{part.strip()} holds no frames")
        count = int((last - first) // step) + 1
        total += count
        if total > MOST_FRAMES:
            raise ParameterError("frames", text, f"must hold at most {MOST_FRAMES} frames")
        if max(abs(first), abs(last)) > LARGEST_FRAME:
            raise ParameterError("frames", text, f"must lie between -{LARGEST_FRAME} and {LARGEST_FRAME}")
        parts.append((first, step, count))
    # only now: count before creating them
    series = [_series(*part) for part in parts]
    if len(series) == 1:
        return tuple(series[0])
    # compared as floats, which still distinguish six decimals: comparing fractions takes seconds
    return tuple(sorted({frame for part in series for frame in part}, key=float))


def _series(first: Fraction, step: Fraction, count: int) -> Iterable[Frame]:
    whole = math.lcm(first.denominator, step.denominator)
    start, stride = int(first * whole), int(step * whole)
    numerators = range(start, start + count * stride, stride)
    if whole == 1:
        return numerators
    return (n // whole if n % whole == 0 else Fraction(n, whole) for n in numerators)


def as_frame(value: float | Fraction) -> Frame:
    """The frame number as an int where it is whole."""
    exact = Fraction(value)
    return int(exact) if exact.denominator == 1 else exact


def frame_label(frame: Frame) -> str:
    """A frame as it is written in a file name: `0007`, `-007`, `12345`, `1001.25`.

    Raises ParameterError for a frame that needs more than six decimals.
    """
    return _digits(frame, 4)


def _digits(frame: Frame, width: int) -> str:
    exact = Fraction(frame)
    sign, size = ("-", -exact) if exact < 0 else ("", exact)
    whole, millionths = int(size), (size - int(size)) * 10**6
    if millionths.denominator != 1:
        raise ParameterError("frame", str(frame), "must have at most six decimals")
    decimals = f".{int(millionths):06d}".rstrip("0") if millionths else ""
    return f"{sign}{whole:0{max(width - len(sign), 1)}d}{decimals}"


def format_frames(frames: Iterable[Frame], step_sign: str = "x") -> str:
    """Frames as ranges that `parse_frames` can read: `1-48,60`, `1-99x2`.

    step_sign : what precedes a step; "" for readers without steps, for which such frames are listed one by
    one
    """
    frames = set(frames)
    whole = sorted(frame for frame in frames if isinstance(frame, int))
    parts = [_range_text(run, step_sign) for run in _runs(whole, bool(step_sign))]
    between = sorted((frame for frame in frames if not isinstance(frame, int)), key=float)
    return ",".join([*parts, *(_digits(frame, 1) for frame in between)])


def held_frame(frames: Sequence[int], frame: int) -> int:
    """The baked frame shown at a frame: the last of the ascending `frames` not after it, else the first."""
    return frames[max(bisect_right(frames, frame) - 1, 0)]


def _runs(frames: Sequence[int], may_step: bool) -> Iterator[range]:
    """Group ascending frames into ranges; a step other than 1 needs at least three frames."""
    start = 0
    while start < len(frames):
        step = frames[start + 1] - frames[start] if start + 1 < len(frames) else 1
        end = start
        while end + 1 < len(frames) and frames[end + 1] - frames[end] == step:
            end += 1
        if step > 1 and not (may_step and end - start >= 2):
            end, step = start, 1
        yield range(frames[start], frames[end] + 1, step)
        start = end + 1


def _range_text(run: range, step_sign: str) -> str:
    if len(run) == 1:
        return str(run[0])
    return f"{run[0]}-{run[-1]}" + (f"{step_sign}{run.step}" if run.step > 1 else "")
