# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames that loop: the last ones fade into those that come before the first, and into an animated WebP file.

Waves of 13 s cannot come back in two: what does not close is blended.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

Frames = NDArray[np.uint8]


def closed(frames: Frames, fade: int) -> Frames:
    """A loop of frames that does not close by itself.

    frames : (count, …), 0 to 255
    fade : the number of frames over which the end becomes what comes before the beginning

    Returns (count − fade, …): the frames after the first `fade`, the last ones of them blended into those.
    Raises ValueError where fewer than one are left without a blend.
    """
    kept = len(frames) - fade
    if not 0 <= fade < kept:
        raise ValueError(f"{len(frames)} frames, {fade} of them to fade: fade fewer than half of them")
    loop = frames[fade:].copy()
    for number in range(fade):
        # slow at both ends, or the eye sees where the fade begins
        share = 0.5 - 0.5 * math.cos(math.pi * (number + 1) / (fade + 1))
        before, after = (frames[index].astype(np.float32) for index in (number, number + kept))
        loop[number + kept - fade] = np.rint(share * before + (1.0 - share) * after)
    return loop


def steps(loop: Frames) -> NDArray[np.float64]:
    """Mean difference of each frame from the one before it; of the first, from the last."""
    values = loop.astype(np.float32)
    differences = (np.abs(values[number] - values[number - 1]).mean() for number in range(len(values)))
    return np.array(list(differences), np.float64)


def read(paths: Sequence[Path]) -> Frames:
    """(count, rows, columns, 3) of pictures of one size."""
    return np.stack([np.asarray(Image.open(path).convert("RGB")) for path in paths])


def save_webp(loop: Frames, path: Path, fps: float, most: int) -> int:
    """The frames as the best WebP of fewer bytes that plays for ever; returns its quality, 0 to 100.

    Raises RuntimeError if there is none.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    first, *others = (Image.fromarray(frame) for frame in loop)
    durations = [round(1000 * (n + 1) / fps) - round(1000 * n / fps) for n in range(len(loop))]
    for quality in range(90, 20, -5):
        first.save(
            path, save_all=True, append_images=others, duration=durations, loop=0, quality=quality, method=4
        )
        if path.stat().st_size < most:
            return quality
    raise RuntimeError(f"{path} stays above {most} bytes: fewer or smaller frames make it smaller")
