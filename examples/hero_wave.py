# SPDX-License-Identifier: GPL-3.0-or-later
"""The picture of docs/hero-waves.md: the sea of hero-wave.json before, at and after the focus of its wave.

Run from the project's folder: `python -m examples.hero_wave`. Wants Pillow.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ocean_tweak.core import HeroWave, Ocean, OceanParameters

from .from_above import GALLERY, save_side_by_side, shaded

EXAMPLE = Path(__file__).with_name("hero-wave.json")
PICTURE = GALLERY / "hero-wave.jpg"

SIDE, STRIP = 360, 110
#: seconds from the focus
_MOMENTS = (-12.0, 0.0, 12.0)
_WATER, _AIR, _LINE = (24, 70, 96), (236, 243, 246), (200, 40, 30)


def parameters() -> OceanParameters:
    """The sea of the example, a sample a pixel."""
    sea = OceanParameters.from_json(EXAMPLE.read_text(encoding="utf-8"))
    return sea.at_resolution(SIDE)


def profile(elevation: NDArray[np.floating], row: int, highest: float) -> NDArray[np.uint8]:
    """A picture (STRIP, N, 3) of the water along a row, its heights twelve times as large."""
    level = 0.5 * STRIP - elevation[row] * (0.45 * STRIP / highest)
    under = np.arange(STRIP)[:, np.newaxis] >= level
    return np.where(under[..., np.newaxis], _WATER, _AIR).astype(np.uint8)


def main() -> int:
    """Write the sea from above and, below, cut along the red line through the focus."""
    sea = parameters()
    (wave,) = sea.of(HeroWave)
    row, highest = round(wave.y * SIDE / sea.domain_size), 1.3 * wave.crest_height
    columns = []
    for moment in _MOMENTS:
        fields = Ocean(sea).surface(wave.time + moment, {"displacement", "normal"})
        above = shaded(fields.normal)
        above[SIDE - 1 - row] = _LINE
        gap = np.full((6, SIDE, 3), 255, np.uint8)
        columns += [np.concatenate([above, gap, profile(fields.displacement[..., 2], row, highest)])]
    save_side_by_side(columns, PICTURE, quality=70)
    return 0


if __name__ == "__main__":
    sys.exit(main())
