# SPDX-License-Identifier: GPL-3.0-or-later
"""What `info` says of equalisers, currents and measured seas."""

from __future__ import annotations

from pathlib import Path

import pytest

from ocean_tweak.cli import main
from tests.cli.commands import baked_heights, described
from tests.export.spectrum_files import BUOY_FILES

SMALL = ("--set", "resolution=64", "--set", "domain_size=200")


def test_info_says_the_height_before_and_after_an_equaliser(capsys: pytest.CaptureFixture[str]) -> None:
    """All bands at -6.0206 dB halve every height."""
    bands = [f"equaliser.{name}=-6.0206" for name in (
        "longer_3", "longer_2", "longer_1", "peak", *(f"shorter_{octave}" for octave in range(1, 7))
    )]  # fmt: skip
    assert main(["info", *SMALL, *(word for band in bands for word in ("--set", band))]) == 0
    printed = capsys.readouterr().out
    words = next(line for line in printed.splitlines() if "equaliser" in line).split()
    before, after = float(words[2]), float(words[6])
    assert after == pytest.approx(0.5 * before, abs=0.006)
    assert main(["info", *SMALL]) == 0
    assert "equaliser" not in capsys.readouterr().out


def test_a_current_and_an_equaliser_can_be_set(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    sea = described(
        capsys, *SMALL, "--set", "current.speed=1.5", "--set", "layers.0.equaliser.peak=-3"
    )["parameters"]  # fmt: skip
    assert sea["current"]["speed"] == 1.5
    assert sea["layers"][0]["equaliser"] == {"peak": -3.0}
    same = ("--set", "resolution=32", "--frames", "1,2")
    still = baked_heights(tmp_path / "still", *same)
    carried = baked_heights(tmp_path / "carried", *same, "--set", "current.speed=1.5")
    assert (still[0] == carried[0]).all()  # at time 0 nothing has moved
    assert not (still[1] == carried[1]).all()


def test_a_buoys_sea_is_baked_with_its_own_height(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    out = tmp_path / "buoy.json"
    assert main(["spectrum", *map(str, BUOY_FILES), "--out", str(out)]) == 0
    capsys.readouterr()
    arguments = ("--params", str(out), "--set", "resolution=256", "--set", "domain_size=700")
    (heights,) = baked_heights(tmp_path / "cache", *arguments, "--frames", "1")
    assert 4.0 * heights.std() == pytest.approx(1.12, rel=0.08)
