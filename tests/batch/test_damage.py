# SPDX-License-Identifier: GPL-3.0-or-later
"""Every kind of damage is named with its frame, and mended without touching anything else."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ocean_tweak.cli import main
from ocean_tweak.core.parameters.shot import Shot
from ocean_tweak.export.cache.folders import read_job
from ocean_tweak.export.cache.job import sealed
from ocean_tweak.export.cache.records import CacheSink, file_hash, read_record
from ocean_tweak.export.exr import read_image, write_image
from tests.batch.bakery import contents, only_folder, records, times_of_change, write_sea


def image(folder: Path, frame: int, name: str = "disp") -> Path:
    return folder / f"sea_{name}.{frame:04d}.exr"


def record(folder: Path, frame: int) -> Path:
    return folder / "records" / f"{frame:04d}.json"


def truncated(folder: Path) -> None:
    path = image(folder, 3)
    path.write_bytes(path.read_bytes()[:-100])


def flipped(folder: Path) -> None:
    content = bytearray(image(folder, 3, "vel").read_bytes())
    content[len(content) // 2] ^= 1
    image(folder, 3, "vel").write_bytes(content)


def emptied(folder: Path) -> None:
    image(folder, 3).write_bytes(b"")


def deleted(folder: Path) -> None:
    image(folder, 3, "vel").unlink()


def swap(one: Path, other: Path) -> None:
    first, second = one.read_bytes(), other.read_bytes()
    one.write_bytes(second)
    other.write_bytes(first)


def swapped_frames(folder: Path) -> None:
    swap(image(folder, 3), image(folder, 5))


def swapped_maps(folder: Path) -> None:
    swap(image(folder, 3), image(folder, 3, "vel"))


def swapped_maps_with_their_record(folder: Path) -> None:
    """As a careless rename would leave it, hashes and all."""
    swap(image(folder, 3), image(folder, 3, "vel"))
    seal_record(folder, 3)


def swapped_frames_with_their_records(folder: Path) -> None:
    swap(image(folder, 3), image(folder, 5))
    for frame in (3, 5):
        seal_record(folder, frame)


def record_of_another_frame(folder: Path) -> None:
    shutil.copy(record(folder, 4), record(folder, 3))


def record_flipped(folder: Path) -> None:
    text = record(folder, 3).read_text()
    place = text.index('"bytes": ') + len('"bytes": ')
    digit = "2" if text[place] == "1" else "1"
    record(folder, 3).write_text(text[:place] + digit + text[place + 1 :])


def record_truncated(folder: Path) -> None:
    path = record(folder, 3)
    path.write_bytes(path.read_bytes()[:50])


def record_deleted(folder: Path) -> None:
    record(folder, 3).unlink()


def record_that_lists_less(folder: Path) -> None:
    data = json.loads(record(folder, 3).read_text())
    data["files"] = data["files"][:1]
    write_record(folder, 3, data)


def record_that_lists_more(folder: Path) -> None:
    data = json.loads(record(folder, 3).read_text())
    data["files"] = [{**data["files"][0], "name": "mine.exr"}, *data["files"]]
    write_record(folder, 3, data)


def other_parameters(folder: Path) -> None:
    """Whole in itself, and of another sea."""
    job = read_job(folder)
    stale = replace(job, shot=Shot(job.shot.parameters.replace(seed=99)))
    write_frame(folder, stale, 3)


def waves_too_high(folder: Path) -> None:
    rewrite(folder, 3, lambda pixels: pixels * np.float32(1.05))


def waves_flat(folder: Path) -> None:
    rewrite(folder, 3, np.zeros_like)


def a_pixel_without_a_number(folder: Path) -> None:
    def damage(pixels: np.ndarray) -> np.ndarray:
        pixels[10, 20, 1] = np.nan
        return pixels

    rewrite(folder, 3, damage)


def fewer_pixels(folder: Path) -> None:
    rewrite(folder, 3, lambda pixels: pixels[:32, :32])


def write_record(folder: Path, frame: int, data: dict) -> None:
    del data["sha256"]
    record(folder, frame).write_text(json.dumps(sealed(data)))


def seal_record(folder: Path, frame: int) -> None:
    """Let the record vouch for the files as they are now."""
    data = json.loads(record(folder, frame).read_text())
    for entry in data["files"]:
        path = folder / entry["name"]
        entry |= {"bytes": path.stat().st_size, "sha256": file_hash(path)}
    write_record(folder, frame, data)


def write_frame(folder: Path, job, frame: int) -> None:
    from ocean_tweak.core.sea.bake import ShotSeas

    CacheSink(folder, job).write(frame, ShotSeas(job.shot).frame(frame, job.outputs))


def rewrite(folder: Path, frame: int, change: Callable[[np.ndarray], np.ndarray]) -> None:
    """Other pixels, with header, hash and record as if they were right."""
    path = image(folder, frame)
    pixels, metadata = read_image(path)
    changed = change(pixels.copy())
    fps = read_job(folder).shot.parameters.timing.fps
    finite = np.isfinite
    try:
        np.isfinite = lambda array: finite(np.zeros_like(array))  # let it be written nevertheless
        write_image(path, changed, metadata, fps)
    finally:
        np.isfinite = finite
    seal_record(folder, frame)


DAMAGES = {
    truncated: ([3], "bytes, not"),
    flipped: ([3], "sea_vel.0003.exr has contents other"),
    emptied: ([3], "has 0 bytes"),
    deleted: ([3], "sea_vel.0003.exr is gone"),
    swapped_frames: ([3, 5], "sea_disp.0003.exr has"),
    swapped_maps: ([3], "sea_disp.0003.exr has"),
    swapped_maps_with_their_record: ([3], "'map': 'vel'"),
    swapped_frames_with_their_records: ([3, 5], "'frame': 5"),
    record_of_another_frame: ([3], "belongs to frame 0004"),
    record_flipped: ([3], "was changed"),
    record_truncated: ([3], "its record cannot be used"),
    record_deleted: ([3], "frame 3 is missing"),
    record_that_lists_less: ([3], "lists other files"),
    record_that_lists_more: ([3], "lists other files"),
    other_parameters: ([3], "stale: it was made from other parameters"),
    waves_too_high: ([3], "has waves of"),
    waves_flat: ([3], "has waves of 0 m"),
    a_pixel_without_a_number: ([3], "not finite"),
    fewer_pixels: ([3], "32 x 32 texels, not 64 x 64"),
}


@pytest.mark.parametrize("damage", DAMAGES, ids=lambda damage: damage.__name__)
def test_damage_is_named_and_mended(
    copy: Path, damage: Callable[[Path], None], capsys: pytest.CaptureFixture[str]
) -> None:
    frames, said = DAMAGES[damage]
    before, changed = contents(copy), times_of_change(copy)
    (copy / "notes.txt").write_text("mine")
    (copy / "holiday.exr").write_bytes(b"mine too")
    changed |= times_of_change(copy)
    damage(copy)

    assert main(["verify", str(copy)]) == 1
    told = capsys.readouterr().out
    assert said in told
    named = [line for line in told.splitlines() if line.startswith("sea: frame ")]
    assert [int(line.split()[2]) for line in named] == frames
    assert "no record lists holiday.exr" in told

    wrong_inside = damage in (
        waves_too_high, waves_flat, a_pixel_without_a_number, fewer_pixels,
        swapped_maps_with_their_record, swapped_frames_with_their_records,
    )  # fmt: skip
    if wrong_inside:  # only reading the pixels tells; whoever has seen that names the frames to resume
        for frame in frames:
            record(copy, frame).unlink()
    assert main(["resume", str(copy), "--workers", "1"]) == 0
    assert main(["verify", str(copy)]) == 0
    now = times_of_change(copy)
    labels = [f"{frame:04d}" for frame in frames]
    touched = {name for name, time in now.items() if changed.get(name) != time}
    assert {name for name in touched if not any(label in name for label in labels)} == set()
    assert {name: digest for name, digest in contents(copy).items() if name != "holiday.exr"} == before


def test_a_whole_bake_is_left_alone(copy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    before = times_of_change(copy)
    assert main(["verify", str(copy)]) == 0
    assert main(["resume", str(copy)]) == 0
    assert "6 frames of disp,vel, all whole" in capsys.readouterr().out
    assert times_of_change(copy) == before


@pytest.mark.parametrize("content", [None, b"", b"{", b"[]", b"\xff\xfe", b'{"format": 1}'])
def test_the_job_is_told_by_the_images(
    copy: Path, content: bytes | None, capsys: pytest.CaptureFixture[str]
) -> None:
    job = (copy / "bake.json").read_bytes()
    before = contents(copy)
    if content is None:
        (copy / "bake.json").unlink()
    else:
        (copy / "bake.json").write_bytes(content)
    image(copy, 1).write_bytes(b"and the first image is damaged")
    image(copy, 6, "vel").unlink()
    assert main(["verify", str(copy)]) == 1
    assert "bake.json" in capsys.readouterr().err
    assert main(["resume", str(copy), "--workers", "1"]) == 0
    assert "written again" in capsys.readouterr().err
    assert contents(copy) == before
    restored = json.loads((copy / "bake.json").read_bytes())
    assert restored["fingerprint"] == json.loads(job)["fingerprint"]
    assert main(["verify", str(copy)]) == 0


def test_a_changed_job_is_noticed(copy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = (copy / "bake.json").read_text()
    (copy / "bake.json").write_text(text.replace('"frames": "1-6"', '"frames": "1-9"'))
    assert main(["verify", str(copy)]) == 1
    assert "was changed" in capsys.readouterr().err


def test_the_job_of_an_animated_sea_that_is_lost(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Images hold a frame's own parameters: they do not tell the others', and that is said."""
    animation = {"first_frame": 1, "samples": {"layers.0.wind_speed": [10, 11, 12]}}
    sea = write_sea(tmp_path / "sea.json", animation=animation)
    bake = ["bake", "--params", str(sea), "--frames", "1-3", "--out", str(tmp_path / "c"), "--workers", "1"]
    assert main(bake) == 0
    folder = only_folder(tmp_path / "c")
    before = times_of_change(folder)
    (folder / "bake.json").unlink()
    capsys.readouterr()
    assert main(["resume", str(folder)]) == 1
    assert "bake with the same arguments" in capsys.readouterr().err
    assert main(bake) == 0
    del before["bake.json"]
    assert before.items() <= times_of_change(folder).items()


