# SPDX-License-Identifier: GPL-3.0-or-later
"""Clean deletes what records list and lies in the folder; all else is left and said."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from ocean_tweak.cli import main
from ocean_tweak.export.cache.job import sealed
from tests.batch.bakery import contents


def relist(folder: Path, frame: int, name: str, map_name: str = "disp") -> None:
    """Let a frame's record list another file, and be whole in itself."""
    path = folder / "records" / f"{frame:04d}.json"
    data = json.loads(path.read_text())
    del data["sha256"]
    entry = {"map": map_name, "name": name, "bytes": 4, "sha256": "0" * 64}
    path.write_text(json.dumps(sealed({**data, "files": [*data["files"], entry]})))


def test_everything_goes(copy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (copy / "locks" / ".x.lock.0123.part").write_text("of a killed process")
    assert main(["clean", str(copy)]) == 0
    assert "12 files deleted" in capsys.readouterr().out
    assert not copy.parent.exists()
    assert copy.parent.parent.is_dir()


def test_other_versions_stay(copy: Path) -> None:
    other = copy.with_name("v002-01234567")
    shutil.copytree(copy, other)
    before = contents(other)
    assert main(["clean", str(copy)]) == 0
    assert not copy.exists()
    assert contents(other) == before


def test_only_some_frames(copy: Path) -> None:
    before = contents(copy)
    assert main(["clean", str(copy), "--frames", "2-3,99"]) == 0
    gone = before.keys() - contents(copy).keys()
    assert gone == {
        name.format(frame)
        for frame in (2, 3)
        for name in ("sea_disp.000{}.exr", "sea_vel.000{}.exr", "000{}.json")
    }
    assert main(["verify", str(copy)]) == 1


def test_foreign_files_stay(copy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (copy / "notes.txt").write_text("mine")
    (copy / "sea_disp.0099.exr").write_text("of nobody")
    (copy / "folder").mkdir()
    assert main(["clean", str(copy)]) == 0
    assert "kept what no record lists: folder, notes.txt, sea_disp.0099.exr" in capsys.readouterr().out
    assert sorted(path.name for path in copy.iterdir()) == [
        "bake.json", "folder", "notes.txt", "sea_disp.0099.exr",
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("../precious_disp.0003.exr", "is not the name of a file in the folder"),
        ("{outside}", "is not the name of a file in the folder"),
        ("..", "is not the name of a file in the folder"),
        ("..\\precious_disp.0003.exr", "is not the name of a file in the folder"),
        ("x\nopenjd_env: A=B", "is not the name of a file in the folder"),
        ("notes.txt", "is not named like a frame's image"),
        ("bake.json", "is not named like a frame's image"),
        ("sea_disp.0004.exr", "is not named like a frame's image"),
        ("link_disp.0003.exr", "is a link"),
        ("dir_disp.0003.exr", "is a folder"),
    ],
)
def test_what_a_record_may_not_name(
    copy: Path, capsys: pytest.CaptureFixture[str], name: str, said: str
) -> None:
    outside = copy.parent / "precious_disp.0003.exr"
    outside.write_text("mine")
    (copy / "notes.txt").write_text("mine")
    (copy / "link_disp.0003.exr").symlink_to(outside)
    (copy / "dir_disp.0003.exr").mkdir()
    relist(copy, 3, name.replace("{outside}", str(outside)))
    keep = [outside, copy / "notes.txt", copy / "bake.json", copy / "sea_disp.0004.exr"]
    before = [path.read_bytes() for path in keep]
    assert main(["clean", str(copy), "--frames", "1-3"]) == 1
    out = capsys.readouterr().out
    assert said in out
    assert "left " in out
    assert [path.read_bytes() for path in keep] == before
    assert (copy / "link_disp.0003.exr").is_symlink()
    assert (copy / "dir_disp.0003.exr").is_dir()
    assert (copy / "records" / "0003.json").exists()  # what is left is still known
    assert not (copy / "records" / "0002.json").exists()


def test_records_that_are_a_link_elsewhere(copy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    elsewhere = copy.parent / "elsewhere"
    (copy / "records").rename(elsewhere)
    (copy / "records").symlink_to(elsewhere)
    before = contents(copy)
    assert main(["clean", str(copy)]) == 1
    assert "is a link" in capsys.readouterr().err
    assert contents(copy) == before
    assert len(list(elsewhere.iterdir())) == 6


def test_a_link_to_the_folder_is_the_folder(copy: Path, tmp_path: Path) -> None:
    link = tmp_path / "link"
    link.symlink_to(copy)
    assert main(["clean", str(link)]) == 0
    assert not copy.exists()


@pytest.mark.parametrize("make", ["nothing", "a file", "a job of somebody else", "a folder of its name"])
def test_folders_that_are_no_bake(tmp_path: Path, capsys: pytest.CaptureFixture[str], make: str) -> None:
    folder = tmp_path / ("v001-01234567" if make == "a folder of its name" else "precious")
    folder.mkdir()
    if make == "a file":
        (folder / "thesis.txt").write_text("mine")
    if make == "a job of somebody else":
        (folder / "bake.json").write_text('{"format": 1}')
        (folder / "records").mkdir()
    before = sorted(tmp_path.rglob("*"))
    assert main(["clean", str(folder)]) == 1
    assert "is not a bake's folder" in capsys.readouterr().err
    assert sorted(tmp_path.rglob("*")) == before


def test_a_damaged_record_is_left_and_said(copy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (copy / "records" / "0003.json").write_text("{")
    assert main(["clean", str(copy)]) == 1
    assert "so its files are not known" in capsys.readouterr().out
    assert sorted(path.name for path in copy.glob("*.exr")) == ["sea_disp.0003.exr", "sea_vel.0003.exr"]
    # mended, it can go
    assert main(["resume", str(copy), "--frames", "3", "--workers", "1"]) == 0
    assert main(["clean", str(copy)]) == 0
    assert not copy.exists()
