# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds wordings in code and documents that readers stumbled over, and says what to write instead.

Each is a pattern that matches across line breaks and comment marks, in any case; part of `make lint`.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator

from .project import ROOT

#: what stands between two words: blanks, also where a line of a comment or a string ends and the next begins
_GAP = r"""(?:\s|["'](?=\s*\n)|(?<=\s)f?["']|\#:?)+"""

#: pattern, with a blank for each gap → what to write
WORDINGS = {
    "seas? as high as real": "physically correct wave heights",
    "(?:is|are) told by the distance": "the distance is measured from …",
    "which number is calm": "pixel value that means no wind",
    "as large as th(?:ese|ose|e) waves want": "resize the domain to fit these waves",
    "a wish that": "if no plan fits, …",
    "(?:number|one) of this (?:one|particular sea)? ?among all": "random seed",
    "floats? no more": "stop floating",
    "(?:an )?artist in doubt": "if unsure, …",
    "what blender is told": "registers …",
    "of a noise at a time": "samples of a noise at one time",
    "by hash and not by order": "identified by a hash, not by order",
    "on how many samples": "resolution",
    "as winds are told": "as for wind",
}
#: where they are looked for
PLACES = ("*.md", "docs/*.md", "ocean_tweak/**/*.py", "ocean_tweak/**/*.json", "blender_manifest.toml")


def found(text: str) -> Iterator[tuple[int, str, str]]:
    """Yield the line, the wording and what to write instead, for each match in a text."""
    for wording, better in WORDINGS.items():
        pattern = r"\b" + wording.replace(" ", _GAP) + r"\b"
        for match in re.finditer(pattern, text, re.IGNORECASE):
            yield text.count("\n", 0, match.start()) + 1, " ".join(match[0].split()), better


def main() -> int:
    """Print all that are found; return the exit code."""
    paths = sorted({path for place in PLACES for path in ROOT.glob(place)} - {ROOT / "CHANGELOG.md"})
    hits = [(path, *hit) for path in paths for hit in found(path.read_text(encoding="utf-8"))]
    for path, line, wording, better in hits:
        print(f'{path.relative_to(ROOT)}:{line}: "{wording}": write plainly, such as "{better}"')
    return 1 if hits else 0


if __name__ == "__main__":
    sys.exit(main())
