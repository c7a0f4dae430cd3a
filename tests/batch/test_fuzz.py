# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of every kind with random damage: no crash, hang, traceback or much memory."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from tests.batch.bakery import ROOT, SOON

LONG = os.environ.get("OCEAN_TWEAK_LONG_TESTS") == "1"
#: damages of each kind, now and in the long run
COUNTS = {
    "json": (100, 20_000), "records": (100, 20_000), "exr": (100, 20_000), "usd": (50, 20_000),
    "png": (100, 20_000), "tiff": (100, 20_000), "npy": (100, 20_000), "bake": (50, 3_000),
    "spectra": (300, 10_000),
}  # fmt: skip
#: that one process tries
AT_ONCE = 500


@pytest.mark.parametrize("kind", COUNTS)
def test_damaged_files(tmp_path: Path, kind: str) -> None:
    """In processes of their own: what reads EXR and USD is C++, and would take this one along."""
    if kind in ("png", "tiff"):
        pytest.importorskip("PIL")
    if kind == "usd":
        pytest.importorskip("pxr")
    count = COUNTS[kind][LONG]
    spans = [range(first, min(first + AT_ONCE, count)) for first in range(0, count, AT_ONCE)]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        problems = pool.map(lambda span: _problem(tmp_path / str(span.start), kind, span), spans)
        assert "\n".join(filter(None, problems)) == ""


def _problem(scratch: Path, kind: str, span: range) -> str:
    """What ended otherwise than it must; nothing where all is well."""
    numbers = [str(span.start), str(span.stop)]
    answer = subprocess.run(
        [sys.executable, "-X", "faulthandler", "-m", "tests.batch.fuzz", kind, scratch, *numbers],
        cwd=ROOT, capture_output=True, text=True, errors="replace", timeout=20 * SOON, check=False,
    )  # fmt: skip
    shutil.rmtree(scratch, ignore_errors=True)
    lines = answer.stdout.splitlines() or ["none"]
    if answer.returncode == 0 and lines[-1].startswith("done"):
        return ""
    return f"{kind}, damage {lines[-1]}, ended with {answer.returncode}:\n{answer.stderr[-5000:]}"
