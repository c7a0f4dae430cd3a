# SPDX-License-Identifier: GPL-3.0-or-later
"""Hero waves through the command line: what `info` says of them, and frames that hold them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from ocean_tweak.cli import main
from tests.cli.commands import EXAMPLES, baked_heights, described

EXAMPLE = EXAMPLES / "hero-wave.json"


def test_info_says_when_and_where_and_how_fast(capsys: pytest.CaptureFixture[str]) -> None:
    (wave,) = described(capsys, "--params", str(EXAMPLE))["hero_waves"]
    assert (wave["x"], wave["y"], wave["time"], wave["frame"]) == (200.0, 200.0, 12.0, 289.0)
    assert wave["phase_speed"] == pytest.approx(9.679, rel=1e-3)  # √(g·60 m/2π)
    assert wave["group_speed"] == pytest.approx(4.839, rel=1e-3)
    assert main(["info", "--params", str(EXAMPLE), "--set", "layers.1.crest_height=9"]) == 0
    text = capsys.readouterr().out
    assert "9 m high at x = 200, y = 200 m at 12 s (frame 289)" in text
    assert "warning: Hero wave 0: waves 60 m long break" in text


def test_info_of_a_sea_without_them_is_what_it_was(capsys: pytest.CaptureFixture[str]) -> None:
    assert "hero_waves" not in described(capsys, "--params", str(EXAMPLE), "--set", "layers.1.muted=true")


def test_what_does_not_fit_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    """Its shortest wave is the (1 + 4.5·2.355/(2π·1.5))·400/60 = 14.2th of the patch: 2·(15 + 1) samples."""
    assert main(["info", "--params", str(EXAMPLE), "--set", "resolution=16"]) == 2
    assert "layers.1.wavelength = 60.0: needs 32 samples along each side" in capsys.readouterr().err


def test_a_baked_frame_holds_the_crest(tmp_path: Path) -> None:
    (height,) = baked_heights(
        tmp_path, "--params", str(EXAMPLE), "--frames", "289",
        "--set", "resolution=64", "--set", "layers.0.muted=true", "--set", "choppiness=0",
    )  # fmt: skip
    row, column = np.unravel_index(np.argmax(height), height.shape)
    assert column == 32
    assert row in (31, 32)  # rows of an image begin at its top
    assert height.max() == pytest.approx(3.5, rel=2e-3)
