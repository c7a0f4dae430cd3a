# SPDX-License-Identifier: GPL-3.0-or-later
"""`bake --spray`: a file of particles a frame beside the images, made anew without them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from ocean_tweak.cli import FileSea, main
from ocean_tweak.core import Ocean, OceanParameters, Spray, WaveLayer
from ocean_tweak.core.parameters.shot import Shot
from ocean_tweak.core.sea.spray import TileSpray
from ocean_tweak.core.spray.columns import COLUMNS, columns
from ocean_tweak.export.ply import PlyError, read_ply

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
