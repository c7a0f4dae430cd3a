# SPDX-License-Identifier: GPL-3.0-or-later
"""The baked images that displace a flat grid: made, or found in a bake."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from ...core.data.frames import Frame, format_frames
from ...core.sea.bake import BakedFrame, bake
from ...core.synthesis.channels import MOVING_MAP
from ..cache.folders import open_folder
from ..cache.job import Job, safe_name, uid_of
from ..cache.locks import claimed
from ..cache.records import CacheSink, State, inspect, unfinished
from ..exr import read_image
from .box import Box, union
from .library import UsdError
from .mesh import Edition
from .package import Package

#: where a bake goes that the export makes itself, beside the asset
FOLDER = "textures"


def own_bake(top: Path, package: Package) -> Path:
    """The folder of the bake beside an asset, made where it is missing."""
    job = Job(
        safe_name(package.name), uid_of(package.name), package.shot, (MOVING_MAP,), frames=package.frames,
        area=package.image_area,
    )  # fmt: skip
    return open_folder(top.parent / FOLDER, job)


def make(folder: Path, job: Job, frames: Sequence[Frame], workers: int) -> Iterator[BakedFrame]:
    """Bake incomplete frames. Raises Held if another process is baking them."""
    with claimed(folder, tuple(frames)):
        todo = tuple(finding.frame for finding in unfinished(folder, job, frames))
        yield from bake(job.shot, todo, CacheSink(folder, job), workers, on=job.on)


def image_paths(folder: Path, job: Job, frames: Sequence[Frame]) -> dict[Frame, Path]:
    """The displacement image of each frame. Raises UsdError naming frames that the bake does not hold."""
    if MOVING_MAP not in job.maps:
        raise UsdError(
            f"{folder}: this bake holds {', '.join(job.maps)} but no {MOVING_MAP}: bake it with "
            f"--maps {MOVING_MAP}"
        )
    findings = [inspect(folder, job, frame) for frame in frames]
    broken = [finding for finding in findings if finding.state is not State.WHOLE]
    if broken:
        raise UsdError(
            f"{folder}: frames {format_frames(finding.frame for finding in broken)} are not in this bake "
            f"({broken[0].reason}): bake them, or ask for fewer frames"
        )
    return {frame: job.sequence(folder, frame).path(frame, MOVING_MAP) for frame in frames}


def relative_path(image: Path, layer: Path) -> str:
    """From a layer's folder to an image. Raises UsdError where there is no way, on another drive."""
    try:
        way = os.path.relpath(image, layer.parent)
    except ValueError:
        raise UsdError(f"{image}: lies on a different drive from {layer}: bake beside the layers") from None
    way = Path(way).as_posix()
    return way if way.startswith("../") else f"./{way}"


def displaced_box(edition: Edition, images: Sequence[Path]) -> Box:
    """Around the displaced surface in all frames. Raises ExrError for an image that cannot be read."""
    (_, grid), *_ = edition.meshes()
    points = grid.positions(None)
    flat = Box(points.min(axis=0).astype(np.float64), points.max(axis=0).astype(np.float64))

    def of_image(path: Path) -> Box:
        vectors = grid.turned(read_image(path)[0], grid.scale)
        return Box(flat.least + vectors.min(axis=0), flat.greatest + vectors.max(axis=0))

    return union(map(of_image, images))
