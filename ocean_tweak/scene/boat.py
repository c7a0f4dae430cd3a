# SPDX-License-Identifier: GPL-3.0-or-later
"""A small stern trawler, 15 m long: hull, wheelhouse, mast and gear, with its waterline at the origin.

Its bow points along +x; lengths in m, port is +y.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import bpy
import numpy as np
from numpy.typing import ArrayLike

from .boat_hull import (
    BULWARK,
    GLASS,
    LAMP,
    NET,
    PAINTS,
    STEEL,
    TOPSIDES,
    WHITE,
    hull,
    rail,
    shell,
    strip,
)
from .solids import Array, Solid, house, lathe, loft, new_object, tube

Point = tuple[float, float, float]
#: as of `house`: height, back, front and half of the breadth
Level = tuple[float, float, float, float]

_DECKHOUSE = ((0.85, -1.9, 3.5, 1.55), (2.75, -1.9, 3.3, 1.5), (2.85, -1.8, 3.2, 1.4))
_WHEELHOUSE = ((2.8, -0.5, 2.55, 1.3), (3.65, -0.5, 2.6, 1.3), (4.75, -0.45, 2.95, 1.22))
_ROOF = ((4.75, -0.8, 3.25, 1.4), (4.85, -0.85, 3.3, 1.45), (4.95, -0.75, 3.15, 1.32))
_MAST_TOP = (-1.1, 0.0, 9.6)
_BOOM_END = (-6.2, 0.0, 6.6)
_GANTRY = (-6.55, 1.75, 4.7)  # its port upper corner


def new_boat(name: str, metres: float = 1.0) -> bpy.types.Object:
    """A fishing boat; in no collection yet.

    metres : in a Blender unit
    """
    return new_object(name, _solids(), PAINTS, metres)


def _solids() -> Iterator[Solid]:
    yield hull()
    for paired in (
        *_strips(),
        *_portholes(),
        *_foredeck_rail(),
        *_sides_of_houses(),
        *_gantry_side(),
        *_shrouds(),
    ):
        yield paired
        yield paired.mirrored()
    yield from _houses()
    yield from _on_the_roof()
    yield from _mast()
    yield from _stern_gear()


def _strips() -> Iterator[Solid]:
    """The rubbing strake at the height of the deck, and the capping of the rail."""
    yield strip(-BULWARK, ((-0.05, -0.12), (0.10, -0.06), (0.10, 0.06), (-0.05, 0.12)), STEEL)
    yield strip(0.0, ((-0.16, 0.0), (0.05, 0.0), (0.05, 0.07), (-0.16, 0.07)), STEEL)


def _portholes() -> Iterator[Solid]:
    """Three in the bow below the foredeck: a rim and its glass."""
    for u in (0.76, 0.82, 0.88):
        height = float(rail(u)) - 1.15
        middle, along, up = shell([u, u + 0.01, u], [height, height, height + 0.05])
        normal = np.cross(up - middle, along - middle)
        normal /= np.linalg.norm(normal)
        beside = np.cross(normal, (0.0, 0.0, 1.0))
        beside /= np.linalg.norm(beside)
        for radius, depth, paint in ((0.21, 0.03, WHITE), (0.15, 0.045, GLASS)):
            angle = np.linspace(0.0, 2.0 * np.pi, 16, endpoint=False)[:, np.newaxis]
            circle = middle + radius * (np.cos(angle) * beside + np.sin(angle) * np.cross(normal, beside))
            yield loft([circle - 0.15 * normal, circle + depth * normal], paint)


def _foredeck_rail() -> Iterator[Solid]:
    """Stanchions and two bars."""
    u = np.linspace(0.715, 0.985, 9)
    feet = shell(u, rail(u))
    feet[:, 1] = np.maximum(feet[:, 1] - 0.12, 0.0)
    middle, top = (feet + np.array([0.0, 0.0, height]) for height in (0.45, 0.85))
    for bar in (middle, top, *np.stack([feet, top], axis=1)):
        yield tube(bar, 0.025, WHITE, 6)


def _houses() -> Iterator[Solid]:
    yield house(_DECKHOUSE, WHITE)
    yield house(_WHEELHOUSE, WHITE)
    yield house(_ROOF, TOPSIDES, 0.25)
    yield from _panes(_wall(_WHEELHOUSE[1:], "front"), 3, (0.08, 0.8))
    yield from _panes(_wall(_WHEELHOUSE[1:], "back"), 2, (0.15, 0.75))
    back = _DECKHOUSE[0][1]
    door = ((back, 0.9, 1.05), (back, 0.1, 1.05), (back, 0.1, 2.65), (back, 0.9, 2.65))
    yield from _panes(door, 1, (0.0, 1.0), STEEL)


def _sides_of_houses() -> Iterator[Solid]:
    """Windows to port, and a life ring behind them."""
    yield from _panes(_wall(_WHEELHOUSE[1:], "port"), 3, (0.08, 0.8))
    fore, aft, above_aft, above_fore = np.array(_wall(_DECKHOUSE[:2], "port"))
    part = (fore, fore + 0.7 * (aft - fore), above_fore + 0.7 * (above_aft - above_fore), above_fore)
    yield from _panes(part, 3, (0.48, 0.8), GLASS, 0.25)
    angle = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
    circle = np.stack([-1.15 + 0.31 * np.cos(angle), np.full(24, 1.60), 2.05 + 0.31 * np.sin(angle)], axis=-1)
    yield tube(circle, 0.075, TOPSIDES, 10, is_closed=True)


def _wall(levels: Sequence[Level], side: str) -> list[Point]:
    """Corners of the "front", "back" or "port" wall between two levels, as `_panes` takes them."""

    def ends(level: Level) -> list[Point]:
        height, back, front, half = level
        places = {
            "front": ((front, -half), (front, half)),
            "back": ((back, half), (back, -half)),
            "port": ((front, half), (back, half)),
        }
        return [(x, y, height) for x, y in places[side]]

    return [*ends(levels[0]), *ends(levels[1])[::-1]]


def _panes(
    corners: Sequence[ArrayLike],
    count: int,
    heights: tuple[float, float],
    paint: int = GLASS,
    gap: float = 0.10,
) -> Iterator[Solid]:
    """Panes side by side on a flat wall.

    corners : of the wall seen from outside, counter-clockwise from below left
    heights : of the panes' lower and upper edges, as shares of the wall's height
    gap : beside each pane, of its width
    """
    first, second, third, fourth = np.array(corners)
    normal = np.cross(second - first, fourth - first)
    normal /= np.linalg.norm(normal)

    def place(across: float, up: float) -> Array:
        return (first + across * (second - first)) * (1.0 - up) + (fourth + across * (third - fourth)) * up

    low, high = heights
    for number in range(count):
        left, right = (number + gap) / count, (number + 1.0 - gap) / count
        ring = np.array([place(left, low), place(right, low), place(right, high), place(left, high)])
        yield loft([ring - 0.05 * normal, ring + 0.02 * normal], paint)


def _on_the_roof() -> Iterator[Solid]:
    """Radar, life raft, exhaust and the lamp above the windows."""
    yield tube([(1.9, 0.0, 4.9), (1.9, 0.0, 5.55)], 0.09, WHITE)
    yield house([(5.55, 1.78, 2.02, 0.75), (5.72, 1.80, 2.00, 0.73)], WHITE, 0.03)
    yield lathe([(0.2, -0.6), (0.29, -0.52), (0.29, 0.52), (0.2, 0.6)], WHITE, 20, (0.1, 0.75, 5.22), axis=0)
    yield tube([(-1.4, -1.0, 2.7), (-1.4, -1.0, 5.3), (-1.62, -1.0, 5.55)], 0.13, STEEL)
    yield house([(4.93, 2.7, 2.95, 0.16), (5.12, 2.72, 2.93, 0.14)], STEEL, 0.02)


def _mast() -> Iterator[Solid]:
    """The mast with its lamp and yard, the derrick, and the wires that hold them."""
    foot = (_MAST_TOP[0], 0.0, 2.7)
    yield tube([foot, _MAST_TOP], [0.13, 0.07], WHITE)
    yield tube([(-1.1, -0.85, 8.3), (-1.1, 0.85, 8.3)], 0.04, WHITE, 8)
    for side in (-0.8, 0.8):
        yield tube([(-1.1, side, 8.3), (-1.1, side, 10.4)], 0.014, STEEL, 6)
    yield lathe([(0.09, 0.0), (0.13, 0.03), (0.13, 0.24), (0.06, 0.3)], LAMP, 16, (-0.93, 0.0, 8.75))
    yield lathe([(0.06, 0.0), (0.08, 0.02), (0.08, 0.16), (0.04, 0.2)], LAMP, 16, _MAST_TOP)
    yield tube([(-1.2, 0.0, 3.9), _BOOM_END], [0.09, 0.06], WHITE)
    yield _wire(_MAST_TOP, _BOOM_END)
    yield _wire(_MAST_TOP, (7.3, 0.0, 3.55))
    yield _wire(_BOOM_END, (-4.9, 0.0, 2.3))


def _shrouds() -> Iterator[Solid]:
    """To port, from the mast to the rail and to the gantry."""
    for x in (-2.4, -0.6):
        yield _wire((-1.1, 0.0, 9.0), (x, 2.4, 1.75))
    yield _wire((-1.1, 0.0, 9.3), _GANTRY)


def _wire(first: Point, last: Point) -> Solid:
    return tube([first, last], 0.016, STEEL, 6)


def _gantry_side() -> Iterator[Solid]:
    """The port half of the gallows at the stern, with its trawl door; and what bears the net drum."""
    x, y, z = _GANTRY
    yield tube([(x, y + 0.2, 1.0), (x, y, z)], 0.12, TOPSIDES)
    yield tube([(x + 1.5, y + 0.25, 1.0), (x, y, z - 0.9)], 0.08, TOPSIDES)
    yield loft(
        [[(x - 1.05, y + 0.62 + d, 1.35), (x + 0.35, y + 0.52 + d, 1.35), (x + 0.25, y + 0.40 + d, 2.55),
          (x - 0.95, y + 0.50 + d, 2.55)] for d in (0.10, 0.0)],
        STEEL,
    )  # fmt: skip
    yield _wire((x, y, z - 0.1), (x - 0.3, y + 0.5, 2.5))
    yield tube([(-4.9, 1.28, 0.9), (-4.9, 1.28, 2.05)], 0.11, STEEL)


def _stern_gear() -> Iterator[Solid]:
    """The gantry's beam, the net drum with its net, and the winch."""
    x, y, z = _GANTRY
    yield tube([(x, -y - 0.25, z), (x, y + 0.25, z)], 0.13, TOPSIDES)
    drum = (-4.9, 0.0, 1.85)
    net = np.linspace(-1.05, 1.05, 15)
    radius = 0.62 + 0.05 * np.cos(5.0 * net) + 0.03 * np.sin(13.0 * net)
    yield lathe(np.stack([radius, net], axis=-1), NET, 24, drum, axis=1)
    for side in (-1.12, 1.12):
        yield lathe([(0.88, side - 0.05), (0.88, side + 0.05)], TOPSIDES, 32, drum, axis=1)
    yield lathe([(0.3, -0.7), (0.3, 0.7)], STEEL, 20, (-2.75, 0.0, 1.4), axis=1)
    yield house([(0.9, -3.1, -2.4, 0.9), (1.2, -3.0, -2.5, 0.85)], STEEL)
