# SPDX-License-Identifier: GPL-3.0-or-later
"""Joined patches and masked layers on the command line: told, baked, verified, exported."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from ocean_tweak.cli import main
from ocean_tweak.core import Ocean, OceanParameters
from ocean_tweak.export.exr import read_header, read_image
from tests.cli.test_cascades import SEA

SAMPLES = 64
EVERY_MAP = "disp,foam,normal,vel,slope,strain"
MASKED = {
    "seed": 2,
    "resolution": 32,
    "domain_size": 150.0,
    "layers": [
        {
            "wind_speed": 11.0,
            "mask": {"source": "DISTANCE", "x": 40.0, "y": 50.0, "inner_radius": 10.0, "outer_radius": 60.0},
        },
        {"wind_speed": 4.0, "fetch": 3000.0, "mask": {"source": "IMAGE", "image": {"file": "coast.png"}}},
    ],
    "foam": {"half_life": 0.3},
}  # fmt: skip


@pytest.fixture
def masked(tmp_path: Path) -> Path:
    from PIL import Image

    texels = np.zeros((4, 8), np.uint8)
    texels[0] = 255  # the top row, and so the one with the largest y
    Image.fromarray(texels).save(tmp_path / "coast.png")
    path = tmp_path / "masked.json"
    path.write_text(json.dumps(MASKED))
    return path


@pytest.fixture
def patched(tmp_path: Path) -> Path:
    path = tmp_path / "sea.json"
    path.write_text(json.dumps(SEA))
    return path


def bake(path: Path, out: Path, *more: str) -> Path:
    arguments = [
        "bake",
        "--params",
        str(path),
        "--frames",
        "1-2",
        "--maps",
        EVERY_MAP,
        "--compression",
        "ZIP",
    ]
    assert main([*arguments, "--out", str(out), *more]) == 0
    (folder,) = out.glob("*/v*")
    return folder


def test_joined_patches_have_every_map_and_plain_names(patched: Path, tmp_path: Path) -> None:
    folder = bake(
        patched, tmp_path / "cache", "--set", f"merged_resolution={SAMPLES}", "--set", "foam.half_life=0.3"
    )
    assert sorted(path.name for path in folder.glob("*.exr")) == sorted(
        f"sea_{name}.{frame:04d}.exr" for name in EVERY_MAP.split(",") for frame in (1, 2)
    )
    header = read_header(folder / "sea_disp.0002.exr")
    parameters = OceanParameters.from_dict(header["parameters"])
    assert header["domain_size"] == 300.0
    assert parameters.patches == OceanParameters.from_dict(SEA).patches
    fields = Ocean(parameters).surface(1 / 25, {"displacement", "foam", "cusp", "normal"})
    for name, field in (("disp", fields.displacement), ("normal", fields.normal)):
        np.testing.assert_array_equal(read_image(folder / f"sea_{name}.0002.exr")[0], field)
    foam = read_image(folder / "sea_foam.0002.exr")[0]
    np.testing.assert_array_equal(foam[..., 0], fields.foam)
    np.testing.assert_array_equal(foam[..., 1], fields.cusp)
    assert main(["verify", str(folder)]) == 0


def test_masked_layers_are_baked(masked: Path, tmp_path: Path) -> None:
    folder = bake(masked, tmp_path / "cache")
    told = read_header(folder / "masked_disp.0001.exr")["parameters"]
    assert told["layers"][1]["mask"]["image"]["name"] == "coast.png"
    pixels = read_image(folder / "masked_disp.0001.exr")[0]
    assert main(["verify", str(folder)]) == 0
    # calm at the place of the distance, but for the small waves that the image leaves at the top
    spacing = MASKED["domain_size"] / MASKED["resolution"]  # type: ignore[operator]
    row, column = round(50.0 / spacing), round(40.0 / spacing)
    assert np.abs(pixels[row, column]).max() == 0.0
    assert np.std(pixels[..., 2]) > 0.1


def test_another_wave_height_is_seen(
    masked: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    from ocean_tweak.export.cache import folders, verify

    folder = bake(masked, tmp_path / "cache")
    baked = folders.read_job(folder)
    pixels = read_image(folder / "masked_disp.0001.exr")[0]
    sea, moment = Ocean(baked.shot.parameters), baked.shot.at(1)
    assert verify.wave_height(sea, moment) == pytest.approx(4.0 * np.std(pixels[..., 2]), rel=1e-5)


def test_patches_under_masks_are_baked_joined_only(
    patched: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mask = ["--set", 'layers.0.mask={"inner_radius":10,"outer_radius":50}']
    arguments = ["bake", "--params", str(patched), "--frames", "1", "--out", str(tmp_path / "cache"), *mask]
    assert main(arguments) == 2
    assert "merged_resolution" in capsys.readouterr().err
    assert not list(tmp_path.glob("cache/*/*/*.exr"))
    assert main([*arguments, "--set", "merged_resolution=32"]) == 0


def test_info_tells_of_the_waves_that_the_grid_holds(
    patched: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["info", "--params", str(patched), "--set", "merged_resolution=48", "--json"]) == 0
    (report,) = json.loads(capsys.readouterr().out).values()
    whole = report["statistics"]
    assert [patch["resolution"] for patch in whole["patches"]] == [96, 128]
    assert report["parameters"]["merged_resolution"] == 48


def test_info_tells_of_masks_and_merged_patches(
    patched: Path, masked: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Two samples of 300 m / 48 are 12.5 m."""
    assert main(["info", "--params", str(patched), "--set", "merged_resolution=48"]) == 0
    said = capsys.readouterr().out
    assert "merged on 48² samples, 6.25 m apart: waves from 12.5 m" in said
    assert "masks" not in said
    assert main(["info", "--params", str(masked)]) == 0
    said = capsys.readouterr().out
    assert "masks cover some of these waves" in said
    assert "merged_resolution" not in said
