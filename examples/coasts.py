# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes `beach.json` and `harbour.json`, and pictures of what the waves are on them, seen from above.

    python examples/coasts.py            # the two files
    python examples/coasts.py docs/img   # maps of heights, directions, breaking and foam, too

The depths come from the formulas of `ocean_tweak.core.waves.coast.beds`; any image or array will do as well:

    python -m ocean_tweak info --set coast.depth.file=bed.exr --set coast.spacing=2
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from ocean_tweak.core import Area, Coast, Foam, Ocean, OceanParameters, Places, Raster, Water, WaveLayer
from ocean_tweak.core.waves.coast.beds import BEDS, SIDE, SPACING, grid
from ocean_tweak.export.sea_files import write_sea

HERE = Path(__file__).resolve().parent
#: every how many samples of a bed go into the file, and to which part of a metre
_EVERY, _ROUNDED = 2, 20.0


def sea(bed: str, wind_speed: float, fetch: float, direction: float, depth: float) -> OceanParameters:
    """A sea that runs towards +x, onto a bed."""
    heights = BEDS[bed](*grid())[::_EVERY, ::_EVERY]
    raster = Raster(np.round(-heights * _ROUNDED) / _ROUNDED, f"{bed.lower()} depth")
    layer = WaveLayer(wind_speed=wind_speed, fetch=fetch, wind_direction=direction, swell=0.6)
    return OceanParameters(
        resolution=256, domain_size=SIDE, seed=3, layers=(layer,), water=Water(depth=depth),
        foam=Foam(half_life=3.0), coast=Coast(depth=raster, spacing=SPACING * _EVERY),
    )  # fmt: skip


SEAS = {
    "beach": sea("BEACH", 11.0, 150e3, 0.2, 20.0),
    "harbour": sea("HARBOUR", 10.0, 90e3, 0.0, 14.0),
    "islet": sea("ISLET", 11.0, 150e3, 0.0, 20.0),
}


def maps(parameters: OceanParameters, time: float = 60.0) -> np.ndarray:
    """(rows, columns, 3) 0…1: elevation and foam, significant height, share of broken waves; land is sand."""
    coast = Ocean(parameters).coast
    assert coast is not None
    land = coast.ground.depth <= 0.0
    highest = coast.significant_height.max()
    elevation = coast.over_bed.elevation(time) / highest + 0.5
    foam = coast.over_bed.foam(time).foam
    sea_now = np.clip(elevation, 0.0, 1.0)[..., np.newaxis] * (0.20, 0.42, 0.48)
    sea_now += foam[..., np.newaxis] * (1.0 - sea_now)
    height = (coast.significant_height / highest)[..., np.newaxis] * (1.0, 1.0, 1.0)
    broken = coast.broken_share[..., np.newaxis] * (1.0, 0.8, 0.5)
    panels = [np.where(land[..., np.newaxis], (0.72, 0.62, 0.45), each) for each in (sea_now, height, broken)]
    # offshore on the left
    return np.concatenate([each.swapaxes(0, 1)[::-1] for each in panels], axis=1)


#: colours of heights, from none to the highest, and of land
_RAMP = np.array(
    [(0.15, 0.05, 0.35), (0.16, 0.35, 0.6), (0.1, 0.62, 0.52), (0.6, 0.82, 0.25), (1.0, 0.92, 0.2)]
)
_LAND = (0.72, 0.62, 0.45)
#: pixels a m, m between arrows, and their length
_SCALE, _APART, _LENGTH = 1.25, 32.0, 22.0


def height_map(parameters: OceanParameters) -> Image.Image:
    """Significant height in colours, and arrows of the mean direction, with offshore at the bottom."""
    ocean, side = Ocean(parameters), round(_SCALE * SIDE)
    area = ocean.surface(0.0, {"significant_height"}, on=Area(SIDE, side))
    x, y = Area(SIDE, side).rest_positions()
    depth = -BEDS["BEACH"](x, y)
    highest = float(area.significant_height[depth > 0.0].max())
    share = np.clip(area.significant_height / highest, 0.0, 1.0)
    stops = np.linspace(0.0, 1.0, len(_RAMP))
    colours = np.stack([np.interp(share, stops, _RAMP[:, index]) for index in range(3)], axis=-1)
    colours[depth <= 0.0] = _LAND
    picture = Image.fromarray(np.rint(255.0 * colours.swapaxes(0, 1)[::-1]).astype(np.uint8))
    draw = ImageDraw.Draw(picture)
    across, along = (axis.ravel() for axis in np.meshgrid(*2 * [np.arange(0.5 * _APART, SIDE, _APART)]))
    there = -BEDS["BEACH"](along, across) > 0.0
    along, across = along[there], across[there]
    towards = ocean.surface(0.0, {"mean_direction"}, on=Places(along, across)).mean_direction
    for px, py, (dx, dy) in zip(along, across, towards, strict=True):
        # x of the sea is up, y to the right
        tip = np.array([py + 0.5 * _LENGTH * dy, px + 0.5 * _LENGTH * dx])
        tail = tip - _LENGTH * np.array([dy, dx])
        heads = [tip - 0.3 * _LENGTH * np.array([dy + sign * dx, dx - sign * dy]) for sign in (-0.5, 0.5)]
        for begin in (tail, *heads):
            draw.line([(_SCALE * a, side - _SCALE * b) for a, b in (begin, tip)], fill="white", width=2)
    draw.rectangle([(6, side - 32), (230, side - 8)], fill=(20, 20, 30))
    for pixel in range(140):
        colour = tuple(round(255.0 * np.interp(pixel / 139.0, stops, _RAMP[:, index])) for index in range(3))
        draw.line([(12 + pixel, side - 26), (12 + pixel, side - 14)], fill=colour)
    draw.text((160, side - 27), f"0 to {highest:.1f} m", fill="white", font_size=14)
    return picture


def main() -> None:
    """Write the files, and pictures into a folder where one is given."""
    for name in ("beach", "harbour"):
        write_sea(HERE / f"{name}.json", SEAS[name])
    if len(sys.argv) > 1:
        for name, parameters in SEAS.items():
            pixels = np.rint(255.0 * np.clip(maps(parameters), 0.0, 1.0)).astype(np.uint8)
            Image.fromarray(pixels).save(Path(sys.argv[1]) / f"coast-{name}-maps.jpg", quality=88)
        height_map(SEAS["beach"]).save(Path(sys.argv[1]) / "coast-beach-height.jpg", quality=85)


if __name__ == "__main__":
    main()
