# SPDX-License-Identifier: GPL-3.0-or-later
"""A sea as value clips: one layer per frame, written in any order and on any machine, and the layers that
combine them.

Default values are in topology.usd, a sublayer of geo.usd: in geo.usd itself, which anchors the clips, they
would override them and nothing would move.
"""

from __future__ import annotations

import threading
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

from ...core.data.frames import Frame, format_frames, frame_label
from ...core.synthesis.channels import SurfaceFields
from ..files import sync_folder
from .attributes import outputs_of
from .layers import mark_of, whole_layer, write_header
from .library import UsdError, pxr
from .mesh import ROOT, Edition, declare, write_frame, write_topology
from .package import clip_name


@dataclass(frozen=True)
class ClipSink:
    """Writes frames as clips/NAME.####.usdc into an edition's folder.

    Several threads may write frames, but only one at a time uses OpenUSD: its plugins are loaded on first
    use, and two threads that load one at the same time can deadlock.
    """

    folder: Path
    edition: Edition
    _alone: threading.Lock = field(default_factory=threading.Lock, compare=False, repr=False)

    @property
    def outputs(self) -> frozenset[str]:
        """The fields that a frame must have."""
        return outputs_of(self.edition.package.attributes)

    def path(self, frame: Frame) -> Path:
        """Path of a frame's clip."""
        return self.folder / clip_name(self.edition.package.name, frame)

    def write(self, frame: Frame, fields: SurfaceFields, *_others: SurfaceFields) -> tuple[Path, ...]:
        """Write a frame's clip. Returns its path. Raises UsdError."""
        path, package = self.path(frame), self.edition.package
        with whole_layer(path, alone=self._alone) as layer:
            write_header(layer, package, (frame,), ROOT, self._mark(frame))
            declare(layer, self.edition)
            try:
                write_frame(layer, self.edition, frame, fields)
            except ValueError as error:
                raise UsdError(f"{path}: {error}") from error
        sync_folder(path.parent)
        return (path,)

    def _mark(self, frame: Frame) -> dict[str, str]:
        fingerprint = self.edition.package.edition_fingerprint(self.edition.resolution)
        return {"fingerprint": fingerprint, "frame": frame_label(frame)}

    def is_current(self, frame: Frame) -> bool:
        """Whether the frame's clip exists and has the same fingerprint."""
        found = mark_of(self.path(frame)) if self.path(frame).exists() else None
        return found is not None and all(found.get(key) == value for key, value in self._mark(frame).items())

    def check_complete(self) -> None:
        """Raise UsdError with the frames that have no clip of this sea."""
        missing = [frame for frame in self.edition.package.frames if not self.is_current(frame)]
        if missing:
            raise UsdError(
                f"{self.path(missing[0]).parent}: frames {format_frames(missing)} have no clip of "
                f"this sea: make them with --only {format_frames(missing)} before stitching"
            )


def write_manifest(path: Path, edition: Edition) -> None:
    """Write the manifest of the clips, so that none has to be opened to list their attributes."""
    with whole_layer(path) as layer:
        write_header(layer, edition.package, edition.package.frames, ROOT)
        declare(layer, edition)


def write_topology_layer(path: Path, edition: Edition) -> None:
    """Write everything that is the same in every frame, and default values."""
    with whole_layer(path) as layer:
        write_header(layer, edition.package, (), ROOT)
        write_topology(layer, edition)


def write_stitch(path: Path, edition: Edition, topology: str, manifest: str) -> None:
    """Write geo.usd: the clip for each time, over the topology.

    topology, manifest : names of the layers beside it
    """
    sdf, package = pxr().Sdf, edition.package
    with whole_layer(path, text=True) as layer:
        write_header(layer, package, package.frames, ROOT, {"clips": format_frames(package.frames)})
        layer.subLayerPaths.append(f"./{topology}")
        # on the meshes, not on their parent: if a shot makes that an instance, clips on it are not read
        for mesh, _ in edition.meshes():
            prim = sdf.CreatePrimInLayer(layer, mesh)
            prim.SetInfo("clips", {"default": _clip_set(package.name, mesh, package.frames, manifest)})


def _clip_set(name: str, mesh: str, frames: Iterable[Frame], manifest: str) -> dict[str, object]:
    sdf, vt, gf = pxr().Sdf, pxr().Vt, pxr().Gf
    frames = tuple(frames)
    return {
        "assetPaths": sdf.AssetPathArray([sdf.AssetPath(f"./{clip_name(name, frame)}") for frame in frames]),
        "primPath": mesh,
        "manifestAssetPath": sdf.AssetPath(f"./{manifest}"),
        "active": vt.Vec2dArray([gf.Vec2d(float(frame), index) for index, frame in enumerate(frames)]),
        "times": vt.Vec2dArray([gf.Vec2d(float(frame), float(frame)) for frame in frames]),
        # for a missing clip, its neighbours are interpolated instead of showing the flat sea
        "interpolateMissingClipValues": True,
    }
