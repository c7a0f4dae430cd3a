# SPDX-License-Identifier: GPL-3.0-or-later
"""The hull of the fishing boat: its lines as functions, and the solid that they give.

A place on the shell is told by `u`, 0 at the transom and 1 at the stem, and by its height `z` above the
waterline. x is towards the bow, y to port; lengths in m.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from .solids import Array, Paint, Solid, loft

#: over all, beam, and of the keel below the waterline aft
LENGTH, BEAM, DRAFT = 15.4, 5.0, 2.1
#: how much deeper it lies with fish in its hold
LADEN = 0.6
BULWARK = 0.8  # above the deck
#: where the foredeck rises to the rail, of the length
BREAK = 0.70

_WIDEST = 0.45  # of the length
_STEM = 0.06  # half of its breadth
_KEEL = 0.08
_THICKNESS = 0.12  # of the bulwark
_CAMBER = 0.06
#: from where to where a painted line goes round the hull above the waterline
_BOOT_TOP = (0.38, 0.22)
_TOP_BAND = 0.30  # of paint below the rail
_TRANSOM = 0.009  # thickness of its bulwark, of the length
_STATIONS, _ROWS, _ROWS_BELOW = 48, 5, 9

TOPSIDES, ANTIFOULING, WHITE, DECK, STEEL, GLASS, NET, LAMP = range(8)
PAINTS = (
    Paint("Boat Topsides", (0.46, 0.070, 0.016), 0.42),
    Paint("Boat Antifouling", (0.16, 0.018, 0.012), 0.6),
    Paint("Boat White", (0.64, 0.63, 0.58), 0.42),
    Paint("Boat Deck", (0.10, 0.13, 0.12), 0.6),
    Paint("Boat Steel", (0.035, 0.037, 0.04), 0.5),
    Paint("Boat Glass", (0.008, 0.011, 0.013), 0.06),
    Paint("Boat Net", (0.012, 0.055, 0.05), 0.9),
    Paint("Boat Lamp", (1.0, 0.86, 0.62), 0.2, light=6.0),
)


def rail(u: ArrayLike) -> Array:
    """Height of the rail: the sheer."""
    aft, fore = np.clip(1.0 - np.asarray(u) / 0.4, 0.0, None), np.clip((np.asarray(u) - 0.4) / 0.6, 0.0, None)
    return 1.75 + 0.25 * aft**2 + 1.75 * fore**2


def shell(u: ArrayLike, z: ArrayLike) -> Array:
    """(..., 3) places of the shell, to port."""
    u, z = np.broadcast_arrays(np.asarray(u, np.float64), np.asarray(z, np.float64))
    transom = -7.3 - 0.12 * z
    stem = 6.6 + np.where(z > 0.0, 0.28 * z + 0.028 * z**2, 0.28 * z - 0.22 * z**2)
    return np.stack([transom + u * (stem - transom), _half_breadth(u, z), z], axis=-1)


def _half_breadth(u: Array, z: Array) -> Array:
    at_rail = _plan(u, 0.5 * BEAM, 0.14, 2.7)
    at_water = _plan(u, 0.47 * BEAM, 0.24, 1.9)
    height, depth = np.clip(z / rail(u), 0.0, 1.0), np.clip(-z / _keel(u), 0.0, 1.0)
    flare = at_water + (at_rail - at_water) * height ** (1.2 + 0.9 * u**3)
    # round bilges amidships, lean ends
    full = np.exp(-(((u - 0.5) / 0.28) ** 2))
    below = _KEEL + (at_water - _KEEL) * (1.0 - depth ** (1.4 + 1.8 * full)) ** (1.0 - 0.45 * full)
    return np.where(z > 0.0, flare, below)


def _plan(u: Array, widest: float, taper: float, entrance: float) -> Array:
    """Half breadth of a waterline: a little narrower at the transom, and pointed at the stem."""
    aft, fore = np.clip(1.0 - u / _WIDEST, 0.0, None), np.clip((u - _WIDEST) / (1.0 - _WIDEST), 0.0, None)
    return _STEM + (widest - _STEM) * (1.0 - taper * aft**2) * (1.0 - fore**entrance)


def _keel(u: Array) -> Array:
    """Depth of the keel's line, which rises towards the bow."""
    return DRAFT - 0.5 * u


def hull() -> Solid:
    """Shell, bulwark and deck in one."""
    # the bulwark goes on across the transom; there and at the break stations are close together
    usual = 1.0 - np.linspace(1.0, 0.0, _STATIONS)[1:] ** 1.35
    u = np.sort([0.0, _TRANSOM - 5e-4, _TRANSOM + 5e-4, BREAK - 5e-4, BREAK + 5e-4, *usual])[:, np.newaxis]
    port = np.concatenate([_inside(u), _outside(u)], axis=1)
    # from the middle of the deck to starboard, down to the keel, and up to port
    rings = np.concatenate([port * (1.0, -1.0, 1.0), port[:, ::-1]], axis=1)
    rows = [DECK, WHITE, WHITE, WHITE, *[TOPSIDES] * _ROWS, WHITE, *[ANTIFOULING] * _ROWS_BELOW]
    return loft(rings, [*rows, ANTIFOULING, *rows[::-1], DECK])


def strip(above_rail: float, profile: Sequence[tuple[float, float]], paint: int, aft: float = 0.0) -> Solid:
    """A bar along the port side, from the stern or `aft` to the stem.

    above_rail : its height
    profile : outwards from the shell and upwards, counter-clockwise seen from the bow with port to the right
    """
    u = np.linspace(aft, 1.0, _STATIONS)[:, np.newaxis]
    offsets = np.array([(0.0, outward, upward) for outward, upward in profile])
    return loft(shell(u, rail(u) + above_rail) + offsets, paint)


def _inside(u: Array) -> Array:
    """(n, 3, 3) places to port: on the deck, at its edge, on the rail within the bulwark."""
    top = rail(u)
    # a deck as high as the rail closes the transom's bulwark and the foredeck
    level = np.where((u < _TRANSOM) | (u > BREAK), top + 0.02, top - BULWARK)
    at_rail = shell(u, top)
    breadth = at_rail[..., 1]
    inner = np.maximum(breadth - _THICKNESS, 0.85 * breadth)
    edge = np.minimum(0.98 * inner, shell(u, np.minimum(level, top))[..., 1] - 0.1 * breadth.clip(0.0, 0.8))
    rows = ((0.3 * breadth, level + _CAMBER), (edge, level), (inner, top + 0.01))
    return np.stack(
        [np.concatenate([at_rail[..., 0], y, z], axis=1) for y, z in rows],
        axis=1,
    )


def _outside(u: Array) -> Array:
    """(n, …, 3) places to port: from the rail down to the keel."""
    top, (boot, below) = rail(u) - _TOP_BAND, _BOOT_TOP
    share = np.linspace(0.0, 1.0, _ROWS + 1)
    depth = np.linspace(0.0, 1.0, _ROWS_BELOW + 1)
    # closer together at the keel, where the shell curves in
    deep = below - (below + _keel(u)) * (1.0 - (1.0 - depth) ** 1.5)
    return shell(u, np.concatenate([rail(u), top + (boot - top) * share, deep], axis=1))