def test_records_that_ask_for_too_many_frames_are_told(
    copy: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Each by itself may ask for a million; so many strangers' records together may not."""
    for index, path in enumerate(records(copy)):
        data = json.loads(path.read_bytes())
        del data["sha256"]
        first = index * 500_000
        path.write_text(json.dumps(sealed(data | {"asked": f"{first}-{first + 499_999}"})))
    assert main(["verify", str(copy)]) == 2
    assert "more than 1000000" in capsys.readouterr().err


def test_frames_asked_for_later_are_not_forgotten(tmp_path: Path) -> None:
    """The job's file is written once; what a longer bake wanted stands with the frames that it made."""
    sea = write_sea(tmp_path / "sea.json")
    bake = ["bake", "--params", str(sea), "--out", str(tmp_path / "c"), "--workers", "1", "--frames"]
    assert main([*bake, "1-2"]) == 0
    assert main([*bake, "1-5", "--only", "4"]) == 0
    folder = only_folder(tmp_path / "c")
    assert main(["verify", str(folder)]) == 1
    assert main(["resume", str(folder), "--workers", "1"]) == 0
    assert [read_record(folder, frame) is not None for frame in range(1, 7)] == [True] * 5 + [False]


def test_a_frame_that_the_disk_does_not_give_back(copy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A folder in the place of a file stands for whatever cannot be read."""
    size = image(copy, 2).stat().st_size
    image(copy, 2).unlink()
    image(copy, 2).mkdir()
    assert size
    assert main(["verify", str(copy)]) == 1
    out = capsys.readouterr().out
    assert "frame 2 is damaged" in out
    assert "6 frames: 5 whole, 1 damaged" in out


@pytest.mark.parametrize("command", ["resume", "verify"])
def test_what_was_given_to_out_means_the_bake_in_it(
    copy: Path, capsys: pytest.CaptureFixture[str], command: str
) -> None:
    """One is meant; of several each is listed, and none is touched."""
    cache = copy.parent.parent
    (cache / "notes").mkdir()
    (copy / "sea_disp.0002.exr").unlink()
    before = contents(copy)
    for place in (copy, copy.parent, cache):
        assert main([command, str(place), "--frames", "2"]) == (1 if command == "verify" else 0)
    capsys.readouterr()
    shutil.copytree(copy, copy.with_name("v002-01234567"))
    shutil.copytree(copy.parent, cache / "Other sea-1a")
    (cache / "Other sea-1a" / "v002-01234567" / "records" / "0006.json").unlink()
    before = contents(copy)
    assert main([command, str(cache)]) == 2
    printed = capsys.readouterr()
    assert printed.err == f"ocean_tweak: {cache}: holds 4 bakes: give the folder of one of them\n"
    assert [line.partition(": ")[0] for line in printed.out.splitlines()] == 2 * ["Other sea"] + 2 * ["sea"]
    assert f"Other sea: {cache / 'Other sea-1a' / 'v002-01234567'}, frames 1-5\n" in printed.out
    assert main([command, str(copy.parent), "--json"]) == 2
    listed = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert [(bake["sea"], bake["version"], bake["frames"]) for bake in listed] == [
        ("sea", 1, "1-6"), ("sea", 2, "1-6"),
    ]  # fmt: skip
    assert contents(copy) == before
    assert main([command, str(cache / "notes")]) == 1
