# SPDX-License-Identifier: GPL-3.0-or-later
"""Images from a file beside the parameters, through bakes."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import OpenEXR
import pytest

from ocean_tweak.cli import main
from ocean_tweak.export.images import read_raster
from tests.cli.commands import EXAMPLES, baked_heights


def test_the_word_stands_in_the_water(tmp_path: Path) -> None:
    """At the first frame the example's sea holds its image, and two seconds later no longer so."""
    heights = baked_heights(
        tmp_path, "--params", str(EXAMPLES / "from-image.json"), "--frames", "1,49",
        "--set", "resolution=256", "--set", "layers.0.muted=true", "--set", "choppiness=0",
    )  # fmt: skip
    image = read_raster(EXAMPLES / "sea.png", 1).values[..., 0].astype(float)
    index = np.fft.fftfreq(256, 1 / 256)
    k = np.hypot(index, index[:, np.newaxis])
    k[0, 0] = 1.0
    # β = 8 - 2·3.2 in power
    by_numpy = np.fft.ifft2(np.fft.fft2(image - image.mean()) * k**-0.8).real
    correlations = [np.corrcoef(by_numpy.ravel(), height.ravel())[0, 1] for height in heights]
    assert correlations[0] > 0.999
    assert correlations[1] < 0.8
    assert 4 * heights[0].std() == pytest.approx(2.5, rel=1e-3)


def test_an_image_that_is_missing_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    params = tmp_path / "sea.json"
    params.write_text(json.dumps({"pictures": [{"image": {"file": "nowhere.png"}}]}))
    assert main(["info", "--params", str(params)]) == 2
    error = capsys.readouterr().err
    assert "layers.1.image.file" in error
    assert "nowhere.png" in error


@pytest.mark.parametrize("kind", ["exr", "tif", "png", "npy"])
def test_what_is_wrong_with_a_file_is_said_in_one_line(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], kind: str
) -> None:
    """Libraries print lines of their own on the process's own streams, past Python's."""
    file = tmp_path / f"a.{kind}"
    values = np.arange(1024.0).reshape(32, 32)
    if kind == "exr":
        header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
        OpenEXR.File(header, {"Y": values.astype(np.float32)}).write(str(file))
    elif kind == "npy":
        np.save(file, values)
    else:
        image = pytest.importorskip("PIL.Image").fromarray(values.astype(np.uint8))
        image.save(file, **({"compression": "tiff_lzw"} if kind == "tif" else {}))
    content = bytearray(file.read_bytes())
    damaged = slice(len(content) // 2, len(content) // 2 + 100)
    content[damaged] = bytes(byte ^ 0xFF for byte in content[damaged])
    file.write_bytes(content[:-200] if kind in ("exr", "npy") else content)
    params = tmp_path / "sea.json"
    params.write_text(json.dumps({"resolution": 16, "pictures": [{"image": {"file": file.name}}]}))
    assert main(["info", "--params", str(params)]) == 2
    said = capfd.readouterr()
    assert said.out == ""
    (line,) = said.err.splitlines()
    assert f"a.{kind}" in line
