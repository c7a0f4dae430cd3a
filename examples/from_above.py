# SPDX-License-Identifier: GPL-3.0-or-later
"""Images of seas seen from above, side by side. Wants Pillow."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

GALLERY = Path(__file__).resolve().parent.parent / "docs" / "gallery"

_GAP = 8  # pixels
_LIGHT = np.array([-0.55, 0.35, 0.76])
_DEEP, _BRIGHT = np.array([8.0, 38.0, 60.0]), np.array([190.0, 220.0, 228.0])


def shaded(normal: NDArray[np.floating]) -> NDArray[np.uint8]:
    """An image (N, N, 3) of the sea from above, lit from one side; its first row is the top."""
    light = np.clip((normal @ (_LIGHT / np.linalg.norm(_LIGHT)) - 0.45) / 0.55, 0.0, 1.0)[..., np.newaxis]
    return np.asarray(_DEEP + light * (_BRIGHT - _DEEP), np.uint8)[::-1]


def save_side_by_side(images: Sequence[NDArray[np.uint8]], path: Path, quality: int) -> None:
    """Write images (rows, columns, 3) of one height as a JPEG, with white between them."""
    gap = np.full((len(images[0]), _GAP, 3), 255, np.uint8)
    parts = [part for image in images for part in (gap, image)][1:]
    Image.fromarray(np.concatenate(parts, axis=1)).save(path, quality=quality)
    print(f"written: {path}, {path.stat().st_size / 1024:.0f} kB")
