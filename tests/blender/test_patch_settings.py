# SPDX-License-Identifier: GPL-3.0-or-later
"""The patches of an ocean object: planned, edited by hand, kept through everything that happens to it."""

import json
import math

import bpy
import pytest


@pytest.fixture
def ocean(ocean_object, make_parameters, empty_scene):
    item = ocean_object.add(empty_scene, make_parameters())
    bpy.context.view_layer.objects.active = item
    item.ocean_tweak.use_foam = False
    return item


@pytest.fixture
def three(core, make_parameters):
    """A small sea of three patches, as an ocean object shows it."""
    return make_parameters(
        patches=(
            core.Patch(domain_size=150.0, shortest_wavelength=20.0, resolution=32),
            core.Patch(61.0, 0.97, 8.0, 20.0, 32),
            core.Patch(23.7, 0.37, 3.0, 8.0, 32),
        )
    ).on_one_grid(48)


@pytest.fixture
def patched(ocean, three, empty_scene):
    ocean.ocean_tweak.from_parameters(three, empty_scene)
    assert not ocean.ocean_tweak.error
    return ocean


@pytest.fixture
def own_presets(extension, tmp_path, monkeypatch):
    """The user's presets lie in an empty folder."""
    monkeypatch.setattr(extension("scene.user_presets"), "user_folder", lambda _name: tmp_path)


def sea(item):
    return item.ocean_tweak.to_parameters(bpy.context.scene)


def bands(item):
    """Shortest and longest wavelength of each patch, m."""
    return [(patch.shortest_wavelength, patch.longest_wavelength) for patch in sea(item).patches]


def wish(item, finest, area, memory=500):
    settings = item.ocean_tweak
    settings.plan_finest, settings.plan_area, settings.plan_memory = finest, area, memory


# --- the planner


@pytest.mark.parametrize("scale", [1.0, 0.01])
def test_a_plan_fills_the_wish(ocean, make_parameters, empty_scene, scale):
    empty_scene.unit_settings.scale_length = scale
    ocean.ocean_tweak.from_parameters(make_parameters(), empty_scene)
    wish(ocean, 0.5 / scale, 400.0 / scale, 60)
    assert bpy.ops.ocean.plan_patches() == {"FINISHED"}
    patches = sea(ocean).patches
    assert len(patches) > 1
    assert patches[0].domain_size >= 400.0
    assert patches[-1].shortest_wavelength == 0.5
    for patch in patches:
        assert patch.shortest_wavelength * patch.resolution / patch.domain_size >= 4.0
    for patch in patches[1:]:
        assert patch.domain_size / patch.longest_wavelength >= 6.0
    assert not ocean.ocean_tweak.error
    assert len(json.loads(ocean.ocean_tweak.statistics)["patches"]) == len(patches)


def test_a_plan_of_one_patch_is_an_ocean_too(ocean):
    wish(ocean, 4.0, 150.0)
    assert bpy.ops.ocean.plan_patches() == {"FINISHED"}
    (patch,) = sea(ocean).patches
    assert (patch.shortest_wavelength, patch.rotation) == (4.0, 0.0)
    assert ocean.ocean_tweak.domain_size == pytest.approx(patch.domain_size)


def test_a_wish_that_cannot_be_filled_changes_nothing(patched, three):
    for finest, area, memory, reason in (
        (0.1, 4000.0, 20, r"needs more memory; memory of [0-9]+ MB"),
        (0.01, 50e3, 100, "too much for 4 patches; a finest wave of"),
        (500.0, 100.0, 100, "plan.finest = 500.*below the area of 100 m"),
        (0.0, 100.0, 100, "plan.finest = 0.*from 0.001 to 10000 m"),
    ):
        wish(patched, finest, area, memory)
        with pytest.raises(RuntimeError, match=reason):
            bpy.ops.ocean.plan_patches()
        assert sea(patched) == three


