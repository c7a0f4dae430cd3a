# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads an exported sea back and says what is wrong with it: also what no validator of layers can know."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.data.frames import Frame, format_frames
from ...core.sea.bake import ShotSeas
from ...core.sea.regions import TILE
from ...core.synthesis.channels import OF_MEMORY
from ..exr import COMPRESSION_ERROR, ExrError, read_image
from .asset import VARIANT_SET, sea_path
from .attributes import POINTS, Attribute
from .layers import UNREADABLE, mark_of, named_errors, reason
from .library import UsdError, pxr
from .material import MATERIAL, SCOPE
from .mesh import SURFACE, Edition
from .package import Package
from .reading import read_package

#: of a 16-bit value, and of one in 32 bits against this machine's own NumPy, relative to the largest
_HALF, _SINGLE = 2.0**-11, 1e-5
#: number of frames that are compared by default
_CHECKED = 3


class Problem(NamedTuple):
    """What is wrong, and at which frame; none for what concerns the whole asset."""

    frame: Frame | None
    text: str


@dataclass(frozen=True)
class _Opened:
    """A stage that shows one resolution."""

    stage: Any
    prim: str
    edition: Edition

    @property
    def package(self) -> Package:
        return self.edition.package

    @property
    def sea(self) -> str:
        """The prim above the meshes."""
        return sea_path(self.package, self.prim)

    @property
    def material(self) -> str:
        """The prim of the material."""
        return f"{self.prim}/{SCOPE}/{MATERIAL}"

    def attribute(self, name: str, mesh: str = SURFACE) -> Any:
        return self.stage.GetAttributeAtPath(f"{self.sea}/{mesh}.{name}")


def checked_frames(package: Package) -> tuple[Frame, ...]:
    """The first, the middle and the last frame."""
    frames = package.frames
    places = np.linspace(0, len(frames) - 1, min(_CHECKED, len(frames))).round().astype(int)
    return tuple(frames[place] for place in places)


def verify(path: Path, frames: Sequence[Frame] | None = None) -> Iterator[Problem]:
    """Each thing that is wrong with an asset of ours, and nothing where all is well.

    frames : those whose values are compared with the core's; by default the first, middle and last

    Raises UsdError for a file that is no asset of ours, or frames that it does not hold.
    """
    prim, package = read_package(path)
    chosen = checked_frames(package) if frames is None else tuple(frames)
    if not set(chosen) <= set(package.frames):
        raise UsdError(
            f"{path}: holds the frames {format_frames(package.frames)}, not {format_frames(chosen)}"
        )
    for resolution in package.resolutions:
        opened = _open(path, prim, package, resolution)
        yield from _readable(_stage_problems(opened))
        if not opened.attribute(POINTS.name):
            yield Problem(None, f"{opened.sea}/{SURFACE} has no points: a layer is missing or was moved")
            continue
        for problems in (_gaps, _CHECKS[package.form]):
            yield from _readable(problems(opened, chosen))


def _readable(problems: Iterator[Problem]) -> Iterator[Problem]:
    """The problems; a layer that cannot be read ends them and is one itself."""
    try:
        yield from problems
    except UNREADABLE as error:
        yield Problem(None, f"a layer cannot be read: {reason(error)}")


def _open(path: Path, prim: str, package: Package, resolution: int) -> _Opened:
    modules = pxr()
    with named_errors(path):
        stage = modules.Usd.Stage.Open(str(path))
        stage.Reload()  # what was replaced on disk is not what this process may have opened before
        if package.variants:
            with modules.Usd.EditContext(stage, stage.GetSessionLayer()):
                stage.GetPrimAtPath(prim).GetVariantSet(VARIANT_SET).SetVariantSelection(str(resolution))
    return _Opened(stage, prim, Edition(package, resolution))


def _stage_problems(opened: _Opened) -> Iterator[Problem]:
    stage, package = opened.stage, opened.package
    usd_geom = pxr().UsdGeom
    told = {
        "timeCodesPerSecond": (stage.GetTimeCodesPerSecond(), package.frames_per_second),
        "framesPerSecond": (stage.GetFramesPerSecond(), package.frames_per_second),
        "metersPerUnit": (usd_geom.GetStageMetersPerUnit(stage), package.metres_per_unit),
        "upAxis": (usd_geom.GetStageUpAxis(stage), package.up_axis),
        "startTimeCode": (stage.GetStartTimeCode(), float(package.frames[0])),
        "endTimeCode": (stage.GetEndTimeCode(), float(package.frames[-1])),
    }
    for name, (found, wanted) in told.items():
        if found != wanted:
            yield Problem(None, f"{name} is {found}, and the sea was exported with {wanted}")
    if not stage.GetPrimAtPath(opened.material):
        yield Problem(None, f"{opened.material} is missing: a layer is missing, damaged or was moved")


