# SPDX-License-Identifier: GPL-3.0-or-later
"""The area of a coast as USD: waves that come ashore and end there, with their foam and velocity."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from pxr import Usd

from ocean_tweak.core import Area, Ocean, Places
from ocean_tweak.core.data.frames import parse_frames
from ocean_tweak.core.parameters.shot import Shot
from ocean_tweak.export.usd.export import Export
from ocean_tweak.export.usd.package import Package
from tests.coasts import SMALL_SEA as SEA

from .conftest import value

MESH = "/sea/geo/sea/surface"
FRAMES = (9, 10, 11)
SQUARE = Area(240.0, 60, (-40.0, 0.0))


@pytest.fixture(scope="module", params=["points", "clips"])
def stage(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Usd.Stage:
    top: Path = tmp_path_factory.mktemp("coast") / "sea.usd"
    wanted = ("velocities", "foam", "breaking", "foam_age")
    package = Package("sea", Shot(SEA), parse_frames("9-11"), proxy=0, area=SQUARE, attributes=wanted,
                      form=request.param)  # fmt: skip
    export = Export(package, top)
    export.check(package.frames)
    for _ in export.make(package.frames):
        pass
    export.finish()
    return Usd.Stage.Open(str(top))


def of_mesh(stage: Usd.Stage, name: str, frame: int) -> np.ndarray:
    return value(stage, f"{MESH}.{name}", frame).astype(np.float64)


def test_the_mesh_is_the_sea_over_the_bed_and_lies_still_on_land(stage: Usd.Stage) -> None:
    along = np.linspace(-40.0, 200.0, 61)
    x, y = (part.ravel() for part in np.meshgrid(along, np.linspace(0.0, 240.0, 61)))
    rest = np.stack((x, y, np.zeros_like(x)), axis=-1)
    moved = of_mesh(stage, "points", 10) - rest
    expected = Ocean(SEA).frame(10, on=Places(x, y)).displacement
    np.testing.assert_allclose(moved, expected, atol=2e-5)
    on_land = x > 188.0  # depths below 0 begin at 184.6 m
    assert np.abs(moved[on_land]).max() < 1e-3
    assert np.abs(moved[~on_land, 2]).max() > 0.4
    # waves are lower than the water is deep
    shallow = (x > 150.0) & (x < 184.0)
    depth = 12.0 - 0.065 * x[shallow]
    assert np.all(np.abs(moved[shallow, 2]) < 1.5 * depth + 0.1)


def test_velocity_is_that_of_the_points(stage: Usd.Stage) -> None:
    before, after = (of_mesh(stage, "points", frame) for frame in (9, 11))
    velocity, fps = of_mesh(stage, "velocities", 10), stage.GetTimeCodesPerSecond()
    found = (after - before) * fps / 2.0
    assert np.sqrt(np.mean((velocity - found) ** 2)) < 0.05 * np.sqrt(np.mean(velocity**2))


def test_breakers_leave_foam_where_it_is_shallow(stage: Usd.Stage) -> None:
    rest_x = np.tile(np.linspace(-40.0, 200.0, 61), 61)
    foam, breaking, age = (
        of_mesh(stage, f"primvars:{name}", 10) for name in ("foam", "breaking", "foam_age")
    )
    surf = (rest_x > 120.0) & (rest_x < 184.0)
    assert foam[surf].mean() > 5.0 * foam[rest_x < 20.0].mean()
    assert foam[surf].max() > 0.3
    assert np.all(breaking <= foam + 1e-5)
    assert age[surf].max() > 0.5
    assert foam[rest_x > 190.0].max() < 0.01