def test_planning_tells_that_troughs_are_not_damped_any_more(ocean, capsys):
    ocean.ocean_tweak.trough_damping = 0.4
    wish(ocean, 2.0, 300.0)
    assert bpy.ops.ocean.plan_patches() == {"FINISHED"}
    assert sea(ocean).trough_damping == 0.0
    assert "Trough Damping is now 0" in capsys.readouterr().out
    assert bpy.ops.ocean.one_patch() == {"FINISHED"}
    ocean.ocean_tweak.trough_damping = 0.4
    with pytest.raises(RuntimeError, match="trough_damping"):
        bpy.ops.ocean.patch_add()


def test_operators_say_why_not(ocean, three, empty_scene, tmp_path):
    names = ("plan_patches", "patch_add", "patch_remove", "one_patch")
    for name in ("patch_remove", "one_patch"):
        with pytest.raises(RuntimeError, match="no list of patches"):
            getattr(bpy.ops.ocean, name)()
    ocean.ocean_tweak.from_parameters(three, empty_scene)
    path = str(tmp_path / "library.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile(use_empty=True)
    for name in names:
        with pytest.raises(RuntimeError, match="There is no ocean in this scene"):
            getattr(bpy.ops.ocean, name)()
    with bpy.data.libraries.load(path, link=True) as (_, into):
        into.objects = ["Ocean"]
    linked = into.objects[0]
    bpy.context.scene.collection.objects.link(linked)
    bpy.context.view_layer.objects.active = linked
    assert sea(linked).patches == three.patches
    for name in names:
        with pytest.raises(RuntimeError, match="linked from another file"):
            getattr(bpy.ops.ocean, name)()
    own = linked.override_create(remap_local_usages=True)
    bpy.context.view_layer.objects.active = own
    assert sea(own) == three
    for name in names:
        with pytest.raises(RuntimeError, match="library override keeps its patches"):
            getattr(bpy.ops.ocean, name)()


def test_an_override_keeps_its_patches(patched, three, core, tmp_path):
    path = str(tmp_path / "library.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile(use_empty=True)
    scene = bpy.context.scene
    with bpy.data.libraries.load(path, link=True) as (_, into):
        into.objects = ["Ocean"]
    scene.collection.objects.link(into.objects[0])
    own = into.objects[0].override_create(remap_local_usages=True)
    for patches, has in ((three.patches[:2], "2"), ((), "none")):
        other = three.replace(patches=patches, merged_resolution=0)
        with pytest.raises(ValueError, match=f"keeps its patches: it has 3, this sea has {has}"):
            own.ocean_tweak.from_parameters(other, scene)
        assert sea(own) == three
    other = three.replace(
        seed=9, patches=(core.Patch(170.0, 0.0, 18.0, 1e6, 32), core.Patch(61.0, 0.9, 8.0, 18.0, 32),
                         three.patches[2]),
    )  # fmt: skip
    own.ocean_tweak.from_parameters(other, scene)
    assert sea(own) == other


# --- the list


def test_add_edit_remove(ocean):
    settings = ocean.ocean_tweak
    before = sea(ocean)
    assert bpy.ops.ocean.patch_add() == {"FINISHED"}
    assert (len(settings.patches), settings.active_patch) == (2, 1)
    first, second = sea(ocean).patches
    assert (first.domain_size, first.resolution) == (150.0, 32)
    assert first.shortest_wavelength == second.longest_wavelength
    settings.patches[1].shortest_wavelength = second.longest_wavelength / 8.0
    assert bpy.ops.ocean.patch_add() == {"FINISHED"}
    last = sea(ocean).patches[-1]
    settings.active_patch = 1
    assert bpy.ops.ocean.patch_remove() == {"FINISHED"}
    assert settings.active_patch == 0
    assert sea(ocean).patches[0].shortest_wavelength == last.longest_wavelength
    assert sea(ocean).patches[1] == last
    assert bpy.ops.ocean.one_patch() == {"FINISHED"}
    assert sea(ocean) == before
    assert not settings.error


def test_four_at_most(patched):
    patched.ocean_tweak.patches[2].shortest_wavelength = 1.0
    assert bpy.ops.ocean.patch_add() == {"FINISHED"}
    with pytest.raises(RuntimeError, match="four patches at most"):
        bpy.ops.ocean.patch_add()


def test_one_patch_has_the_size_of_the_first_and_the_samples_of_the_mesh(patched, three):
    patched.ocean_tweak.patches[0].domain_size = 180.0
    assert bpy.ops.ocean.one_patch() == {"FINISHED"}
    assert sea(patched) == three.without_patches.replace(domain_size=180.0, resolution=48)


# --- numbers by hand


@pytest.mark.parametrize("scale", [1.0, 0.3048])
def test_where_bands_meet_both_ends_are_one(patched, three, empty_scene, scale):
    empty_scene.unit_settings.scale_length = scale
    settings = patched.ocean_tweak
    settings.from_parameters(three, empty_scene)
    first, second, third = settings.patches
    first.shortest_wavelength = 14.3 / scale
    assert second.longest_wavelength == first.shortest_wavelength
    third.longest_wavelength = 6.7 / scale
    assert second.shortest_wavelength == third.longest_wavelength
    assert not settings.error
    found = bands(patched)
    assert found[0][0] == found[1][1] == pytest.approx(14.3, rel=1e-6)
    assert found[1][0] == found[2][1] == pytest.approx(6.7, rel=1e-6)


def test_no_end_can_be_dragged_past_another(patched):
    settings = patched.ocean_tweak
    first, second, third = settings.patches
    drags = [
        (first, "shortest_wavelength", 0.0), (first, "shortest_wavelength", 1e7),
        (first, "longest_wavelength", 0.0), (second, "longest_wavelength", 0.0),
        (second, "longest_wavelength", 1e9), (second, "shortest_wavelength", 1e4),
        (second, "shortest_wavelength", 0.0), (third, "longest_wavelength", 300.0),
        (third, "shortest_wavelength", 300.0), (third, "shortest_wavelength", 0.0),
        (second, "shortest_wavelength", 0.0), (third, "longest_wavelength", 0.0),
    ]  # fmt: skip
    for patch, name, value in drags:
        setattr(patch, name, value)
        assert not settings.error, (name, value)
        ends = [end for band in bands(patched) for end in reversed(band)]
        assert ends == sorted(ends, reverse=True)
        assert ends[1] == ends[2]
        assert ends[3] == ends[4]


def test_the_first_patch_is_as_large_as_the_ocean(patched):
    settings = patched.ocean_tweak
    first = settings.patches[0]
    first.domain_size = 260.0
    assert settings.domain_size == 260.0
    settings.domain_size = 240.0
    assert first.domain_size == 240.0
    settings.patches[2].domain_size = 20.0
    assert settings.domain_size == 240.0
    assert [patch.domain_size for patch in sea(patched).patches] == [240.0, 61.0, 20.0]
    assert sea(patched).domain_size == 240.0
    assert not settings.error


def test_samples_of_the_mesh_are_not_those_of_a_patch(patched, core, ocean_object, empty_scene):
    """A sea that is not joined is shown on as many as its first patch has."""
    settings = patched.ocean_tweak
    settings.resolution = 64
    settings.patches[0].resolution = 40
    assert (sea(patched).merged_resolution, sea(patched).patches[0].resolution) == (64, 40)
    apart = sea(patched).replace(merged_resolution=0, patches=sea(patched).patches)
    settings.from_parameters(apart, empty_scene)
    assert settings.resolution == 40
    assert sea(patched) == apart.on_one_grid(40)
    assert bpy.ops.ocean.plan_patches.poll()
    wish(patched, 2.0, 300.0)
    assert bpy.ops.ocean.plan_patches() == {"FINISHED"}
    assert settings.resolution == settings.patches[0].resolution > 40


def test_what_is_wrong_is_told(patched):
    settings = patched.ocean_tweak
    settings.patches[1].resolution = 33
    assert "patches.1.resolution = 33" in settings.error
    settings.patches[1].resolution = 32
    settings.patches[0].rotation = 0.2
    assert not settings.error
    with pytest.raises(RuntimeError, match=r"patches.0.rotation = 0.2: must be 0 in a sea with hero_waves"):
        bpy.ops.ocean.layer_add(kind="HERO_WAVE")


def test_patches_are_not_animated(patched):
    patch = patched.ocean_tweak.patches[0]
    for name in ("domain_size", "resolution", "rotation", "shortest_wavelength", "longest_wavelength"):
        assert not patch.bl_rna.properties[name].is_animatable
    with pytest.raises(TypeError, match="not animatable"):
        patched.keyframe_insert("ocean_tweak.patches[0].domain_size")


def test_what_each_patch_is_adds_up(patched):
    values = json.loads(patched.ocean_tweak.statistics)
    patches = values["patches"]
    assert sum(patch["share"] for patch in patches) == pytest.approx(1.0)
    heights = [patch["resolved"]["significant_wave_height"] for patch in patches]
    assert values["resolved"]["significant_wave_height"] == pytest.approx(math.hypot(*heights), rel=1e-4)
    assert heights[0] > heights[1] > heights[2] > 0.0


# --- what happens to an ocean


def test_files_presets_and_copies_keep_patches(patched, three, own_presets, tmp_path):
    path = str(tmp_path / "sea.json")
    assert bpy.ops.ocean.export_parameters(filepath=path) == {"FINISHED"}
    assert bpy.ops.ocean.save_preset(title="Three") == {"FINISHED"}
    copy = patched.copy()
    bpy.context.scene.collection.objects.link(copy)
    name = copy.name
    assert sea(copy) == three
    copy.ocean_tweak.patches[0].shortest_wavelength = 15.0
    assert sea(patched) == three
    copy.ocean_tweak.patches[0].shortest_wavelength = 20.0
    for take in (
        lambda: bpy.ops.ocean.import_parameters(filepath=path),
        lambda: bpy.ops.ocean.apply_preset(key="user:three"),
    ):
        assert bpy.ops.ocean.one_patch() == {"FINISHED"}
        assert take() == {"FINISHED"}
        assert sea(patched) == three
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "sea.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "sea.blend"))
    assert sea(bpy.data.objects["Ocean"]) == three
    assert sea(bpy.data.objects[name]) == three


def test_a_preset_without_patches_takes_them_away(patched):
    assert bpy.ops.ocean.apply_preset(key="beaufort_05") == {"FINISHED"}
    assert not patched.ocean_tweak.patches
    assert not patched.ocean_tweak.error


def test_patches_change_no_animation_of_the_wind(patched, three, tmp_path):
    layer = patched.ocean_tweak.layers[0]
    for frame, wind in ((1, 8.0), (3, 10.0)):
        layer.wind_speed = wind
        layer.keyframe_insert("wind_speed", frame=frame)
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, 3
    path = tmp_path / "shot.json"
    assert bpy.ops.ocean.export_parameters(filepath=str(path)) == {"FINISHED"}
    assert bpy.ops.ocean.one_patch() == {"FINISHED"}
    assert bpy.ops.ocean.import_parameters(filepath=str(path)) == {"FINISHED"}
    assert sea(patched).patches == three.patches
    assert "layers.0.wind_speed" in json.loads(path.read_text())["animation"]["samples"]


def test_match_leaves_the_area_and_makes_room_for_long_waves(patched):
    assert bpy.ops.ocean.match_sea_state(by="WAVES", height=0.3, period=3.0) == {"FINISHED"}
    assert sea(patched).domain_size == 150.0  # 14 m waves want less
    assert bpy.ops.ocean.match_sea_state(by="WAVES", height=4.0, period=12.0) == {"FINISHED"}
    # g·12²/2π = 225 m
    assert sea(patched).domain_size == pytest.approx(4.5 * 225.0, rel=0.05)
    assert [patch.domain_size for patch in sea(patched).patches[1:]] == [61.0, 23.7]
    assert patched.ocean_tweak.domain_size == sea(patched).domain_size
