# SPDX-License-Identifier: GPL-3.0-or-later
"""Writing a sea as USD: what it adds to computing it and writing its bare arrays, in time and in bytes."""

from __future__ import annotations

import itertools
import os
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ocean_tweak.core import OceanParameters
from ocean_tweak.core.data.frames import Frame
from ocean_tweak.core.parameters.shot import Shot
from ocean_tweak.core.sea.bake import ShotSeas
from ocean_tweak.core.synthesis.channels import SurfaceFields
from ocean_tweak.export.usd.attributes import mesh_values, outputs_of
from ocean_tweak.export.usd.export import Export
from ocean_tweak.export.usd.library import pxr
from ocean_tweak.export.usd.mesh import Edition
from ocean_tweak.export.usd.package import Package

from .measure import interleaved
from .plan import SCRATCH, Plan, sea
from .rows import Row

GROUP = "usd"
FORMS = ("points", "clips")


def rows(plan: Plan) -> Iterator[Row]:
    """Time and size of the forms that hold points, one thread."""
    SCRATCH.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=SCRATCH) as folder:
        yield from _times(plan, Path(folder))
        for form in FORMS:
            yield _size(plan, form, Path(folder) / "size" / form)


def _parameters(plan: Plan) -> OceanParameters:
    """Foam without a memory, which would only make the first frame of each round long."""
    parameters = sea(plan.bake)
    return parameters.replace(foam=replace(parameters.foam, half_life=0.0))


def _package(plan: Plan, form: str, frames: tuple[Frame, ...]) -> Package:
    return Package("sea", Shot(_parameters(plan)), frames, form=form)


def _times(plan: Plan, folder: Path) -> Iterator[Row]:
    frames = tuple(range(1, plan.bake_frames + 1))
    package = _package(plan, "points", frames)
    timings = interleaved({**_parts(package, folder), **_exports(plan, frames, folder)}, plan.rounds)
    for form in FORMS:
        parts = [
            1.0 / (1.0 / a + 1.0 / b)
            for a, b in zip(timings.ratios(form, "compute"), timings.ratios(form, "arrays"), strict=True)
        ]
        low, middle, high = np.quantile(parts, (0.25, 0.5, 0.75))
        whole = timings.median("compute") + timings.median("arrays")
        yield Row(
            GROUP, f"{form} {plan.bake}²: export against its parts", float(middle), "×", timings.rounds,
            (float(low), float(high)), timings.median(form) / len(frames), whole / len(frames),
            target="usd time", remark="seconds a frame; computing, and bare arrays to a synced file",
        )  # fmt: skip


def _parts(package: Package, folder: Path) -> dict[str, Callable[[], object]]:
    surfaces, outputs = ShotSeas(package.shot), outputs_of(package.attributes)
    fields = surfaces.frame(package.frames[0], outputs)

    def compute() -> None:
        for frame in package.frames:
            surfaces.frame(frame, outputs)

    def arrays() -> None:
        with (folder / "arrays").open("wb") as file:
            for _ in package.frames:
                for values in _frame_arrays(package, fields):
                    file.write(np.asarray(values).data)
            file.flush()
            os.fsync(file.fileno())

    return {"compute": compute, "arrays": arrays}


def _exports(plan: Plan, frames: tuple[Frame, ...], folder: Path) -> dict[str, Callable[[], object]]:
    numbers = itertools.count()

    def writing(form: str) -> Callable[[], None]:
        def run() -> None:
            with tempfile.TemporaryDirectory(dir=folder) as own:
                _write(_package(plan, form, frames), Path(own) / f"{next(numbers)}" / "sea.usd")

        return run

    return {form: writing(form) for form in FORMS}


def _write(package: Package, top: Path) -> None:
    export = Export(package, top)
    export.check(package.frames)
    for _ in export.make(package.frames):
        pass
    export.finish()


def _frame_arrays(package: Package, fields: SurfaceFields | None) -> Iterator[Any]:
    edition = Edition(package, package.resolutions[0])
    for _, patch in edition.meshes():
        yield from mesh_values(pxr().Vt, patch, edition.attributes, package.half, fields).values()


def _size(plan: Plan, form: str, folder: Path) -> Row:
    """Bytes of all layers against those of all arrays in them."""
    frames = tuple(range(1, 4 * plan.bake_frames + 1))
    small = replace(plan, bake=plan.bake // 4)
    package = _package(small, form, frames)
    _write(package, folder / "sea.usd")
    written = sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())
    edition = Edition(package, package.resolutions[0])
    arrays = sum(patch.quads**2 * 5 * 4 + patch.vertices * 2 * 4 for _, patch in edition.meshes())
    # once at rest, and once a frame
    arrays += (len(frames) + 1) * sum(np.asarray(values).nbytes for values in _frame_arrays(package, None))
    return Row(
        GROUP, f"{form} {small.bake}², {len(frames)} frames: bytes of all layers against those of the arrays",
        written / arrays, "×", target="usd size",
    )  # fmt: skip
