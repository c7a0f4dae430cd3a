# SPDX-License-Identifier: GPL-3.0-or-later
"""A coast on the command line: its bed from a file, what it will be, and its area in images and in USD."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest

from ocean_tweak.cli import main, progress
from ocean_tweak.core import Area, Coast, Ocean, OceanParameters, Raster, Water
from ocean_tweak.core.numerics.memo import MEMO
from ocean_tweak.core.sea import coast_waves, memory
from ocean_tweak.export.exr import read_image
from ocean_tweak.export.sea_files import read_sea

SIZE = ["--set", "resolution=32", "--set", "domain_size=200", "--set", "water.depth=20"]


@pytest.fixture
def coast(tmp_path: Path) -> list[str]:
    bed = np.repeat(np.linspace(12.0, -1.0, 51, dtype=np.float32)[np.newaxis], 51, axis=0)
    np.save(tmp_path / "bed.npy", bed)
    changes = (f"depth.file={tmp_path / 'bed.npy'}", "spacing=4", "rim=80", "shortest_wavelength=40")
    return [*SIZE, *(word for change in changes for word in ("--set", f"coast.{change}"))]


def test_info_tells_heights_offshore_at_breaking_and_at_the_shore(
    coast: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["info", *coast, "--save", str(tmp_path / "sea.json")]) == 0
    told = capsys.readouterr().out
    assert "% of the energy" in told
    assert "where waves begin to break" in told
    assert "at the shore" in told
    assert main(["info", "--json", *coast]) == 0
    numbers = json.loads(capsys.readouterr().out)["ocean"]["coast"]
    assert numbers["offshore"] > numbers["breaking"] > numbers["shore"]
    saved = read_sea(tmp_path / "sea.json").parameters.coast
    assert saved is not None
    assert saved.depth is not None
    assert saved.depth.shape == (51, 51, 1)


def test_info_tells_first_what_it_takes_and_finds_it_again(
    coast: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("OCEAN_TWEAK_CACHE", str(tmp_path / "cache"))
    MEMO.drop()
    assert main(["info", *coast]) == 0
    told = capsys.readouterr()
    before = (
        r"over the coast's bed: \d+ frequencies on .*: [\d.]+ kB, about \d+ s; they hold \d+ % of the energy"
    )
    assert re.search(before, told.err)
    (path,) = (tmp_path / "cache" / "coasts").iterdir()
    MEMO.drop()
    with monkeypatch.context() as patched:
        patched.setattr(coast_waves, "pictures", lambda *_: pytest.fail("they were made again"))
        assert main(["info", *coast]) == 0
    assert re.sub(r"made in.*?s;", "", capsys.readouterr().out) == re.sub(r"made in.*?s;", "", told.out)
    path.write_bytes(path.read_bytes()[:-1])
    MEMO.drop()
    assert main(["info", *coast]) == 0
    assert "the waves are computed again" in capsys.readouterr().err
    assert MEMO.shelf is None


def test_a_bake_s_processes_share_the_waves_over_the_bed(
    coast: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.delenv("OCEAN_TWEAK_CACHE", raising=False)
    own = ["bake", *coast, "--area", "240", "48", "-20", "0", "--out", str(tmp_path / "out")]
    monkeypatch.setattr(progress, "_SILENCE", 0.0)
    MEMO.drop()
    assert main([*own, "--frames", "1-4", "--workers", "2"]) == 0
    assert "waves over the coast's bed: 100 %" in capsys.readouterr().out
    (path,) = (tmp_path / "out" / "coasts").iterdir()
    written = path.stat().st_mtime_ns
    assert len(list((tmp_path / "out").glob("*/*/*_disp.*.exr"))) == 4
    MEMO.drop()
    assert main([*own, "--frames", "5", "--workers", "1"]) == 0
    assert path.stat().st_mtime_ns > written  # it was used
    assert list((tmp_path / "out" / "coasts").iterdir()) == [path]  # and nothing of trials is kept


def test_an_area_is_baked_and_a_tile_refused_in_words(
    coast: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    own = ["bake", *coast, "--frames", "1", "--out", str(tmp_path / "out"), "--maps", "disp,foam"]
    assert main(own) == 2
    assert "ask for an Area" in capsys.readouterr().err
    assert main([*own, "--area", "240", "48", "-20", "0"]) == 0
    (image,) = (tmp_path / "out").glob("*/*/*_disp.0001.exr")
    pixels, _ = read_image(image)
    assert np.abs(pixels[:, -3:]).max() < 1e-5
    assert np.abs(pixels[..., 2]).max() > 0.3


def test_what_a_bake_takes_is_told_for_any_rim(
    coast: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The trial's samples are as far apart as the rim lets them, and fit into the domain: 5 m would not."""
    wide = [*coast, "--set", "domain_size=202", "--set", "coast.step=4", "--set", "coast.rim=60"]
    bake = ["bake", *wide, "--frames", "1-2", "--area", "200", "16", "-40", "0", "--estimate"]
    assert main([*bake, "--out", str(tmp_path)]) == 0
    assert "2 missing; about" in capsys.readouterr().out


def test_spray_has_no_tile_and_nothing_is_begun(
    coast: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    given = [*coast, "--set", "layers.0.wind_speed=15", "--area", "240", "16", "--frames", "1", "--spray"]
    for command in (["bake", "--out", str(tmp_path / "out")],
                    ["usd", "--form", "points", "--out", str(tmp_path / "out" / "sea.usd")]):  # fmt: skip
        assert main([*command, *given]) == 2
        told = capsys.readouterr().err
        assert "say where it is seen, --spray-place 0 0" in told
        assert not (tmp_path / "out").exists()


def test_a_coast_that_no_memory_holds_is_refused_before_it_is_begun(
    coast: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """By `info`, by `bake`, and by the waves themselves; each names what would make it smaller."""
    monkeypatch.setattr(memory, "usable_memory", lambda: 4 * 2**30)
    monkeypatch.setattr(coast_waves, "pictures", lambda *_: pytest.fail("it was begun"))
    told = r"needs \d+\.\d GB of memory.*: set a larger coast\.step or"
    sea = [*coast, "--set", "coast.step=0.1"]
    assert main(["info", *sea]) == 1
    assert re.search(f"of the waves {told}", capsys.readouterr().err)
    assert main(["bake", *sea, "--area", "200", "32", "--frames", "1", "--out", str(tmp_path / "out")]) == 1
    assert re.search(rf"Baking 32² samples with 1 worker {told}", capsys.readouterr().err)
    bed = Raster(np.load(tmp_path / "bed.npy")[..., np.newaxis])
    own = Coast(depth=bed, spacing=4.0, rim=80.0, shortest_wavelength=40.0, step=0.1)
    waves = Ocean(OceanParameters(resolution=32, domain_size=200.0, water=Water(depth=20.0), coast=own))
    with pytest.raises(MemoryError, match=f"of the waves {told}"):
        waves.surface(0.0, on=Area(200.0, 32))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ("coast.depht.file=bed.npy", "did you mean depth?"),
        ("coast.shore=+X", "give the bed"),
        ("coast.depth.file=none.npy", "none.npy"),
    ],
)
def test_a_slip_is_told_by_name(change: str, words: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["info", *SIZE, "--set", change]) == 2
    assert words in capsys.readouterr().err
