# SPDX-License-Identifier: GPL-3.0-or-later
"""What is told before a bake, against what the system counts of it."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from statistics import median

import pytest

from ocean_tweak.cli import main
from ocean_tweak.core.parameters.shot import Shot
from ocean_tweak.export.cache import estimate as cache_estimate
from ocean_tweak.export.cache.estimate import estimate, process_memory
from ocean_tweak.export.cache.job import Job
from tests.batch.bakery import ROOT, command, write_sea

WAITS = pytest.mark.skipif(not hasattr(os, "wait4"), reason="this system does not tell what a process took")


#: starts a command and prints what it took. A process counts the memory of the one that started it, which
#: for a test's own is much
MEASURE = """
import os, subprocess, sys
process = subprocess.Popen(sys.argv[1:], stdout=subprocess.DEVNULL)
_, status, usage = os.wait4(process.pid, 0)
print(usage.ru_maxrss * 1024, usage.ru_utime + usage.ru_stime)
sys.exit(status)
"""


def measured(*arguments: object) -> tuple[int, float]:
    """Most memory in bytes and seconds of a processor that a command takes."""
    program = [sys.executable, "-c", MEASURE, *command(*arguments)]
    # glibc keeps what was freed for each thread: from machine to machine an eighth more or less
    env = {**os.environ, "MALLOC_ARENA_MAX": "1"}
    told = subprocess.run(program, cwd=ROOT, env=env, capture_output=True, check=True).stdout
    memory, seconds = told.split()
    return int(memory), float(seconds)


@WAITS
@pytest.mark.parametrize("resolution", [1024, 2048])
def test_memory_and_time_are_near(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, resolution: int) -> None:
    sea = write_sea(tmp_path / "sea.json", resolution=resolution)
    arguments = ["bake", "--params", sea, "--frames", "1-2", "--workers", 1, "--out", tmp_path]
    shot = Shot.from_dict(json.loads(sea.read_text()))
    job = Job("sea", "1", shot, frames=(1, 2))
    monkeypatch.setattr(cache_estimate, "usable_cores", lambda: 1)
    # what other programs do meanwhile makes a trial slower, and what is told from it 16 times as much
    told = median(estimate(tmp_path, job, job.frames).seconds for _ in range(5))
    _, start = measured(*arguments, "--estimate")
    memory, seconds = measured(*arguments)
    assert process_memory(job) == pytest.approx(memory, rel=0.1)
    if seconds - start > 1.0:  # of what is over in a moment, other things take most
        assert 0.6 < told / (seconds - start) < 1.6


def test_more_processes_look_back_more_often(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Foam's look back is what each process begins with: two on two cores gain the less, the longer it is."""
    monkeypatch.setattr(cache_estimate, "usable_cores", lambda: 2)
    monkeypatch.setattr(cache_estimate, "_costs", lambda *_: cache_estimate._Costs(1.0, 0.5, 4.0))
    foam = {"half_life": 1.0}  # looks back over 49 moments of an eighth of a second
    shot = Shot.from_dict(
        {"resolution": 16, "foam": foam, "timing": {"fps": 8}, "layers": [{"wind_speed": 14}]}
    )
    job = Job("sea", "1", shot, ("disp", "foam"), frames=tuple(range(1, 11)))

    def seconds(workers: int, job: Job = job) -> float:
        return estimate(tmp_path, job, job.frames, workers).seconds

    # the sea, 50 moments, and frames of 4 s; each looks at a new moment and at its own beside the last
    assert seconds(1) == pytest.approx(1.0 + 25.0 + 10 * 4.0)
    begin = 0.4
    assert seconds(2) == pytest.approx(begin + 1.0 + 25.0 + 4 * 1.0 + 5 * 4.0)
    still = Job("sea", "1", shot, ("disp",), frames=job.frames)
    assert seconds(2, still) == pytest.approx(begin + 1.0 + 5 * 4.0)
    changing = {**shot.to_dict(), "animation": {"first_frame": 1, "samples": {"choppiness": [0.5] * 10}}}
    every = Job("sea", "1", Shot.from_dict(changing), ("disp", "foam"), frames=job.frames)
    assert seconds(1, every) == pytest.approx(10 * (1.0 + 25.0 + 4.0) / 2, rel=0.9)
    assert seconds(1, every) > 250.0


def test_nothing_is_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    sea = write_sea(tmp_path / "sea.json", resolution=32)
    aside = tmp_path / "tmp"
    aside.mkdir()
    monkeypatch.setenv("TMPDIR", str(aside))
    assert (
        main([*map(str, ["bake", "--params", sea, "--frames", "1-9", "--out", tmp_path / "c", "--estimate"])])
        == 0
    )
    assert not [*aside.iterdir(), *(tmp_path / "c").rglob("*.exr")]
