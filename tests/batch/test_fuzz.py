# SPDX-License-Identifier: GPL-3.0-or-later
"""Images, records, jobs and parameters with random damage: no crash, hang, traceback or much memory."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from ocean_tweak.cli import main
from tests.batch.bakery import ROOT, SOON, only_folder, times, write_sea

EACH = 100


def pristine(place: Path, compression: str) -> Path:
    sea = write_sea(place / "sea.json", resolution=16)
    arguments = ["--frames", "1-2", "--maps", "disp,vel", "--compression", compression, "--workers", "1"]
    assert main(["bake", "--params", str(sea), "--out", str(place / "cache"), *arguments]) == 0
    return only_folder(place / "cache")


@pytest.mark.parametrize("part", range(times(3)))
def test_damaged_files(tmp_path: Path, part: int) -> None:
    """In a process of its own: OpenEXR is C++, and would take this one along."""
    folder = pristine(tmp_path, ("ZIP", "PXR24", "HTJ2K")[part % 3])
    span = [str(part * EACH), str((part + 1) * EACH)]
    answer = subprocess.run(
        [sys.executable, "-X", "faulthandler", "-m", "tests.batch.fuzz", folder, tmp_path / "x", *span],
        cwd=ROOT, capture_output=True, text=True, timeout=10 * SOON, check=False,
    )  # fmt: skip
    seeds = answer.stdout.split() or ["none"]
    assert answer.returncode == 0, f"damage {seeds[-1]} ended it with {answer.returncode}:\n{answer.stderr}"
    assert seeds[-1] == "done"
