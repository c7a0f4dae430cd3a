# SPDX-License-Identifier: GPL-3.0-or-later
"""What Blender's own importer makes of each form."""

from __future__ import annotations

import importlib.util
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from .conftest import SIZE, expected

ASSETS = {
    "points": {"form": "points"}, "clips": {"form": "clips"}, "displacement": {"form": "displacement"},
    "centimetres": {"form": "clips", "up_axis": "Y", "metres_per_unit": 0.01},
    "tiles": {"form": "clips", "tiles": (3, 2)},
}  # fmt: skip
FRAMES = (1001, 1003)
SCRIPT = Path(__file__).with_name("read_in_blender.py")


def in_blender(first: str, out: Path, files: dict[str, Path]) -> dict[str, np.ndarray]:
    command = [sys.executable, str(SCRIPT), first, str(out), ",".join(map(str, FRAMES))]
    answer = subprocess.run(
        [*command, *(f"{name}={path}" for name, path in files.items())], capture_output=True, text=True
    )
    assert answer.returncode == 0, answer.stderr[-2000:]
    with np.load(out) as found:
        return dict(found)


@pytest.fixture(scope="module")
def imported(exported, tmp_path_factory):
    files = {name: exported(**options) for name, options in ASSETS.items()}
    return in_blender("bpy", tmp_path_factory.mktemp("imported") / "found.npz", files)


@pytest.mark.parametrize("name", ASSETS)
def test_frame_range_comes_along(imported, name):
    assert tuple(imported[f"{name}.range"]) == (1001, 1004)


@pytest.mark.parametrize("name", ASSETS)
def test_material_comes_along(imported, name):
    assert imported[f"{name}.1001.0.materials"].tolist() == ["water"]


@pytest.mark.parametrize("name", ["points", "clips", "centimetres"])
@pytest.mark.parametrize("frame", FRAMES)
def test_moving_mesh(imported, name, frame):
    wanted = expected(frame)
    start = f"{name}.{frame}.0"
    np.testing.assert_allclose(imported[f"{start}.points"], wanted.points, atol=1e-4)
    np.testing.assert_allclose(imported[f"{start}.foam"], wanted.foam, atol=1e-4)
    np.testing.assert_allclose(imported[f"{start}.cusp"], wanted.cusp, atol=1e-4)
    np.testing.assert_allclose(imported[f"{start}.st"], wanted.st, atol=1e-6)
    if name != "centimetres":  # velocities are of the object, which the importer turns and scales
        np.testing.assert_allclose(imported[f"{start}.velocity"], wanted.velocities, atol=1e-4)


@pytest.mark.parametrize("frame", FRAMES)
def test_displaced_grid_is_flat(imported, frame):
    wanted = expected(frame)
    np.testing.assert_allclose(imported[f"displacement.{frame}.0.points"], wanted.flat, atol=1e-4)
    np.testing.assert_allclose(imported[f"displacement.{frame}.0.st"], wanted.st, atol=1e-6)


@pytest.mark.parametrize("frame", FRAMES)
def test_tiles_are_instances_that_move(imported, frame):
    wanted = expected(frame).points
    corners = set()
    for number in range(6):
        points = imported[f"tiles.{frame}.{number}.points"]
        offset = np.round((points - wanted).mean(axis=0) / SIZE) * SIZE
        np.testing.assert_allclose(points, wanted + offset, atol=1e-4)
        corners.add(tuple(offset.tolist()))
    assert f"tiles.{frame}.6.points" not in imported
    assert corners == {(SIZE * column, SIZE * row, 0.0) for column in range(3) for row in range(2)}


def test_openusd_before_blender(exported, tmp_path):
    found = in_blender("pxr.Usd", tmp_path / "found.npz", {"points": exported(form="points")})
    np.testing.assert_allclose(found["points.1003.0.points"], expected(1003).points, atol=1e-4)


def test_blenders_own_openusd_finds_no_error(exported, tmp_path):
    """It knows MaterialX, which the package usd-core does not: the shaders' inputs are checked here."""
    spec = importlib.util.find_spec("bpy")
    (own,) = Path(spec.origin).parent.glob("*/python/lib/python3*/site-packages")
    script = tmp_path / "validate.py"
    script.write_text(
        "import bpy, sys\n"
        "from pxr import Sdr, Usd, UsdValidation\n"
        "assert Sdr.Registry().GetShaderNodeByIdentifier('ND_displacement_vector3')\n"
        "validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()\n"
        "context = UsdValidation.ValidationContext(validators)\n"
        "errors = [error for path in sys.argv[1:] for error in context.Validate(Usd.Stage.Open(path))]\n"
        "sys.exit('\\n'.join(error.GetMessage() for error in errors) or 0)\n"
    )
    files = [
        exported(form="displacement", up_axis="Y", metres_per_unit=0.1), exported(form="displacement"),
        exported(form="points"), exported(form="clips"),
    ]  # fmt: skip
    answer = subprocess.run(
        [sys.executable, str(script), *map(str, files)], capture_output=True, text=True,
        env={**os.environ, "PYTHONPATH": str(own)},
    )  # fmt: skip
    assert answer.returncode == 0, answer.stderr[-2000:]
