# SPDX-License-Identifier: GPL-3.0-or-later
"""Follows docs/first-sea.md and docs/ship.md in a window, by the tests that do, and renews their pictures.

python -m tools.guide [first-sea | ship]
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

from .project import BUILD, ROOT

GUIDE, SHIP = (ROOT / "docs" / f"{name}.md" for name in ("first-sea", "ship"))
#: the test that follows a page
_TESTS = {GUIDE: "tests/ui/test_guide.py", SHIP: "tests/ui/test_ship_guide.py"}
#: bytes of a picture
LARGEST = 200_000


def pictures_of(text: str) -> list[str]:
    """Names of a page's pictures, in order."""
    return re.findall(r"\(pictures/([a-z-]+)\.png\)", text)


def main() -> int:
    """Follow the pages that are named, or all; return the exit code of the first test that fails, or 1 where
    a picture does not become small.
    """
    wanted = sys.argv[1:]
    pages = [page for page in _TESTS if not wanted or page.stem in wanted]
    return next((code for code in map(_renewed, pages) if code), 0)


def _renewed(page: Path) -> int:
    command = [sys.executable, "-m", "pytest", "-q", _TESTS[page]]
    code = subprocess.call(command, cwd=ROOT, env={**os.environ, "OCEAN_TWEAK_FINE_PICTURES": "1"})
    if code:
        return code
    for name in pictures_of(page.read_text(encoding="utf-8")):
        size = shrink(BUILD / "window" / f"{name}.png", page.parent / "pictures" / f"{name}.png")
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
