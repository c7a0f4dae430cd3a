# SPDX-License-Identifier: GPL-3.0-or-later
"""A coast in Blender: a mesh as sea bed, and the sea that ends on it."""

import bpy
import numpy as np
import pytest

from .other_blender import look, run_script

SIDE = 200.0


def slope(name="Bed", hole=False):
    """A plane from 12 m below the water to 1 m above it, along +x."""
    xs = (0.0, 80.0, 120.0, SIDE) if hole else (0.0, SIDE)
    places = [(x, y, -12.0 + 0.065 * x) for x in xs for y in (0.0, SIDE)]
    faces = [(2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1) for i in range(len(xs) - 1) if not (hole and i == 1)]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(places, [], faces)
    item = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(item)
    return item


@pytest.fixture
def calm(core):
    """A sea without a coast."""
    layer = core.WaveLayer(wind_speed=9.0, fetch=60e3)
    water = core.Water(depth=20.0)
    return core.OceanParameters(resolution=32, domain_size=SIDE, water=water, layers=(layer,))


@pytest.fixture
def ocean(empty_scene, ocean_object, calm):
    item = ocean_object.add(empty_scene, calm)
    bpy.context.view_layer.objects.active = item
    group = item.ocean_tweak.coast
    with item.ocean_tweak.quiet():
        group.rim, group.shortest_wavelength = 80.0, 40.0
    return item


@pytest.fixture
def coast_of(extension):
    return extension("scene.coast_surface").coast_of


def values(mesh, name, components=1):
    attribute = mesh.attributes[name]
    found = np.empty(len(attribute.data) * components, np.float32)
    attribute.data.foreach_get("value" if components == 1 else "vector", found)
    return found.reshape(-1, components) if components > 1 else found


@pytest.mark.parametrize("hole", [False, True])
def test_make_coast_reads_the_depths_of_a_mesh(ocean, hole):
    settings = ocean.ocean_tweak
    settings.coast.bed = slope(hole=hole)
    assert bpy.ops.ocean.make_coast() == {"FINISHED"}
    assert settings.error == ""
    coast = settings.to_parameters(bpy.context.scene).coast
    assert coast is not None
    assert coast.depth is not None
    depth = coast.depth.values[..., 0]
    expected = 12.0 - 0.065 * np.linspace(0.0, SIDE, depth.shape[1])
    np.testing.assert_allclose(depth, np.broadcast_to(expected, depth.shape), atol=2.0 if hole else 0.02)
    assert coast.spacing == pytest.approx(SIDE / (depth.shape[1] - 1))


def test_the_mesh_over_the_bed_is_the_sea_there(ocean, core, coast_of):
    settings, scene = ocean.ocean_tweak, bpy.context.scene
    settings.coast.bed = slope()
    bpy.ops.ocean.make_coast()
    scene.frame_set(30)
    item = coast_of(ocean)
    assert item is not None
    assert ocean.hide_render
    sea = core.Ocean(settings.to_parameters(scene))
    place, moved = values(item.data, "position", 3), values(item.data, "displacement", 3)
    rest = (place - moved)[:, :2].astype(np.float64)
    time = sea.parameters.timing.time(30)
    expected = sea.surface(time, on=core.Places(rest[:, 0], rest[:, 1])).displacement
    np.testing.assert_allclose(moved, expected, atol=2e-3)
    assert np.abs(moved[:, 2]).max() > 0.3
    assert np.abs(moved[rest[:, 0] > 190.0]).max() < 1e-4
    assert values(item.data, "foam").max() > 0.5
    assert values(item.data, "depth").min() > 0.0
    scene.frame_set(31)
    assert np.abs(values(item.data, "displacement", 3) - moved).max() > 0.01
    # finer near the shore
    x = np.unique(rest[:, 0].round(0))
    assert np.diff(x)[-1] < 0.5 * np.diff(x)[0]


def test_patterns_of_the_material_lie_on_the_water_at_rest(ocean, coast_of):
    ocean.ocean_tweak.coast.bed = slope()
    bpy.ops.ocean.make_coast()
    mesh = coast_of(ocean).data
    rest = (values(mesh, "position", 3) - values(mesh, "displacement", 3))[:, :2]
    corners = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    found = np.empty(2 * len(corners), np.float32)
    mesh.uv_layers["st"].uv.foreach_get("vector", found)
    np.testing.assert_allclose(np.ptp(found.reshape(-1, 2) - rest[corners] / SIDE, axis=0), 0.0, atol=1e-5)
    assert values(mesh, "cusp").max() > 0.0


