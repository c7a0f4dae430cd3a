# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws docs/pictures/buoy-day.svg: the wave height of a buoy's day, and of the sea that is made of it.

python3 -m tools.buoy_day

The buoy's own is the sum over the bins of its file, a dot an hour; the sea's is that of its surface, the mean
of some seeds, every ten minutes, also between the hours.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from html import escape

import numpy as np

from ocean_tweak.core import Ocean
from ocean_tweak.export.spectra.reading import ALL_TIMES, chosen_times, measured_sea, read_spectra
from ocean_tweak.export.spectra.records import Record

from .project import ROOT

FILES = [
    ROOT / "examples" / "buoy" / f"41010.{kind}" for kind in ("data_spec", "swdir", "swdir2", "swr1", "swr2")
]
PICTURE = ROOT / "docs" / "pictures" / "buoy-day.svg"
#: pixels; seeds that a height is the mean of; s between two of the sea's
_WIDTH, _HEIGHT, _MARGIN = 720, 300, 48
_SEEDS, _STEP = 40, 600.0
_BUOY, _SEA = "#b45309", "#2563eb"


def main() -> int:
    """Write the picture."""
    record = chosen_times(read_spectra(FILES)[0], ALL_TIMES)
    own = [record.summary(index).significant_wave_height for index in range(len(record.times))]
    times = np.arange(0.0, record.seconds[-1] + 1.0, _STEP)
    sea = [height_of_sea(record, float(time)) for time in times]
    PICTURE.write_text(drawn(record, own, times, sea), encoding="utf-8")
    print(f"written: {PICTURE.relative_to(ROOT)}")
    return 0


def height_of_sea(record: Record, time: float) -> float:
    """Four standard deviations in m of the surface at a time in s after the first spectrum."""
    sea = measured_sea(record).replace(resolution=256, domain_size=700.0)
    sea = sea.replace(layers=(sea.layers[0].changed(measured_time=time),))
    fields = (Ocean(sea.replace(seed=seed)).surface(0.0).displacement[..., 2] for seed in range(_SEEDS))
    return 4.0 * math.sqrt(float(np.mean([field.var() for field in fields])))


def drawn(record: Record, own: Sequence[float], times: np.ndarray, sea: Sequence[float]) -> str:
    """The picture as SVG."""
    highest = math.ceil(4.0 * max(*own, *sea)) / 4.0
    last = float(record.seconds[-1])

    def x(time: float) -> float:
        return _MARGIN + time / last * (_WIDTH - 2 * _MARGIN)

    def y(height: float) -> float:
        return _HEIGHT - _MARGIN - height / highest * (_HEIGHT - 2 * _MARGIN)

    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_WIDTH} {_HEIGHT}" font-family="sans-serif" '
        'font-size="13">',
        f'<rect width="{_WIDTH}" height="{_HEIGHT}" fill="#ffffff"/>',
    ]
    for height in np.arange(0.0, highest + 0.01, 0.25):
        lines.append(f'<path d="M{_MARGIN} {y(height):.1f}H{_WIDTH - _MARGIN}" stroke="#e5e7eb"/>')
        lines.append(f'<text x="{_MARGIN - 8}" y="{y(height) + 4:.1f}" text-anchor="end">{height:g}</text>')
    for time, at in zip(record.times, record.seconds, strict=True):
        if time is not None and time.hour % 2:
            label = f"{time:%H:%M}"
            lines.append(f'<text x="{x(at):.1f}" y="{_HEIGHT - 26}" text-anchor="middle">{label}</text>')
    path = " ".join(f"{x(time):.1f},{y(height):.1f}" for time, height in zip(times, sea, strict=True))
    lines.append(f'<polyline points="{path}" fill="none" stroke="{_SEA}" stroke-width="2"/>')
    for at, height in zip(record.seconds, own, strict=True):
        lines.append(f'<circle cx="{x(at):.1f}" cy="{y(height):.1f}" r="4" fill="{_BUOY}"/>')
    title = f"Hs in m at buoy {record.place}, {record.times[0]:%Y-%m-%d} to {record.times[-1]:%Y-%m-%d} (UTC)"
    lines.append(f'<text x="{_MARGIN}" y="24" font-weight="bold">{escape(title)}</text>')
    for place, colour, text in ((340, _BUOY, "the buoy"), (440, _SEA, f"the sea, mean of {_SEEDS} seeds")):
        lines.append(f'<text x="{place + 80}" y="{_HEIGHT - 8}" fill="{colour}">{text}</text>')
    return "\n".join([*lines, "</svg>"]) + "\n"


if __name__ == "__main__":
    sys.exit(main())
