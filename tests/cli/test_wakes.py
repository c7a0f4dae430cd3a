# SPDX-License-Identifier: GPL-3.0-or-later
"""Wakes through the command line: what `info` says of them, and frames of areas that hold them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from ocean_tweak.cli import main
from tests.cli.commands import EXAMPLES, baked_heights, described

EXAMPLE = EXAMPLES / "ship.json"
#: of few samples: 6.4 m apart around the place where the ship is after 30 s, at frame 721
AREA = ("--area", "409.6", "64", "46", "-212")
SMALL = ("--set", "patches.0.resolution=64", "--set", "patches.0.shortest_wavelength=125",
         "--set", "patches.1.longest_wavelength=125", "--set", "patches.1.resolution=64")  # fmt: skip


def test_info_says_how_fast_and_how_long(capsys: pytest.CaptureFixture[str]) -> None:
    (wake,) = described(capsys, "--params", str(EXAMPLE))["wake"]
    assert wake["speed"] == pytest.approx(8.5, abs=0.01)
    assert wake["froude"] == pytest.approx(8.5 / np.sqrt(9.81 * 90.0), rel=1e-3)
    assert wake["wavelength"] == pytest.approx(2.0 * np.pi * 8.5**2 / 9.81, rel=2e-3)
    assert main(["info", "--params", str(EXAMPLE), "--set", "layers.1.area_size=600"]) == 0
    text = capsys.readouterr().out
    assert "wake 0: up to 8.5 m/s, Froude number 0.29; transverse waves 46.3 m" in text
    assert "warning: Wake 0" in text
    assert "come around the area" in text


def test_a_sea_that_has_a_wake_has_no_tile(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    given = ["--params", str(EXAMPLE), "--frames", "1", "--out", str(tmp_path)]
    assert main(["bake", *given]) == 2
    assert "layers.1" in (told := capsys.readouterr().err)
    assert "ask for an Area or Places (--area on the command line" in told


def test_frames_of_an_area_are_the_same_alone_and_in_a_row(tmp_path: Path) -> None:
    given = ("--params", str(EXAMPLE), *SMALL, *AREA)
    row = baked_heights(tmp_path / "row", *given, "--frames", "720-721", "--workers", "1")
    (alone,) = baked_heights(tmp_path / "alone", *given, "--frames", "721")
    (calm,) = baked_heights(tmp_path / "calm", *given, "--frames", "721", "--set", "layers.1.muted=true")
    np.testing.assert_array_equal(alone, row[1])
    hull = np.abs(alone - calm)[28:36, 28:37]  # where it presses the water down
    assert hull.max() > 3.0
    assert np.abs(alone - calm).mean() > 0.02


def test_a_hull_s_mesh_takes_the_place_of_the_ellipse(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    """A box of 30 by 6 m, 2 m deep in the water: F = U/√(gL) follows from its length."""
    corners = [(x, y, z) for z in (-2.0, 3.0) for x in (-15.0, 15.0) for y in (-3.0, 3.0)]
    faces = ((1, 2, 4, 3), (5, 7, 8, 6), (1, 3, 7, 5), (2, 6, 8, 4), (1, 5, 6, 2), (3, 4, 8, 7))
    lines = [
        *("v {} {} {}".format(*each) for each in corners),
        *("f {} {} {} {}".format(*each) for each in faces),
    ]
    (tmp_path / "box.obj").write_text("\n".join(lines))
    given = ("--params", str(EXAMPLE), "--set", f"layers.1.footprint.file={tmp_path / 'box.obj'}")
    (wake,) = described(capsys, *given)["wake"]
    assert wake["froude"] == pytest.approx(8.5 / np.sqrt(9.81 * 30.0), rel=1e-3)
    assert wake["draught"] == pytest.approx(2.0)
    assert wake["narrow"] == pytest.approx(6.0)
    (tmp_path / "box.obj").write_text("\n".join(lines[:8]))
    assert main(["info", *given]) == 2
    assert "layers.1.footprint.file" in (told := capsys.readouterr().err)
    assert "no faces" in told
