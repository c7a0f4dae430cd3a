# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of every kind with random damage: no crash, hang, traceback or much memory."""

from __future__ import annotations

import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from tests.batch.bakery import ROOT, SOON

LONG = os.environ.get("OCEAN_TWEAK_LONG_TESTS") == "1"
#: damages of each kind, now and in the long run
COUNTS = {
    "json": (100, 20_000), "records": (100, 20_000), "exr": (100, 20_000),
    "png": (100, 20_000), "tiff": (100, 20_000), "npy": (100, 20_000), "bake": (100, 3_000),
}  # fmt: skip
PROCESSES = os.cpu_count() or 1 if LONG else 1


@pytest.mark.parametrize("kind", COUNTS)
def test_damaged_files(tmp_path: Path, kind: str) -> None:
    """In processes of their own: what reads EXR and USD is C++, and would take this one along."""
    if kind in ("png", "tiff"):
        pytest.importorskip("PIL")
    if kind == "usd":
        pytest.importorskip("pxr")
    with ThreadPoolExecutor(PROCESSES) as pool:
        problems = list(
            pool.map(lambda first: _problem(tmp_path / str(first), kind, first), range(PROCESSES))
        )
    assert not any(problems), "\n".join(problems)


def _problem(scratch: Path, kind: str, first: int) -> str:
    """What ended otherwise than it must, of every so manieth damage; nothing where all is well."""
    count = COUNTS[kind][LONG]
    span = [str(first), str(count), str(PROCESSES)]
    answer = subprocess.run(
        [sys.executable, "-X", "faulthandler", "-m", "tests.batch.fuzz", kind, scratch, *span],
        cwd=ROOT, capture_output=True, text=True, errors="replace", timeout=10 * SOON + count, check=False,
    )  # fmt: skip
    lines = answer.stdout.splitlines() or ["none"]
    if answer.returncode == 0 and lines[-1].startswith("done"):
        return ""
    return f"{kind}, damage {lines[-1]}, ended with {answer.returncode}:\n{answer.stderr[-5000:]}"
