# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures on the picture of boats in a harbour at which angle from its course the ferry's wake ends. Wants
Pillow.

python3 examples/wake_angle.py
python3 examples/wake_angle.py build/wakes/harbour-wakes.png
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

Array = NDArray[np.floating]

PICTURE = Path(__file__).resolve().parents[1] / "docs" / "gallery" / "harbour-wakes.jpg"
#: m across the picture, whose middle is 0, 0; of the ferry, which goes to the right, m/s, place and length
WIDE, SPEED, FERRY, LENGTH = 320.0, 5.0, (108.0, -24.0), 17.0


def main() -> None:
    """Print the angle on a picture."""
    path = Path(sys.argv[1]) if len(sys.argv) > 1 else PICTURE
    angle = measured_angle(np.asarray(Image.open(path).convert("L"), np.float64))
    print(f"{path.name}: the wake's edge is {angle:.1f}° from the course; Kelvin's: 19.47°")


def measured_angle(grey: Array) -> float:
    """The edge of the ferry's wake, degrees to starboard of its course: where brightness along rays from its
    bow varies half as much as where it varies most, from 60 to 160 m astern.
    """
    distance = np.arange(60.0, 160.0, 0.2)
    angles = np.arange(10.0, 26.0, 0.1)
    rows, columns = grey.shape
    scale = columns / WIDE
    smooth = _blurred(grey)  # without what the wind raises, as far as it is shorter
    found = np.zeros(len(angles))
    for number, angle in enumerate(np.radians(angles)):
        x, y = FERRY[0] + 0.5 * LENGTH - distance, FERRY[1] - distance * np.tan(angle)
        column = np.rint(0.5 * columns + x * scale).astype(int)
        row = np.minimum(np.rint(0.5 * rows - y * scale).astype(int), rows - 1)
        line = smooth[row, column]
        found[number] = np.std(line - _mean(line, 60))
    found = _mean(found, 7)
    outside = found[angles > 24.0].mean()  # of what the wind raises
    highest = int(found[angles < 21.0].argmax())
    beyond = found[highest:] < outside + 0.5 * (found[highest] - outside)
    return float(angles[highest + int(np.argmax(beyond))])


def _blurred(grey: Array) -> Array:
    """Means of 3 by 3 pixels."""
    padded = np.pad(grey, 1, mode="edge")
    rows, columns = grey.shape
    parts = [padded[i : i + rows, j : j + columns] for i in range(3) for j in range(3)]
    return np.mean(parts, axis=0)


def _mean(line: Array, width: int) -> Array:
    """Running mean."""
    padded = np.pad(line, width, mode="edge")
    return np.convolve(padded, np.ones(width) / width, "same")[width:-width]


if __name__ == "__main__":
    main()
