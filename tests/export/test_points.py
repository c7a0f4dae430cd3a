# SPDX-License-Identifier: GPL-3.0-or-later
"""Points of patches: what is in the files is the sea, and a bake takes care of them as of its images."""

import json
import re
import shutil
from pathlib import Path

import numpy as np
import pytest

from ocean_tweak.cli import main
from ocean_tweak.core import Ocean, OceanParameters, Patch, Places, WaveLayer
from ocean_tweak.core.parameters.patch_seas import parts
from ocean_tweak.export.ply import PlyError
from ocean_tweak.export.points import PointSequence, read_points

LARGE, SMALL = 384, 48


@pytest.fixture(scope="module")
def sea():
    layer = WaveLayer(wind_speed=8.0, fetch=20e3, wind_direction=0.4)
    patches = (
        Patch(domain_size=60.0, shortest_wavelength=15.0, resolution=LARGE),
        Patch(
            domain_size=21.0, longest_wavelength=15.0, shortest_wavelength=4.0, rotation=0.9, resolution=SMALL
        ),
    )
    return OceanParameters(layers=(layer,), patches=patches, merged_resolution=32)


@pytest.fixture(scope="module")
def made(sea, tmp_path_factory):
    home = tmp_path_factory.mktemp("points")
    (home / "sea.json").write_text(sea.to_json())
    arguments = ["--params", str(home / "sea.json"), "--frames", "1-2", "--maps", "disp,points"]
    assert main(["bake", *arguments, "--workers", "1", "--out", str(home / "cache")]) == 0
    (folder,) = (path.parent for path in home.glob("cache/*/*/bake.json"))
    return folder


@pytest.fixture
def baked(made, tmp_path):
    """A copy of one bake, to spoil."""
    return Path(shutil.copytree(made.parent, tmp_path / made.parent.name)) / made.name


def columns(path, *names):
    values = read_points(path)
    side = round(len(values["x"]) ** 0.5)
    return np.stack([values[name] for name in names], axis=-1).reshape(side, side, len(names))


def test_all_samples_of_each_patch(sea, made):
    for number, part in enumerate(parts(sea), start=1):
        fields = Ocean(part.parameters).surface(1 / 24, {"displacement", "velocity", "slope", "strain"})
        samples, size = part.parameters.resolution, part.parameters.domain_size
        path = made / f"sea_p{number}_points.0002.ply"
        along = np.arange(samples) * size / samples
        place = columns(path, "x", "y", "z").astype(np.float64)
        place[..., 0] -= along
        place[..., 1] -= along[:, np.newaxis]
        np.testing.assert_allclose(place, fields.displacement, atol=1e-5)
        for name, axes in (("velocity", "xyz"), ("slope", "xy"), ("strain", ("xx", "yy", "xy"))):
            found = columns(path, *(f"{name}_{axis}" for axis in axes))
            np.testing.assert_allclose(found, getattr(fields, name), atol=1e-6)


def test_the_small_ones_are_means_over_cells(sea, made):
    """384 samples are 256 cells of one and a half: each second sample is shared by two."""
    first = parts(sea)[0].parameters
    slope = Ocean(first).surface(0.0, {"slope"}).slope.astype(np.float64)
    weights = np.zeros((256, LARGE))
    for cell in range(256):
        start = 1.5 * cell
        for sample in range(LARGE):
            weights[cell, sample] = max(0.0, min(start + 1.5, sample + 1) - max(start, sample)) / 1.5
    means = np.stack([weights @ slope[..., axis] @ weights.T for axis in (0, 1)], axis=-1)
    squares = weights @ (slope**2).sum(axis=-1) @ weights.T
    path = made / "sea_p1_small_points.0001.ply"
    np.testing.assert_allclose(columns(path, "slope_x", "slope_y"), means, atol=1e-6)
    lacking = squares - (means**2).sum(axis=-1)
    np.testing.assert_allclose(columns(path, "slope_variance")[..., 0], lacking, atol=1e-7)
    # a mean is that of the middle of its cell, which begins half a sample before its first one
    x = columns(path, "x")[..., 0].astype(np.float64)
    assert x.mean() == pytest.approx((1.5 * 127.5 + 0.25) * 60.0 / LARGE, abs=1e-3)


def test_the_sum_of_the_patches_is_the_sea(sea, made):
    at_corner = [columns(made / f"sea_p{number}_points.0001.ply", "z")[0, 0, 0] for number in (1, 2)]
    whole = (
        Ocean(sea.replace(merged_resolution=0))
        .surface(0.0, {"displacement"}, on=Places(0.0, 0.0))
        .displacement
    )
    assert sum(at_corner) == pytest.approx(float(np.ravel(whole)[2]), abs=1e-4)


def test_few_samples_have_one_file(made):
    names = {path.name for path in made.glob("*.ply")}
    assert {re.sub(r"\.\d+\.ply", "", name) for name in names} == {
        "sea_p1_points", "sea_p1_small_points", "sea_p2_points",
    }  # fmt: skip
    record = json.loads((made / "records" / "0001.json").read_text())
    assert {entry["name"] for entry in record["files"]} == {
        "sea_disp.0001.exr", *(name for name in names if ".0001." in name)
    }  # fmt: skip


def test_a_bake_takes_care_of_them(baked, capsys):
    assert main(["verify", str(baked)]) == 0
    broken, lost = baked / "sea_p1_points.0001.ply", baked / "sea_p1_small_points.0002.ply"
    whole = broken.read_bytes()
    broken.write_bytes(whole[:-4] + b"\0\0\0\0")
    lost.unlink()
    assert main(["verify", str(baked)]) == 1
    said = capsys.readouterr().out
    assert broken.name in said
    assert lost.name in said
    assert main(["resume", str(baked), "--workers", "1"]) == 0
    assert broken.read_bytes() == whole
    assert main(["verify", str(baked)]) == 0
    assert main(["clean", str(baked)]) == 0
    assert not baked.exists()


def test_a_job_is_found_again_from_its_images(baked, capsys):
    (baked / "bake.json").unlink()
    assert main(["resume", str(baked)]) == 0
    assert "points" in json.loads((baked / "bake.json").read_text())["maps"]
    capsys.readouterr()


def test_a_sea_of_one_patch_has_none(tmp_path, capsys):
    assert main(["bake", "--frames", "1", "--maps", "disp,points", "--out", str(tmp_path)]) == 2
    assert "points" in capsys.readouterr().err


@pytest.mark.parametrize(
    "change",
    [
        lambda text: text[:-1],
        lambda text: text + b"1",
        lambda text: text.replace(b"binary_little", b"binary_big"),
        lambda text: text.replace(b"element vertex 2304", b"element vertex 99999999999999"),
        lambda text: text.replace(b"element vertex 2304", b"element vertex -1"),
        lambda text: text.replace(b"strain_xx", b"strain_zz"),
        lambda text: b"\xff" + text,
        lambda text: text[:200],
        lambda _text: b"",
    ],
)
def test_damaged_points_are_told(sea, baked, change):
    path = baked / "sea_p2_points.0001.ply"
    path.write_bytes(change(path.read_bytes()))
    with pytest.raises(PlyError, match=re.escape(path.name)):
        read_points(path)
    with pytest.raises(PlyError, match=re.escape(path.name)):
        PointSequence(baked, "sea", 2, parts(sea)[1]).check(1)