def test_the_bed_is_wet_up_to_where_waves_run(ocean):
    bed = slope()
    bpy.context.view_layer.objects.active = bed
    modifier = bed.modifiers.new("Fine", "SUBSURF")
    modifier.subdivision_type, modifier.levels = "SIMPLE", 6
    bpy.ops.object.modifier_apply(modifier=modifier.name)
    bpy.context.view_layer.objects.active = ocean
    ocean.ocean_tweak.coast.bed = bed
    bpy.ops.ocean.make_coast()
    bpy.context.scene.frame_set(10)
    height, wet = values(bed.data, "position", 3)[:, 2], values(bed.data, "wet")
    assert (wet[height < -0.1] == 1.0).all()
    assert (wet[height > 0.95] == 0.0).all()
    shore = wet[(height > 0.1) & (height < 0.3)]
    assert shore.mean() > 0.3
    bpy.context.scene.frame_set(200)
    assert np.abs(values(bed.data, "wet") - wet).max() > 0.01


@pytest.mark.parametrize("drawn", [False, True])
def test_what_floats_rides_the_waves_over_the_bed(extension, ocean, core, drawn):
    settings, scene = ocean.ocean_tweak, bpy.context.scene
    settings.coast.bed = slope()
    bpy.ops.ocean.make_coast()
    item = bpy.data.objects.new("Buoy", None)
    item.location = (130.0, 70.0, 0.0)
    scene.collection.objects.link(item)
    floating = extension("scene.floating")
    floating.float_on(item, ocean, floating.Ride(tilt=0.0))
    if drawn:
        bpy.context.view_layer.objects.active = item
        item.select_set(True)
        scene.frame_start, scene.frame_end = 20, 22
        bpy.ops.object.ocean_tweak_float_bake()
    sea = core.Ocean(settings.to_parameters(scene))
    found, expected = [], []
    for frame in (20, 22):
        scene.frame_set(frame)
        found.append(item.evaluated_get(bpy.context.evaluated_depsgraph_get()).matrix_world.translation.z)
        # the mean of its least disc, 0.25 m
        expected.append(sea.height_at(130.0, 70.0, sea.parameters.timing.time(frame)))
    np.testing.assert_allclose(found, np.ravel(expected), atol=0.01)
    settings.coast.muted = True
    scene.frame_set(20)
    if not drawn:
        open_sea = core.Ocean(settings.to_parameters(scene)).height_at(
            130.0, 70.0, sea.parameters.timing.time(20)
        )
        height = item.evaluated_get(bpy.context.evaluated_depsgraph_get()).matrix_world.translation.z
        assert height == pytest.approx(float(open_sea), abs=0.01)
        assert abs(height - found[0]) > 0.02


def test_it_goes_when_it_is_switched_off(ocean, coast_of):
    settings = ocean.ocean_tweak
    settings.coast.bed = slope()
    bpy.ops.ocean.make_coast()
    settings.coast.use = False
    assert coast_of(ocean) is None
    assert not ocean.hide_render


def test_the_ocean_is_shown_as_before_when_it_goes(ocean, coast_of):
    coast, ocean.display_type = ocean.ocean_tweak.coast, "WIRE"
    coast.bed = slope()
    for was_hidden in (True, False):
        ocean.hide_render = was_hidden
        bpy.ops.ocean.make_coast()
        bpy.context.scene.frame_set(5)
        assert (ocean.hide_render, ocean.display_type) == (True, "BOUNDS")
        coast.use = False
        assert (ocean.hide_render, ocean.display_type) == (was_hidden, "WIRE")


@pytest.mark.parametrize("how", ["use", "muted", "bed"])
def test_a_bed_dries_when_it_is_one_no_more(ocean, coast_of, how):
    coast, bed, own = ocean.ocean_tweak.coast, slope(), slope("Own")
    own.data.attributes.new("wet", "FLOAT", "POINT")
    coast.bed = bed
    bpy.ops.ocean.make_coast()
    assert "wet" in bed.data.attributes
    if how == "bed":
        coast.bed = own
        bpy.ops.ocean.make_coast()
    else:
        setattr(coast, how, not getattr(coast, how))
    assert "wet" not in bed.data.attributes
    coast.use = False
    assert "wet" in own.data.attributes  # it was there before


