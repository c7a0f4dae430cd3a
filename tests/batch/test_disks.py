# SPDX-License-Identifier: GPL-3.0-or-later
"""Disks that are full, folders that cannot be written or go away, and names of every kind."""

from __future__ import annotations

import errno
import json
import os
import resource
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from ocean_tweak.cli import main
from ocean_tweak.core.sea import memory
from ocean_tweak.export import files
from ocean_tweak.export.cache import estimate as cache_estimate
from tests.batch.bakery import (
    Watch,
    baking,
    contents,
    end,
    image_contents,
    images,
    leftovers,
    only_folder,
    records,
    run,
    start,
    write_sea,
)

MEGABYTES = 6


@pytest.fixture(scope="module")
def sea(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_sea(tmp_path_factory.mktemp("sea") / "sea.json")


@pytest.fixture(scope="module")
def undisturbed(sea: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    cache = tmp_path_factory.mktemp("undisturbed")
    assert main(bake(sea, cache, "1-60", "--maps", "disp,vel", "--workers", 1)) == 0
    return contents(only_folder(cache))


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Path]:
    place = tmp_path / "disk"
    place.mkdir()
    _mount("-t", "tmpfs", "-o", f"size={MEGABYTES}m", "tmpfs", place)
    yield place
    subprocess.run(["umount", "--lazy", place], check=True)


def _mount(*arguments: object) -> None:
    mount = shutil.which("mount")
    answer = mount and subprocess.run([mount, *map(str, arguments)], capture_output=True, text=True)
    if not answer or answer.returncode:
        pytest.skip(f"mounting is not allowed here ({answer.stderr.strip() if answer else 'no mount'})")


def bake(sea: Path, cache: Path, frames: str, *more: object) -> list[str]:
    return [str(a) for a in ("bake", "--params", sea, "--frames", frames, "--out", cache, *more)]


def fill(path: Path) -> None:
    with path.open("wb", buffering=0) as file:
        while True:
            file.write(bytes(4096))


@pytest.mark.parametrize("workers", [1, 2])
def test_full_in_the_middle(sea: Path, undisturbed: dict[str, str], small_disk: Path, workers: int) -> None:
    arguments = ("--maps", "disp,vel", "--workers", workers)
    with Watch(small_disk):
        process = start(*bake(sea, small_disk, "1-60", *arguments))
        baking(process, small_disk, 2)
        with pytest.raises(OSError, match="No space"):
            fill(small_disk / "filler")
        code, _, err = end(process)
    folder = only_folder(small_disk)
    assert code == 1
    assert err.count("\n") == 1, err
    assert (
        "No space left on device: make room on the disk; complete frames are kept; continue with: resume"
        in err
    )
    assert 2 <= len(records(folder)) < 60
    good = contents(folder)
    (small_disk / "filler").unlink()
    assert main(["resume", str(folder), "--workers", "1"]) == 0
    assert leftovers(folder) == []
    assert good.items() <= contents(folder).items()
    assert contents(folder) == undisturbed


def test_a_disk_too_small_is_refused_at_once(sea: Path, small_disk: Path) -> None:
    answer = run(*bake(sea, small_disk, "1-400"))
    assert answer.returncode == 1
    assert "400 frames need about" in answer.stderr
    assert "make room, bake fewer frames or maps" in answer.stderr
    assert images(only_folder(small_disk)) == []
    assert "resume" not in answer.stderr


def test_a_disk_too_small_is_refused_without_mounting(
    sea: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    usage = shutil.disk_usage(tmp_path)
    arguments = bake(sea, tmp_path, "1-10", "--workers", 1)

    def room(free: int) -> None:
        monkeypatch.setattr(cache_estimate.shutil, "disk_usage", lambda path: usage._replace(free=free))

    room(10 * 20_000)
    assert main(arguments) == 1
    assert "10 frames need about" in capsys.readouterr().err
    assert images(only_folder(tmp_path)) == []
    room(usage.free)
    assert main(arguments) == 0


def test_full_in_the_middle_without_mounting(
    sea: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Synchronising is where network disks refuse."""
    sync = os.fsync
    left = 20

    def refuse(descriptor: int) -> None:
        nonlocal left
        left -= 1
        if left < 0:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        sync(descriptor)

    monkeypatch.setattr(files.os, "fsync", refuse)
    assert main(bake(sea, tmp_path, "1-10", "--workers", 1)) == 1
    err = capsys.readouterr().err
    assert err.count("\n") == 1
    assert "No space left on device: make room" in err
    monkeypatch.setattr(files.os, "fsync", sync)
    folder = only_folder(tmp_path)
    assert 0 < len(records(folder)) < 10
    assert leftovers(folder) == []
    assert main(["resume", str(folder), "--workers", "1"]) == 0
    assert main(["verify", str(folder)]) == 0


@pytest.mark.parametrize("maps", ["disp", "disp,foam,normal,vel"])
@pytest.mark.parametrize("compression", ["PXR24", "NONE"])
@pytest.mark.parametrize("resolution", [16, 64, 256])
def test_the_estimate_is_enough_and_near(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], maps: str, compression: str, resolution: int
) -> None:
    sea = write_sea(tmp_path / "sea.json", resolution=resolution, foam={"half_life": 0.1})
    arguments = ["--maps", maps, "--compression", compression, "--workers", 1]
    command = bake(sea, tmp_path / "c", "1-2", *arguments)
    assert main([*command, "--estimate", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)["bytes"]
    assert main(command) == 0
    folder = only_folder(tmp_path / "c")
    taken = sum(path.stat().st_blocks * 512 for path in [*images(folder), *records(folder)])
    assert taken <= told * 1.02
    assert told <= 2 * taken + 2 * 8192


@pytest.mark.parametrize("workers", [1, 2])
def test_a_disk_that_is_read_only(
    sea: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], workers: int
) -> None:
    cache = tmp_path / "cache"
    assert main(bake(sea, cache, "1-3", "--workers", 1)) == 0
    folder = only_folder(cache)
    (folder / "records" / "0002.json").unlink()
    before = contents(folder)
    _mount("--bind", cache, cache)
    try:
        _mount("-o", "remount,ro,bind", cache)
        for refused in (
            ["resume", folder, "--workers", workers],
            ["clean", folder],
            bake(sea, cache, "1-3", "--set", "seed=3"),
        ):
            assert main([str(part) for part in refused]) == 1
            err = capsys.readouterr().err
            assert "Read-only file system: get permission to write there" in err
            assert err.count("\n") == 1
        assert main(["verify", str(folder)]) == 1  # it reads, and names the frame without its record
        assert "frame 2 is missing" in capsys.readouterr().out
    finally:
        subprocess.run(["umount", "--lazy", cache], check=True)
    assert contents(folder) == before


def test_a_place_where_nothing_can_be_written(sea: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Without a mount, and for root too."""
    assert main(bake(sea, Path("/proc/self/cache"), "1")) == 1
    err = capsys.readouterr().err
    assert err.count("\n") == 1
    assert "/proc/self/cache" in err


@pytest.mark.skipif(os.name == "nt" or os.geteuid() == 0, reason="root may write everywhere")
def test_permission_that_is_lost(sea: Path, tmp_path: Path) -> None:
    process = start(*bake(sea, tmp_path, "1-2000"))
    baking(process, tmp_path, 2)
    folder = only_folder(tmp_path)
    folder.chmod(0o500)
    code, _, err = end(process)
    folder.chmod(0o700)
    assert code == 1
    assert "Permission denied: get permission" in err


@pytest.mark.parametrize("workers", [1, 2])
def test_the_folder_is_removed_meanwhile(sea: Path, tmp_path: Path, workers: int) -> None:
    cache = tmp_path / "cache"
    process = start(*bake(sea, cache, "1-2000", "--workers", workers))
    baking(process, cache, 2)
    folder = only_folder(cache)
    folder.rename(tmp_path / "elsewhere")
    code, _, err = end(process)
    assert code == 1
    assert err.count("\n") == 1, err
    assert "the folder is gone: bake it again" in err
    assert list(cache.rglob("*.exr")) == []
    moved = tmp_path / "elsewhere"
    assert len(images(moved)) >= len(records(moved)) >= 2


@pytest.mark.parametrize(
    "name",
    [
        "North Sea at dawn", "Öresund 海 🌊", "x" * 250, "海" * 250, "-start", "a.b/c\\d:e*f?",
        "CON", "..", " ", "e\u0301",
    ],
)  # fmt: skip
def test_names_of_every_kind(sea: Path, tmp_path: Path, name: str) -> None:
    cache = tmp_path / "a folder with spaces, ÄÖ and 海"
    arguments = bake(sea, cache, "1-2", f"--name={name}", "--workers", 1)
    assert main(arguments) == 0
    folder = only_folder(cache)
    whole = image_contents(folder)
    assert len(whole) == 2
    assert all(len(os.fsencode(file)) <= 140 for file in whole)
    images(folder)[0].unlink()
    assert main(["verify", str(folder)]) == 1
    assert main(["resume", str(folder), "--workers", "1"]) == 0
    (folder / "bake.json").unlink()
    assert main(["resume", str(folder)]) == 0  # the job is told by images and the folder's name
    assert main(["verify", str(folder)]) == 0
    assert image_contents(folder) == whole
    assert main(["clean", str(folder)]) == 0
    assert list(cache.iterdir()) == []


def test_accents_in_one_piece_and_in_two_are_one_name(sea: Path, tmp_path: Path) -> None:
    for name in ("caf\u00e9", "cafe\u0301"):
        assert main(bake(sea, tmp_path, "1", "--name", name, "--workers", 1)) == 0
    only_folder(tmp_path)


def test_the_go_on_line_can_be_pasted(sea: Path, tmp_path: Path) -> None:
    cache = tmp_path / "it's a cache"
    process = start(*bake(sea, cache, "1-2000", "--workers", 1))
    baking(process, cache, 1)
    process.terminate()
    _, _, err = end(process)
    line = err.rpartition("continue with: ")[2].strip()
    answer = subprocess.run(["sh", "-c", f"printf '%s|' {line}"], capture_output=True, text=True, check=True)
    assert answer.stdout == f"resume|{only_folder(cache)}|"


def test_many_workers_need_as_much_memory(
    sea: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    for module in (memory, cache_estimate):  # a process with Python and its packages takes some 90 MB
        monkeypatch.setattr(module, "usable_memory", lambda: 200 * 10**6)
    assert main(bake(sea, tmp_path, "1-8", "--workers", 3)) == 1
    assert "with 3 workers needs" in capsys.readouterr().err
    assert main(bake(sea, tmp_path, "1-3", "--workers", 2)) == 0
    assert main(bake(sea, tmp_path, "4-6")) == 0  # by default as many as fit


@pytest.mark.parametrize(
    "arguments",
    [["info", "--save", "{}/sea.json"], ["job", "--out", "{}"], ["job", "--form", "flamenco", "--out", "{}"]],
    ids=["parameters", "openjd", "flamenco"],
)
def test_what_is_written_over_old_files_is_whole_or_the_old(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], arguments: list[str]
) -> None:
    """Also files that belong together: none of them is new while another one is old."""
    frames = ["--frames", "1"] if arguments[0] == "job" else []
    command = [word.format(tmp_path) for word in arguments] + frames
    assert main([*command, "--set", "seed=1"]) == 0
    before = contents(tmp_path)
    most = max(path.stat().st_size for path in tmp_path.rglob("*") if path.is_file()) - 1
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (most, limits[1]))  # the largest does not fit any more
    try:
        assert main([*command, "--set", "seed=2"]) == 1
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert "File too large" in capsys.readouterr().err
    assert contents(tmp_path) == before
    assert list(tmp_path.rglob(".*")) == []
