# SPDX-License-Identifier: GPL-3.0-or-later
"""The bed as waves meet it: on samples along the march, flat before it, and the same at both of its ends.

The samples lie on those of the sea's first patch where they are as far apart, and their rows are along whole
patches: the waves of that patch, and so the field over the bed, repeat along the shore.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...data.errors import ParameterError
from ...numerics.interpolation import Between, between, smoothstep
from ..contribution import RealArray
from .parameters import SHORES, Coast

Array = NDArray[np.float64]

#: share of the width at whose ends the bed goes over into what is at the other end
_ENDS = 0.1
#: rows before the rim: derivatives reach so far
_BEFORE = 5
#: share of the flat rim in which the coast comes in; in the rest all waves of a frequency become one
_COMES_IN = 0.75
#: samples that the rim holds at least
LEAST_RIM = 12
#: samples of the march, at the most
_MOST = 4096


@dataclass(frozen=True)
class Ground:
    """Samples (rows, columns) over a bed: rows run from offshore to the shore.

    coast : whose bed it is
    domain_size : of the first patch, m
    rotation : of the first patch, rad
    deep : of the open sea, m
    step : between samples, m
    rows, columns : how many there are
    first : place of the first sample along the march and along its rows, m, from the sea's origin
    """

    coast: Coast
    domain_size: float
    rotation: float
    deep: float
    step: float
    rows: int
    columns: int
    first: tuple[float, float]

    @classmethod
    def of(cls, coast: Coast, domain_size: float, resolution: int, rotation: float, deep: float) -> Ground:
        """Raises ParameterError, with the remedy, for a bed that is too large or that waves cannot reach."""
        step = domain_size / max(2, round(domain_size / (coast.step or domain_size / resolution)))
        along, across = _extent(coast)
        begin = along[0] - 2.0 * coast.rim
        first = step * (math.floor(begin / step) - _BEFORE), step * math.floor(across[0] / step)
        rows = math.ceil((along[1] - first[0]) / step) + 1
        patches = math.ceil((across[1] - first[1]) / domain_size - 1e-6)
        columns = patches * round(domain_size / step)
        if coast.rim < LEAST_RIM * step:
            reason = f"must be at least {LEAST_RIM * step:g} m, {LEAST_RIM} samples of the waves"
            raise ParameterError("coast.rim", coast.rim, reason)
        for name, count in (("rows", rows), ("columns", columns)):
            if count > _MOST:
                raise ParameterError(
                    "coast.step", step,
                    f"makes {count} {name} of samples over the bed, more than {_MOST}: give a larger step, "
                    "or a smaller bed",
                )  # fmt: skip
        ground = cls(coast, domain_size, rotation, deep, step, rows, columns, first)
        ground.depth  # noqa: B018  what is wrong with it is told now
        return ground

    @property
    def turn(self) -> float:
        """From the sea's +x to the march, rad counter-clockwise."""
        return self.rotation + _quarter(self.coast) * 0.5 * math.pi

    @cached_property
    def depth(self) -> Array:
        """(rows, columns) m, 0 and less on land."""
        coast = self.coast
        (begin, _), (low, high) = _extent(coast)
        along = self._along(self.rows)
        across = self.first[1] + self.step * np.arange(self.columns, dtype=np.float64)
        bed = self._read(np.maximum(along, begin)[:, np.newaxis], np.minimum(across, high))
        edges = [self._read(np.maximum(along, begin)[:, np.newaxis], np.array([end])) for end in (low, high)]
        bed = _joined(bed, edges, across, low, high)
        edge = bed[math.ceil((begin - self.first[0]) / self.step)]
        if (edge <= 0.0).any():
            raise ParameterError(
                "coast.shore", coast.shore,
                f"the bed has land, {edge.min():.3g} m deep, at the opposite side, where waves come in: "
                "extend it to deeper water, choose another side, or give depths, positive downwards",
            )  # fmt: skip
        # the open sea's own depth over the first rim, and over the second from there to the bed's own edge
        sinks = smoothstep((along - (begin - coast.rim)) / coast.rim)[:, np.newaxis]
        return np.where(along[:, np.newaxis] < begin, self.deep + sinks * (edge - self.deep), bed)

    @property
    def rim_rows(self) -> int:
        """Rows in which the depth is the open sea's."""
        begin = _extent(self.coast)[0][0]
        return max(1, math.floor((begin - self.coast.rim - self.first[0]) / self.step) + 1)

    @cached_property
    def blend(self) -> Array:
        """(rows,) share of the coast: 0 in the open sea, 1 over the bed, and less again behind water."""
        along = self._along(self.rows)
        (begin, end), _ = _extent(self.coast)
        share = smoothstep((along - begin + 2.0 * self.coast.rim) / (_COMES_IN * self.coast.rim))
        if (self.depth[-1] > 0.0).any():
            share *= 1.0 - smoothstep((along - end + self.coast.rim) / (self.coast.rim - self.step))
        return share

    @property
    def bed_share(self) -> Array:
        """(rows,) 0 over the flat rim, 1 over the bed, and smooth over what sinks from it."""
        begin = _extent(self.coast)[0][0]
        return smoothstep((self._along(self.rows) - begin + self.coast.rim) / self.coast.rim)

    @cached_property
    def late_on_rim(self) -> Array:
        """(rim_rows,) 0 where the coast comes in, and from there to 1 at the last row of the flat rim."""
        along = self._along(self.rim_rows)
        since = along - (_extent(self.coast)[0][0] - (2.0 - _COMES_IN) * self.coast.rim)
        return smoothstep(since / (along[-1] - along[0] - _COMES_IN * self.coast.rim))

    @property
    def places(self) -> tuple[Array, Array]:
        """x and y of each sample, (rows, columns) m."""
        across = self.first[1] + self.step * np.arange(self.columns, dtype=np.float64)
        along, across = np.meshgrid(self._along(self.rows), across, indexing="ij")
        c, s = math.cos(self.turn), math.sin(self.turn)
        return c * along - s * across, s * along + c * across

    def between(self, x: Array, y: Array) -> Between:
        """Where places in m lie among the samples: beyond the first and last rows on these."""
        return between(*self._samples(x, y), self.depth.shape)

    def nearest(self, x: Array, y: Array) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """Row and column of the sample next to places in m."""
        row, column = self._samples(x, y)
        return np.rint(row).astype(np.intp), np.rint(column).astype(np.intp) % self.columns

    def _samples(self, x: Array, y: Array) -> tuple[Array, Array]:
        """Places in m in samples: rows end with the first and the last."""
        c, s = math.cos(self.turn), math.sin(self.turn)
        along, across = c * x + s * y, c * y - s * x
        row = np.clip((along - self.first[0]) / self.step, 0.0, self.rows - 1 - 1e-9)
        return row, (across - self.first[1]) / self.step

    def _along(self, rows: int) -> Array:
        return self.first[0] + self.step * np.arange(rows, dtype=np.float64)

    def _read(self, along: Array, across: Array) -> Array:
        """Depth of the raster at places along the march, clamped to it."""
        raster = self.coast.depth
        assert raster is not None
        angle = 0.5 * math.pi * _quarter(self.coast)
        c, s = round(math.cos(angle)), round(math.sin(angle))
        column = (c * along - s * across - self.coast.x) / self.coast.spacing
        row = (s * along + c * across - self.coast.y) / self.coast.spacing
        rows, columns, _ = raster.shape
        values = raster.values[..., 0]
        # at its last row and column a place lies in the cell before
        row, column = np.clip(row, 0.0, rows - 1 - 1e-9), np.clip(column, 0.0, columns - 1 - 1e-9)
        row, column = np.broadcast_arrays(row, column)
        return np.asarray(between(row, column, values.shape).read(values), np.float64)


