# SPDX-License-Identifier: GPL-3.0-or-later
"""The spectrum drawn into an array of pixels: each layer's S over period, and all energy over direction.

Blender's panels have no curves, but they show pictures. This one is made with NumPy alone.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core import OceanParameters
from ..core.numerics.interpolation import between
from ..core.spectral.equaliser import LEAST_GAIN, MOST_GAIN
from ..core.statistics.sea_spectrum import FrequencyCurves, PolarDensity, frequency_curves, polar_density

Pixels = NDArray[np.float32]

#: pixels along each side of the picture
SIZE = 384
_CURVES_HEIGHT = 172
_MARGIN = 10
_LABELS = 26  # pixels under the curves

_PAPER = (0.09, 0.10, 0.115)
_BAND = (0.16, 0.185, 0.21)
_GRID = (0.26, 0.28, 0.30)
_TEXT = (0.72, 0.74, 0.76)
#: told apart by people who see colours in another way too (Okabe & Ito 2008)
_LAYERS = (
    (0.34, 0.71, 0.91),
    (0.90, 0.62, 0.0),
    (0.0, 0.62, 0.45),
    (0.80, 0.47, 0.65),
    (0.94, 0.89, 0.26),
    (0.84, 0.37, 0.0),
)
#: from no energy to the most
_HEAT = np.array([(0.09, 0.10, 0.115), (0.10, 0.28, 0.45), (0.20, 0.62, 0.72), (0.98, 0.97, 0.80)])
#: periods in s that get a mark, where they are shown
_MARKS = (0.2, 0.5, 1, 2, 5, 10, 20, 50)

#: 3 x 5 pixels, row by row from the top
_GLYPHS = {
    "0": "111101101101111", "1": "010110010010111", "2": "111001111100111", "5": "111100111001111",
    ".": "000000000000010", "s": "011100010001110", " ": "000000000000000",
}  # fmt: skip


class _Frame(NamedTuple):
    """A rectangle of the picture: first column and row from the bottom, size."""

    x: int
    y: int
    width: int
    height: int


def spectrum_plot(parameters: OceanParameters) -> Pixels:
    """(SIZE, SIZE, 4) float32, row 0 at the bottom, display colours; the picture of a sea's spectrum."""
    picture = np.ones((SIZE, SIZE, 4), np.float32)
    picture[..., :3] = _PAPER
    below = SIZE - _CURVES_HEIGHT
    _draw_curves(
        picture,
        frequency_curves(parameters, SIZE - 2 * _MARGIN),
        _Frame(_MARGIN, below + _LABELS, SIZE - 2 * _MARGIN, _CURVES_HEIGHT - _LABELS - _MARGIN),
    )
    diameter = below - _MARGIN
    _draw_polar(
        picture,
        polar_density(parameters),
        _Frame((SIZE - diameter) // 2, _MARGIN // 2, diameter, diameter),
    )
    return picture


def _draw_curves(picture: Pixels, curves: FrequencyCurves, frame: _Frame) -> None:
    """Long waves on the left; what the grid holds stands on a lighter ground."""
    part = picture[frame.y : frame.y + frame.height, frame.x : frame.x + frame.width, :3]
    low, high = curves.resolved
    part[:, (curves.omega >= low) & (curves.omega <= high)] = _BAND
    for period in _MARKS:
        column = float(np.interp(math.log(2.0 * math.pi / period), np.log(curves.omega), range(frame.width)))
        if 0.0 < column < frame.width - 1:
            part[:, round(column)] = _GRID
            _write(picture, f"{period:g}s", frame.x + round(column), frame.y - 16)
    # energy over log ω is ω·S: equal areas are equal energies
    energies = curves.layers * curves.omega
    highest = float(energies.max(initial=0.0))
    if highest > 0.0:
        for index, energy in reversed(list(enumerate(energies))):
            _draw_curve(part, energy / highest * (frame.height - 4), _LAYERS[index % len(_LAYERS)])
    _draw_gains(part, curves)
    part[0] = _TEXT


def _draw_gains(part: Pixels, curves: FrequencyCurves) -> None:
    """What equalisers do to the heights, dotted over the curves: a line at 0 dB, and one for each layer."""
    if not np.any(curves.gains):
        return

    def row(gain: NDArray[np.float64] | float) -> NDArray[np.int64]:
        share = (np.asarray(gain) - LEAST_GAIN) / (MOST_GAIN - LEAST_GAIN)
        return np.clip(np.rint(share * (part.shape[0] - 2)), 0, part.shape[0] - 1).astype(np.int64)

    dots = np.arange(0, part.shape[1] - 1, 4)
    part[row(0.0), dots] = _GRID
    for index, gain in enumerate(curves.gains):
        if np.any(gain):
            part[row(gain)[dots], dots] = part[row(gain)[dots], dots + 1] = _LAYERS[index % len(_LAYERS)]


def _draw_curve(part: Pixels, height: NDArray[np.float64], colour: tuple[float, float, float]) -> None:
    """A line two pixels wide with soft edges, and a thin veil of its colour below."""
    rows = np.arange(part.shape[0])[:, np.newaxis]
    steepness = np.sqrt(1.0 + np.gradient(height) ** 2)
    line = np.clip(1.6 - np.abs(rows - height) / steepness, 0.0, 1.0)
    veil = np.where(rows < height, 0.16, 0.0)
    share = np.maximum(line, veil)[..., np.newaxis].astype(np.float32)
    part += share * (np.array(colour, np.float32) - part)


def _draw_polar(picture: Pixels, polar: PolarDensity, frame: _Frame) -> None:
    """Seen from above, +x to the right; long waves in the middle, as much energy as the colour is light."""
    radius = frame.width / 2.0
    y, x = (np.mgrid[0 : frame.width, 0 : frame.width] + 0.5 - radius) / radius
    distance, angle = np.hypot(x, y), np.arctan2(y, x) % (2.0 * np.pi)
    ring = np.clip(distance * (len(polar.omega) - 1), 0, len(polar.omega) - 1.001)
    direction = angle / (2.0 * np.pi) * len(polar.theta)
    energy = between(ring, direction, polar.density.shape).read(polar.density * polar.omega[:, np.newaxis])
    highest = float(energy.max(initial=0.0))
    shade = np.sqrt(energy / highest) if highest > 0.0 else np.zeros_like(energy)
    stops = np.linspace(0.0, 1.0, len(_HEAT))
    colours = np.stack([np.interp(shade, stops, channel) for channel in _HEAT.T], axis=-1)
    inside = np.clip((1.0 - distance) * radius, 0.0, 1.0)[..., np.newaxis]
    rim = np.clip(1.5 - np.abs(distance - 0.995) * radius, 0.0, 1.0)[..., np.newaxis]
    part = picture[frame.y : frame.y + frame.height, frame.x : frame.x + frame.width, :3]
    part += (inside * (colours - part)).astype(np.float32)
    part += (rim * (np.array(_GRID) - part)).astype(np.float32)
    middle = int(radius)
    part[middle, ::4] = 0.5 * part[middle, ::4] + 0.5 * np.array(_GRID, np.float32)
    part[::4, middle] = 0.5 * part[::4, middle] + 0.5 * np.array(_GRID, np.float32)


def _write(picture: Pixels, text: str, centre: int, bottom: int) -> None:
    """Text in small letters of two pixels a dot, as far as it lies within the picture."""
    x = centre - 4 * len(text)
    for letter in text:
        dots = np.array(list(_GLYPHS[letter]), int).reshape(5, 3)[::-1]
        mask = np.kron(dots, np.ones((2, 2), int)).astype(bool)
        if x >= 0 and x + 6 <= picture.shape[1]:
            picture[bottom : bottom + 10, x : x + 6, :3][mask] = _TEXT
        x += 8
