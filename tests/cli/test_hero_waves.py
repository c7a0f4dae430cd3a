# SPDX-License-Identifier: GPL-3.0-or-later
"""Hero waves through the command line: what `info` says of them, and frames that hold them."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from ocean_tweak.cli import main
from ocean_tweak.export.exr import read_image

EXAMPLE = Path(__file__).parents[2] / "examples" / "hero-wave.json"


def test_info_says_when_and_where_and_how_fast(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["info", "--json", "--params", str(EXAMPLE)]) == 0
    (report,) = json.loads(capsys.readouterr().out).values()
    (wave,) = report["hero_waves"]
    assert (wave["x"], wave["y"], wave["time"], wave["frame"]) == (200.0, 200.0, 12.0, 289.0)
    assert wave["phase_speed"] == pytest.approx(9.679, rel=1e-3)  # √(g·60 m/2π)
    assert wave["group_speed"] == pytest.approx(4.839, rel=1e-3)
    assert main(["info", "--params", str(EXAMPLE), "--set", "hero_waves.0.crest_height=9"]) == 0
    text = capsys.readouterr().out
    assert "9 m high at x = 200, y = 200 m at 12 s (frame 289)" in text
    assert "warning: Hero wave 0: waves of 60 m break" in text


def test_info_of_a_sea_without_them_is_what_it_was(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["info", "--json", "--params", str(EXAMPLE), "--set", "hero_waves.0.muted=true"]) == 0
    (report,) = json.loads(capsys.readouterr().out).values()
    assert "hero_waves" not in report


def test_what_does_not_fit_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    """Its shortest wave is the (1 + 4.5·2.355/(2π·1.5))·400/60 = 14.2th of the patch: 2·(15 + 1) samples."""
    assert main(["info", "--params", str(EXAMPLE), "--set", "resolution=16"]) == 2
    assert "hero_waves.0.wavelength = 60.0: needs 32 samples a side" in capsys.readouterr().err


def test_a_baked_frame_holds_the_crest(tmp_path: Path) -> None:
    code = main(
        [
            "bake", "--params", str(EXAMPLE), "--frames", "289", "--out", str(tmp_path),
            "--set", "resolution=64", "--set", "layers.0.muted=true", "--set", "choppiness=0",
        ]
    )  # fmt: skip
    assert code == 0
    (path,) = tmp_path.glob("*/v*/*_disp.*.exr")
    height = read_image(path)[0][..., 2]
    row, column = np.unravel_index(np.argmax(height), height.shape)
    assert column == 32
    assert row in (31, 32)  # rows of a picture begin at its top
    assert height.max() == pytest.approx(3.5, rel=2e-3)
