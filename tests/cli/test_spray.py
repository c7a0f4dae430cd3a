# SPDX-License-Identifier: GPL-3.0-or-later
"""`bake --spray`: a file of particles a frame beside the images, made anew without them."""

from __future__ import annotations

import json
import os
import re
import shutil
from pathlib import Path

import numpy as np
import pytest

from ocean_tweak.cli import FileSea, baking, main
from ocean_tweak.core import Ocean, OceanParameters, Spray, WaveLayer
from ocean_tweak.core.parameters.shot import Shot
from ocean_tweak.core.sea.spray import TileSpray
from ocean_tweak.core.spray.columns import COLUMNS, columns
from ocean_tweak.export.ply import PlyError, read_ply, told_by_ply

SEA = OceanParameters(
    resolution=64, domain_size=100.0, seed=2, layers=(WaveLayer(wind_speed=22.0, fetch=300e3),)
)


@pytest.fixture
def sea(tmp_path: Path) -> Path:
    path = tmp_path / "sea.json"
    path.write_text(SEA.to_json(), encoding="utf-8")
    return path


def bake(sea: Path, *more: str, frames: str = "12-13") -> int:
    return main(["bake", "--params", str(sea), "--frames", frames, "--out", str(sea.parent / "out"), *more])


def files(sea: Path, pattern: str) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in sorted(sea.parent.glob(f"out/*/*/{pattern}"))}


def test_files_hold_the_particles(sea: Path) -> None:
    assert bake(sea, "--spray") == 0
    (path,) = sea.parent.glob("out/*/*/spray/sea_spray.0012.ply")
    found = read_ply(path, (COLUMNS,))
    expected = columns(TileSpray(Ocean(SEA)).at(11 / 24.0, Spray()))
    assert len(expected) > 500
    np.testing.assert_array_equal(np.stack([found[name] for name in COLUMNS], axis=-1), expected)


def test_one_frame_alone_has_the_bytes_of_the_sequence(sea: Path) -> None:
    assert bake(sea, "--spray") == 0
    whole = files(sea, "spray/*.ply")
    for path in sea.parent.glob("out/*/*/spray/*.ply"):
        path.unlink()
    assert bake(sea, "--spray", "--only", "13") == 0
    assert files(sea, "spray/*.ply") == {"sea_spray.0013.ply": whole["sea_spray.0013.ply"]}