def test_a_deleted_bed_is_not_read(ocean, coast_of, window):
    bed = ocean.ocean_tweak.coast.bed = slope()
    bpy.ops.ocean.make_coast()
    for item in bpy.context.scene.objects:
        item.select_set(item == bed)
    with window.override():
        bpy.ops.object.delete()
    assert ocean.ocean_tweak.coast.bed is not None
    with pytest.raises(RuntimeError, match="Bed was deleted: choose another mesh"):
        bpy.ops.ocean.make_coast()


def test_settings_keep_a_coast_that_a_file_has(ocean, core, calm):
    bed = np.repeat(np.linspace(12.0, -1.0, 51)[np.newaxis], 51, axis=0)
    coast = core.Coast(depth=core.Raster(bed, "bed"), spacing=4.0, rim=80.0, shortest_wavelength=40.0)
    ocean.ocean_tweak.from_parameters(calm.replace(coast=coast), bpy.context.scene)
    found = ocean.ocean_tweak.to_parameters(bpy.context.scene).coast
    assert found is not None
    assert found.depth is not None
    np.testing.assert_allclose(found.depth.values[..., 0], bed, atol=0.01)
    assert (found.spacing, found.rim, found.shore) == (4.0, 80.0, "+X")


def test_what_is_no_bed_is_refused_in_words(ocean):
    with pytest.raises(RuntimeError, match="Choose a mesh as Sea Bed"):
        bpy.ops.ocean.make_coast()
    ocean.ocean_tweak.coast.bed = slope()
    ocean.ocean_tweak.coast.shore = "-X"
    bpy.ops.ocean.make_coast()
    assert "choose another side" in ocean.ocean_tweak.error


@pytest.fixture
def coast(ocean, coast_of):
    """The mesh over a bed."""
    ocean.ocean_tweak.coast.bed = slope()
    bpy.ops.ocean.make_coast()
    return coast_of(ocean)


def test_it_goes_with_its_ocean(ocean, coast, window):
    for item in bpy.context.scene.objects:
        item.select_set(item == ocean)
    with window.override():
        bpy.ops.object.delete()
    bpy.context.view_layer.update()
    assert [item.name for item in bpy.context.scene.objects] == ["Bed"]


def test_a_converted_ocean_is_seen(ocean, coast, window):
    for item in bpy.context.scene.objects:
        item.select_set(item == ocean)
    with window.override():
        bpy.ops.object.convert(target="MESH")
    bpy.context.view_layer.update()
    assert sorted(item.name for item in bpy.context.scene.objects) == ["Bed", "Ocean"]
    assert not ocean.hide_render


def test_a_deeper_bed_of_the_same_size_shows_its_depth(ocean, coast):
    before = values(coast.data, "depth").copy()
    for vertex in ocean.ocean_tweak.coast.bed.data.vertices:
        vertex.co.z *= 2.0
    bpy.context.view_layer.update()
    bpy.ops.ocean.make_coast()
    at_twelve = np.abs(before - 12.0).argmin()
    assert values(coast.data, "depth")[at_twelve] == pytest.approx(24.0, abs=0.1)


def test_waves_too_short_for_the_bed_leave_it_at_rest(ocean, coast):
    ocean.ocean_tweak.coast.shortest_wavelength = 2.0 * SIDE
    assert ocean.ocean_tweak.error == ""
    assert np.isfinite(values(coast.data, "position", 3)).all()


def test_an_edited_coast_is_told(ocean, coast, window):
    bpy.context.view_layer.objects.active = coast
    with window.override():
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.context.scene.frame_set(6)
        assert "leave Edit Mode" in ocean.ocean_tweak.error
        bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.scene.frame_set(7)
    assert ocean.ocean_tweak.error == ""


def test_over_a_bake_the_coast_goes_on_live_and_says_so(ocean, coast, calm, bake, extension):
    scene = bpy.context.scene
    assert [need.text for need in extension("scene.portability").needs_of(ocean)] == [
        "Ocean is computed live: bake it"
    ]
    extension("scene.ocean_object").use_sequence(ocean, scene, bake(calm, 1, 6))
    scene.frame_set(2)
    before = values(coast.data, "displacement", 3).copy()
    scene.frame_set(5)
    assert np.abs(values(coast.data, "displacement", 3) - before).max() > 0.01
    assert [need.name for need in extension("scene.portability").needs_of(ocean)] == ["Ocean Coast"]


