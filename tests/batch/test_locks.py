# SPDX-License-Identifier: GPL-3.0-or-later
"""Two bakes of the same frames: one at a time, and the other is told who is at it."""

from __future__ import annotations

import contextlib
import json
import os
import platform
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from ocean_tweak.cli import main
from ocean_tweak.export import files
from ocean_tweak.export.cache import locks, processes
from ocean_tweak.export.cache.locks import Held, claimed, claims
from tests.batch.bakery import (
    baking,
    end,
    image_contents,
    leftovers,
    only_folder,
    records,
    start,
    times,
    wait_for,
    write_sea,
)

HOST = platform.node()


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "locks").mkdir()
    return tmp_path


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(locks, "BEAT", 0.05)
    monkeypatch.setattr(locks, "SILENCE", 0.6)


@pytest.fixture(scope="module")
def sea(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_sea(tmp_path_factory.mktemp("sea") / "sea.json")


def bake(sea: Path, cache: Path, frames: str, *more: object) -> list[str]:
    return [str(a) for a in ("bake", "--params", sea, "--frames", frames, "--out", cache, *more)]


def foreign_lock(folder: Path, frames: str = "1-6", **changes: object) -> Path:
    """The lock of a process on another machine."""
    data = {"host": "render7", "machine": "render7 x", "process": 4711, "started": "5", "frames": frames}
    path = folder / "locks" / "00.lock"
    path.write_text(json.dumps({**data, **changes}) + "\n000000000000\n")
    return path


HOLDER = "a holder elsewhere"


@pytest.fixture
def beating(copy: Path) -> Iterator[Path]:
    """A lock whose holder, elsewhere, keeps saying that it lives, until the lock is gone."""
    lock = foreign_lock(copy)
    head = lock.read_text().partition("\n")[0]
    ended = threading.Event()

    def beat() -> None:
        count = 0
        while not ended.wait(0.05) and lock.exists():
            count += 1
            with contextlib.suppress(FileNotFoundError), lock.open("r+") as file:  # it is gone just now
                file.write(f"{head}\n{count:012d}\n")

    thread = threading.Thread(target=beat, name=HOLDER)
    thread.start()
    yield lock
    ended.set()
    thread.join()


def test_the_life_of_a_lock(sea: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Held, refused by name, never taken from the living, gone on with after its death."""

    def attempt(frames: str, *more: str) -> tuple[int, str]:
        code = main(bake(sea, tmp_path, frames, "--workers", 1, *more))
        return code, capsys.readouterr().err

    first = start(*bake(sea, tmp_path, "1-2000", "--workers", 1))
    baking(first, tmp_path, 1)
    folder = only_folder(tmp_path)
    holder = f"are being baked by process {first.pid} on {HOST}"

    for more in ([], ["--take-over"]):
        code, err = attempt("1-2000", "--only", "7-9", *more)
        assert code == 1
        assert f"frames 7-9 {holder}" in err
        assert err.count("\n") == 1
    assert "is alive" in err
    assert main(["clean", str(folder)]) == 1
    assert holder in capsys.readouterr().err
    assert first.poll() is None
    assert attempt("3000-3001") == (0, "")  # other frames of the same folder are free

    first.kill()
    end(first)
    assert attempt("1-2000", "--only", "1-3") == (0, "")
    assert all(".part" in name for name in leftovers(folder))


def test_of_two_that_come_at_once_one_refuses(sea: Path, tmp_path: Path) -> None:
    for repeat in range(times(2)):
        cache = tmp_path / str(repeat)
        both = [start(*bake(sea, cache, "1-60", "--workers", 1)) for _ in range(2)]
        ends = [end(process) for process in both]
        assert sorted(code for code, _, _ in ends) == [0, 1]
        loser = next(index for index, (code, _, _) in enumerate(ends) if code == 1)
        assert f"process {both[1 - loser].pid} on {HOST}" in ends[loser][2]
        assert len(image_contents(only_folder(cache))) == 60


@pytest.mark.parametrize("with_file_locks", [True, False])
def test_never_two_inside(
    folder: Path, quick: None, monkeypatch: pytest.MonkeyPatch, with_file_locks: bool
) -> None:
    """Also on a disk that has no file locks, where only the order of writing and looking protects."""
    if not with_file_locks:
        monkeypatch.setattr(files, "_locked", lambda file: True)
    inside, most, turns = set(), [], []

    def worker(number: int) -> None:
        for _ in range(times(4)):
            with claimed(folder, (number % 2, 2), wait=True):
                inside.add(number)
                most.append(len(inside))
                time.sleep(0.001)
                inside.discard(number)
            turns.append(number)

    threads = [threading.Thread(target=worker, args=(number,)) for number in range(5)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(turns) == 5 * times(4)
    assert set(most) == {1}
    assert claims(folder / "locks") == []


def test_other_frames_are_free(folder: Path) -> None:
    with claimed(folder, (1, 2)), claimed(folder, (3,)):
        refused = pytest.raises(Held, match=f"frames 2 are being baked by process {os.getpid()} on {HOST}")
        with refused, claimed(folder, (2, 4)):
            pass
        assert len(claims(folder / "locks")) == 2
    assert claims(folder / "locks") == []


def test_of_a_dead_process_elsewhere(copy: Path, quick: None, capsys: pytest.CaptureFixture[str]) -> None:
    lock = foreign_lock(copy)
    assert main(["resume", str(copy)]) == 1
    assert "process 4711 on render7: wait for it with --wait or, if it has died" in capsys.readouterr().err
    assert lock.exists()
    assert main(["resume", str(copy), "--take-over"]) == 0
    assert "watching process 4711 on render7" in capsys.readouterr().out
    assert claims(copy / "locks") == []


def test_of_a_living_process_elsewhere(
    copy: Path, beating: Path, quick: None, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["resume", str(copy), "--take-over"]) == 1
    assert "is alive: only the lock of a dead process can be taken over" in capsys.readouterr().err
    assert beating.exists()


def test_another_machine_of_the_same_name(copy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Containers and clones: its processes cannot be asked, so it does not count as dead at once."""
    foreign_lock(copy, host=HOST, process=2**22 + 1)
    assert main(["resume", str(copy)]) == 1
    assert (
        f"process {2**22 + 1} on {HOST}: wait for it with --wait or, if it has died"
        in capsys.readouterr().err
    )


def test_a_process_number_that_is_used_again(copy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """This process has the number, but was not started when the holder was."""
    foreign_lock(copy, host=HOST, machine=processes.this_machine(), process=os.getpid(), started="1")
    assert main(["resume", str(copy)]) == 0
    assert f"process {os.getpid()} on {HOST} has died; its lock is removed" in capsys.readouterr().out
    assert claims(copy / "locks") == []


@pytest.mark.parametrize(
    ("hardware", "boot", "freed"),
    [
        ("card 1", "before", True),
        ("card 1", "now", False),
        ("card 2", "before", False),
        ("", "before", False),
    ],
)
def test_a_machine_that_was_started_again(
    copy: Path, monkeypatch: pytest.MonkeyPatch, hardware: str, boot: str, freed: bool
) -> None:
    """Its processes are gone; not those of a copy of it, of a container, or of one that has a new name."""
    monkeypatch.setattr(locks, "hardware", lambda: "card 1")
    monkeypatch.setattr(locks, "boot", lambda: "now")
    lock = foreign_lock(copy, host=HOST, process=os.getpid(), hardware=hardware, boot=boot)
    assert main(["resume", str(copy)]) == (0 if freed else 1)
    assert lock.exists() is not freed


def test_what_this_machine_tells_of_itself_is_of_this_start(folder: Path) -> None:
    """A claim of this process is alive by what the system says, and says it to the others."""
    with claimed(folder, (1,)):
        (claim,) = claims(folder / "locks")
    assert locks.is_alive_here(claim) is True
    assert claim.boot in claim.machine
    ticks = time.clock_gettime(time.CLOCK_BOOTTIME) * os.sysconf("SC_CLK_TCK")
    assert 0 < int(claim.started) < ticks


@pytest.mark.parametrize("jump", [-10 * 365 * 86400, 10 * 365 * 86400])
def test_clocks_do_not_matter(
    copy: Path, beating: Path, quick: None, capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch, jump: int,
) -> None:  # fmt: skip
    """A clock set back or forward, here or on the disk, neither frees a living lock nor keeps a dead one."""
    now = time.time
    monkeypatch.setattr(time, "time", lambda: now() + jump)
    os.utime(beating, (now() - jump, now() - jump))
    assert main(["resume", str(copy), "--take-over"]) == 1
    assert "is alive" in capsys.readouterr().err
    beating.unlink()
    wait_for(lambda: HOLDER not in {thread.name for thread in threading.enumerate()}, "the holder's end")
    dead = foreign_lock(copy, process=4712)
    os.utime(dead, (now() + jump, now() + jump))
    assert main(["resume", str(copy), "--take-over"]) == 0
    assert not dead.exists()


def test_whoever_loses_its_lock_stops(sea: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
                                      capsys: pytest.CaptureFixture[str]) -> None:  # fmt: skip
    """It was asleep, somebody took it for dead, and now it is awake again."""
    monkeypatch.setattr(locks, "BEAT", 0.02)

    def take_away() -> None:
        while not list(tmp_path.glob("*/v*/records/*.json")):
            time.sleep(0.01)
        for lock in tmp_path.glob("*/v*/locks/*.lock"):
            lock.unlink()

    thief = threading.Thread(target=take_away)
    thief.start()
    assert main(bake(sea, tmp_path, "1-2000", "--workers", 1)) == 1
    thief.join()
    assert "the lock is gone: another process took it over" in capsys.readouterr().err
    folder = only_folder(tmp_path)
    assert 0 < len(records(folder)) < 2000
    assert claims(folder / "locks") == []  # it was not written again


@pytest.mark.parametrize("content", [b"", b"{", b"\xff" * 40, b"[]\n0\n", b'{"frames": "1-9999999999"}\n1\n'])
def test_a_lock_that_cannot_be_read_holds_all(
    copy: Path, quick: None, capsys: pytest.CaptureFixture[str], content: bytes
) -> None:
    lock = copy / "locks" / "00.lock"
    lock.write_bytes(content)
    assert main(["resume", str(copy)]) == 1
    assert f"a process whose lock {lock} cannot be read" in capsys.readouterr().err
    assert main(["resume", str(copy), "--take-over"]) == 0


@pytest.mark.parametrize("kind", ["fifo", "folder", "device"])
def test_a_lock_that_is_no_file_holds_all_and_nobody_up(
    copy: Path, quick: None, capsys: pytest.CaptureFixture[str], kind: str
) -> None:
    lock = copy / "locks" / "00.lock"
    make = {"fifo": os.mkfifo, "folder": os.mkdir, "device": lambda path: path.symlink_to("/dev/zero")}
    make[kind](lock)
    assert main(["resume", str(copy)]) == 1
    assert f"a process whose lock {lock} cannot be read" in capsys.readouterr().err
    assert main(["resume", str(copy), "--take-over"]) == (1 if kind == "folder" else 0)


def test_what_a_lock_says_is_printed_short_and_plain(copy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    foreign_lock(copy, host="\x1b[2J\r\nroot" + 5000 * "x", process=10**2000)
    assert main(["resume", str(copy)]) == 1
    err = capsys.readouterr().err
    assert len(err) < 500
    assert err.rstrip("\n").isprintable()


def test_a_full_disk_does_not_silence_a_holder(
    folder: Path, quick: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Beats are written in place: no new file, no new room."""
    with claimed(folder, (1,)):
        (lock,) = (folder / "locks").glob("*.lock")
        before = lock.stat()

        def full(*_: object) -> None:
            raise OSError(28, "No space left on device")

        monkeypatch.setattr(files.os, "fsync", full)
        beats = {claims(folder / "locks")[0].beat}
        until = time.monotonic() + 60.0
        while len(beats) < 4:
            assert time.monotonic() < until
            beats.add(claims(folder / "locks")[0].beat)
        after = lock.stat()
    assert (after.st_ino, after.st_size) == (before.st_ino, before.st_size)


def test_a_machine_numbers_a_job_once(sea: Path, tmp_path: Path) -> None:
    """Of seas begun at the same time, each gets one folder, which all who bake it share."""
    jobs = [bake(sea, tmp_path, "1-2", "--set", f"seed={seed}", "--wait", "--workers", 1) for seed in (1, 2)]
    processes = [start(*arguments) for arguments in jobs * times(2)]
    assert {end(process)[0] for process in processes} == {0}
    found = sorted(path.name for path in tmp_path.glob("*/v*"))
    assert [name[:5] for name in found] == ["v001-", "v002-"]