def _quarter(coast: Coast) -> int:
    return SHORES.index(coast.shore)


def _extent(coast: Coast) -> tuple[tuple[float, float], tuple[float, float]]:
    """First and last place of the bed along the march and across it, m, in the first patch's axes."""
    assert coast.depth is not None
    rows, columns, _ = coast.depth.shape
    x = coast.x, coast.x + (columns - 1) * coast.spacing
    y = coast.y, coast.y + (rows - 1) * coast.spacing
    turned = {"+X": (x, y), "+Y": (y, x[::-1]), "-X": (x[::-1], y[::-1]), "-Y": (y[::-1], x)}
    signs = {"+X": (1, 1), "+Y": (1, -1), "-X": (-1, -1), "-Y": (-1, 1)}
    (along, across), (a, b) = turned[coast.shore], signs[coast.shore]
    return (a * along[0], a * along[1]), (b * across[0], b * across[1])


def _joined(bed: Array, edges: list[Array], across: RealArray, low: float, high: float) -> Array:
    """The bed whose ends meet: towards each, and in what is left of the width, the mean of both."""
    half = 0.5 * (edges[1] - edges[0])
    reach = _ENDS * (high - low)
    at_low = 1.0 - smoothstep((across - low) / reach)
    at_high = 1.0 - smoothstep((high - across) / reach)
    joined: Array = bed + half * (at_low - at_high)
    return joined