def _gaps(opened: _Opened, _frames: Sequence[Frame]) -> Iterator[Problem]:
    """Frames that nothing is there for."""
    if opened.package.form == "clips":
        yield from _missing_clips(opened)
    yield from _missing_samples(opened)


def _missing_samples(opened: _Opened) -> Iterator[Problem]:
    attribute = _moving_attribute(opened)
    if not attribute:
        return
    found = {_nearest_frame(opened.package, time) for time in attribute.GetTimeSamples()}
    missing = [frame for frame in opened.package.frames if frame not in found]
    if missing:
        yield Problem(None, f"frames {format_frames(missing)} have no sample: other frames are shown instead")


def _moving_attribute(opened: _Opened) -> Any:
    if opened.edition.static:
        return _texture(opened)
    return opened.attribute(POINTS.name)


def _nearest_frame(package: Package, time: float) -> Frame:
    return min(package.frames, key=lambda frame: abs(float(frame) - time))


def _missing_clips(opened: _Opened) -> Iterator[Problem]:
    """Clips that cannot be found from the layer that lists them, or are not of this sea."""
    fingerprint = opened.package.edition_fingerprint(opened.edition.resolution)
    listed = _listed_clips(opened)
    for frame in opened.package.frames:
        clip = listed.get(frame)
        if clip is None:
            yield Problem(frame, "no clip is listed: stitch the clips again with --stitch")
        elif not clip.is_file():
            yield Problem(frame, f"{clip} is missing: make it with --only {frame}")
        elif (mark := mark_of(clip)) is None:
            yield Problem(frame, f"{clip} is damaged: make it again with --force --only {frame}")
        elif mark.get("fingerprint") != fingerprint:
            yield Problem(frame, f"{clip} belongs to another sea: make it again with --only {frame}")


def _listed_clips(opened: _Opened) -> dict[Frame, Path]:
    """The clip that is active at each frame, as the surface's strongest layer with clips lists them."""
    modules = pxr()
    for spec in opened.stage.GetPrimAtPath(f"{opened.sea}/{SURFACE}").GetPrimStack():
        if spec.HasInfo("clips"):
            clips = spec.GetInfo("clips")["default"]
            paths = [
                Path(modules.Sdf.ComputeAssetPathRelativeToLayer(spec.layer, asset.path))
                for asset in clips["assetPaths"]
            ]
            return {
                _nearest_frame(opened.package, time): paths[int(index)] for time, index in clips["active"]
            }
    return {}


def _check_values(opened: _Opened, frames: Sequence[Frame]) -> Iterator[Problem]:
    """Every attribute of every mesh against the core's, at the chosen frames."""
    package, edition = opened.package, opened.edition
    surfaces = ShotSeas(package.at(edition.resolution), package.on(edition.resolution))
    compared = _as_made_now(package, edition.attributes)
    outputs = frozenset().union(*(attribute.outputs for attribute in compared))
    shown: list[NDArray[np.floating]] = []
    made: list[NDArray[np.floating]] = []
    for frame in frames:
        fields = surfaces.frame(frame, outputs)
        for path, grid in edition.meshes():
            mesh = path.rpartition("/")[2]
            points = _value(opened, POINTS.name, mesh, frame)
            if points is None or points.shape[1:] != (3,):
                yield Problem(frame, f"{mesh} has no points")
                continue
            for attribute in compared:
                found = _value(opened, attribute.name, mesh, frame)
                yield from _difference(opened, frame, f"{mesh}.{attribute.name}", attribute, found,
                                       attribute.values(grid, fields))  # fmt: skip
            yield from _outside(opened, frame, mesh, points)
            if mesh == SURFACE:
                shown.append(points)
                made.append(fields.displacement.copy())
    if _stands_still(shown) and not _stands_still(made):  # a calm does not move either
        yield Problem(None, f"nothing moves: the points are the same at frames {format_frames(frames)}")


