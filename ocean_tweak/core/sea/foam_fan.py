# SPDX-License-Identifier: GPL-3.0-or-later
"""Rest positions and their foam for one camera view, as dense as its pixels.

Seen from a height h, the footprint of a pixel at a distance r is proportional to r across the view and to
r²/h along it. The fan's columns are directions from the point below the camera, dense within the picture and
sparse beside it; its rows are r ∝ 1/u² for even steps of u, so cells are ∝ r wide and ∝ r^1.5 long, close to
the geometric mean of both. A camera among the waves sees their faces, on which a pixel is a few times longer
than wide, and so are the cells.

Waves carry water sideways, into the picture too: the closer a row, the wider are its directions.

Each row has the foam of the level (`foam_levels`) with the next smaller cells, and blends into the next level
close to it. Foam is computed within the picture, and has its mean elsewhere. Only breaking waves that the
nearest row can show count as resolved.

The places drift with the foam. A fan is kept while the camera moves and turns little.
"""

from __future__ import annotations

import math
import threading
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..foam.drifting import DriftingFoam
from ..foam.model import Whitecaps
from .foam_levels import FINEST, FoamLevels

Array = NDArray[np.float64]

#: steps in which a fan rotates, rad, and moves, as a fraction of the distance to the nearest water
_TURN, _MOVE = math.radians(5.0), 0.125
#: steps per octave of the distance to the nearest water
_STEPS = 4
#: the fan is dense from this fraction of the distance of flat water at the picture's edge, as crests are
# higher
_NEARER = 0.85
#: rows in front of that, and columns beside the picture, which only matter for lighting
_ROWS_BEFORE, _COLUMNS_BESIDE = 16, 48
#: distance of the nearest of these rows, as a fraction of that of the dense rows
_FOOT = 0.02
#: rows per column of the picture
_ROWS_TO_COLUMNS = 0.7
#: ratio of length to width of cells in front of a camera among the waves
_ON_FACES = 3.0
#: fraction of a level's octave of cell sizes after which the next level is blended in
_OVER = 0.85


@dataclass(frozen=True)
class View:
    """The view of a camera over the water.

    x, y : of the point below it, m
    near : distance from there to the nearest water in the picture, m
    azimuth : of the middle of the picture, rad counter-clockwise from +x
    half_angle : from there to the farthest direction in the picture, rad
    reach : distance up to which water is shown, m
    is_low : whether it is among the waves
    """

    x: float
    y: float
    near: float
    azimuth: float
    half_angle: float
    reach: float
    is_low: bool = False

    def stepped(self, drift: tuple[float, float], time: float) -> View:
        """A view that covers this one and is the same for all nearby views, at its place at time 0."""
        near = 2.0 ** (math.floor(_STEPS * math.log2(self.near)) / _STEPS)
        move = _MOVE * near
        x, y = (
            move * round((along - time * speed) / move)
            for along, speed in zip((self.x, self.y), drift, strict=True)
        )
        return replace(
            self, x=x, y=y, near=near,
            azimuth=_TURN * round(self.azimuth / _TURN),
            # covers a lateral move by half a step at the near edge
            half_angle=min(_TURN * math.ceil(self.half_angle / _TURN + 1.0), math.pi - _TURN),
        )  # fmt: skip


@dataclass(frozen=True)
class Fan:
    """Foam at a time on rest positions; all arrays are (rows, columns), and the last column repeats the
    first.

    x, y : of the places, m
    size : of the cells, m
    """

    x: Array
    y: Array
    size: Array
    foam: Whitecaps


class _Rows(NamedTuple):
    """The places of one level.

    level : its number
    rows : the fan's rows
    share : (rows,) weight of the level in them
    foam : of the places in the picture
    """

    level: int
    rows: slice
    share: Array
    foam: DriftingFoam


class _Places(NamedTuple):
    """Places of a fan at time 0, as in `Fan`, with the number of columns in the picture and of rows in front
    of it."""

    x: Array
    y: Array
    size: Array
    columns: int


