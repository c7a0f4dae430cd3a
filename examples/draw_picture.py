# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the picture that examples/from-image.json makes waves of: `python examples/draw_picture.py` (Pillow).

The word is soft at its edges, so that no wave is shorter than the sea's samples show, and the picture grey
around it up to its rim, so that the patch repeats without a seam.
"""

from __future__ import annotations

from pathlib import Path

from PIL import Image, ImageDraw, ImageFilter, ImageFont

PICTURE = Path(__file__).with_name("sea.png")
SIDE = 256


def main() -> None:
    """Write the picture."""
    picture = Image.new("L", (SIDE, SIDE), 96)
    draw = ImageDraw.Draw(picture)
    font = ImageFont.load_default(size=104)
    draw.text((SIDE // 2, SIDE // 2), "SEA", 255, font, anchor="mm", stroke_width=3)
    picture.filter(ImageFilter.GaussianBlur(2.0)).save(PICTURE, optimize=True)


if __name__ == "__main__":
    main()
