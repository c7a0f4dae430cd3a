# SPDX-License-Identifier: GPL-3.0-or-later
"""Follows docs/first-sea.md in a window, by the test that does, and renews its pictures."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

from .project import BUILD, ROOT

GUIDE = ROOT / "docs" / "first-sea.md"
#: bytes of a picture
LARGEST = 200_000


def pictures_of(text: str) -> list[str]:
    """Names of the guide's pictures, in order."""
    return re.findall(r"\(pictures/(first-sea-[a-z]+)\.png\)", text)


def main() -> int:
    """Follow the guide; return the exit code of the test, or 1 where a picture does not become small."""
    command = [sys.executable, "-m", "pytest", "-q", "tests/ui/test_guide.py"]
    code = subprocess.call(command, cwd=ROOT, env={**os.environ, "OCEAN_TWEAK_FINE_PICTURES": "1"})
    if code:
        return code
    for name in pictures_of(GUIDE.read_text(encoding="utf-8")):
        size = shrink(BUILD / "window" / f"{name}.png", GUIDE.parent / "pictures" / f"{name}.png")
        print(f"{name}: {size // 1000} kB")
        if size > LARGEST:
            print(f"{name} is larger than {LARGEST // 1000} kB", file=sys.stderr)
            return 1
    return 0


def shrink(source: Path, target: Path) -> int:
    """Write a picture with as many colours as make it small enough; return its bytes."""
    from PIL import Image

    target.parent.mkdir(parents=True, exist_ok=True)
    with Image.open(source) as picture:
        for colours in (256, 128, 64, 32):
            few = picture.convert("RGB").quantize(colours, dither=Image.Dither.NONE)
            few.save(target, optimize=True)
            if target.stat().st_size <= LARGEST:
                break
    return target.stat().st_size


if __name__ == "__main__":
    sys.exit(main())
