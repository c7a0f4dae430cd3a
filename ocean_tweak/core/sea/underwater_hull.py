# SPDX-License-Identifier: GPL-3.0-or-later
"""The part of a hull below the waterline: how deep it is at each place, from its lines plan.

What a hull displaces is the water between its bottom and the waterline, in an open boat as in a closed one.
The area within each waterline of the plan, added up over the height, is this volume.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .hull_plan import LEVELS, HullPlan, Integers, hull_plan

Array = NDArray[np.float64]

#: of a footprint, rows and columns, steps from 0 to the greatest draught, and the least block coefficient: a
#: capsized hull displaces its planking
_SHAPE, _STEPS, _LEAST_BLOCK = (24, 64), 255.0, 0.05


def shares_of_draught(
    vertices: Array, triangles: Integers, level: float, low: tuple[float, float], high: tuple[float, float]
) -> Array:
    """(24, 64) draughts of a hull in the cells of a rectangle, [y, x], as shares of the greatest.

    vertices, triangles : (N, 3), z up, and (M, 3) of their numbers
    level : height of calm water, above the keel
    low, high : corners (x, y) of the rectangle around the part below it

    Raises ValueError, with the reason, for one that encloses nothing below the water.
    """
    if not len(triangles):
        raise ValueError("it has no faces")
    draught = level - float(np.min(vertices[:, 2]))
    shares = draughts_below(hull_plan(vertices, triangles), level, low, high, _SHAPE) / draught
    if shares.mean() < _LEAST_BLOCK:
        raise ValueError(
            f"it displaces {100.0 * shares.mean():.2g} % of its length, width and draught: it may be upside "
            "down, or have gaps below the water"
        )
    found: Array = np.rint(_STEPS * np.clip(shares, 0.0, 1.0)) / _STEPS
    return found


def draughts_below(
    plan: HullPlan, level: float, low: tuple[float, float], high: tuple[float, float], shape: tuple[int, int]
) -> Array:
    """(rows, columns) mean draughts in the cells of a rectangle, [y, x], in the unit of the plan.

    level : height of calm water, in the plan's axes
    low, high : corners (x, y) of the rectangle
    shape : rows and columns of the cells

    Their sum times the area of a cell is the displaced volume, if the rectangle holds the hull.
    """
    inside = np.clip(0.5 - plan.distance, 0.0, 1.0)  # share of each texel
    draughts: Array = np.tensordot(_heights_below(plan, level), inside, axes=1)
    for axis, (count, begin, first, last) in enumerate(
        zip(shape, plan.low[1::-1], low[::-1], high[::-1], strict=True)
    ):
        draughts = np.moveaxis(
            _averaged(np.moveaxis(draughts, axis, 0), begin, plan.texel, np.linspace(first, last, count + 1)),
            0,
            axis,
        )
    return draughts


def _heights_below(plan: HullPlan, level: float) -> Array:
    """(LEVELS,) heights that each waterline stands for up to a level: the plan is linear between them."""
    heights = plan.low[2] + plan.spacing * np.arange(LEVELS)
    part = np.clip((level - heights) / plan.spacing, 0.0, 1.0)
    weights = np.zeros(LEVELS)
    weights[:-1] += (part - 0.5 * part**2)[:-1]
    weights[1:] += (0.5 * part**2)[:-1]
    weights[-1] += max((level - heights[-1]) / plan.spacing, 0.0)
    return plan.spacing * weights


def _averaged(rows: Array, begin: float, texel: float, edges: Array) -> Array:
    """Means of rows of texels, the first of which begins somewhere, between edges; 0 beyond the texels."""
    total = np.concatenate([np.zeros((1, rows.shape[1])), np.cumsum(rows, axis=0)])
    place = np.clip((edges - begin) / texel, 0.0, len(rows))
    first = np.minimum(place.astype(np.intp), len(rows) - 1)
    share = (place - first)[:, np.newaxis]
    passed = total[first] * (1.0 - share) + total[first + 1] * share
    result: Array = np.diff(passed, axis=0) * (texel / np.diff(edges))[:, np.newaxis]
    return result
