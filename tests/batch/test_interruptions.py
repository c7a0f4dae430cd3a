# SPDX-License-Identifier: GPL-3.0-or-later
"""Whatever ends a bake: what is there is whole, and gone on with it becomes the same bytes."""

from __future__ import annotations

import contextlib
import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from ocean_tweak.cli import main
from ocean_tweak.export.cache import records as cache_records
from tests.batch.bakery import (
    ROOT,
    SOON,
    Watch,
    baking,
    children,
    contents,
    end,
    image_contents,
    leftovers,
    only_folder,
    records,
    run,
    start,
    times,
    times_of_change,
    wait_for,
    write_sea,
)

KILLS = times(10, more=20)
FRAMES = 30 * KILLS  # more than three fast workers make between the kills


@pytest.fixture(scope="module")
def sea(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_sea(tmp_path_factory.mktemp("sea") / "sea.json")


@pytest.fixture(scope="module")
def undisturbed(sea: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    cache = tmp_path_factory.mktemp("undisturbed")
    assert run(*bake(sea, cache), timeout=KILLS * SOON).returncode == 0
    return contents(only_folder(cache))


def bake(sea: Path, cache: Path, frames: int = FRAMES, workers: int = 1) -> list[object]:
    return [
        "bake", "--params", sea, "--frames", f"1-{frames}", "--out", cache, "--workers", workers,
    ]  # fmt: skip


def all_processes(process) -> list[int]:
    return [process.pid, *children(process)]


def test_killed_at_any_moment(sea: Path, undisturbed: dict[str, str], tmp_path: Path) -> None:
    chance = random.Random(5)
    with Watch(tmp_path):
        for kill in range(KILLS):
            process = start(*bake(sea, tmp_path, workers=1 + kill % 2))
            before = len(list(tmp_path.glob("*/v*/records/*.json")))
            if chance.random() < 0.8:
                baking(process, tmp_path, before + 1)
                time.sleep(chance.uniform(0.0, 0.05))
            else:  # while it starts
                time.sleep(chance.uniform(0.0, 0.4))
            processes = all_processes(process)
            process.kill()
            for number in processes[1:]:  # they would end by themselves after a frame
                with contextlib.suppress(ProcessLookupError):
                    os.kill(number, signal.SIGKILL)
            end(process)
        folder = only_folder(tmp_path)
        assert 0 < len(records(folder)) < FRAMES
        answer = run(*bake(sea, tmp_path, workers=2), timeout=KILLS * SOON)
    assert answer.returncode == 0, answer.stderr
    assert contents(folder) == undisturbed
    assert leftovers(folder) == []


def test_killed_workers_are_started_again(sea: Path, undisturbed: dict[str, str], tmp_path: Path) -> None:
    chance = random.Random(7)
    with Watch(tmp_path):
        process = start(*bake(sea, tmp_path, workers=3))
        for kill in range(KILLS // 2):
            baking(process, tmp_path, 1 + kill * FRAMES // KILLS)
            time.sleep(chance.uniform(0.0, 0.05))
            workers = children(process)
            if workers:  # the oldest: one that dies again and again before it makes a frame is given up
                os.kill(min(workers), signal.SIGKILL)
        code, _, err = end(process)
    assert (code, err) == (0, "")
    folder = only_folder(tmp_path)
    assert contents(folder) == undisturbed
    # what a killed worker had begun is removed by the next bake of its frames
    assert main(["resume", str(folder)]) == 0
    assert contents(folder) == undisturbed


def test_the_workers_of_a_killed_process_end(sea: Path, tmp_path: Path) -> None:
    process = start(*bake(sea, tmp_path, frames=2000, workers=2))
    baking(process, tmp_path, 4)
    workers = children(process)
    assert len(workers) == 2
    process.kill()
    end(process)
    wait_for(
        lambda: not any(Path(f"/proc/{worker}").exists() and not is_zombie(worker) for worker in workers),
        "the end of workers without anybody to tell",
    )


def is_zombie(process: int) -> bool:
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] == "Z"
    except OSError:
        return True


@pytest.mark.parametrize("workers", [1, 2])
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_asked_to_stop(
    sea: Path, undisturbed: dict[str, str], tmp_path: Path, workers: int, number: signal.Signals
) -> None:
    with Watch(tmp_path):
        process = start(*bake(sea, tmp_path, workers=workers))
        baking(process, tmp_path, 3)
        if number is signal.SIGINT:
            os.killpg(process.pid, number)  # as a terminal does: the workers get it too
        else:
            process.send_signal(number)
        code, _, err = end(process)
    folder = only_folder(tmp_path)
    assert code == 1
    assert err == f"ocean_tweak: stopped; complete frames are kept; continue with: resume {folder}\n"
    assert 3 <= len(records(folder)) < FRAMES
    assert leftovers(folder) == []  # nor a lock
    assert contents(folder).items() <= undisturbed.items()
    assert main(["resume", str(folder), "--workers", "1"]) == 0
    assert contents(folder) == undisturbed


#: a bake that does not come to an end of its third frame, whose image lies half written beside its place
STUCK = """
import os, sys, time
from ocean_tweak.cli import main, stopping
stopping.PATIENCE = float(sys.argv[1])
def stuck(file, sync=os.fsync):
    if "_disp.0003." in os.readlink(f"/proc/self/fd/{file}"):
        os.write(1, b"\\nstuck\\n")  # a line of its own, whoever prints meanwhile
        time.sleep(600)
    sync(file)
os.fsync = stuck
sys.exit(main(sys.argv[2:]))
"""


@pytest.mark.parametrize(("patience", "again"), [(0.5, False), (600.0, True)])
def test_a_frame_that_does_not_end_is_given_up(
    sea: Path, undisturbed: dict[str, str], tmp_path: Path, patience: float, again: bool
) -> None:
    """A while after it was asked to stop, or at once where it is asked again."""
    arguments = map(str, bake(sea, tmp_path, frames=4))
    process = subprocess.Popen(
        [sys.executable, "-c", STUCK, str(patience), *arguments], cwd=ROOT, stdout=subprocess.PIPE,
        stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    assert "stuck\n" in iter(process.stdout.readline, "")
    asked = time.monotonic()
    process.send_signal(signal.SIGINT)
    while again and process.poll() is None:  # two that come before it looks are one
        time.sleep(0.2)
        process.send_signal(signal.SIGINT)
    code, _, err = end(process)
    assert time.monotonic() - asked < 60.0  # it would sleep for ten minutes
    folder = only_folder(tmp_path)
    assert (code, err) == (
        1, f"ocean_tweak: stopped; complete frames are kept; continue with: resume {folder}\n",
    )  # fmt: skip
    assert leftovers(folder) == []
    assert len(records(folder)) == 2
    assert main([str(a) for a in bake(sea, tmp_path, frames=4)]) == 0
    assert len(image_contents(folder)) == 4
    assert image_contents(folder).items() <= undisturbed.items()


def test_workers_give_long_frames_up(tmp_path: Path) -> None:
    sea = write_sea(tmp_path / "sea.json", resolution=2048)
    process = start(*bake(sea, tmp_path / "c", frames=4, workers=2), "--maps", "disp,foam")
    wait_for(lambda: len(children(process)) == 2, "two workers")
    time.sleep(1.0)
    asked = time.monotonic()
    process.terminate()
    code, _, err = end(process)
    assert time.monotonic() - asked < 60.0
    assert code == 1
    assert "ocean_tweak: stopped; complete frames are kept" in err
    folder = only_folder(tmp_path / "c")
    assert leftovers(folder) == []
    assert len(records(folder)) == 0


def test_stopped_while_it_looks_at_what_is_there(
    copy: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A signal before the first frame is not lost, and costs nothing of what is there."""
    before = times_of_change(copy)
    look = cache_records.file_hash

    def interrupted(path: Path) -> str:
        if path.name == "sea_disp.0003.exr":
            os.kill(os.getpid(), signal.SIGTERM)
        return look(path)

    monkeypatch.setattr(cache_records, "file_hash", interrupted)
    assert main(["resume", str(copy), "--workers", "1"]) == 1
    assert "ocean_tweak: stopped; complete frames are kept" in capsys.readouterr().err
    assert times_of_change(copy) == before
