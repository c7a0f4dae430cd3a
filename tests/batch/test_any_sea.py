# SPDX-License-Identifier: GPL-3.0-or-later
"""Every sea whose parameters are valid can be baked to every map that it has."""

from __future__ import annotations

import tempfile
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, given, seed, settings
from hypothesis import strategies as st

from ocean_tweak.core import OceanParameters
from ocean_tweak.core.parameters.shot import Shot
from ocean_tweak.core.sea.bake import bake
from ocean_tweak.export.cache.job import Job, maps_for
from ocean_tweak.export.cache.records import CacheSink
from ocean_tweak.export.exr import read_image
from ocean_tweak.export.points import read_points
from tests.batch.bakery import LONG
from tests.core.random_seas import any_seas

EACH = 25


@pytest.mark.parametrize("part", range(20 if LONG else 1))
def test_any_sea_bakes_every_map(part: int) -> None:
    @seed(part)
    @settings(
        max_examples=EACH,
        deadline=None,
        database=None,
        phases=[Phase.generate],  # shrinking a sea bakes it hundreds of times
        suppress_health_check=list(HealthCheck),
    )
    @given(sea=any_seas(), frame=st.one_of(st.integers(-1000, 100_000), st.just(Fraction(5, 2))))
    def bakes(sea: OceanParameters, frame: int | Fraction) -> None:
        if sea.is_cascade and sea.is_masked:
            sea = sea.on_one_grid(16)
        job = Job("sea", "0", Shot(sea), maps_for(sea), "NONE")
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "records").mkdir()
            with np.errstate(over="raise", invalid="raise", divide="raise"):
                (made,) = bake(job.shot, [frame], CacheSink(folder, job))
            assert [path.name for path in made.paths] == [file for _, file in job.files(folder, frame)]
            assert len(made.paths) >= len(job.maps)
            for path in made.paths:
                is_image = path.suffix == ".exr"
                values = [read_image(path)[0]] if is_image else read_points(path).values()
                assert all(np.all(np.isfinite(numbers)) for numbers in values), path.name

    bakes()
