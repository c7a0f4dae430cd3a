# SPDX-License-Identifier: GPL-3.0-or-later
"""A frame has the same bytes in whatever order, chunk, process or company it is made."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from ocean_tweak.cli import main
from tests.batch.bakery import end, image_contents, only_folder, run, start, times, write_sea

FRAMES = 4
MAPS = "foam,disp,vel"
GUSTS = {
    "first_frame": 0,
    "samples": {
        "layers.0.wind_speed": [10.0 + 0.5 * frame for frame in range(FRAMES + 2)],
        "ocean_time": [0.02 * frame**1.5 for frame in range(FRAMES + 2)],
    },
}


@pytest.fixture(scope="module", params=["still", "animated"])
def sea(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Foam remembers, so it is what an order could change; its memory is kept short to be quick."""
    changes = {"foam": {"half_life": 0.2}, "resolution": 128}
    if request.param == "animated":
        changes |= {"animation": GUSTS, "resolution": 64}
    return write_sea(tmp_path_factory.mktemp("sea") / "sea.json", **changes)


def bake(sea: Path, cache: Path, *more: object, frames: str = f"1-{FRAMES}") -> list[str]:
    arguments = ["--frames", frames, "--maps", MAPS, "--out", cache]
    return [str(a) for a in ("bake", "--params", sea, *arguments, *more)]


@pytest.fixture(scope="module")
def in_one_go(sea: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    cache = tmp_path_factory.mktemp("whole")
    assert main(bake(sea, cache, "--workers", 1)) == 0
    hashes = image_contents(only_folder(cache))
    assert len(set(hashes.values())) == len(hashes) == 3 * FRAMES
    return hashes


def test_any_order_and_chunks(sea: Path, in_one_go: dict[str, str], tmp_path: Path) -> None:
    for repeat in range(times(1)):
        chance = random.Random(repeat)
        cache = tmp_path / str(repeat)
        frames = list(range(1, FRAMES + 1))
        chance.shuffle(frames)
        while frames:
            size = chance.randint(1, 3)
            chunk, frames = frames[:size], frames[size:]
            only = ",".join(map(str, chunk))
            assert main(bake(sea, cache, "--only", only, "--workers", 1)) == 0
        assert image_contents(only_folder(cache)) == in_one_go


def test_four_workers(sea: Path, in_one_go: dict[str, str], tmp_path: Path) -> None:
    assert run(*bake(sea, tmp_path, "--workers", 4)).returncode == 0
    assert image_contents(only_folder(tmp_path)) == in_one_go


def test_processes_that_share_a_folder(sea: Path, in_one_go: dict[str, str], tmp_path: Path) -> None:
    """Two have chunks of their own, two others the same frames again: these wait and find them made."""
    chunks = [["--only", "1-2"], ["--only", f"3-{FRAMES}"], ["--only", f"2-{FRAMES}"], []]
    processes = [start(*bake(sea, tmp_path, *chunk, "--wait", "--workers", 1)) for chunk in chunks]
    for process in processes:
        code, _, err = end(process)
        assert (code, err) == (0, "")
    assert image_contents(only_folder(tmp_path)) == in_one_go


def test_maps_in_another_order_are_the_same_job(sea: Path, in_one_go: dict[str, str], tmp_path: Path) -> None:
    assert main(bake(sea, tmp_path, "--only", "1", "--workers", 1)) == 0
    other = [part.replace(MAPS, "vel,disp,foam") for part in bake(sea, tmp_path)]
    assert main([*other, "--only", "2", "--workers", "1"]) == 0
    assert image_contents(only_folder(tmp_path)).items() <= in_one_go.items()


@pytest.mark.parametrize(
    ("frames", "labels"),
    [
        ("-2--1", ["-001", "-002"]),
        ("9999-10000", ["10000", "9999"]),
        ("1-5x2", ["0001", "0003", "0005"]),
    ],
)
def test_frames_that_are_not_1_2_3(tmp_path: Path, frames: str, labels: list[str]) -> None:
    """Alone and among others, and what resume, verify and clean make of their names."""
    sea = write_sea(tmp_path / "sea.json", timing={"fps": "24000/1001", "start_frame": -7})

    def baked(cache: str, *more: str) -> dict[str, str]:
        arguments = ["--params", str(sea), f"--frames={frames}", "--out", str(tmp_path / cache)]
        assert main(["bake", *arguments, *more]) == 0
        return image_contents(only_folder(tmp_path / cache))

    whole = baked("whole", "--workers", "1")
    assert sorted(name.removeprefix("sea_disp.").removesuffix(".exr") for name in whole) == labels
    assert baked("again", "--workers", "1") == whole
    last = labels[-1]
    assert baked("part", f"--only={last}", "--workers", "1") == {
        f"sea_disp.{last}.exr": whole[f"sea_disp.{last}.exr"]
    }
    folder = only_folder(tmp_path / "part")
    assert main(["verify", str(folder)]) == 1
    assert main(["resume", str(folder), "--workers", "1"]) == 0
    assert main(["verify", str(folder)]) == 0
    assert image_contents(folder) == whole
    assert main(["clean", str(folder)]) == 0
    assert not folder.parent.exists()


def test_another_sea_never_overwrites(tmp_path: Path) -> None:
    sea = write_sea(tmp_path / "sea.json")
    cache = tmp_path / "cache"

    def baked(*changes: str) -> None:
        arguments = ["--params", str(sea), "--frames", "1-2", "--out", str(cache), "--workers", "1"]
        assert main(["bake", *arguments, *changes]) == 0

    baked()
    first = only_folder(cache)
    before = image_contents(first)
    for changes in (["--set", "seed=12"], ["--maps", "vel"], ["--compression", "ZIP"], ["--fps", "25"]):
        baked(*changes)
        assert image_contents(first) == before
    versions = sorted(path.name for path in cache.glob("*/v*"))
    assert [name[:4] for name in versions] == ["v001", "v002", "v003", "v004", "v005"]
    assert len({name[5:] for name in versions}) == 5
    baked()  # finds its own again
    assert sorted(path.name for path in cache.glob("*/v*")) == versions
