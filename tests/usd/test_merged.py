# SPDX-License-Identifier: GPL-3.0-or-later
"""Seas of several patches and under masks as layers: the sum on one grid, which repeats."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from pxr import Usd

from ocean_tweak.cli import main
from ocean_tweak.core import Ocean, OceanParameters
from ocean_tweak.core.parameters.shot import Shot
from ocean_tweak.export.usd.export import Export
from ocean_tweak.export.usd.package import Package

from .conftest import FORMS, SEA, SIZE, value

PATCHES = [
    {"domain_size": SIZE, "shortest_wavelength": 15.0, "resolution": 32},
    {"domain_size": 41.0, "longest_wavelength": 15.0, "rotation": 0.6, "resolution": 64},
]
MASK = {"x": 30.0, "y": 40.0, "inner_radius": 5.0, "outer_radius": 30.0}
SEAS = {
    "patches": {**SEA, "patches": PATCHES},
    "joined patches": {**SEA, "patches": PATCHES, "merged_resolution": 48},
    "masks": {**SEA, "layers": [{"wind_speed": 12.0, "mask": MASK}, {"wind_speed": 4.0, "fetch": 3e3}]},
}
SAMPLES = {"patches": 32, "joined patches": 48, "masks": 32}


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("kind", SEAS)
def test_layers_hold_the_sum_on_one_grid(kind: str, form: str, tmp_path: Path) -> None:
    parameters = OceanParameters.from_dict(SEAS[kind])
    top = tmp_path / "sea.usd"
    export = Export(Package("sea", Shot(parameters), (1001, 1002), form=form, proxy=0), top)
    for _ in export.make((1001, 1002)):
        pass
    export.finish()
    samples = SAMPLES[kind]
    fields = Ocean(parameters.on_one_grid(samples)).surface(1 / 25, {"displacement", "velocity", "foam"})
    index = np.arange(samples + 1)
    row, column = (part.ravel() for part in np.meshgrid(index, index, indexing="ij"))
    flat = np.stack([column * SIZE / samples, row * SIZE / samples, np.zeros(len(row))], axis=-1)
    moved = flat + fields.displacement[row % samples, column % samples]
    stage = Usd.Stage.Open(str(top))
    points = value(stage, "/sea/geo/sea/surface.points", 1002 if form != "displacement" else None)
    np.testing.assert_allclose(points, flat if form == "displacement" else moved, rtol=2e-7, atol=1e-5)
    assert main(["usd-verify", str(top)]) == 0
