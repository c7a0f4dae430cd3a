# SPDX-License-Identifier: GPL-3.0-or-later
"""The steps of an export: checks, frames, then the layers that combine them, the asset's own last."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from ...core import ParameterError
from ...core.data.frames import Frame, format_frames
from ...core.sea.bake import BakedFrame, bake
from ...core.sea.shot_spray import ShotSpray
from ..cache.folders import read_job
from ..cache.job import Job
from ..cache.records import unfinished
from ..files import sync_folder, writable_folder
from . import textures
from .asset import prim_name, write_asset, write_payload
from .box import Box, union
from .clips import ClipSink, write_manifest, write_stitch, write_topology_layer
from .layers import refuse_foreign, remove_leftovers, whole_layer, write_header
from .library import UsdError, pxr
from .material import write_material
from .mesh import ROOT, SURFACE, Edition, write_topology
from .package import LAYER_NAMES, Package, edition_folder
from .points import points_sink
from .spray import SPRAY_LAYER, write_spray

TOPOLOGY, MANIFEST, PAYLOAD, MATERIAL = "topology.usd", "manifest.usda", "payload.usd", "mtl.usd"
#: form → name of the geometry's layer, and of the other layers of this form
_GEOMETRY = {
    "points": ("geo.usdc",),
    "clips": ("geo.usd", TOPOLOGY, MANIFEST),
    "displacement": ("geo.usd",),
}


@dataclass(frozen=True)
class Export:
    """A package and its destination.

    top : the asset's own layer; all others are in the same folder
    bake : folder of a bake whose images displace the sea; None to bake beside the asset
    force : replace files of others, and existing clips
    spray : exported with the sea; None for none

    Raises UsdError if `pxr` is missing, ParameterError if the file name is not that of a layer.
    """

    package: Package
    top: Path
    bake: Path | None = None
    force: bool = False
    spray: ShotSpray | None = None

    def __post_init__(self) -> None:
        pxr()
        if self.top.suffix not in (".usd", ".usda", ".usdc"):
            raise ParameterError("out", str(self.top), "must end in .usd, .usda or .usdc")
        if self.top.stem in LAYER_NAMES:
            raise ParameterError(
                "out", str(self.top), "has the name of a layer beside it: choose another name"
            )

    @property
    def editions(self) -> tuple[tuple[Path, Edition], ...]:
        """The folder of each resolution, and its sea."""
        package = self.package
        return tuple(
            (edition_folder(self.top, package, resolution), Edition(package, resolution))
            for resolution in package.resolutions
        )

    def paths(self) -> Iterator[Path]:
        """All layers except the clips."""
        yield self.top
        if self.spray is not None:
            yield self._spray_layer
        for folder, _ in self.editions:
            for name in (*_GEOMETRY[self.package.form], MATERIAL, PAYLOAD):
                yield folder / name

    def check(self, frames: Sequence[Frame]) -> None:
        """Raise UsdError or OSError, before any work, if the export cannot be written.

        frames : those that will be written
        """
        package = self.package
        if not set(frames) <= set(package.frames):
            raise ParameterError(
                "only", format_frames(frames), f"must be some of the frames {format_frames(package.frames)}"
            )
        if package.form == "points" and len(frames) < len(package.frames):
            raise ParameterError(
                "only", format_frames(frames), "is for clips: a layer of points is made in one go"
            )
        writable_folder(self.top.parent)
        if not self.force:
            refuse_foreign(self.paths(), package)
            for _, _, sink in self._clips():
                refuse_foreign(map(sink.path, frames), package)
        if self.bake is not None:
            self.images  # noqa: B018  # names what is missing

    def left(self, frames: Sequence[Frame]) -> int:
        """Number of frames to write, over all resolutions."""
        if self.package.form == "clips":
            return sum(len(self._todo(sink, frames)) for _, _, sink in self._clips())
        if self.package.form == "displacement":
            return len(tuple(unfinished(self.bake_folder, self.job, frames)))
        return len(frames) * self.rounds

    @property
    def rounds(self) -> int:
        """Number of times each frame is computed: once per resolution, but only once for images."""
        return 1 if self.package.form == "displacement" else len(self.editions)

    def written_bytes(self) -> int:
        """Size of the asset on disk, without images of an existing bake."""
        clips = [sink.path(frame) for _, _, sink in self._clips() for frame in self.package.frames]
        own = self.package.form == "displacement" and self.bake is None
        images = self.images.values() if own else ()
        return sum(path.stat().st_size for path in (*self.paths(), *clips, *images))

    def make(self, frames: Sequence[Frame], workers: int = 1) -> Iterator[BakedFrame]:
        """Write frames; yields each once written. Frames in the form "points" appear together at the end."""
        yield from _MAKERS[self.package.form](self, frames, workers)

    def make_spray(self) -> Iterator[BakedFrame]:
        """Write the spray of all frames, if there is any; yields each. It appears at the end."""
        if self.spray is not None:
            yield from write_spray(self._spray_layer, self.package, self.spray)

    @property
    def _spray_layer(self) -> Path:
        return self.top.with_name(SPRAY_LAYER)

    def check_clips(self) -> None:
        """Raise UsdError if clips are missing."""
        for _, _, sink in self._clips():
            sink.check_complete()

    def finish(self) -> None:
        """Write the layers that combine the frames.

        Raises UsdError if frames or the spray are missing.
        """
        package = self.package
        self.check_clips()
        if self.spray is not None and not self._spray_layer.exists():
            raise UsdError(
                f"{self._spray_layer}: the spray is missing: make it before the layers are put together"
            )
        boxes, payloads = [], {}
        for folder, edition in self.editions:
            folder.mkdir(exist_ok=True)
            box = _FINISHERS[package.form](self, folder, edition)
            boxes.append(box)
            material = folder / MATERIAL
            write_material(material, package, self._relative_images(material))
            spray = (
                None if self.spray is None else textures.relative_path(self._spray_layer, folder / PAYLOAD)
            )
            write_payload(folder / PAYLOAD, package, _GEOMETRY[package.form][0], MATERIAL, box, spray)
            sync_folder(folder)
            payloads[edition.resolution] = f"./{(folder / PAYLOAD).relative_to(self.top.parent).as_posix()}"
        write_asset(self.top, package, payloads, union(boxes))
        sync_folder(self.top.parent)
        self._clean()

    def _clean(self) -> None:
        clips = (sink.path(frame) for _, _, sink in self._clips() for frame in self.package.frames)
        for path in (*self.paths(), *clips):
            remove_leftovers(path)

    @property
    def prim(self) -> str:
        """The asset's prim."""
        return f"/{prim_name(self.package)}"

    def _clips(self) -> Iterator[tuple[Path, Edition, ClipSink]]:
        if self.package.form == "clips":
            for folder, edition in self.editions:
                yield folder, edition, ClipSink(folder, edition)

    def _todo(self, sink: ClipSink, frames: Sequence[Frame]) -> tuple[Frame, ...]:
        return tuple(frame for frame in frames if self.force or not sink.is_current(frame))

    @cached_property
    def bake_folder(self) -> Path:
        """Folder of the images."""
        return self.bake or textures.own_bake(self.top, self.package)

    @cached_property
    def job(self) -> Job:
        """The job of the bake."""
        return read_job(self.bake_folder)

    @cached_property
    def images(self) -> dict[Frame, Path]:
        """The image of each frame. Raises UsdError with those that are missing."""
        return textures.image_paths(self.bake_folder, self.job, self.package.frames)

    def _relative_images(self, layer: Path) -> dict[Frame, str]:
        if self.package.form != "displacement":
            return {}
        return {frame: textures.relative_path(path, layer) for frame, path in self.images.items()}