def _as_made_now(package: Package, attributes: tuple[Attribute, ...]) -> tuple[Attribute, ...]:
    """The attributes that this program makes as they were made: not foam of an earlier version."""
    if package.foam_is_made_now:
        return attributes
    return tuple(attribute for attribute in attributes if not attribute.outputs & OF_MEMORY)


def _stands_still(fields: Sequence[NDArray[np.floating]]) -> bool:
    return len(fields) > 1 and all(np.array_equal(field, fields[0]) for field in fields[1:])


def _value(opened: _Opened, name: str, mesh: str, frame: Frame) -> NDArray[np.floating] | None:
    value = np.array(opened.attribute(name, mesh).Get(float(frame)))
    return value if value.dtype.kind in "fiu" and value.size else None  # of another type, or missing


def _difference(
    opened: _Opened,
    frame: Frame,
    name: str,
    attribute: Attribute,
    found: NDArray[np.floating] | None,
    wanted: NDArray[np.floating],
) -> Iterator[Problem]:
    if found is None or found.shape != wanted.shape:
        there = "nothing" if found is None else f"{len(np.atleast_1d(found))} values"
        yield Problem(frame, f"{name} holds {there} instead of {len(wanted)}")
        return
    tolerance = _HALF if opened.package.half and attribute.halved else _SINGLE
    limit = tolerance * max(1.0, float(np.abs(wanted).max()))
    error = float(np.abs(found.astype(np.float64) - wanted).max())
    if not error <= limit:
        yield Problem(frame, f"{name} differs from this sea's by {error:.3g}, more than {limit:.2g}")


def _outside(opened: _Opened, frame: Frame, mesh: str, points: NDArray[np.floating]) -> Iterator[Problem]:
    extent = _value(opened, "extent", mesh, frame)
    if (
        extent is None
        or extent.shape != (2, 3)
        or np.any(points.min(axis=0) < extent[0])
        or np.any(points.max(axis=0) > extent[1])
    ):
        yield Problem(frame, f"{mesh} has points outside its extent")


def _texture(opened: _Opened) -> Any:
    return opened.stage.GetAttributeAtPath(f"{opened.material}/mtlx_image.inputs:file")


def _check_images(opened: _Opened, frames: Sequence[Frame]) -> Iterator[Problem]:
    """Every frame's image is there, and the chosen ones hold this sea."""
    package = opened.package
    texture = _texture(opened)
    if not texture:
        yield Problem(None, f"{opened.material} has no displacement image")
        return
    surfaces = ShotSeas(package.shot, package.image_area or TILE)
    for frame in package.frames:
        image = texture.Get(float(frame))
        if image is None or not image.resolvedPath:
            yield Problem(frame, f"{image.path if image else 'its image'} is missing")
        elif frame in frames:
            yield from _image_difference(Path(image.resolvedPath), frame, surfaces)
    yield from _still_grid(opened)


def _image_difference(path: Path, frame: Frame, surfaces: ShotSeas) -> Iterator[Problem]:
    try:
        image, metadata = read_image(path)
    except ExrError as error:
        yield Problem(frame, str(error))
        return
    wanted = surfaces.frame(frame, {"displacement"}).displacement
    if image.shape != wanted.shape:
        yield Problem(frame, f"{path} has {image.shape[0]}² texels instead of {wanted.shape[0]}²")
        return
    kept = COMPRESSION_ERROR.get(metadata.get("compression", ""), 0.0)
    off = float(np.abs(image.astype(np.float64) - wanted).max())
    limit = (kept + _SINGLE) * max(1.0, float(np.abs(wanted).max()))
    if not off <= limit:
        yield Problem(frame, f"{path} differs from this sea by {off:.3g} m, more than {limit:.2g}")


def _still_grid(opened: _Opened) -> Iterator[Problem]:
    _, grid = next(iter(opened.edition.meshes()))
    points = opened.attribute(POINTS.name).Get()
    if (
        points is None
        or len(points) != grid.vertices
        or not np.allclose(np.array(points), grid.positions(None), atol=_SINGLE)
    ):
        yield Problem(None, f"{opened.sea}/{SURFACE} is not the flat grid that the images displace")


_CHECKS: dict[str, Callable[[_Opened, Sequence[Frame]], Iterator[Problem]]] = {
    "points": _check_values, "clips": _check_values, "displacement": _check_images
}  # fmt: skip
