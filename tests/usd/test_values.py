# SPDX-License-Identifier: GPL-3.0-or-later
"""What a reopened stage holds is what the core makes, wherever the layers are."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest
from pxr import Kind, Sdf, Usd, UsdGeom, UsdShade

from ocean_tweak.export.usd.reading import read_package

from .conftest import FORMS, SAMPLES, SIZE, expected, shot, turned, value, write

MESH = "/sea/geo/sea/surface"
ANIMATED = ("points", "clips")


def close(found: np.ndarray, wanted: np.ndarray) -> None:
    np.testing.assert_allclose(found, wanted, rtol=2e-7, atol=1e-5)  # the first is two roundings to 32 bits


@pytest.mark.parametrize("form", ANIMATED)
def test_values_are_the_cores(exported, tmp_path, form):
    moved = tmp_path / "elsewhere"
    shutil.copytree(exported(form=form).parent, moved)
    stage = Usd.Stage.Open(str(moved / "sea.usd"))
    for frame in (1001, 1003, 1004):
        wanted = expected(frame)
        close(value(stage, f"{MESH}.points", frame), wanted.points)
        close(value(stage, f"{MESH}.velocities", frame), wanted.velocities)
        close(value(stage, f"{MESH}.normals", frame), wanted.normals)
        close(value(stage, f"{MESH}.primvars:foam", frame), wanted.foam)
        close(value(stage, f"{MESH}.primvars:cusp", frame), wanted.cusp)
        close(value(stage, f"{MESH}.primvars:breaking", frame), wanted.breaking)
        close(value(stage, f"{MESH}.primvars:foam_age", frame), wanted.foam_age)
        extent = value(stage, f"{MESH}.extent", frame)
        close(extent, [wanted.points.min(axis=0), wanted.points.max(axis=0)])
        points = value(stage, f"{MESH}.points", frame)
        assert np.all(points >= extent[0])
        assert np.all(points <= extent[1])
    for name in ("foam", "breaking", "foam_age"):  # or the comparison would say nothing
        assert np.ptp(getattr(expected(1001), name)) > 0.01


@pytest.mark.parametrize("form", ANIMATED)
def test_display_colour_goes_from_water_to_white_with_foam(exported, form):
    stage = Usd.Stage.Open(str(exported(form=form)))
    colours, foam = value(stage, f"{MESH}.primvars:displayColor", 1003), expected(1003).foam
    brightness = colours.sum(axis=1)
    order = np.argsort(foam)
    assert np.all(np.diff(brightness[order]) >= -1e-5)
    assert np.all((colours >= 0.0) & (colours <= 1.0))


@pytest.mark.parametrize("form", ANIMATED)
@pytest.mark.parametrize("scale", [1.0, 100.0])
def test_y_up_and_centimetres_turn_and_scale_all_vectors(exported, form, scale):
    path = exported(form=form, up_axis="Y", metres_per_unit=1.0 / scale)
    stage = Usd.Stage.Open(str(path))
    assert UsdGeom.GetStageUpAxis(stage) == "Y"
    assert UsdGeom.GetStageMetersPerUnit(stage) == 1.0 / scale
    wanted = expected(1003)
    close(value(stage, f"{MESH}.points", 1003) / scale, turned(wanted.points))
    close(value(stage, f"{MESH}.velocities", 1003) / scale, turned(wanted.velocities))
    close(value(stage, f"{MESH}.normals", 1003), turned(wanted.normals))


def test_axes_keep_right_handed_faces(exported):
    for axis, up in (("Z", 2), ("Y", 1)):
        stage = Usd.Stage.Open(str(exported(form="points", up_axis=axis)))
        points = value(stage, f"{MESH}.points").astype(np.float64)
        faces = value(stage, f"{MESH}.faceVertexIndices").reshape(-1, 4)
        first, second, _, fourth = (points[faces[:, corner]] for corner in range(4))
        assert np.all(np.cross(second - first, fourth - first)[:, up] > 0.0)


@pytest.mark.parametrize("form", ANIMATED)
def test_velocities_are_the_points_differences(exported, form):
    stage = Usd.Stage.Open(str(exported(form=form, frames="1001.99-1002.01x0.01")))
    rate = stage.GetTimeCodesPerSecond()
    before, after = (value(stage, f"{MESH}.points", frame).astype(np.float64) for frame in (1001.99, 1002.01))
    velocities = value(stage, f"{MESH}.velocities", 1002)
    np.testing.assert_allclose((after - before) * rate / 0.02, velocities, atol=0.02)
    assert np.abs(velocities).max() > 1.0


@pytest.mark.parametrize("form", FORMS)
def test_layer_tree(exported, form):
    path = exported(form=form)
    stage = Usd.Stage.Open(str(path))
    root = stage.GetDefaultPrim()
    assert root.GetPath() == "/sea"
    assert Usd.ModelAPI(root).GetKind() == Kind.Tokens.component
    info = Usd.ModelAPI(root).GetAssetInfo()
    assert info["name"] == "sea"
    assert info["identifier"].path == "./sea.usd"
    assert [child.GetName() for child in root.GetChildren()] == ["geo", "mtl"]
    assert {child.GetTypeName() for child in root.GetChildren()} == {"Scope"}
    unloaded = Usd.Stage.Open(str(path), Usd.Stage.LoadNone)
    assert not unloaded.GetDefaultPrim().GetChildren()
    bound = UsdShade.MaterialBindingAPI(stage.GetPrimAtPath(MESH)).ComputeBoundMaterial()[0]
    assert bound.GetPath() == "/sea/mtl/water"
    for layer in stage.GetUsedLayers():
        if layer.anonymous:
            continue
        assert layer.HasTimeCodesPerSecond()  # it would be that of the frames anyhow, and is read by some
        assert layer.timeCodesPerSecond == layer.framesPerSecond == 25.0
        for other in layer.GetCompositionAssetDependencies():
            assert other.startswith("./")
    assert (stage.GetStartTimeCode(), stage.GetEndTimeCode()) == (1001.0, 1004.0)
    assert read_package(path)[1].shot == shot()
    assert root.GetCustomDataByKey("ocean_tweak:form") == form


@pytest.mark.parametrize("form", ANIMATED)
def test_every_animated_layer_says_its_range(exported, form):
    folder = exported(form=form).parent
    animated = [folder / "geo.usdc"] if form == "points" else [folder / "geo.usd", folder / "manifest.usda"]
    for path in animated:
        layer = Sdf.Layer.FindOrOpen(str(path))
        assert (layer.startTimeCode, layer.endTimeCode) == (1001.0, 1004.0)
    for clip in folder.glob("clips/*"):
        layer = Sdf.Layer.FindOrOpen(str(clip))
        frame = float(clip.name.split(".")[1])
        assert (layer.startTimeCode, layer.endTimeCode) == (frame, frame)
        assert (layer.timeCodesPerSecond, layer.framesPerSecond) == (25.0, 25.0)


@pytest.mark.parametrize("form", ANIMATED)
def test_what_does_not_move(exported, form):
    stage = Usd.Stage.Open(str(exported(form=form)))
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath(MESH))
    assert mesh.GetSubdivisionSchemeAttr().Get() == "none"
    assert mesh.GetNormalsInterpolation() == "vertex"
    primvars = UsdGeom.PrimvarsAPI(mesh)
    for name, kind in {
        "st": Sdf.ValueTypeNames.TexCoord2fArray, "foam": Sdf.ValueTypeNames.FloatArray,
        "cusp": Sdf.ValueTypeNames.FloatArray, "displayColor": Sdf.ValueTypeNames.Color3fArray,
    }.items():  # fmt: skip
        primvar = primvars.GetPrimvar(name)
        assert primvar.GetInterpolation() == "vertex"
        assert primvar.GetTypeName() == kind
    wanted = expected(1001)
    close(value(stage, f"{MESH}.primvars:st"), wanted.st)
    close(value(stage, f"{MESH}.points"), wanted.flat)  # the defaults are a flat sea
    close(value(stage, f"{MESH}.extent"), [[0, 0, 0], [SIZE, SIZE, 0]])
    close(value(stage, f"{MESH}.normals"), np.tile([0.0, 0.0, 1.0], (len(wanted.flat), 1)))
    assert not value(stage, f"{MESH}.primvars:foam").any()
    assert len(value(stage, f"{MESH}.faceVertexCounts")) == SAMPLES**2
    assert UsdGeom.Mesh.ValidateTopology(
        mesh.GetFaceVertexIndicesAttr().Get(), mesh.GetFaceVertexCountsAttr().Get(), len(wanted.flat)
    )[0]


def test_lost_clips_show_their_neighbours(tmp_path, quiet):
    top = tmp_path / "sea.usd"
    write(top, frames="1001-1008", form="clips")
    for frame in (1003, 1004, 1005):
        (tmp_path / "clips" / f"sea.{frame}.usdc").unlink()
    stage = Usd.Stage.Open(str(top))
    before, after = expected(1002).points, expected(1006).points
    close(value(stage, f"{MESH}.points", 1003), before + (after - before) / 4.0)
    close(value(stage, f"{MESH}.points", 1005), before + (after - before) * 0.75)
    close(value(stage, f"{MESH}.points", 1007), expected(1007).points)


@pytest.mark.parametrize("form", ANIMATED)
def test_flattened(exported, tmp_path, form):
    flat = tmp_path / "flat.usdc"
    Usd.Stage.Open(str(exported(form=form))).Flatten().Export(str(flat))
    stage = Usd.Stage.Open(str(flat))
    for frame in (1001, 1004):
        close(value(stage, f"{MESH}.points", frame), expected(frame).points)
        close(value(stage, f"{MESH}.primvars:foam", frame), expected(frame).foam)


@pytest.mark.parametrize("form", ANIMATED)
def test_referenced_with_an_offset_and_a_scale_in_time(exported, tmp_path, form):
    stage = Usd.Stage.CreateNew(str(tmp_path / "shot.usda"))
    prim = stage.DefinePrim("/set/ocean")
    # frame 1001 at 10, every second frame of the shot one of the sea
    prim.GetReferences().AddReference(str(exported(form=form)), Sdf.LayerOffset(10.0 - 2 * 1001, 2.0))
    stage.SetTimeCodesPerSecond(25)
    stage.Save()
    stage = Usd.Stage.Open(str(tmp_path / "shot.usda"))
    mesh = "/set/ocean/geo/sea/surface"
    for frame, original in ((10, 1001), (12, 1002), (16, 1004)):
        close(value(stage, f"{mesh}.points", frame), expected(original).points)
    between = (expected(1001).points + expected(1002).points) / 2.0
    close(value(stage, f"{mesh}.points", 11), between)


@pytest.mark.parametrize("form", ANIMATED)
def test_instanced_in_a_shot(exported, tmp_path, form):
    stage = Usd.Stage.CreateInMemory()
    stage.SetTimeCodesPerSecond(25)  # with another rate OpenUSD stretches the time of what is referenced
    for name in ("/here", "/there"):
        prim = stage.DefinePrim(name)
        prim.GetReferences().AddReference(str(exported(form=form)))
        prim.SetInstanceable(True)
    assert len(stage.GetPrototypes()) == 1
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/there/geo/sea/surface"))
    for frame in (1001, 1004):
        close(np.array(mesh.GetPointsAttr().Get(frame)), expected(frame).points)


@pytest.mark.parametrize("form", ANIMATED)
def test_tiles_stand_side_by_side_and_move(exported, form):
    stage = Usd.Stage.Open(str(exported(form=form, tiles=(3, 2))))
    tiles = UsdGeom.PointInstancer(stage.GetPrimAtPath("/sea/geo/tiles"))
    places = [
        transform.ExtractTranslation() for transform in tiles.ComputeInstanceTransformsAtTime(1003, 1003)
    ]
    wanted = [(column * SIZE, row * SIZE, 0.0) for row in range(2) for column in range(3)]
    assert [tuple(place) for place in places] == wanted
    assert tiles.GetPrototypesRel().GetForwardedTargets() == [Sdf.Path("/sea/geo/tiles/sea")]
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/sea/geo/tiles/sea/surface"))
    assert mesh.GetPointsAttr().ValueMightBeTimeVarying()
    assert mesh.GetPointsAttr().GetTimeSamples() == [1001.0, 1002.0, 1003.0, 1004.0]
    extent = value(stage, "/sea/geo/tiles.extent")
    for frame in (1001, 1002, 1003, 1004):
        points = np.array(mesh.GetPointsAttr().Get(frame))
        close(points, expected(frame).points)
        assert np.all(points >= extent[0])
        assert np.all(points + np.array(wanted[-1]) <= extent[1] + 1e-4)


def test_tiles_north_in_y_up(exported):
    stage = Usd.Stage.Open(str(exported(form="points", tiles=(1, 2), up_axis="Y", metres_per_unit=0.5)))
    tiles = UsdGeom.PointInstancer(stage.GetPrimAtPath("/sea/geo/tiles"))
    close(np.array(tiles.GetPositionsAttr().Get()), [(0.0, 0.0, 0.0), (0.0, 0.0, -2.0 * SIZE)])


@pytest.mark.parametrize("form", FORMS)
def test_extents_hint_holds_every_frame(exported, form):
    stage = Usd.Stage.Open(str(exported(form=form)), Usd.Stage.LoadNone)
    low, high = np.array(UsdGeom.ModelAPI(stage.GetDefaultPrim()).GetExtentsHintAttr().Get())
    for frame in (1001, 1002, 1003, 1004):
        points = expected(frame).points
        assert np.all(points >= low - 1e-3)
        assert np.all(points <= high + 1e-3)


@pytest.mark.parametrize("form", ANIMATED)
def test_proxy_beside_render(exported, form):
    stage = Usd.Stage.Open(str(exported(form=form, proxy=10)))
    surface, proxy = (
        UsdGeom.Mesh(stage.GetPrimAtPath(f"/sea/geo/sea/{name}")) for name in ("surface", "proxy")
    )
    assert surface.ComputePurpose() == "render"
    assert proxy.ComputePurpose() == "proxy"
    assert surface.GetProxyPrimRel().GetForwardedTargets() == [proxy.GetPath()]
    wanted = expected(1003, step=4)  # 32 samples in at most 10 quads
    close(np.array(proxy.GetPointsAttr().Get(1003)), wanted.points)
    close(np.array(proxy.GetNormalsAttr().Get(1003)), wanted.normals)
    close(value(stage, "/sea/geo/sea/proxy.primvars:st"), wanted.st)


@pytest.mark.parametrize("form", ANIMATED)
def test_variants_of_resolution(exported, form):
    stage = Usd.Stage.Open(str(exported(form=form, variants=(32, 16))))
    variants = stage.GetDefaultPrim().GetVariantSet("resolution")
    assert variants.GetVariantSelection() == "32"
    for resolution in (32, 16):
        variants.SetVariantSelection(str(resolution))
        wanted = expected(1003, samples=resolution)
        close(value(stage, f"{MESH}.points", 1003), wanted.points)
        close(value(stage, f"{MESH}.primvars:st"), wanted.st)


def test_half_keeps_what_is_seen(exported):
    stage = Usd.Stage.Open(str(exported(form="clips", half=True)))
    primvar = UsdGeom.PrimvarsAPI(stage.GetPrimAtPath(MESH)).GetPrimvar("foam")
    assert primvar.GetTypeName() == Sdf.ValueTypeNames.HalfArray
    error = np.abs(np.array(primvar.Get(1003), np.float64) - expected(1003).foam).max()
    assert 0.0 < error < 0.5 / 255.0
    close(value(stage, f"{MESH}.points", 1003), expected(1003).points)


@pytest.mark.parametrize("form", ANIMATED)
def test_samples_between_frames(exported, form):
    stage = Usd.Stage.Open(str(exported(form=form, frames="1001-1002x0.5")))
    assert stage.GetAttributeAtPath(f"{MESH}.points").GetTimeSamples() == [1001.0, 1001.5, 1002.0]
    close(value(stage, f"{MESH}.points", 1001.5), expected(1001.5).points)


def test_only_the_attributes_asked_for(exported):
    stage = Usd.Stage.Open(str(exported(form="clips", attributes=("foam",))))
    mesh = stage.GetPrimAtPath(MESH)
    assert mesh.GetAttribute("primvars:foam").HasAuthoredValue()
    for name in ("velocities", "normals", "primvars:cusp", "primvars:displayColor"):
        assert not mesh.GetAttribute(name).HasAuthoredValue()


@pytest.mark.parametrize("axis", ["Z", "Y"])
def test_displacement_reads_the_baked_images(exported, tmp_path, axis):
    moved = tmp_path / "elsewhere"
    shutil.copytree(exported(form="displacement", up_axis=axis, metres_per_unit=0.1).parent, moved)
    stage = Usd.Stage.Open(str(moved / "sea.usd"))
    flat = expected(1001).flat * 10.0
    close(value(stage, f"{MESH}.points", 1003), turned(flat) if axis == "Y" else flat)
    close(value(stage, f"{MESH}.primvars:st"), expected(1001).st)
    assert stage.GetAttributeAtPath(f"{MESH}.subdivisionScheme").Get() == "catmullClark"
    material = UsdShade.Material(stage.GetPrimAtPath("/sea/mtl/water"))
    for node in ("displacement", "mtlx_image"):
        file = stage.GetAttributeAtPath(f"/sea/mtl/water/{node}.inputs:file")
        assert file.GetColorSpace() == "raw"
        for frame in (1001, 1004):
            resolved = Path(file.Get(frame).resolvedPath)
            assert resolved.is_relative_to(moved)
            assert resolved.name == f"sea_disp.{frame}.exr"
    texture = UsdShade.Shader(stage.GetPrimAtPath("/sea/mtl/water/displacement"))
    inputs = {name: texture.GetInput(name).Get() for name in ("wrapS", "wrapT", "sourceColorSpace", "scale")}
    assert inputs == {
        "wrapS": "repeat", "wrapT": "repeat", "sourceColorSpace": "raw", "scale": (10.0, 10.0, 10.0, 10.0)
    }  # fmt: skip
    height = material.ComputeDisplacementSource()[0].GetInput("displacement")
    assert "height alone" in height.GetAttr().GetDocumentation()
    assert height.GetConnectedSources()[0][0].sourceName == "b"
    vector = material.ComputeDisplacementSource("mtlx")[0]
    assert vector.GetIdAttr().Get() == "ND_displacement_vector3"
    assert "(dPdu, dPdv, N)" in vector.GetInput("displacement").GetAttr().GetDocumentation()
    assert vector.GetInput("scale").Get() == pytest.approx(10.0)
