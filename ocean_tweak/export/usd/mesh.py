# SPDX-License-Identifier: GPL-3.0-or-later
"""The mesh prims of a sea: what of them never changes, and their values at a frame."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...core.data.frames import Frame
from ...core.synthesis.channels import SurfaceFields
from .attributes import EXTENT, Attribute, chosen, mesh_values, to_vt, type_name
from .grid import UsdGrid, proxy_step
from .library import pxr
from .package import Package

#: the prim that an edition's layers are about, and its meshes
ROOT = "sea"
SURFACE, PROXY = "surface", "proxy"


@dataclass(frozen=True)
class Edition:
    """The sea of a package at one resolution."""

    package: Package
    resolution: int

    @property
    def static(self) -> bool:
        """Whether the mesh stands still, because a material moves it."""
        return self.package.form == "displacement"

    @property
    def attributes(self) -> tuple[Attribute, ...]:
        """Those of the meshes, points first."""
        return chosen(() if self.static else self.package.attributes)

    def meshes(self) -> Iterator[tuple[str, UsdGrid]]:
        """Paths of the mesh prims and their grids."""
        package = self.package
        grid = UsdGrid(
            package.size, self.resolution, package.texels, 1, package.up_axis, package.scale, package.corner
        )
        yield f"/{ROOT}/{SURFACE}", grid
        step = proxy_step(self.resolution, package.proxy)
        if step:
            yield f"/{ROOT}/{PROXY}", replace(grid, step=step)


def write_topology(layer: Any, edition: Edition) -> None:
    """Author into a layer all that is the same in every frame, and the flat sea as defaults."""
    sdf = pxr().Sdf
    root = sdf.CreatePrimInLayer(layer, f"/{ROOT}")
    root.specifier, root.typeName = sdf.SpecifierDef, "Xform"
    meshes = dict(edition.meshes())
    for path, grid in meshes.items():
        prim = sdf.CreatePrimInLayer(layer, path)
        prim.specifier, prim.typeName = sdf.SpecifierDef, "Mesh"
        # a material that moves the mesh dices it; a flat grid is the same after any subdivision
        _write_constants(prim, grid, "catmullClark" if edition.static else "none")
        _write_declarations(prim, edition)
        values = mesh_values(pxr().Vt, grid, edition.attributes, edition.package.half, None)
        for name, value in values.items():
            prim.attributes[name].default = value
        if len(meshes) > 1:
            _write_purpose(prim, path)


def _write_constants(prim: Any, grid: UsdGrid, subdivision: str) -> None:
    sdf, vt = pxr().Sdf, pxr().Vt
    names = sdf.ValueTypeNames
    counts = np.full(grid.quads**2, 4, np.int32)
    constants = (
        ("faceVertexCounts", names.IntArray, vt.IntArray.FromNumpy(counts)),
        ("faceVertexIndices", names.IntArray, vt.IntArray.FromNumpy(grid.corners().reshape(-1))),
        ("subdivisionScheme", names.Token, subdivision),
        ("orientation", names.Token, "rightHanded"),
        ("doubleSided", names.Bool, True),
    )
    for name, kind, value in constants:
        uniform = name in ("subdivisionScheme", "orientation", "doubleSided")
        variability = sdf.VariabilityUniform if uniform else sdf.VariabilityVarying
        sdf.AttributeSpec(prim, name, kind, variability).default = value
    coordinates = sdf.AttributeSpec(prim, "primvars:st", names.TexCoord2fArray)
    coordinates.SetInfo("interpolation", "vertex")
    coordinates.default = to_vt(vt, grid.texture_coordinates())


def _write_declarations(prim: Any, edition: Edition) -> None:
    sdf = pxr().Sdf
    for attribute in edition.attributes:
        kind = getattr(sdf.ValueTypeNames, type_name(attribute, edition.package.half))
        spec = sdf.AttributeSpec(prim, attribute.name, kind)
        if attribute.name == "normals" or attribute.name.startswith("primvars:"):
            spec.SetInfo("interpolation", "vertex")
    sdf.AttributeSpec(prim, EXTENT[0], getattr(sdf.ValueTypeNames, EXTENT[1]))


def _write_purpose(prim: Any, path: str) -> None:
    sdf = pxr().Sdf
    is_proxy = path.endswith(f"/{PROXY}")
    purpose = sdf.AttributeSpec(prim, "purpose", sdf.ValueTypeNames.Token, sdf.VariabilityUniform)
    purpose.default = "proxy" if is_proxy else "render"
    if not is_proxy:
        target = sdf.RelationshipSpec(prim, "proxyPrim", False)
        target.targetPathList.explicitItems = [sdf.Path(f"/{ROOT}/{PROXY}")]


def declare(layer: Any, edition: Edition) -> None:
    """Author into a layer only the types of what moves: a clip, or the manifest of all."""
    sdf = pxr().Sdf
    for path, _ in edition.meshes():
        prim = sdf.CreatePrimInLayer(layer, path)
        for attribute in edition.attributes:
            kind = getattr(sdf.ValueTypeNames, type_name(attribute, edition.package.half))
            sdf.AttributeSpec(prim, attribute.name, kind)
        sdf.AttributeSpec(prim, EXTENT[0], getattr(sdf.ValueTypeNames, EXTENT[1]))


def write_frame(layer: Any, edition: Edition, frame: Frame, fields: SurfaceFields) -> int:
    """Author a frame's values into a layer where they are declared. Returns their bytes.

    Raises ValueError for numbers that are not finite.
    """
    sdf, vt = pxr().Sdf, pxr().Vt
    size = 0
    for path, grid in edition.meshes():
        values = mesh_values(vt, grid, edition.attributes, edition.package.half, fields)
        for name, value in values.items():
            layer.SetTimeSample(sdf.Path(f"{path}.{name}"), float(frame), value)
            size += np.asarray(value).nbytes
    return size