@pytest.mark.parametrize("overridden", [False, True])
def test_a_linked_coast_says_that_it_stands_and_an_override_moves(
    ocean, coast, tmp_path, overridden, coast_of
):
    scene = bpy.context.scene
    beach = bpy.data.collections.new("Beach")
    scene.collection.children.link(beach)
    for item in list(scene.collection.objects):
        beach.objects.link(item)
        scene.collection.objects.unlink(item)
    file = str(tmp_path / "beach.blend")
    bpy.ops.wm.save_as_mainfile(filepath=file)
    bpy.ops.wm.read_homefile(use_empty=True)
    with bpy.data.libraries.load(file, link=True) as (_, chosen):
        chosen.collections = ["Beach"]
    scene, beach = bpy.context.scene, bpy.data.collections["Beach"]
    scene.collection.children.link(beach)
    if overridden:
        beach = beach.override_hierarchy_create(scene, bpy.context.view_layer)
    shown = coast_of(next(item for item in beach.all_objects if item.ocean_tweak.is_ocean))
    found = []
    for frame in (2, 5):
        scene.frame_set(frame)
        found.append(values(shown.data, "displacement", 3).copy())
    if overridden:
        assert np.abs(found[1] - found[0]).max() > 0.01
    else:
        assert "make a library override" in shown.parent.ocean_tweak.error


@pytest.fixture
def elsewhere(tmp_path, monkeypatch):
    """Save the file and move it to another folder; gives its path there."""
    monkeypatch.delenv("OCEAN_TWEAK_CACHE", raising=False)
    project, moved = tmp_path / "project", tmp_path / "moved"
    project.mkdir()
    bpy.ops.wm.save_as_mainfile(filepath=str(project / "shot.blend"))

    def move():
        bpy.ops.wm.save_mainfile()
        project.rename(moved)
        return moved / "shot.blend"

    return move


@pytest.mark.parametrize("baked", [False, True])
def test_without_the_extension_it_stands_and_says_so(
    ocean, coast, calm, bake, extension, elsewhere, tmp_path, baked
):
    scene = bpy.context.scene
    if baked:
        extension("scene.ocean_object").use_sequence(ocean, scene, bake(calm, 1, 12))
    scene.frame_set(12)
    held = values(coast.data, "position", 3)
    seen, said = look(elsewhere(), [coast.name], [1, 12], tmp_path)
    assert "Ocean Tweak: live oceans stand still" in said
    for frame in (1, 12):
        np.testing.assert_allclose(seen[f"{coast.name} render {frame}"], held, atol=1e-6)
        told = seen[f"{coast.name} warnings {frame}"]
        assert any(text.startswith("The coast stands still as it was in frame 12 ") for text in told)
        assert any(text.endswith("enable the extension, or bake the ocean") for text in told)


def test_where_the_extension_runs_it_says_nothing_and_exports_move(ocean, coast, tmp_path):
    scene = bpy.context.scene
    scene.frame_set(2)
    moving = coast.evaluated_get(bpy.context.evaluated_depsgraph_get())
    assert not [text for modifier in coast.modifiers for text in modifier.node_warnings]
    assert "velocity" in moving.data.attributes
    if not bpy.app.build_options.alembic:
        pytest.skip("this Blender was built without Alembic")
    path, name = str(tmp_path / "coast.abc"), coast.name
    bpy.ops.wm.alembic_export(filepath=path, start=1, end=3, as_background_job=False)
    wanted = []
    for frame in (1, 3):
        scene.frame_set(frame)
        wanted.append(values(coast.data, "position", 3))
    assert np.abs(wanted[1] - wanted[0]).max() > 0.01
    bpy.data.objects.remove(coast)
    bpy.ops.wm.alembic_import(filepath=path, as_background_job=False)
    (item,) = (each for each in bpy.context.selected_objects if name.replace(" ", "_") in each.name)
    for frame, places in zip((1, 3), wanted, strict=True):
        scene.frame_set(frame)
        shown = item.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
        np.testing.assert_allclose(values(shown, "position", 3), places, atol=1e-4)


