# SPDX-License-Identifier: GPL-3.0-or-later
"""`usd --spray`: points with ids, widths and velocities beside the mesh, in the layer's units and axes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from ocean_tweak.cli import main
from ocean_tweak.core import Ocean, OceanParameters, Spray, WaveLayer
from ocean_tweak.core.parameters.shot import Shot
from ocean_tweak.core.sea.shot_spray import ShotSpray
from ocean_tweak.core.sea.spray import TileSpray
from ocean_tweak.export.usd.export import Export
from ocean_tweak.export.usd.library import UsdError
from ocean_tweak.export.usd.package import Package

pxr = pytest.importorskip("pxr")
from pxr import Usd, UsdGeom, UsdShade, UsdValidation  # noqa: E402

SEA = OceanParameters(
    resolution=64, domain_size=100.0, seed=2, layers=(WaveLayer(wind_speed=22.0, fetch=300e3),)
)


def export(folder: Path, *more: str, form: str = "points") -> Path:
    sea, top = folder / "sea.json", folder / "asset" / "sea.usd"
    sea.write_text(SEA.to_json(), encoding="utf-8")
    arguments = ["usd", "--params", str(sea), "--frames", "12-13", "--out", str(top), "--form", form]
    assert main([*arguments, "--spray", *more]) == 0
    return top


def points_of(top: Path) -> UsdGeom.Points:
    stage = Usd.Stage.Open(str(top))
    (found,) = (prim for prim in stage.Traverse() if prim.IsA(UsdGeom.Points))
    points = UsdGeom.Points(found)
    points.stage = stage  # as long as the prim is used
    return points


@pytest.mark.parametrize("form", ["points", "clips"])
def test_points_are_the_particles(tmp_path: Path, form: str) -> None:
    points = points_of(export(tmp_path, "--up-axis", "Y", "--metres-per-unit", "0.01", form=form))
    expected = TileSpray(Ocean(SEA)).at(12 / 24.0, Spray())
    assert len(expected.age) > 500
    x, y, z = 100.0 * expected.position.T
    np.testing.assert_allclose(points.GetPointsAttr().Get(13.0), np.stack((x, z, -y), -1), rtol=1e-5)
    x, y, z = 100.0 * expected.velocity.T
    np.testing.assert_allclose(points.GetVelocitiesAttr().Get(13.0), np.stack((x, z, -y), -1), rtol=1e-5)
    np.testing.assert_allclose(points.GetWidthsAttr().Get(13.0), 200.0 * expected.radius, rtol=1e-5)
    np.testing.assert_array_equal(points.GetIdsAttr().Get(13.0), expected.id)
    assert points.GetWidthsInterpolation() == "vertex"


def test_the_extent_holds_every_particle_whole(tmp_path: Path) -> None:
    points = points_of(export(tmp_path))
    low, high = np.array(points.GetExtentAttr().Get(12.0))
    place = np.array(points.GetPointsAttr().Get(12.0))
    half = 0.5 * np.array(points.GetWidthsAttr().Get(12.0))[:, np.newaxis]
    assert np.all(place - half >= low - 1e-4)
    assert np.all(place + half <= high + 1e-4)


def test_spray_has_its_own_look_and_goes_with_tiles(tmp_path: Path) -> None:
    top = export(tmp_path, "--tiles", "2x1")
    stage = Usd.Stage.Open(str(top))
    (prim,) = (prim for prim in stage.TraverseAll() if prim.IsA(UsdGeom.Points))
    bound, _ = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial()
    assert bound.GetPath().name == "look"
    instancer = next(each for each in stage.TraverseAll() if each.IsA(UsdGeom.PointInstancer))
    assert prim.GetPath().HasPrefix(UsdGeom.PointInstancer(instancer).GetPrototypesRel().GetTargets()[0])
    assert main(["usd-verify", str(top)]) == 0


def test_pixars_validators_find_nothing(tmp_path: Path) -> None:
    stage = Usd.Stage.Open(str(export(tmp_path)))
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    errors = UsdValidation.ValidationContext(validators).Validate(stage)
    assert [f"{error.GetName()}: {error.GetMessage()}" for error in errors] == []


def test_a_sea_without_spray_is_refused_before_anything_is_written(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    top = tmp_path / "asset" / "sea.usd"
    arguments = ["usd", "--frames", "1", "--out", str(top), "--form", "points", "--spray"]
    assert main([*arguments, "--set", "layers.0.wind_speed=5"]) == 2
    assert "tears nothing off" in capsys.readouterr().err
    assert not top.parent.exists()


def test_over_a_bake_the_spray_can_be_set(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    sea, cache, top = tmp_path / "sea.json", tmp_path / "cache", tmp_path / "asset" / "sea.usd"
    sea.write_text(SEA.to_json(), encoding="utf-8")
    assert main(["bake", "--params", str(sea), "--frames", "12-13", "--out", str(cache)]) == 0
    (folder,) = cache.glob("*/v*")
    arguments = ["usd", "--bake", str(folder), "--out", str(top), "--form", "displacement"]
    assert main([*arguments, "--spray", "--set", "spray.amount=0.5"]) == 0
    expected = TileSpray(Ocean(SEA)).at(12 / 24.0, Spray(amount=0.5))
    assert len(points_of(top).GetIdsAttr().Get(13.0)) == len(expected.id)
    bake = ["bake", "--params", str(sea), "--frames", "12-13", "--out", str(cache), "--spray"]
    assert main([*bake, "--set", "spray.amount=0.25"]) == 0
    assert main([*arguments, "--spray", "--force"]) == 0  # that of the bake
    expected = TileSpray(Ocean(SEA)).at(12 / 24.0, Spray(amount=0.25))
    assert len(points_of(top).GetIdsAttr().Get(13.0)) == len(expected.id)
    for refused in (["--set", "spray.amount=0.5"], ["--spray", "--set", "layers.0.wind_speed=9"]):
        capsys.readouterr()
        assert main([*arguments, *refused]) == 2
        assert "--set: the bake in" in capsys.readouterr().err


def test_clips_that_were_made_apart_are_stitched_with_their_spray(tmp_path: Path) -> None:
    for frame in ("12", "13"):
        top = export(tmp_path, "--only", frame, form="clips")
    assert not (top.parent / "spray.usdc").exists()
    export(tmp_path, "--stitch", form="clips")
    expected = TileSpray(Ocean(SEA)).at(12 / 24.0, Spray())
    assert len(points_of(top).GetIdsAttr().Get(13.0)) == len(expected.id)


def test_layers_are_not_put_together_without_their_spray(tmp_path: Path) -> None:
    shot = Shot(SEA)
    package = Package("sea", shot, (12,), form="points")
    asset = Export(package, tmp_path / "sea.usd", spray=ShotSpray(shot, Spray()))
    for _ in asset.make((12,)):
        pass
    with pytest.raises(UsdError, match=r"spray\.usdc: the spray is missing"):
        asset.finish()
    assert not (tmp_path / "sea.usd").exists()
