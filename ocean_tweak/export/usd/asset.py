# SPDX-License-Identifier: GPL-3.0-or-later
"""The asset's own layer, which a shot references, and its payload."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from .attributes import to_vt
from .box import Box, of_tiles, tile_offsets
from .grid import proxy_step
from .layers import MARK, whole_layer, write_header
from .library import pxr
from .material import MATERIAL, SCOPE
from .mesh import ROOT
from .package import Package
from .spray import SPRAY

GEOMETRY, TILES = "geo", "tiles"
VARIANT_SET = "resolution"
_KIND = "component"


def prim_name(package: Package) -> str:
    """The asset's name as a valid prim name."""
    return str(pxr().Tf.MakeValidIdentifier(package.name))


def write_payload(
    path: Path, package: Package, geometry: str, material: str, box: Box, spray: str | None = None
) -> None:
    """Write payload.usd: geometry and material under the asset's own prim.

    geometry, material : names of these layers in the same folder
    box : around one tile in all frames
    spray : path of the spray's layer; None for none
    """
    modules = pxr()
    root = f"/{prim_name(package)}"
    with whole_layer(path, text=True) as layer:
        write_header(layer, package, package.frames, root[1:])
        stage = modules.Usd.Stage.Open(layer)
        modules.UsdGeom.Xform.Define(stage, root)
        scope = modules.UsdGeom.Scope.Define(stage, f"{root}/{GEOMETRY}").GetPrim()
        looks = modules.UsdGeom.Scope.Define(stage, f"{root}/{SCOPE}").GetPrim()
        looks.GetReferences().AddReference(f"./{material}")
        _add_sea(stage, scope, package, geometry, box)
        if spray is not None:
            beside = stage.DefinePrim(f"{sea_path(package, root)}/{SPRAY}")
            beside.GetReferences().AddReference(spray)
        binding = modules.UsdShade.MaterialBindingAPI.Apply(scope)
        water = modules.UsdShade.Material(stage.GetPrimAtPath(f"{root}/{SCOPE}/{MATERIAL}"))
        binding.Bind(water)
        del stage


def _add_sea(stage: Any, scope: Any, package: Package, geometry: str, box: Box) -> None:
    """Add the sea itself, or a point instancer that places it at each tile.

    Not instanceable prims: for these, OpenUSD does not report that clips are animated (as of 26.11), and
    Blender loses inherited materials.
    """
    modules = pxr()
    path = scope.GetPath()
    offsets = tile_offsets(package)
    if len(offsets) > 1:
        path = path.AppendChild(TILES)
        tiles = modules.UsdGeom.PointInstancer.Define(stage, path)
        tiles.CreatePositionsAttr(to_vt(modules.Vt, offsets))
        tiles.CreateProtoIndicesAttr(modules.Vt.IntArray(len(offsets)))
        tiles.CreateExtentAttr(to_vt(modules.Vt, np.stack(of_tiles(package, box))))
        tiles.CreatePrototypesRel().SetTargets([path.AppendChild(ROOT)])
    sea = modules.UsdGeom.Xform.Define(stage, path.AppendChild(ROOT))
    sea.GetPrim().GetReferences().AddReference(f"./{geometry}")


def sea_path(package: Package, prim: str) -> str:
    """Path of the sea's prim, the parent of its meshes, in the asset at `prim`."""
    return f"{prim}/{GEOMETRY}/{TILES}/{ROOT}" if package.tiles != (1, 1) else f"{prim}/{GEOMETRY}/{ROOT}"


def write_asset(path: Path, package: Package, payloads: Mapping[int, str], box: Box) -> None:
    """Write the asset's layer, last of all, as it makes the others visible.

    payloads : paths by resolution, relative to the layer
    box : around one tile in all frames
    """
    modules = pxr()
    with whole_layer(path, text=True) as layer:
        write_header(layer, package, package.frames, prim_name(package))
        stage = modules.Usd.Stage.Open(layer)
        prim = modules.UsdGeom.Xform.Define(stage, f"/{prim_name(package)}").GetPrim()
        model = modules.Usd.ModelAPI(prim)
        model.SetKind(_KIND)
        model.SetAssetName(package.name)
        model.SetAssetIdentifier(modules.Sdf.AssetPath(f"./{path.name}"))
        model.SetAssetVersion(package.fingerprint[:8])
        hint = modules.Vt.Vec3fArray.FromNumpy(_extents_hint(package, of_tiles(package, box)))
        modules.UsdGeom.ModelAPI.Apply(prim).SetExtentsHint(hint)
        prim.SetCustomDataByKey(MARK, package.record())
        if package.variants:
            _add_variants(prim, package, payloads)
        else:
            prim.GetPayloads().AddPayload(next(iter(payloads.values())))
        del stage


def _add_variants(prim: Any, package: Package, payloads: Mapping[int, str]) -> None:
    variants = prim.GetVariantSets().AddVariantSet(VARIANT_SET)
    for resolution in package.resolutions:
        variants.AddVariant(str(resolution))
        variants.SetVariantSelection(str(resolution))
        with variants.GetVariantEditContext():
            prim.GetPayloads().AddPayload(payloads[resolution])
    variants.SetVariantSelection(str(package.resolutions[0]))


def _extents_hint(package: Package, box: Box) -> Any:
    """Extents by purpose: default and, if the mesh has a proxy, render and proxy."""
    full = np.stack(box).astype(np.float32)
    if not any(proxy_step(resolution, package.proxy) for resolution in package.resolutions):
        return full
    most = np.finfo(np.float32).max
    empty = np.array([[most] * 3, [-most] * 3], np.float32)
    has_plain = not all(proxy_step(resolution, package.proxy) for resolution in package.resolutions)
    return np.concatenate([full if has_plain else empty, full, full])
