# SPDX-License-Identifier: GPL-3.0-or-later
"""Built-in beds: heights above still water in m, over a square of 512 m with the shore towards +x."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ...numerics.interpolation import smoothstep

Array = NDArray[np.float64]

#: side of the square, and sample spacing, m
SIDE, SPACING = 512.0, 2.0


def grid() -> tuple[Array, Array]:
    """x and y in m of the samples, (257, 257) each."""
    along = np.arange(0.0, SIDE + SPACING, SPACING)
    x, y = np.meshgrid(along, along)
    return x, y


def beach(x: Array, y: Array) -> Array:
    """A sandy bay between rocky headlands, with a bar before it, dunes behind."""
    off = y - 0.5 * SIDE
    head = 150.0 * np.exp(-(((np.abs(off) - 0.5 * SIDE) / 55.0) ** 2))
    shore = 385.0 + 12.0 * np.cos(2.0 * np.pi * off / 170.0) - head
    out = shore - x
    bar = 1.1 * np.exp(-(((out - 75.0 - 8.0 * np.sin(off / 40.0)) / 18.0) ** 2))
    below = -np.minimum(0.09 * np.maximum(out, 0.0) ** 0.84 * 1.15, 13.0) + bar * (out > 0.0)
    above = 6.0 * (1.0 - np.exp(-np.maximum(-out, 0.0) / 70.0)) + 3.5 * smoothstep((-out - 38.0) / 35.0)
    cliff = 9.0 * smoothstep(-out / 16.0) + 3.0 * smoothstep((25.0 - out) / 30.0)
    rock = smoothstep((head - 22.0) / 55.0) * cliff
    return np.where(out > 0.0, below, above) + rock * (1.0 + 0.35 * _rough(x, y))


def harbour(x: Array, y: Array) -> Array:
    """A basin behind two moles with a gap between them, a quay at its end."""
    bottom = -12.0 + 5.0 * smoothstep((x - 200.0) / 200.0)
    off = y - 0.5 * SIDE
    mole = np.hypot(np.maximum(np.abs(x - 210.0) - 4.0, 0.0), np.maximum(36.0 - np.abs(off), 0.0))
    wall = 2.6 * smoothstep((3.0 - mole) / 3.0)
    quay = smoothstep((x - 455.0) / 3.0)
    stone = np.where(wall > 0.0, wall - 14.0 * (1.0 - smoothstep((3.0 - mole) / 2.0)), bottom)
    return stone * (1.0 - quay) + 2.4 * quay


def islet(x: Array, y: Array) -> Array:
    """A rock of a hundred metres in deep water."""
    r = np.hypot(x - 250.0, (y - 0.5 * SIDE) * 0.8) + 9.0 * _rough(x, y)
    return np.maximum(-16.0, 11.0 - 0.30 * r + 6.0 * smoothstep((30.0 - r) / 30.0))


#: by name
BEDS: dict[str, Callable[[Array, Array], Array]] = {"BEACH": beach, "HARBOUR": harbour, "ISLET": islet}


def _rough(x: Array, y: Array) -> Array:
    """Pseudo-noise of about -1…1, from a few waves in different directions."""
    angles, lengths = (0.3, 1.7, 2.6, 4.1, 5.2, 0.9), (61.0, 43.0, 29.0, 19.0, 13.0, 9.0)
    total = np.zeros(np.broadcast_shapes(x.shape, y.shape))
    for number, (angle, length) in enumerate(zip(angles, lengths, strict=True)):
        phase = 2.0 * np.pi / length * (x * np.cos(angle) + y * np.sin(angle)) + 1.9 * number
        total += np.sin(phase) / (1.0 + 0.5 * number)
    return 0.6 * total
