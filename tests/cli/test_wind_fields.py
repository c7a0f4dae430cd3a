# SPDX-License-Identifier: GPL-3.0-or-later
"""Wind fields through the command line: from an image beside the JSON to baked frames."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from ocean_tweak.cli import main
from ocean_tweak.core import Ocean, OceanParameters
from tests.cli.commands import EXAMPLES, baked_heights, described
from tests.layers import layers_of

EXAMPLE = EXAMPLES / "wind-front.json"


def test_the_example_is_what_its_script_makes() -> None:
    from examples.wind_front import parameters

    assert OceanParameters.from_json(EXAMPLE.read_text(encoding="utf-8")) == parameters()


def test_info_tells_of_the_winds_waves(capsys: pytest.CaptureFixture[str]) -> None:
    report = described(capsys, "--params", str(EXAMPLE), "--set", "resolution=128")
    assert 10.0 < report["wind_fields"]["longest_wavelength"] < 30.0
    assert main(["info", "--params", str(EXAMPLE), "--set", "layers.1.wind_scale=0.1"]) == 0
    text = capsys.readouterr().out
    assert "not counted in the heights above" in text
    assert "raises no waves" in text
    assert main(["info", "--params", str(EXAMPLE), "--set", "resolution=32"]) == 0
    assert "shorter than 4 samples" in capsys.readouterr().out


def test_the_front_crosses_the_patch(tmp_path: Path) -> None:
    heights = baked_heights(
        tmp_path, "--params", str(EXAMPLE), "--frames", "289,577",
        "--set", "resolution=128", "--set", "layers.0.muted=true", "--workers", "2",
    )  # fmt: skip
    early, late = (np.std(height, axis=0) for height in heights)
    ahead = slice(70, 90)  # 130 to 170 m: at 12 s the front is at 96 m
    assert late[ahead].mean() > 0.1
    assert early[ahead].mean() < 0.2 * late[ahead].mean()


def test_an_image_beside_the_file_is_the_wind(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A red image, of which green and blue are nothing, is a wind towards +x."""
    image = pytest.importorskip("PIL.Image")
    image = image.new("RGB", (2, 1), (255, 0, 0))
    image.save(tmp_path / "wind.png")
    wind = {"file": "wind.png", "offset": 0.0, "scale": 8.0}
    sea = {
        "resolution": 64, "domain_size": 40.0, "layers": [{"muted": True}],
        "wind_fields": [{"keys": [{"vectors": wind}], "rows": 4, "columns": 4}],
    }  # fmt: skip
    (tmp_path / "sea.json").write_text(json.dumps(sea))
    report = described(capsys, "--params", str(tmp_path / "sea.json"))
    parameters = OceanParameters.from_dict(report["parameters"])
    (raster,) = layers_of(parameters, "WIND_FIELD")[0].rasters
    np.testing.assert_array_equal(raster.values, np.full((1, 2, 2), (8.0, 0.0)))
    assert raster.name == "wind.png"
    assert Ocean(parameters).surface(0.0).displacement[..., 2].max() > 0.05
    (tmp_path / "wind.png").unlink()
    assert main(["info", "--params", str(tmp_path / "sea.json")]) == 2
    assert "layers.1.keys.0.vectors.file" in capsys.readouterr().err
