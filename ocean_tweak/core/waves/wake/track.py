# SPDX-License-Identifier: GPL-3.0-or-later
"""The path of an object: straight pieces between samples, each with constant velocity."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...data.validation import real_array

Array = NDArray[np.float64]

#: of a path, by which a bend is none: of the distance covered, and of a turn in rad
_STRAIGHT, _SAME_HEADING = 1e-9, 1e-6
#: m/s, below which an object has no direction of its own
_AT_REST = 1e-6


@dataclass(frozen=True)
class Piece:
    """A straight stretch of a path.

    begin, end : times, s
    start, place : x and y where it begins and where it ends, m
    velocity : m/s
    heading : direction in which the object points, counter-clockwise from +x, rad
    immersion : what its draught is multiplied by
    """

    begin: float
    end: float
    start: tuple[float, float]
    place: tuple[float, float]
    velocity: tuple[float, float]
    heading: float
    immersion: float = 1.0

    def ending(self, time: float) -> Piece:
        """The same way, until another time."""
        ahead = time - self.end
        (x, y), (vx, vy) = self.place, self.velocity
        return replace(self, end=time, place=(x + ahead * vx, y + ahead * vy))


@dataclass(frozen=True, eq=False)
class Track:
    """Samples of a path.

    times : (T,) s, ascending
    positions : (T, 2) m
    headings : (T,) rad; None points along the path
    immersions : (T,) by which the draught is multiplied; None for 1

    Before its first sample and after its last, the object moves with the adjacent velocity; a path of one
    sample is at rest.
    """

    times: Array
    positions: Array
    headings: Array | None = None
    immersions: Array | None = None

    @classmethod
    def of(
        cls,
        times: ArrayLike,
        positions: ArrayLike,
        headings: ArrayLike | None = None,
        immersions: ArrayLike | None = None,
    ) -> Track:
        """A checked track. Raises ValueError for samples that are none, not finite or out of order."""
        t, x = real_array("times", times), real_array("positions", positions)
        if t.ndim != 1 or not len(t):
            raise ValueError(f"times: must be one row of at least one time, not of shape {t.shape}")
        if x.shape != (len(t), 2):
            raise ValueError(
                f"positions: must have the shape ({len(t)}, 2), x and y of each time, not {x.shape}"
            )
        theta, immersed = (
            None if given is None else real_array(name, given)
            for name, given in (("headings", headings), ("immersions", immersions))
        )
        for name, values in (("headings", theta), ("immersions", immersed)):
            if values is not None and values.shape != t.shape:
                raise ValueError(
                    f"{name}: must have the shape ({len(t)},), one for each time, not {values.shape}"
                )
        of_all = {"times": t, "positions": x, "headings": theta, "immersions": immersed}
        for name, values in of_all.items():
            if values is not None and not np.isfinite(values).all():
                raise ValueError(f"{name}: must be finite")
        if np.any(np.diff(t) <= 0.0):
            index = int(np.argmax(np.diff(t) <= 0.0)) + 1
            raise ValueError(
                f"times: must ascend, but sample {index} is at {t[index]:g} s after {t[index - 1]:g} s"
            )
        return cls(t, x, theta, immersed)

    @cached_property
    def _velocities(self) -> Array:
        """(T - 1, 2) m/s, or one of rest."""
        if len(self.times) == 1:
            return np.zeros((1, 2))
        return np.diff(self.positions, axis=0) / np.diff(self.times)[:, np.newaxis]

    @cached_property
    def _headings(self) -> Array:
        """Of each stretch between samples, rad."""
        if self.headings is not None:
            if len(self.times) == 1:
                return self.headings
            turn = np.diff(self.headings)
            return self.headings[:-1] + 0.5 * np.arctan2(np.sin(turn), np.cos(turn))
        moving = np.hypot(*self._velocities.T) > _AT_REST
        if not moving.any():
            return np.zeros(len(self._velocities))
        # what stands still points as it did before, or as it will
        last = np.maximum.accumulate(np.where(moving, np.arange(len(moving)), -1))
        last[last < 0] = int(np.argmax(moving))
        vx, vy = self._velocities[last].T
        return np.arctan2(vy, vx)

    @cached_property
    def _immersions(self) -> Array:
        """Of each stretch, as at its middle."""
        if self.immersions is None:
            return np.ones(len(self._velocities))
        if len(self.times) == 1:
            return self.immersions
        return 0.5 * (self.immersions[:-1] + self.immersions[1:])

    def place(self, time: float) -> tuple[tuple[float, float], tuple[float, float]]:
        """x and y in m at a time in s, and the velocity there in m/s."""
        index = self._stretch(time)
        vx, vy = self._velocities[index].tolist()
        x, y = self.positions[index].tolist()
        since = time - float(self.times[index])
        return (x + since * vx, y + since * vy), (vx, vy)

    def heading(self, time: float) -> float:
        """Direction in which the object points at a time in s, rad."""
        return float(self._headings[self._stretch(time)])

    def _stretch(self, time: float) -> int:
        """Of those between samples, the one at a time in s."""
        last = int(np.searchsorted(self.times, time, side="right")) - 1
        return min(max(last, 0), len(self._velocities) - 1)

    def immersion(self, time: float) -> float:
        """What the draught is multiplied by at a time in s."""
        return 1.0 if self.immersions is None else float(np.interp(time, self.times, self.immersions))

    @property
    def fastest(self) -> tuple[float, int]:
        """The greatest speed in m/s, and the index of the sample at its end."""
        speeds = np.hypot(*self._velocities.T)
        index = int(np.argmax(speeds))
        return float(speeds[index]), min(index + 1, len(self.times) - 1)

    @property
    def first(self) -> Piece:
        """The object's unlimited path up to its first sample."""
        return Piece(-np.inf, float(self.times[0]), (-np.inf, -np.inf), *self._motion(0, self.positions[0]))

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """The pieces from the first sample to the last; collinear ones with the same speed are merged."""
        found: list[Piece] = []
        for index in range(len(self.times) - 1):
            begin, end = float(self.times[index]), float(self.times[index + 1])
            start, motion = _pair(self.positions[index]), self._motion(index, self.positions[index + 1])
            piece = Piece(begin, end, start, *motion)
            if found and _goes_on(found[-1], piece):
                piece = replace(found.pop(), end=end, place=piece.place)
            found.append(piece)
        return tuple(found)

    def until(self, time: float) -> tuple[tuple[Piece, ...], Piece | None]:
        """Pieces that end by a time, and the part of the one that is under way; None where none is."""
        done = tuple(piece for piece in self.pieces if piece.end <= time)
        begin = done[-1].end if done else float(self.times[0])
        if time <= begin:
            return done, None
        way = self.pieces[len(done)] if len(done) < len(self.pieces) else self._last
        start = done[-1].place if done else self.first.place
        return done, replace(way.ending(time), begin=begin, start=start)

    @property
    def _last(self) -> Piece:
        return self.pieces[-1] if self.pieces else self.first

    def _motion(
        self, index: int, place: Array
    ) -> tuple[tuple[float, float], tuple[float, float], float, float]:
        """What a piece is beside its times."""
        vx, vy = self._velocities[index].tolist()
        heading, immersion = float(self._headings[index]), float(self._immersions[index])
        return _pair(place), (vx, vy), heading, immersion


def _pair(place: Array) -> tuple[float, float]:
    x, y = place.tolist()
    return x, y


def _goes_on(one: Piece, other: Piece) -> bool:
    change = np.hypot(other.velocity[0] - one.velocity[0], other.velocity[1] - one.velocity[1])
    turn = other.heading - one.heading
    same = one.immersion == other.immersion
    same = same and abs(np.arctan2(np.sin(turn), np.cos(turn))) <= _SAME_HEADING
    return bool(same and change <= _STRAIGHT * max(np.hypot(*one.velocity), np.hypot(*other.velocity)))
