# SPDX-License-Identifier: GPL-3.0-or-later
"""The demo's pictures side by side, and whether they show one and the same moving sea."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations
from pathlib import Path

from .project import ToolError

#: mean absolute difference of two pictures, 0 ... 1: the same sea at the same frame differs by noise alone
SAME_SEA = 0.01
#: frames of one sea must differ by so many times more than the same frame of two seas
CLEARLY = 4.0
GALLERY_BYTES = 200_000

BORDER, COLUMN_TITLE, ROW_TITLE = 12, 64, 76
PAPER, INK = (24, 27, 30), (225, 228, 230)


def load(folder: Path, scenes: Sequence[str], frames: Sequence[int]) -> dict[tuple[str, int], object]:
    """The pictures <scene>.<frame>.png as Pillow images. Raises `ToolError` if one is missing."""
    from PIL import Image

    pictures = {}
    for scene in scenes:
        for frame in frames:
            path = folder / f"{scene}.{frame:04d}.png"
            if not path.exists():
                raise ToolError(f"{path} was not rendered")
            pictures[scene, frame] = Image.open(path).convert("RGB")
    return pictures


def compare(pictures: Mapping[tuple[str, int], object]) -> str:
    """Say how much the rows and the columns differ; raise `ToolError` unless rows match and frames move."""
    import numpy as np

    arrays = {key: np.asarray(picture, np.float32) / 255.0 for key, picture in pictures.items()}
    between_seas, between_frames = 0.0, 1.0
    for (one, a), (other, b) in combinations(arrays.items(), 2):
        difference = float(np.mean(np.abs(a - b)))
        if one[1] == other[1]:
            between_seas = max(between_seas, difference)
        elif one[0] == other[0]:
            between_frames = min(between_frames, difference)
    text = (
        f"mean difference of pixels: at most {between_seas:.5f} between oceans at the same frame, "
        f"at least {between_frames:.5f} between frames of the same ocean"
    )
    if between_seas > SAME_SEA:
        raise ToolError(f"the oceans do not match; {text}; allowed between oceans: {SAME_SEA}")
    if between_frames < CLEARLY * between_seas:
        raise ToolError(f"an ocean stands still; {text}")
    return text


def save(pictures: Mapping[tuple[str, int], object], titles: Mapping[str, str], path: Path) -> None:
    """Write the pictures as a table: a row an ocean, a column a frame."""
    from PIL import Image, ImageDraw, ImageFont

    scenes, frames = list(titles), sorted({frame for _, frame in pictures})
    width, height = next(iter(pictures.values())).size
    left, top = ROW_TITLE + BORDER, COLUMN_TITLE + BORDER
    size = (left + len(frames) * (width + BORDER), top + len(scenes) * (height + BORDER))
    sheet = Image.new("RGB", size, PAPER)
    draw, font = ImageDraw.Draw(sheet), ImageFont.load_default(34)
    for column, frame in enumerate(frames):
        x = left + column * (width + BORDER)
        draw.text((x + width / 2, top / 2), f"Frame {frame}", INK, font, anchor="mm")
        for row, scene in enumerate(scenes):
            sheet.paste(pictures[scene, frame], (x, top + row * (height + BORDER)))
    for row, scene in enumerate(scenes):
        title = Image.new("RGB", (height, left), PAPER)
        ImageDraw.Draw(title).text((height / 2, left / 2), titles[scene], INK, font, anchor="mm")
        sheet.paste(title.rotate(90, expand=True), (0, top + row * (height + BORDER)))
    sheet.save(path)


def save_gallery(sheet: Path, gallery: Path) -> None:
    """Write the sheet as a JPEG small enough for the repository."""
    from PIL import Image

    gallery.mkdir(parents=True, exist_ok=True)
    picture = Image.open(sheet).convert("RGB")
    picture = picture.resize((1600, round(picture.height * 1600 / picture.width)), Image.Resampling.LANCZOS)
    path = gallery / "storm-contact-sheet.jpg"
    for quality in range(92, 40, -4):
        picture.save(path, quality=quality, optimize=True, progressive=True)
        if path.stat().st_size < GALLERY_BYTES:
            return
    raise ToolError(f"{path.name} stays above {GALLERY_BYTES} bytes")
