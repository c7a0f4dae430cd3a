# SPDX-License-Identifier: GPL-3.0-or-later
"""Derivatives of fields that are known on water: of the eighth order, and near land between what is water."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

RealArray = NDArray[np.floating]

#: what samples so far ahead count, less those as far behind (Fornberg 1988, table 1)
_WEIGHTS = (4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0)


class Differences:
    """Of fields (rows, columns) that repeat along their rows' samples, and end along the others.

    wet : (rows, columns) where they are known
    step : between samples, m
    """

    def __init__(self, wet: NDArray[np.bool_], step: float) -> None:
        self._step = step
        self._plans = tuple(self._plan(_padded(wet, axis), axis) for axis in (0, 1))

    def by(self, field: RealArray, axis: int) -> RealArray:
        """The derivative along the rows' order, axis 0, or along a row, axis 1."""
        wide, result = _padded(field, axis), np.zeros_like(field)
        for ahead, weight in enumerate(_WEIGHTS, 1):
            part = _shifted(wide, ahead, axis) - _shifted(wide, -ahead, axis)
            part *= field.dtype.type(weight / self._step)
            result += part
        near, onwards, back = self._plans[axis]
        here = field.reshape(-1)[near]
        ahead_of, behind = (_shifted(wide, by, axis).reshape(-1)[near] for by in (1, -1))
        result.reshape(-1)[near] = onwards * (ahead_of - here) + back * (here - behind)
        return result

    def _plan(self, wide: NDArray[np.bool_], axis: int) -> tuple[NDArray[np.intp], RealArray, RealArray]:
        """Samples that are too near to land, and what the steps onwards and back from them count."""
        reach = range(-len(_WEIGHTS), len(_WEIGHTS) + 1)
        far = np.all([_shifted(wide, by, axis) for by in reach], axis=0)
        near = np.flatnonzero(~far)
        here, onwards, back = (_shifted(wide, by, axis).reshape(-1)[near] for by in (0, 1, -1))
        counts = (here & onwards).astype(np.float32), (here & back).astype(np.float32)
        both = np.maximum(counts[0] + counts[1], 1.0) * np.float32(self._step)
        return near, counts[0] / both, counts[1] / both


def _padded(field: NDArray, axis: int) -> NDArray:  # type: ignore[type-arg]
    """The field with as many samples before and behind as differences reach; beyond the last rows there is
    nothing, and no water."""
    width = [(0, 0), (0, 0)]
    width[axis] = (len(_WEIGHTS), len(_WEIGHTS))
    return np.pad(field, width, mode="wrap" if axis else "constant")


def _shifted(wide: NDArray, by: int, axis: int) -> NDArray:  # type: ignore[type-arg]
    """Of a padded field, the samples so far ahead of each."""
    reach = len(_WEIGHTS)
    part = slice(reach + by, wide.shape[axis] - reach + by)
    return wide[part] if axis == 0 else wide[:, part]
