# SPDX-License-Identifier: GPL-3.0-or-later
"""Commands that several tests give, and what comes of them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ocean_tweak.cli import main
from ocean_tweak.export.exr import read_image

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


def described(capsys: pytest.CaptureFixture[str], *arguments: str) -> dict[str, Any]:
    """What `info --json` says of the only sea."""
    assert main(["info", "--json", *arguments]) == 0
    (report,) = json.loads(capsys.readouterr().out).values()
    return report


def baked_heights(cache: Path, *arguments: str) -> list[np.ndarray]:
    """Heights in m, (N, N) with the top row first, of the frames that `bake` makes, in their order."""
    assert main(["bake", *arguments, "--out", str(cache)]) == 0
    return [read_image(path)[0][..., 2] for path in sorted(cache.glob("*/v*/*_disp.*.exr"))]
