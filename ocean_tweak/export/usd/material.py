# SPDX-License-Identifier: GPL-3.0-or-later
"""The water's material, and displacement of the mesh by images."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ...core.data.frames import Frame
from .attributes import WATER_COLOUR
from .layers import whole_layer, write_header
from .library import pxr
from .package import Package

SCOPE, MATERIAL = "mtl", "water"
_ROUGHNESS = 0.05
_REFRACTION = 1.333

HEIGHT_ONLY = (
    "Displaced by height alone, along the normal: UsdPreviewSurface has no vector displacement, "
    "so crests are less sharp than the sea's. The MaterialX terminal displaces by the whole "
    "vector."
)
VECTOR_SPACE = (
    "Vector displacement in tangent space (dPdu, dPdv, N), all of length 1. On this flat grid u runs east "
    "and v north, so red, green and blue are metres east, north and up, whichever axis is up."
)


def write_material(path: Path, package: Package, textures: Mapping[Frame, str]) -> None:
    """Write mtl.usd.

    textures : displacement images by frame, relative to the layer; none if the mesh itself moves
    """
    modules = pxr()
    frames = tuple(sorted(textures))
    with whole_layer(path) as layer:
        write_header(layer, package, frames, SCOPE)
        stage = modules.Usd.Stage.Open(layer)
        modules.UsdGeom.Scope.Define(stage, f"/{SCOPE}")
        material = modules.UsdShade.Material.Define(stage, f"/{SCOPE}/{MATERIAL}")
        surface = _preview_surface(stage, material, package)
        if textures:
            _preview_displacement(stage, material, surface, package, textures)
            _vector_displacement(stage, material, package, textures)
        del stage


def _shader(stage: Any, material: Any, name: str, kind: str) -> Any:
    shader = pxr().UsdShade.Shader.Define(stage, material.GetPath().AppendChild(name))
    shader.CreateIdAttr(kind)
    return shader


def _inputs(shader: Any, **values: tuple[Any, Any]) -> None:
    for name, (kind, value) in values.items():
        shader.CreateInput(name, kind).Set(value)


def _preview_surface(stage: Any, material: Any, package: Package) -> Any:
    names, gf = pxr().Sdf.ValueTypeNames, pxr().Gf
    surface = _shader(stage, material, "preview", "UsdPreviewSurface")
    _inputs(surface, roughness=(names.Float, _ROUGHNESS), ior=(names.Float, _REFRACTION))
    colour = surface.CreateInput("diffuseColor", names.Color3f)
    colour.Set(gf.Vec3f(*WATER_COLOUR))
    if package.form != "displacement" and "displayColor" in package.attributes:
        reader = _shader(stage, material, "displayColor", "UsdPrimvarReader_float3")
        _inputs(
            reader, varname=(names.String, "displayColor"), fallback=(names.Float3, gf.Vec3f(*WATER_COLOUR))
        )
        colour.ConnectToSource(reader.CreateOutput("result", names.Float3))
    material.CreateSurfaceOutput().ConnectToSource(surface.CreateOutput("surface", names.Token))
    return surface


def _set_images(attribute: Any, textures: Mapping[Frame, str]) -> None:
    sdf = pxr().Sdf
    for frame, path in textures.items():
        attribute.Set(sdf.AssetPath(path), float(frame))
    attribute.Set(sdf.AssetPath(textures[min(textures)]))
    attribute.SetColorSpace("raw")


def _preview_displacement(
    stage: Any, material: Any, surface: Any, package: Package, textures: Mapping[Frame, str]
) -> None:
    names, gf = pxr().Sdf.ValueTypeNames, pxr().Gf
    place = _shader(stage, material, "st", "UsdPrimvarReader_float2")
    _inputs(place, varname=(names.String, "st"))
    texture = _shader(stage, material, "displacement", "UsdUVTexture")
    scale = gf.Vec4f(package.scale)
    _inputs(
        texture, wrapS=(names.Token, "repeat"), wrapT=(names.Token, "repeat"),
        sourceColorSpace=(names.Token, "raw"), scale=(names.Float4, scale),
        bias=(names.Float4, gf.Vec4f(0.0)), fallback=(names.Float4, gf.Vec4f(0.0)),
    )  # fmt: skip
    _set_images(texture.CreateInput("file", names.Asset).GetAttr(), textures)
    texture.CreateInput("st", names.Float2).ConnectToSource(place.CreateOutput("result", names.Float2))
    height = surface.CreateInput("displacement", names.Float)
    height.GetAttr().SetDocumentation(HEIGHT_ONLY)
    height.ConnectToSource(texture.CreateOutput("b", names.Float))
    material.CreateDisplacementOutput().ConnectToSource(surface.CreateOutput("displacement", names.Token))


def _vector_displacement(stage: Any, material: Any, package: Package, textures: Mapping[Frame, str]) -> None:
    names, gf = pxr().Sdf.ValueTypeNames, pxr().Gf
    surface = _shader(stage, material, "mtlx_surface", "ND_standard_surface_surfaceshader")
    _inputs(
        surface, base_color=(names.Color3f, gf.Vec3f(*WATER_COLOUR)),
        specular_roughness=(names.Float, _ROUGHNESS), specular_IOR=(names.Float, _REFRACTION),
    )  # fmt: skip
    place = _shader(stage, material, "mtlx_st", "ND_geompropvalue_vector2")
    _inputs(place, geomprop=(names.String, "st"))
    image = _shader(stage, material, "mtlx_image", "ND_image_vector3")
    _inputs(
        image, uaddressmode=(names.String, "periodic"), vaddressmode=(names.String, "periodic"),
        filtertype=(names.String, "linear"),
    )  # fmt: skip
    _set_images(image.CreateInput("file", names.Asset).GetAttr(), textures)
    image.CreateInput("texcoord", names.Float2).ConnectToSource(place.CreateOutput("out", names.Float2))
    moved = _shader(stage, material, "mtlx_displacement", "ND_displacement_vector3")
    _inputs(moved, scale=(names.Float, package.scale))
    vector = moved.CreateInput("displacement", names.Float3)
    vector.GetAttr().SetDocumentation(VECTOR_SPACE)
    vector.ConnectToSource(image.CreateOutput("out", names.Float3))
    material.CreateSurfaceOutput("mtlx").ConnectToSource(surface.CreateOutput("out", names.Token))
    material.CreateDisplacementOutput("mtlx").ConnectToSource(moved.CreateOutput("out", names.Token))
