# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of version 0.1.0 without Blender: a sea with the heights that it showed, a bake, and a preset."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from ocean_tweak.cli import main
from ocean_tweak.core import Ocean
from ocean_tweak.core.parameters.presets import Preset
from ocean_tweak.export.exr import read_image
from ocean_tweak.export.sea_files import read_sea

RELEASE = Path(__file__).parents[1] / "data" / "0.1.0"


@pytest.fixture
def version(tmp_path: Path) -> Path:
    """A copy of the bake."""
    (folder,) = (Path(shutil.copytree(RELEASE / "cache", tmp_path / "cache"))).glob("*/v001-*")
    return folder


@pytest.mark.parametrize("frame", [1, 3])
def test_its_sea_has_the_heights_that_it_showed(frame: int) -> None:
    """The positions of vertices that Blender had, of every fourth sample."""
    shot = read_sea(RELEASE / "sea.json")
    with np.load(RELEASE / "shown.npz") as data:
        wanted = data[f"Live-{frame}"]
    moved = Ocean(shot.at(frame).parameters).surface(shot.parameters.timing.time(frame)).displacement
    np.testing.assert_allclose(moved[::4, ::4, 2], wanted[:-1, :-1, 2], atol=1e-4)


def test_its_preset_is_that_sea_at_the_frame_when_it_was_saved() -> None:
    preset = Preset.from_json((RELEASE / "presets" / "rocky_bay.json").read_text())
    assert (preset.title, preset.description) == ("Rocky Bay", "Waves about a rock")
    assert preset.parameters.layers == read_sea(RELEASE / "sea.json").at(3).parameters.layers


def test_its_bake_is_known_whole_and_not_made_again(version: Path, capsys: pytest.CaptureFixture) -> None:
    before = {path: path.stat().st_mtime_ns for path in version.glob("*.exr")}
    assert len(before) == 3 * 5
    for command in ("verify", "resume"):
        assert main([command, str(version)]) == 0, capsys.readouterr().err
    assert {path: path.stat().st_mtime_ns for path in version.glob("*.exr")} == before


def test_a_lost_frame_of_it_is_made_as_before(version: Path) -> None:
    lost = version / "Baked_disp.0002.exr"
    before, _ = read_image(lost)
    lost.unlink()
    assert main(["resume", str(version)]) == 0
    again, _ = read_image(lost)
    assert np.ptp(before) > 0.5
    np.testing.assert_allclose(again, before, atol=1e-4)