def test_a_coast_of_a_file_without_the_modifier_gets_it(ocean, coast):
    coast.modifiers.clear()
    bpy.context.scene.frame_set(4)
    assert [each.name for each in coast.modifiers] == ["Ocean Tweak Coast"]


def test_the_farm_s_render_of_a_coast_over_a_bake_ends_with_3(
    ocean, coast, calm, bake, extension, elsewhere, tmp_path
):
    extension("scene.ocean_object").use_sequence(ocean, bpy.context.scene, bake(calm, 1, 2))
    script = extension("export.farm.render_baked").__file__
    folder = tmp_path / "Ocean-12345678" / "v001-01234567"
    folder.mkdir(parents=True)
    (folder / "bake.json").write_text('{"shot": {"domain_size": 200.0, "timing": {}}}')
    arguments = ["--cache", str(tmp_path), "--bake", "Ocean-12345678/01234567", "--frames", "1"]
    said = run_script(script, "--pictures", str(tmp_path / "out"), *arguments, blend=elsewhere())
    assert said.returncode == 3, said.stdout + said.stderr
    assert f"moves {coast.name} of " in said.stderr


def test_the_mesh_has_height_breaking_and_direction_which_stay(ocean, coast, core):
    mesh, scene = coast.data, bpy.context.scene
    sea = core.Ocean(ocean.ocean_tweak.to_parameters(scene))
    names = {"significant_height": 1, "broken_share": 1, "mean_direction": 2}
    rest = (values(mesh, "position", 3) - values(mesh, "displacement", 3))[:, :2].astype(np.float64)
    expected = sea.surface(0.0, set(names), core.Places(rest[:, 0], rest[:, 1]))
    found = {name: values(mesh, name, count) for name, count in names.items()}
    for name in names:
        np.testing.assert_allclose(found[name], expected[name], atol=0.01)
    assert found["broken_share"].max() > 0.5
    scene.frame_set(9)
    np.testing.assert_array_equal(values(mesh, "significant_height"), found["significant_height"])
    ocean.ocean_tweak.layers[0].wind_speed = 12.0
    assert values(mesh, "significant_height").max() > 1.1 * found["significant_height"].max()
    scene.unit_settings.scale_length = 0.5
    bpy.context.view_layer.update()
    scene.frame_set(10)
    scaled = values(coast.data, "significant_height")
    assert scaled.max() == pytest.approx(
        2.0 * core.Ocean(ocean.ocean_tweak.to_parameters(scene)).coast.significant_height.max(), rel=0.05
    )


def test_overlays_show_height_and_direction_where_there_is_water(ocean, coast, extension, core):
    overlay, scene, group = extension("ui.coast_overlay"), bpy.context.scene, ocean.ocean_tweak.coast
    assert overlay.state_map(ocean, scene) is None
    group.show_height = group.show_direction = True
    shown = overlay.state_map(ocean, scene)
    sea = core.Ocean(ocean.ocean_tweak.to_parameters(scene))
    assert shown.highest == pytest.approx(sea.coast.significant_height.max(), rel=0.1)
    # the waterline of the slope is at x = 184.6
    assert shown.places[shown.triangles.ravel()][:, 0].max() < 185.0
    assert shown.places[shown.triangles.ravel()][:, 0].min() < -100.0
    a, b, c = (shown.places[shown.triangles[:, corner]][:, :2] for corner in range(3))
    (ux, uy), (vx, vy) = (b - a).T, (c - a).T
    assert np.abs(ux * vy - uy * vx).min() > 0.0
    highest = shown.places[np.argmax(shown.colours[:, 0])]
    assert highest[0] < 185.0
    shafts = shown.lines[: len(shown.lines) // 3]
    towards = shafts[:, 1] - shafts[:, 0]
    assert (towards[:, 0] > 0.0).all()  # waves run along +x
    length = np.hypot(towards[:, 0], towards[:, 1])
    np.testing.assert_allclose(length, length[0], rtol=0.02)
    assert shafts[..., 0].max() < 190.0
    group.use = False
    assert overlay.state_map(ocean, scene) is None


def test_colours_are_those_of_a_ramp(extension):
    ramp = extension("ui.coast_overlay").ramp
    light = ramp(np.linspace(0.0, 1.0, 9))[:, :3] @ (0.2126, 0.7152, 0.0722)
    assert (np.diff(light) > 0.0).all()
    assert light[-1] - light[0] > 0.6
