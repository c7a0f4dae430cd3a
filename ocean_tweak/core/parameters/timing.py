# SPDX-License-Identifier: GPL-3.0-or-later
"""The frames of a shot in seconds of ocean time."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from ..data.errors import ParameterError
from ..data.plain_data import to_plain
from ..data.validation import Validated, integer, rational


@dataclass(frozen=True)
class Timing(Validated):
    """The relation of frames to ocean time, which is 0 at ``start_frame``.

    ``fps`` is stored as an exact fraction, such as 24000/1001.

    Examples
    --------
    >>> Timing(fps=Fraction(24000, 1001), start_frame=1001).time(1025)
    Fraction(1001, 1000)
    """

    fps: Fraction = rational(
        Fraction(24), 0.01, 1000.0, "frames per second", "Frames per second of the shot",
        "from time-lapse to high speed",
    )  # fmt: skip
    start_frame: int = integer(
        1,
        -1_000_000,
        10_000_000,
        "Frame at which the ocean's time is zero",
        "more than Blender's frame range",
    )
    stretch: Fraction = rational(
        Fraction(1), 0.001, 1000.0, "", "Frames of the shot per frame of its animation: 2 is half speed. "
        "In Blender, the scene's Time Stretching",
        "more than Blender's 1/900 to 900", left_out=True,
    )  # fmt: skip

    def time(self, frame: float | Fraction) -> Fraction:
        """Ocean time in seconds at a frame or subframe; exact.

        Examples
        --------
        >>> Timing(fps=25).time(51)
        Fraction(2, 1)
        """
        return (Fraction(frame) / self.stretch - self.start_frame) / self.fps

    def frame(self, time: float) -> float:
        """The frame at an ocean time in seconds.

        Examples
        --------
        >>> Timing(fps=25).frame(2.0)
        51.0
        """
        return float(self.stretch) * (self.start_frame + time * float(self.fps))


def check_loop(duration: Fraction | None, timing: Timing) -> None:
    """Raise ParameterError for a loop in s that is no whole number of frames."""
    if duration is None:
        return
    frames = duration * timing.fps
    if frames.denominator != 1:
        nearest = max(1, round(frames))
        raise ParameterError(
            "loop_duration", str(duration),
            f"is {float(frames):.6g} frames at {timing.fps} frames per second, not a whole number; "
            f"the nearest that is: {to_plain(nearest / timing.fps)} s, {nearest} frames",
        )  # fmt: skip
