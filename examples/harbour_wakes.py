# SPDX-License-Identifier: GPL-3.0-or-later
"""Boats in a harbour from above, the picture of docs/wakes.md, and Kelvin's angle on it. Wants Pillow.

python3 examples/harbour_wakes.py            writes docs/gallery/harbour-wakes.jpg
python3 examples/harbour_wakes.py --measure  prints at which angle from the course the ferry's wake ends on it
"""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
sys.path.insert(0, str(Path(__file__).resolve().parent))

from from_above import GALLERY

from ocean_tweak.core import Ocean, OceanParameters, PathSample, Places, Timing, WakeLayer, WaveLayer

Array = NDArray[np.floating]

PICTURE = GALLERY / "harbour-wakes.jpg"
#: pixels, pixels a metre, and the moment that is shown, s
WIDTH, HEIGHT, SCALE, NOW = 1280, 720, 3.2, 60.0
#: m/s and m: of the ferry that goes straight on, on whose wake the angle is measured, and its place then
SPEED, LENGTH, PLACE = 5.0, 16.0, (318.0, 84.0)
#: m of a drawn boat
_HULL = np.array(
    [(-0.5, -0.42), (0.18, -0.5), (0.38, -0.32), (0.5, 0.0), (0.38, 0.32), (0.18, 0.5), (-0.5, 0.42)]
)
_SUN = np.array([-0.68, 0.28, 0.67])
_DEEP, _SKY, _FOAM = (
    np.array([9.0, 52.0, 66.0]),
    np.array([176.0, 205.0, 214.0]),
    np.array([236.0, 242.0, 243.0]),
)