class FoamFan:
    """The foam of a sea of patches in front of a camera. Creating it is cheap.

    It is efficient for ascending times and views that change little; others are computed from scratch, with
    the same result. One thread at a time uses it while others wait.
    """

    def __init__(self, levels: FoamLevels, places: int) -> None:
        """`places` is the largest number of places of a fan."""
        self._levels = levels
        self.places = places
        self._busy = threading.Lock()
        self._view: View | None = None
        self._rows: tuple[_Rows, ...] = ()

    @property
    def nbytes(self) -> int:
        """Bytes of the places and their births."""
        return sum(rows.foam.nbytes for rows in self._rows)

    def at(self, time: float | Fraction, view: View) -> Fan:
        """Foam in front of a camera at a time in s. May be called on any thread."""
        model = self._levels.seas[0].foam_model
        now = model.reduced(time)
        stepped = view.stepped(model.drift, float(now))
        with self._busy:
            places = _places(stepped, self.places, self._aside)
            if self._view != stepped:
                self._view, self._rows = stepped, tuple(self._new_rows(places))
            missing = [rows.foam.missing(now) for rows in self._rows]
            # one moment at a time, because levels share strains
            for index in sorted({index for each in missing for index in each}):
                for rows, of_rows in zip(self._rows, missing, strict=True):
                    if index in of_rows:
                        rows.foam.remember(index)
            foam = self._shown(places, now)
        drift_x, drift_y = (float(now) * speed for speed in model.drift)
        return Fan(places.x + drift_x, places.y + drift_y, places.size, foam)

    @cached_property
    def _aside(self) -> float:
        """How far waves carry water sideways, m: as far as the significant ones do."""
        height = self._levels.seas[0].statistics().significant_wave_height
        return 0.5 * self._levels.parameters.choppiness * height

    def _new_rows(self, places: _Places) -> list[_Rows]:
        """Rows for each level that the picture shows."""
        number = np.log2(np.maximum(places.size[_ROWS_BEFORE:, 0] / FINEST, 1.0))
        found = []
        for level, sea in enumerate(self._levels.seas):
            below, above = (
                np.clip((number - at - _OVER) / (1.0 - _OVER), 0.0, 1.0) for at in (level - 1, level)
            )
            share = (below if level else np.ones_like(number)) * (1.0 - above)
            shown = np.flatnonzero(share > 0.0)
            if len(shown):
                rows = slice(_ROWS_BEFORE + shown[0], _ROWS_BEFORE + shown[-1] + 1)
                at = rows, slice(places.columns)
                foam = sea.new_drifting_foam(places.x[at].ravel(), places.y[at].ravel())
                found.append(_Rows(level, rows, share[shown[0] : shown[-1] + 1], foam))
        return found

    def _shown(self, places: _Places, now: Fraction) -> Whitecaps:
        beyond = self._levels.beyond
        seen = max(FINEST, float(places.size[_ROWS_BEFORE, 0]))
        total = [np.zeros(places.x.shape, np.float32) for _ in beyond]
        known = np.zeros(len(places.x), np.float32)
        most = np.zeros(places.x.shape, np.float32)
        for rows in self._rows:
            shape = len(rows.share), places.columns
            own = Whitecaps(*(field.reshape(shape) for field in rows.foam.whitecaps(now)))
            foam, breaking, age = self._levels.mixed(own, rows.level, seen)
            share = rows.share.astype(np.float32)[:, np.newaxis]
            at = rows.rows, slice(places.columns)
            known[rows.rows] += share[:, 0]
            total[0][at] += share * foam
            total[1][at] += share * breaking
            # the mean of two ages would be neither
            total[2][at] = np.where(share * foam >= most[at], age, total[2][at])
            most[at] = np.maximum(most[at], share * foam)
        rest = np.ones(places.x.shape, np.float32)
        rest[:, : places.columns] -= known[:, np.newaxis]
        total[0] += rest * beyond.foam
        total[1] += rest * beyond.breaking
        total[2] = np.where(rest * beyond.foam > most, beyond.foam_age, total[2])
        return Whitecaps(*total)


def _places(view: View, count: int, aside: float) -> _Places:
    """The places of a fan with at most this many.

    aside : distance from which water may have come into the picture, m
    """
    near = _NEARER * view.near
    farthest = max(view.reach, 2.0 * near)
    octaves = math.log(farthest / near)
    ratio = octaves / (2.0 * view.half_angle * _ON_FACES) if view.is_low else _ROWS_TO_COLUMNS
    # c columns with ratio·c rows, plus those beside the picture
    columns = int(math.sqrt(0.25 * _COLUMNS_BESIDE**2 + count / ratio) - 0.5 * _COLUMNS_BESIDE)
    rows = count // (columns + _COLUMNS_BESIDE) - _ROWS_BEFORE
    if view.is_low:
        dense = near * np.exp(np.linspace(0.0, octaves, rows))
    else:
        dense = near / np.linspace(1.0, math.sqrt(near / farthest), rows) ** 2
    before = near * np.linspace(_FOOT, 1.0, _ROWS_BEFORE + 1)[:-1]
    distance = np.concatenate((before, dense))
    half = np.minimum(view.half_angle + np.arctan(aside / distance), math.pi - _TURN)[:, np.newaxis]
    in_picture = half * np.linspace(-1.0, 1.0, columns)
    beside = half + 2.0 * (math.pi - half) * np.linspace(0.0, 1.0, _COLUMNS_BESIDE + 1)[1:]
    angle = view.azimuth + np.concatenate((in_picture, beside), axis=1)
    x = view.x + distance[:, np.newaxis] * np.cos(angle)
    y = view.y + distance[:, np.newaxis] * np.sin(angle)
    x[:, -1], y[:, -1] = x[:, 0], y[:, 0]
    along = np.concatenate((np.full(_ROWS_BEFORE, before[1] - before[0]), np.gradient(dense)))
    across = np.repeat(np.diff(beside[:, :2]), angle.shape[1], axis=1)
    across[:, :columns] = np.diff(in_picture[:, :2])
    across[:, -1] = across[:, 0]
    size = np.sqrt((along * distance)[:, np.newaxis] * across)
    return _Places(x, y, size, columns)
