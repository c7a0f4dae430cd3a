# SPDX-License-Identifier: GPL-3.0-or-later
"""Spray as points of USD: one layer with all frames, which the payload shows beside the sea's mesh."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from ...core.sea.bake import BakedFrame
from ...core.sea.shot_spray import ShotSpray
from ...core.spray.particles import Particles
from .grid import turned
from .layers import save, whole_layer, write_header
from .library import pxr
from .package import Package
from .points import HELD_BYTES

#: the layer beside the others, its prim, and that of the points in it
SPRAY_LAYER, SPRAY = "spray.usdc", "spray"
POINTS = f"/{SPRAY}/particles"
_MATERIAL = f"/{SPRAY}/look"
_COLOUR = (0.92, 0.93, 0.94)

#: attribute → its type
_TYPES = {
    "points": "Point3fArray", "velocities": "Vector3fArray", "widths": "FloatArray", "ids": "Int64Array",
    "extent": "Float3Array", "primvars:age": "FloatArray", "primvars:kind": "IntArray",
}  # fmt: skip


def write_spray(path: Path, package: Package, spray: ShotSpray) -> Iterator[BakedFrame]:
    """Write the spray of a package's frames; yields each. The layer is there at the end, or as it was.

    Raises SprayError for more particles than the memory holds, UsdError for what cannot be written.
    """
    sdf, held = pxr().Sdf, 0
    with whole_layer(path) as layer:
        write_header(layer, package, package.frames, SPRAY)
        _declare(layer)
        for frame in package.frames:
            begun = time.perf_counter()
            for name, value in _values(spray.at(frame), package).items():
                layer.SetTimeSample(sdf.Path(f"{POINTS}.{name}"), float(frame), value)
                held += np.asarray(value).nbytes
            if held >= HELD_BYTES:
                save(layer, path)
                held = 0
            yield BakedFrame(frame, (path,), time.perf_counter() - begun)


def _declare(layer: Any) -> None:
    """What is the same in all frames."""
    modules = pxr()
    sdf = modules.Sdf
    for name, kind in ((f"/{SPRAY}", "Xform"), (POINTS, "Points")):
        prim = sdf.CreatePrimInLayer(layer, name)
        prim.specifier, prim.typeName = sdf.SpecifierDef, kind
    for name, kind in _TYPES.items():
        spec = sdf.AttributeSpec(layer.GetPrimAtPath(POINTS), name, getattr(sdf.ValueTypeNames, kind))
        if name == "widths" or name.startswith("primvars:"):
            spec.SetInfo("interpolation", "vertex")
    stage = modules.Usd.Stage.Open(layer)
    material = modules.UsdShade.Material.Define(stage, _MATERIAL)
    shader = modules.UsdShade.Shader.Define(stage, f"{_MATERIAL}/surface")
    shader.CreateIdAttr("UsdPreviewSurface")
    for name, kind, value in (("diffuseColor", "Color3f", _COLOUR), ("roughness", "Float", 1.0)):
        shader.CreateInput(name, getattr(sdf.ValueTypeNames, kind)).Set(value)
    material.CreateSurfaceOutput().ConnectToSource(shader.ConnectableAPI(), "surface")
    points = stage.GetPrimAtPath(POINTS)
    modules.UsdShade.MaterialBindingAPI.Apply(points).Bind(material)
    del stage


def _values(particles: Particles, package: Package) -> dict[str, Any]:
    """Arrays of a frame by attribute, in the layer's units and axes."""
    vt = pxr().Vt
    scale = np.float32(package.scale)
    points = turned(particles.position * scale, package.up_axis)
    radius = particles.radius * scale
    widest = float(np.max(radius, initial=0.0))
    box = np.zeros((2, 3), np.float32)
    if len(points):
        box = np.stack([points.min(axis=0) - widest, points.max(axis=0) + widest])
    return {
        "points": vt.Vec3fArray.FromNumpy(np.ascontiguousarray(points)),
        "velocities": vt.Vec3fArray.FromNumpy(
            np.ascontiguousarray(turned(particles.velocity * scale, package.up_axis))
        ),
        "widths": vt.FloatArray.FromNumpy(2.0 * radius),
        "ids": vt.Int64Array.FromNumpy(particles.id),
        "extent": vt.Vec3fArray.FromNumpy(box.astype(np.float32)),
        "primvars:age": vt.FloatArray.FromNumpy(particles.age),
        "primvars:kind": vt.IntArray.FromNumpy(particles.kind.astype(np.int32)),
    }
