# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the image that examples/from-image.json makes waves of: `python examples/draw_image.py` (Pillow).

The word is soft at its edges, so that no wave is shorter than the sea's samples show, and the image grey
around it up to its rim, so that the patch repeats without a seam.
"""

from __future__ import annotations

from pathlib import Path

from PIL import Image, ImageDraw, ImageFilter, ImageFont

IMAGE = Path(__file__).with_name("sea.png")
SIDE = 256


def main() -> None:
    """Write the image."""
    image = Image.new("L", (SIDE, SIDE), 96)
    draw = ImageDraw.Draw(image)
    font = ImageFont.load_default(size=104)
    draw.text((SIDE // 2, SIDE // 2), "SEA", 255, font, anchor="mm", stroke_width=3)
    image.filter(ImageFilter.GaussianBlur(2.0)).save(IMAGE, optimize=True)


if __name__ == "__main__":
    main()
