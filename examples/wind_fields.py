# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of waves from wind fields, seen from above, for docs/wind-fields.md.

Run from the project's folder: `python -m examples.wind_fields`. Wants Pillow.
"""

from __future__ import annotations

import sys
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ocean_tweak.core import Ocean, OceanParameters, WaveLayer, WindFieldLayer
from ocean_tweak.core.waves.wind_field.presets import WIND_FIELDS, wind_field
from ocean_tweak.core.waves.wind_field.wind import winds_at

from .from_above import GALLERY, save_side_by_side, shaded

SIZE, RESOLUTION = 200.0, 400


def arrows(parameters: OceanParameters, across: int = 14) -> NDArray[np.uint8]:
    """A picture of the wind: strokes that are longer and thicker where it is stronger."""
    picture = np.full((RESOLUTION, RESOLUTION, 3), 245, np.uint8)
    (layer,) = parameters.of(WindFieldLayer)
    places = (np.arange(across) + 0.5) * (SIZE / across)
    x, y = (values.ravel() for values in np.meshgrid(places, places))
    _, winds = winds_at(layer, x, y, SIZE)
    reach = 0.65 * SIZE / across / layer.greatest_speed
    for share in np.linspace(-0.5, 0.5, 60):
        column = np.clip((x + share * reach * winds[0, :, 0]) * RESOLUTION / SIZE, 0, RESOLUTION - 4).astype(
            int
        )
        row = np.clip((y + share * reach * winds[0, :, 1]) * RESOLUTION / SIZE, 0, RESOLUTION - 4).astype(int)
        width = 4 if share > 0.3 else 2  # its head is the thick end
        for i in range(width):
            for j in range(width):
                picture[row + i, column + j] = (30, 60, 90)
    return picture[::-1]


def main() -> int:
    """Write a picture of the three presets: their winds above, the sea below."""
    columns = []
    for name in WIND_FIELDS:
        parameters = OceanParameters(
            resolution=RESOLUTION, domain_size=SIZE,
            layers=(
                WaveLayer(wind_speed=2.0, fetch=2e3),
                replace(wind_field(name, SIZE, 9.81), steepness=0.16),
            ),
        )  # fmt: skip
        normal = Ocean(parameters).surface(0.0, {"normal"}).normal
        columns.append(np.concatenate([arrows(parameters), shaded(normal)]))
    save_side_by_side(columns, GALLERY / "wind-fields.jpg", quality=75)
    return 0


if __name__ == "__main__":
    sys.exit(main())