def main() -> None:
    """Draw, or measure what was drawn."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--measure", action="store_true")
    parser.add_argument("--out", type=Path, default=PICTURE)
    arguments = parser.parse_args()
    if not arguments.measure:
        draw(arguments.out)
    angle = measured_angle(np.asarray(Image.open(arguments.out).convert("L"), np.float64))
    print(f"{arguments.out.name}: the wake's edge is {angle:.1f}° from the course; Kelvin's: 19.47°")


def boats() -> tuple[WakeLayer, ...]:
    """A ferry that goes straight on, a launch that turns, one that crosses, and one that has stopped."""
    straight = path(lambda t: (PLACE[0] + SPEED * (t - NOW), PLACE[1]))
    turning = path(lambda t: turned(t, (206.0, 170.0), 25.0, 4.6))
    crossing = path(lambda t: (96.0 + 1.3 * (t - NOW), 118.0 - 4.0 * (t - NOW)))
    stopped = path(lambda t: (352.0 + 3.6 * (min(t, NOW - 9.0) - NOW + 9.0), 196.0))
    common = {"area_size": 512.0, "area_resolution": 1024, "decay": 0.025, "foam_half_life": 5.0}
    return tuple(
        WakeLayer(path=way, length=length, beam=0.28 * length, draught=draught, **common)
        for way, length, draught in (
            (straight, LENGTH, 0.9), (turning, 9.0, 0.5), (crossing, 9.0, 0.5), (stopped, 10.0, 0.6)
        )
    )  # fmt: skip


def path(place_at: Callable[[float], tuple[float, float]]) -> tuple[PathSample, ...]:
    """A sample every fourth of a second, from a minute before to now."""
    return tuple(PathSample(t, *place_at(t)) for t in np.arange(0.0, NOW + 0.3, 0.25).tolist())


def turned(time: float, middle: tuple[float, float], radius: float, speed: float) -> tuple[float, float]:
    """Along a line, and from 14 s ago on around a middle."""
    since = time - (NOW - 14.0)
    if since < 0.0:
        return middle[0] + speed * since, middle[1] - radius
    angle = speed * since / radius
    return middle[0] + radius * math.sin(angle), middle[1] - radius * math.cos(angle)


def sea() -> OceanParameters:
    """A light air over the harbour."""
    air = WaveLayer(wind_speed=1.9, fetch=500.0, wind_direction=2.4)
    return OceanParameters(
        resolution=256, domain_size=64.0, seed=5, layers=(air, *boats()), timing=Timing(start_frame=0)
    )


def draw(out: Path) -> None:
    """Write the picture."""
    row, column = np.mgrid[:HEIGHT, :WIDTH]
    x, y = column / SCALE, (HEIGHT - 1 - row) / SCALE
    fields = Ocean(sea()).surface(NOW, {"normal", "foam", "displacement"}, on=Places(x, y))
    normal = fields.normal
    towards_sky = np.clip(0.5 + 4.6 * (normal @ (_SUN * (1.0, 1.0, 0.0))), 0.0, 1.0)[..., np.newaxis]
    glint = np.clip((normal @ (_SUN / np.linalg.norm(_SUN)) - 0.72) / 0.28, 0.0, 1.0)[..., np.newaxis] ** 12
    colour = _DEEP + (0.06 + 0.78 * towards_sky**1.5) * (_SKY - _DEEP) * 0.72 + 30.0 * glint
    chance = np.random.default_rng(3)
    grain = chance.random((HEIGHT // 2, WIDTH // 2)).repeat(2, 0).repeat(2, 1)
    white = 0.92 * np.clip(1.45 * fields.foam - 0.8 * grain * (1.0 - fields.foam), 0.0, 1.0)[..., np.newaxis]
    colour = colour + white * (_FOAM - colour)
    image = Image.fromarray(np.clip(colour, 0.0, 255.0).astype(np.uint8))
    _draw_harbour(ImageDraw.Draw(image, "RGBA"))
    image.save(out, quality=80)
    print(f"written: {out}, {out.stat().st_size / 1024:.0f} kB")


def _draw_harbour(pen: ImageDraw.ImageDraw) -> None:
    for layer in boats():
        (x, y), (vx, vy) = layer.track.place(NOW)
        before, _ = layer.track.place(NOW - 12.0)
        course = math.atan2(vy, vx) if math.hypot(vx, vy) > 0.1 else math.atan2(y - before[1], x - before[0])
        for size, paint in ((1.0, (236, 236, 230)), (0.72, (150, 108, 74)), (0.4, (228, 230, 232))):
            hull = size * _HULL * (layer.length, layer.beam)
            c, s = math.cos(course), math.sin(course)
            corners = hull @ np.array([(c, s), (-s, c)]) + (x, y)
            pen.polygon([_pixel(*corner) for corner in corners], fill=paint)
    quay = [(0.0, 225.0), (0.0, 205.0), (250.0, 209.0), (252.0, 225.0)]
    mole = [(400.0, 0.0), (382.0, 0.0), (366.0, 58.0), (372.0, 66.0), (380.0, 62.0)]
    for shape in (quay, mole):
        pen.polygon([_pixel(px + 3.0, py - 2.5) for px, py in shape], fill=(4, 26, 34, 150))
        pen.polygon([_pixel(*corner) for corner in shape], fill=(157, 152, 142))
        pen.line([_pixel(*corner) for corner in (*shape, shape[0])], fill=(196, 191, 180), width=4)


def _pixel(x: float, y: float) -> tuple[float, float]:
    return x * SCALE, HEIGHT - 1 - y * SCALE


def measured_angle(grey: Array) -> float:
    """The edge of the ferry's wake, degrees to starboard of its course: where brightness along rays from its
    bow varies half as much as where it varies most, from 60 to 160 m astern.
    """
    distance = np.arange(60.0, 160.0, 0.2)
    angles = np.arange(10.0, 26.0, 0.1)
    smooth = _blurred(grey, 3)
    found = np.zeros(len(angles))
    for number, angle in enumerate(np.radians(angles)):
        x, y = PLACE[0] + 0.5 * LENGTH - distance, PLACE[1] - distance * math.tan(angle)
        column, row = (np.rint(part).astype(int) for part in _pixel(x, y))
        line = smooth[np.minimum(row, len(grey) - 1), column]
        found[number] = np.std(line - _blurred(line[np.newaxis], 60)[0])
    outside = found[angles > 24.0].mean()  # of what the wind raises
    highest = int(found.argmax())
    beyond = found[highest:] < outside + 0.5 * (found[highest] - outside)
    return float(angles[highest + int(np.argmax(beyond))])


def _blurred(grey: Array, width: int) -> Array:
    box = np.ones(width) / width
    padded = np.pad(grey, ((0, 0), (width, width)), mode="edge")
    rows = np.apply_along_axis(lambda line: np.convolve(line, box, "same"), 1, padded)[:, width:-width]
    if len(grey) == 1:
        return rows
    padded = np.pad(rows, ((width, width), (0, 0)), mode="edge")
    return np.apply_along_axis(lambda line: np.convolve(line, box, "same"), 0, padded)[width:-width]


if __name__ == "__main__":
    main()