def _make_points(export: Export, frames: Sequence[Frame], workers: int) -> Iterator[BakedFrame]:
    for folder, edition in export.editions:
        folder.mkdir(exist_ok=True)
        shot, on = export.package.at(edition.resolution), export.package.on(edition.resolution)
        with points_sink(folder / _GEOMETRY["points"][0], edition) as sink:
            yield from bake(shot, frames, sink, workers, on=on)


def _make_clips(export: Export, frames: Sequence[Frame], workers: int) -> Iterator[BakedFrame]:
    for folder, edition, sink in export._clips():
        sink.path(frames[0]).parent.mkdir(parents=True, exist_ok=True)
        todo = export._todo(sink, frames)
        shot, on = export.package.at(edition.resolution), export.package.on(edition.resolution)
        yield from bake(shot, todo, sink, workers, on=on)
        sync_folder(folder)


def _make_images(export: Export, frames: Sequence[Frame], workers: int) -> Iterator[BakedFrame]:
    if export.bake is None:
        yield from textures.make(export.bake_folder, export.job, frames, workers)


_MAKERS: dict[str, Callable[[Export, Sequence[Frame], int], Iterator[BakedFrame]]] = {
    "points": _make_points, "clips": _make_clips, "displacement": _make_images
}  # fmt: skip


def _finish_points(_export: Export, folder: Path, edition: Edition) -> Box:
    return union(extents(folder / _GEOMETRY["points"][0], edition.package.frames))


def _finish_clips(_export: Export, folder: Path, edition: Edition) -> Box:
    sink = ClipSink(folder, edition)
    write_topology_layer(folder / TOPOLOGY, edition)
    write_manifest(folder / MANIFEST, edition)
    write_stitch(folder / _GEOMETRY["clips"][0], edition, TOPOLOGY, MANIFEST)
    return union(box for frame in edition.package.frames for box in extents(sink.path(frame), (frame,)))


def _finish_displacement(export: Export, folder: Path, edition: Edition) -> Box:
    box = textures.displaced_box(edition, tuple(export.images.values()))
    with whole_layer(folder / _GEOMETRY["displacement"][0]) as layer:
        write_header(layer, export.package, (), ROOT)
        write_topology(layer, edition)
    return box


_FINISHERS: dict[str, Callable[[Export, Path, Edition], Box]] = {
    "points": _finish_points, "clips": _finish_clips, "displacement": _finish_displacement
}  # fmt: skip


def extents(path: Path, frames: Sequence[Frame]) -> Iterator[Box]:
    """The surface's bounding box at each frame, from a layer. Raises UsdError if there is none."""
    sdf = pxr().Sdf
    layer = sdf.Layer.OpenAsAnonymous(str(path))
    for frame in frames:
        extent = layer.QueryTimeSample(sdf.Path(f"/{ROOT}/{SURFACE}.extent"), float(frame))
        if extent is None:
            raise UsdError(f"{path}: does not hold frame {frame}: make it again with --force")
        yield Box(*np.array(extent, np.float64))