def test_another_amount_bakes_no_sea_anew(sea: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert bake(sea, "--spray") == 0
    images, spray = files(sea, "*.exr"), files(sea, "spray/*.ply")
    capsys.readouterr()
    assert bake(sea, "--spray") == 0
    assert "sea_spray" not in capsys.readouterr().out  # all whole
    assert bake(sea, "--spray", "--set", "spray.amount=2", "--set", "spray.life=1") == 0
    said = capsys.readouterr().out
    assert "all whole" in said
    assert "sea_spray.0012.ply" in said
    assert files(sea, "*.exr") == images
    again = files(sea, "spray/*.ply")
    assert all(len(again[name]) > 1.5 * len(spray[name]) for name in spray)


def test_an_estimate_counts_spray(sea: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Of frames without a file, whatever images there are; and nothing is written."""
    wide = ("--set", "domain_size=400", "--set", "resolution=128")  # gusts and breakers even out

    def told(*more: str) -> int:
        assert bake(sea, "--estimate", "--json", *wide, *more, frames="12-14") == 0
        line = next(line for line in capsys.readouterr().out.splitlines() if '"seconds"' in line)
        found = json.loads(line)
        assert found["seconds"] > 0.0 or not found["bytes"]
        return int(found["bytes"])

    spray = told("--spray") - told()
    assert not list(sea.parent.glob("out/*/*/spray"))
    assert bake(sea, "--spray", *wide, frames="12-14") == 0
    sizes = [len(content) for content in files(sea, "spray/*.ply").values()]
    assert spray == pytest.approx(sum(sizes), rel=0.25)
    (path,) = sea.parent.glob("out/*/*/spray/sea_spray.0012.ply")
    path.unlink()
    capsys.readouterr()
    assert told("--spray") - told() == pytest.approx(spray / 3, rel=0.25)


def test_a_disk_without_room_for_spray_is_told_first(
    sea: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    usage = shutil.disk_usage(sea.parent)
    monkeypatch.setattr(shutil, "disk_usage", lambda _: usage._replace(free=400_000))
    assert bake(sea) == 0  # there is room for images
    assert bake(sea, "--spray", "--set", "spray.amount=20") == 1
    assert re.search(r"2 frames need about [\d.]+ \w+, and the disk has", capsys.readouterr().err)
    assert not list(sea.parent.glob("out/*/*/spray/*.ply"))


def test_a_file_cut_off_is_made_again(sea: Path) -> None:
    assert bake(sea, "--spray", frames="12") == 0
    (path,) = sea.parent.glob("out/*/*/spray/*.ply")
    before = path.read_bytes()
    path.write_bytes(before[:-4])
    with pytest.raises(PlyError, match="does not match its header"):
        read_ply(path, (COLUMNS,))
    assert bake(sea, "--spray", frames="12") == 0
    assert path.read_bytes() == before


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        (("layers.0.wind_speed=6",), "wind of 6 m/s tears nothing off"),
        (("foam.coverage=0",), "has no foam"),
        (("spray.amount=100", "domain_size=4000"), "would do"),
    ],
)
def test_what_cannot_be_is_refused_before_anything_is_written(
    sea: Path, capsys: pytest.CaptureFixture[str], changes: tuple[str, ...], reason: str
) -> None:
    assert bake(sea, "--spray", *(f"--set={change}" for change in changes)) == 2
    assert reason in capsys.readouterr().err
    assert not (sea.parent / "out").exists()


def test_patches_apart_need_a_place(sea: Path, capsys: pytest.CaptureFixture[str]) -> None:
    plan = ("--plan", "finest=4,area=150")
    assert bake(sea, "--spray", *plan) == 2
    assert "--spray-place" in capsys.readouterr().err
    assert bake(sea, "--spray-place", "0", "0") == 2


@pytest.mark.parametrize(
    ("place", "reason"),
    [(("0", "0"), "is for a sea of patches"), (("nan", "0"), "'nan' must be a number of metres")],
)
def test_a_place_that_would_be_ignored_or_is_none_is_refused(
    sea: Path, capsys: pytest.CaptureFixture[str], place: tuple[str, str], reason: str
) -> None:
    assert bake(sea, "--spray", "--spray-place", *place) == 2
    assert reason in capsys.readouterr().err
    assert bake(sea, "--spray", "--plan", "finest=4,area=150", "--spray-place", "0", "1e400") == 2
    assert not (sea.parent / "out").exists()


def test_no_sea_is_baked_where_another_has_no_spray(tmp_path: Path) -> None:
    calm = SEA.replace(layers=(WaveLayer(wind_speed=5.0, fetch=300e3),))
    seas = {name: FileSea(Shot(each), frames=(1,)) for name, each in (("storm", SEA), ("calm", calm))}
    assert main(["bake", "--out", str(tmp_path / "out"), "--spray"], lambda: seas) == 2
    assert not (tmp_path / "out").exists()


@pytest.fixture
def baked(sea: Path) -> Path:
    """The folder of a bake of frames 12 and 13 with spray."""
    assert bake(sea, "--spray") == 0
    (folder,) = sea.parent.glob("out/*/v*")
    return folder


def spoil(path: Path, how: str) -> None:
    content = path.read_bytes()
    if how == "is missing":
        path.unlink()
    elif how == "is cut off or damaged":
        path.write_bytes(content[:-1])
    else:
        path.write_bytes(content[:-4] + np.float32(np.nan).tobytes())


@pytest.mark.parametrize("how", ["is missing", "is cut off or damaged", "holds values that are not finite"])
def test_spray_that_is_not_whole_is_found_and_made_again(
    baked: Path, capsys: pytest.CaptureFixture[str], how: str
) -> None:
    assert main(["verify", str(baked)]) == 0
    path = baked / "spray/sea_spray.0013.ply"
    before = path.read_bytes()
    spoil(path, how)
    capsys.readouterr()
    assert main(["verify", str(baked)]) == 1
    assert f"frame 13 is damaged: sea_spray.0013.ply {how}" in capsys.readouterr().out
    if "finite" in how:  # only who reads all of it sees this
        path.unlink()
    assert main(["resume", str(baked)]) == 0
    assert path.read_bytes() == before
    assert main(["verify", str(baked)]) == 0


def test_spray_of_other_settings_is_found_and_made_again(
    sea: Path, baked: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert bake(sea, "--spray", "--only", "12", "--set", "spray.amount=0.5") == 0
    assert main(["verify", str(baked)]) == 1
    assert "sea_spray.0013.ply is of other settings or another version" in capsys.readouterr().out
    assert main(["resume", str(baked)]) == 0
    assert main(["verify", str(baked)]) == 0
    sizes = [path.stat().st_size for path in sorted(baked.glob("spray/*.ply"))]
    assert sizes[1] == pytest.approx(sizes[0], rel=0.2)


def test_a_bake_that_ended_before_its_spray_goes_on_with_it(
    sea: Path, baked: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = files(sea, "spray/*.ply")
    shutil.rmtree(baked)
    monkeypatch.setattr(baking, "_make", lambda *_: 1)
    assert bake(sea, "--spray") == 1
    monkeypatch.undo()
    assert main(["resume", str(baked)]) == 0
    assert files(sea, "spray/*.ply") == whole


def test_what_was_asked_for_and_cannot_be_read_is_told(
    baked: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for text in ("{", '{"format": 1}', '{"spray": {"amount": -1}, "place": null}', "[" * 10_000):
        (baked / "spray/spray.json").write_text(text, encoding="utf-8")
        assert main(["verify", str(baked)]) == 1
        assert "bake the sea with --spray again" in capsys.readouterr().err


def test_clean_takes_spray_away_and_nothing_else(baked: Path, capsys: pytest.CaptureFixture[str]) -> None:
    own = baked / "spray/mine_spray.0012.ply"
    own.write_bytes(b"ply")
    assert main(["clean", str(baked), "--frames", "12"]) == 0
    assert {path.name for path in baked.glob("spray/*")} == {
        "sea_spray.0013.ply", "mine_spray.0012.ply", "spray.json",
    }  # fmt: skip
    assert main(["clean", str(baked)]) == 0
    assert "kept what no record lists: spray/mine_spray.0012.ply" in capsys.readouterr().out
    assert [path.name for path in baked.glob("spray/*.ply")] == [own.name]
    own.unlink()
    assert main(["clean", str(baked)]) == 0
    assert not baked.exists()


@pytest.mark.skipif(os.name == "nt", reason="links need a privilege there")
def test_spray_elsewhere_is_left_alone(sea: Path, baked: Path, capsys: pytest.CaptureFixture[str]) -> None:
    elsewhere = baked.parent.parent / "elsewhere"
    (baked / "spray").rename(elsewhere)
    (baked / "spray").symlink_to(elsewhere)
    kept = {path.name: path.read_bytes() for path in elsewhere.iterdir()}
    assert main(["clean", str(baked)]) == 1
    assert bake(sea, "--spray", "--set", "spray.amount=2") == 1
    assert "is a link to something that may not belong to this bake" in capsys.readouterr().err
    assert {path.name: path.read_bytes() for path in elsewhere.iterdir()} == kept


def test_the_tasks_of_a_farm_bake_and_verify_it(sea: Path, tmp_path: Path) -> None:
    arguments = ["--params", str(sea), "--frames", "12-13", "--chunk", "1", "--plain-ranges"]
    wanted = [
        "--spray",
        "--set",
        "spray.life=1.5",
        "--plan",
        "finest=4,area=150",
        "--spray-place",
        "-20",
        "5",
    ]
    assert main(["job", *arguments, *wanted, "--maps", "disp", "--out", str(tmp_path / "job")]) == 0
    template = json.loads((tmp_path / "job/template.json").read_text(encoding="utf-8"))
    tasks = {step["name"]: step["script"]["actions"]["onRun"]["args"] for step in template["steps"]}
    for frames in ("12", "13"):  # each on a machine of its own
        assert main(task(tasks["Bake"], frames, tmp_path)) == 0
    (path,) = tmp_path.glob("out/*/v*/spray/sea_spray.0013.ply")
    told = told_by_ply(path, (COLUMNS,))
    assert told is not None
    assert told["spray"]["life"] == 1.5
    assert told["place"] == [-20.0, 5.0]
    assert main(task(tasks["Verify"], "13", tmp_path)) == 0
    path.unlink()
    assert main(task(tasks["Verify"], "13", tmp_path)) == 1


def task(words: list[str], frames: str, folder: Path) -> list[str]:
    """The arguments of a task, with what a farm fills in."""
    values = {"Param.Seas": str(folder / "job/seas"), "Param.Cache": str(folder / "out")}
    values |= {"Param.Frames": "12-13", "Task.Param.Frames": frames}
    for name, value in values.items():
        words = [word.replace(f"{{{{{name}}}}}", value) for word in words]
    assert words[:2] == ["-m", "ocean_tweak"]
    return [word for word in words[2:] if word != "--openjd"]


@pytest.mark.parametrize(
    "head",
    [
        b"ply\nformat binary_little_endian 1.0\nend_header\n",
        b"ply\nformat binary_little_endian 1.0\ncomment Ocean Tweak " + b"[" * 3000 + b"\nend_header\n",
        b"ply\nformat binary_little_endian 1.0\ncomment Ocean Tweak {}\nelement vertex x\nend_header\n",
        b"ply\nformat ascii 1.0\nelement vertex 0\nend_header\n", b"", b"\xff\xd8\xff",
    ],
)  # fmt: skip
def test_a_file_of_others_is_none_of_ours(tmp_path: Path, head: bytes) -> None:
    path = tmp_path / "sea_spray.0001.ply"
    columns = b"".join(b"property float %s\n" % name.encode() for name in COLUMNS)
    path.write_bytes(head.replace(b"element vertex x\n", b"element vertex x\n" + columns))
    assert told_by_ply(path, (COLUMNS,)) is None
    with pytest.raises(PlyError, match="not readable points of Ocean Tweak"):
        read_ply(path, (COLUMNS,))


def test_info_says_how_much_there_will_be(sea: Path, capsys: pytest.CaptureFixture[str]) -> None:
    large = SEA.replace(resolution=128, domain_size=400.0)
    sea.write_text(large.to_json(), encoding="utf-8")
    info, spray = ["info", "--params", str(sea), "--set"], 'spray={"amount": 0.2}'
    assert main([*info, spray, "--json"]) == 0
    particles = json.loads(capsys.readouterr().out)["sea"]["spray"]["particles"]
    made = [len(TileSpray(Ocean(large)).at(time, Spray(amount=0.2)).age) for time in (3.0, 41.0)]
    assert particles == pytest.approx(np.mean(made), rel=0.5)
    assert main([*info, spray]) == 0
    said = capsys.readouterr().out
    assert "particles on the tile" in said
    assert main([*info, spray, "--set", "layers.0.wind_speed=6"]) == 0
    assert "this sea has no spray, because its wind of 6 m/s tears nothing off" in capsys.readouterr().out
    assert main(info[:-1]) == 0
    assert "spray" not in capsys.readouterr().out
