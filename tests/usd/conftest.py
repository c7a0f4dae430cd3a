# SPDX-License-Identifier: GPL-3.0-or-later
"""A small sea, its export, and what the layers should hold, straight from the core's fields."""

from __future__ import annotations

import functools
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from pxr import Usd

from ocean_tweak.core import OceanParameters
from ocean_tweak.core.data.frames import parse_frames
from ocean_tweak.core.parameters.shot import Shot
from ocean_tweak.core.sea.bake import ShotSeas
from ocean_tweak.export.usd.export import Export
from ocean_tweak.export.usd.package import Package

SIZE, SAMPLES = 100.0, 32
SEA = {
    "resolution": SAMPLES, "domain_size": SIZE, "seed": 3, "layers": [{"wind_speed": 12.0}],
    "timing": {"fps": 25, "start_frame": 1001}, "foam": {"half_life": 0.05},  # remembers a few frames
}  # fmt: skip
OUTPUTS = {"displacement", "velocity", "normal", "foam", "cusp", "breaking", "foam_age"}
FORMS = ("points", "clips", "displacement")


def shot() -> Shot:
    return Shot(OceanParameters.from_dict(SEA))


def write(top: Path, frames: str = "1001-1004", force: bool = False, **options: object) -> Export:
    """Export the sea to a file; options as those of a Package."""
    package = Package(top.stem, shot(), parse_frames(frames), **{"proxy": 0, **options})
    export = Export(package, top, force=force)
    export.check(package.frames)
    for _ in export.make(package.frames):
        pass
    export.finish()
    return export


@functools.cache
def expected(frame: float, step: int = 1, samples: int = SAMPLES) -> SimpleNamespace:
    """What a frame should hold: metres, Z up, a vertex every so many samples, x fastest."""
    sea = Shot(OceanParameters.from_dict({**SEA, "resolution": samples}))
    fields = ShotSeas(sea).frame(parse_frames(str(frame))[0], OUTPUTS)
    index = np.arange(0, samples + 1, step)
    row, column = (part.reshape(-1) for part in np.meshgrid(index, index, indexing="ij"))

    def vertices(field: np.ndarray) -> np.ndarray:
        return field.astype(np.float64)[row % samples, column % samples]

    flat = np.stack([column * SIZE / samples, row * SIZE / samples, np.zeros(len(row))], axis=-1)
    return SimpleNamespace(
        flat=flat, points=flat + vertices(fields.displacement), velocities=vertices(fields.velocity),
        normals=vertices(fields.normal), foam=vertices(fields.foam), cusp=vertices(fields.cusp),
        breaking=vertices(fields.breaking), foam_age=vertices(fields.foam_age),
        st=np.stack([column, row], axis=-1) / samples + 0.5 / SAMPLES,
    )  # fmt: skip


def turned(vectors: np.ndarray) -> np.ndarray:
    """Z up to Y up: north becomes -z."""
    return vectors @ np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])


def value(stage: Usd.Stage, path: str, frame: float | None = None) -> np.ndarray:
    """An attribute's value at a frame, or its default."""
    time = Usd.TimeCode.Default() if frame is None else Usd.TimeCode(frame)
    return np.array(stage.GetAttributeAtPath(path).Get(time))


@pytest.fixture(scope="session")
def exported(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., Path]:
    """Exports with the same options are made once; nobody may change them."""
    made: dict[str, Path] = {}

    def make(**options: object) -> Path:
        key = repr(sorted(options.items()))
        if key not in made:
            made[key] = tmp_path_factory.mktemp("asset") / "sea.usd"
            write(made[key], **options)
        return made[key]

    return make


@pytest.fixture
def quiet(capfd: pytest.CaptureFixture[str]) -> Iterator[None]:
    """OpenUSD's warnings about files that a test has removed are no news."""
    yield
    capfd.readouterr()
    sys.stdout.flush()
