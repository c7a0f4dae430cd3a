# SPDX-License-Identifier: GPL-3.0-or-later
"""Seas of several patches on the command line: planned, told, baked, verified and resumed."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from ocean_tweak.cli import main
from ocean_tweak.core import Ocean, OceanParameters
from ocean_tweak.export.exr import read_header, read_image

SEA = {
    "seed": 5,
    "layers": [{"wind_speed": 9.0}],
    "patches": [
        {"domain_size": 300.0, "shortest_wavelength": 16.0, "resolution": 96},
        {"domain_size": 120.0, "longest_wavelength": 16.0, "shortest_wavelength": 5.0, "rotation": 0.7,
         "resolution": 128},
    ],
    "timing": {"fps": 25},
}  # fmt: skip
MAPS = "disp,vel,slope,strain"


@pytest.fixture
def params(tmp_path: Path) -> Path:
    path = tmp_path / "sea.json"
    path.write_text(json.dumps(SEA))
    return path


@pytest.fixture
def baked(params: Path, tmp_path: Path) -> Path:
    """The folder of two frames with four maps."""
    bake = ["bake", "--params", str(params), "--frames", "1-2", "--maps", MAPS, "--compression", "ZIP"]
    assert main([*bake, "--out", str(tmp_path / "cache")]) == 0
    (folder,) = (tmp_path / "cache").glob("*/v*")
    return folder


def test_each_patch_has_images_of_its_own(baked: Path) -> None:
    images = sorted(path.name for path in baked.glob("*.exr"))
    assert images == sorted(
        f"sea_p{patch}_{name}.{frame:04d}.exr"
        for patch in (1, 2)
        for name in MAPS.split(",")
        for frame in (1, 2)
    )
    for number, patch in enumerate(Ocean(OceanParameters.from_dict(SEA)).patches, 1):
        fields = patch.surface(1 / 25, {"displacement", "velocity", "slope", "strain"})
        for name, field in (
            ("disp", fields.displacement), ("vel", fields.velocity), ("strain", fields.strain),
            ("slope", np.dstack((fields.slope, np.zeros_like(fields.slope[..., 0])))),
        ):  # fmt: skip
            pixels, told = read_image(baked / f"sea_p{number}_{name}.0002.exr")
            np.testing.assert_array_equal(pixels, field, err_msg=name)
            assert told["domain_size"] == SEA["patches"][number - 1]["domain_size"]  # type: ignore[index]
            assert told["patch"] == {"number": number, "of": 2, "rotation": (0.0, 0.7)[number - 1]}
            assert OceanParameters.from_dict(told["parameters"]) == OceanParameters.from_dict(SEA)


def test_one_patch_keeps_its_names_and_its_header(tmp_path: Path) -> None:
    path = tmp_path / "one.json"
    path.write_text(json.dumps({"resolution": 32, "domain_size": 200.0}))
    assert main(["bake", "--params", str(path), "--frames", "1", "--out", str(tmp_path / "cache")]) == 0
    (image,) = (tmp_path / "cache").glob("*/v*/*.exr")
    assert image.name == "one_disp.0001.exr"
    assert "patch" not in read_header(image)


def test_verify_and_resume_know_all_patches(baked: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["verify", str(baked)]) == 0
    before = {path.name: path.read_bytes() for path in baked.glob("*.exr")}
    lost, broken = baked / "sea_p2_disp.0001.exr", baked / "sea_p1_slope.0002.exr"
    lost.unlink()
    broken.write_bytes(broken.read_bytes()[:-20])
    assert main(["verify", str(baked)]) == 1
    said = capsys.readouterr().out
    assert "sea_p2_disp.0001.exr is gone" in said
    assert "sea_p1_slope.0002.exr has" in said
    assert main(["resume", str(baked)]) == 0
    assert {path.name: path.read_bytes() for path in baked.glob("*.exr")} == before
    assert main(["verify", str(baked)]) == 0


def test_an_image_of_the_other_patch_is_found_out(baked: Path, capsys: pytest.CaptureFixture[str]) -> None:
    record = baked / "records" / "0001.json"
    assert json.loads(record.read_text())["files"][0]["name"] == "sea_p1_disp.0001.exr"
    (baked / "sea_p1_disp.0001.exr").write_bytes((baked / "sea_p2_disp.0001.exr").read_bytes())
    assert main(["verify", str(baked)]) == 1
    assert "frame 1 is damaged" in capsys.readouterr().out


def test_a_lost_job_is_told_by_the_images(baked: Path) -> None:
    (baked / "bake.json").unlink()
    (baked / "sea_p1_disp.0001.exr").unlink()
    assert main(["resume", str(baked)]) == 0
    assert main(["verify", str(baked)]) == 0


def test_clean_takes_all_patches(baked: Path) -> None:
    assert main(["clean", str(baked)]) == 0
    assert not baked.exists()


def test_workers_make_the_same_bytes(baked: Path, params: Path, tmp_path: Path) -> None:
    bake = ["bake", "--params", str(params), "--frames", "1-2", "--maps", MAPS, "--compression", "ZIP"]
    assert main([*bake, "--workers", "2", "--out", str(tmp_path / "other")]) == 0
    (other,) = (tmp_path / "other").glob("*/v*")
    assert other.name == baked.name
    for path in baked.glob("*.exr"):
        assert (other / path.name).read_bytes() == path.read_bytes()


@pytest.mark.parametrize("name", ["foam", "normal"])
def test_maps_that_are_no_sums_are_refused(
    name: str, params: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bake = ["bake", "--params", str(params), "--frames", "1", "--maps", f"disp,{name}"]
    assert main([*bake, "--out", str(tmp_path / "cache")]) == 2
    assert "do not add up" in capsys.readouterr().err
    assert not (tmp_path / "cache").exists()


def test_info_tells_each_patch(params: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["info", "--params", str(params)]) == 0
    said = capsys.readouterr().out
    assert "96² and 128² samples" in said
    assert "resolved by grids" in said
    assert main(["info", "--params", str(params), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)["sea"]["statistics"]
    assert [patch["domain_size"] for patch in told["patches"]] == [300.0, 120.0]
    assert sum(patch["resolved"]["m0"] for patch in told["patches"]) == pytest.approx(told["resolved"]["m0"])


def test_a_plan_is_told_and_saved(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    saved = tmp_path / "planned.json"
    assert main(["info", "--plan", "finest=0.2,area=1000,memory=1GB", "--save", str(saved)]) == 0
    first = capsys.readouterr().out
    sea = OceanParameters.from_json(saved.read_text())
    assert sea.patches[0].domain_size >= 1000.0
    assert sea.patches[-1].shortest_wavelength == 0.2
    assert main(["info", "--params", str(saved)]) == 0
    again = capsys.readouterr().out
    assert again.partition(":")[2] == first.partition(":")[2]


@pytest.mark.parametrize(
    ("plan", "said"),
    [
        ("finest=0.1", "must give finest and area"),
        ("finest=0.1,area=4km", "must look like finest=0.1,area=4000"),
        ("finest=0.1,finest=0.2,area=10", "must look like"),
        ("finest=0.1,area=1e9", "must look like"),
        ("finest=20,area=10", "must be below the area"),
        ("finest=0.1,area=4000,memory=60MB", "would do"),
    ],
)
def test_a_plan_that_cannot_be(plan: str, said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["info", "--plan", plan]) == 2
    assert said in capsys.readouterr().err


def test_one_patch_of_several_is_set_by_its_number(params: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["info", "--params", str(params), "--set", "resolution=64"]) == 2
    assert "set patches.0.resolution" in capsys.readouterr().err
    assert main(["info", "--params", str(params), "--set", "patches.0.resolution=128", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)["sea"]["parameters"]
    assert told["resolution"] == 128
