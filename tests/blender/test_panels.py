# SPDX-License-Identifier: GPL-3.0-or-later
"""What stands in the sidebar, read from a layout that records it."""

import dataclasses
from types import SimpleNamespace

import bpy
import pytest

from tests.blender.conftest import stored
from tests.export.spectrum_files import BUOY_FILES

from . import layouts
from .layouts import Layout

# fixtures for the tests here
draw, item = layouts.draw, layouts.item


def test_the_layout_draws_what_blenders_can():
    methods = {name for name, part in vars(Layout).items() if callable(part) and not name.startswith("_")}
    assert methods - {"part"} <= set(bpy.types.UILayout.bl_rna.functions.keys())


def test_without_an_ocean_there_is_a_way_to_one(draw):
    # calm, fresh breeze, storm, horizon, beach, harbour, islet
    scenes = ["With sky and camera:", *["ocean.add_scene"] * 7]
    floating = [f"object.ocean_tweak_{name}" for name in ("float", "wake", "float_bake", "float_remove")]
    offered = ["No ocean in this scene", "mesh.ocean_tweak_add", "ocean.add_scene", *scenes, *floating]
    assert draw(None) == offered


@pytest.mark.parametrize("index", [-5, 900])
def test_an_index_beyond_a_list_draws_its_nearest_entry(draw, item, index):
    bpy.context.view_layer.objects.active = item
    bpy.ops.ocean.layer_add(kind="HERO_WAVE")
    bpy.ops.ocean.patch_add()
    settings = item.ocean_tweak
    settings.active_layer = 0 if index < 0 else 1
    settings.active_patch = 0 if index < 0 else len(settings.patches) - 1
    expected = draw(item)
    for name in ("active_layer", "active_patch"):
        stored(item)[name] = index
    assert draw(item) == expected


def test_blenders_own_ocean_can_be_converted(draw, empty_scene):
    item = bpy.data.objects.new("Old", bpy.data.meshes.new("Old"))
    item.modifiers.new("Ocean", "OCEAN")
    assert "ocean.convert" in draw(item)


def test_the_sea_shows_the_size_of_the_first_patch(draw, item, core, empty_scene):
    """What is edited is the number that counts."""
    settings = item.ocean_tweak
    assert "OCEAN_UL_patches" not in draw(item)
    assert {"plan_finest", "plan_area", "plan_memory", "ocean.plan_patches", "ocean.patch_add"} <= {
        *draw(item)
    }
    patches = (core.Patch(100.0, 0.0, 20.0, 1e6, 32), core.Patch(40.0, 0.9, 4.0, 20.0, 32))
    settings.from_parameters(settings.to_parameters(empty_scene).replace(patches=patches), empty_scene)
    settings.active_patch = 1
    owners = []
    drawn = draw(item, lambda owner, name: owners.append((name, owner)))
    assert {"OCEAN_UL_patches", "ocean.patch_remove", "ocean.one_patch", "And one more patch"} <= {*drawn}
    first, second = settings.patches
    assert [owner for name, owner in owners if name == "domain_size"] == [first, second]
    samples = [owner for name, owner in owners if name == "resolution" and owner != settings.foam]
    assert samples == [settings, second]
    assert {"rotation", "shortest_wavelength", "longest_wavelength"} <= {
        name for name, owner in owners if owner == second
    }
    # 4 m · 32 / 40 m, and 40 m / 20 m
    assert drawn[drawn.index("Shortest Has") + 1] == "3.2 samples"
    assert drawn[drawn.index("Longest Fits") + 1] == "2 times"
    energy = drawn[drawn.index("Energy") + 1]
    statistics = core.Ocean(settings.to_parameters(empty_scene).separate).statistics()
    assert energy == f"{100.0 * statistics.patches[1].share:.3g} %"
    # in the sea's box and in the patch's
    assert " ".join(drawn).count("Patch 2: its longest wave, 20 m") == 2


def test_patches_in_one_line_each(extension, item, core, empty_scene):
    settings = item.ocean_tweak
    patches = (core.Patch(2000.0, 0.0, 20.0, 1e6, 32), core.Patch(40.0, 0.9, 0.0, 20.0, 32))
    settings.from_parameters(settings.to_parameters(empty_scene).replace(patches=patches), empty_scene)
    lines = []
    for index, patch in enumerate(settings.patches):
        drawn = []
        context = SimpleNamespace(scene=empty_scene)
        extension("ui.panels.patches").OCEAN_UL_patches.draw_item(
            None, context, Layout(drawn), settings, patch, 0, settings, "active_patch", index
        )
        lines.append(drawn)
    assert [line[:2] for line in lines] == [["2 km", "> 20 m"], ["40 m", "< 20 m"]]
    assert sum(float(line[2].removesuffix(" %")) for line in lines) == pytest.approx(100.0, abs=0.2)


def test_layers_in_one_line_each_have_the_scenes_units(extension, item, empty_scene):
    settings = item.ocean_tweak
    settings.layers[0].definition = "SEA_STATE"
    settings.layers[0].significant_wave_height, settings.layers[0].peak_period = 2.5, 8.0
    bpy.context.view_layer.objects.active = item
    for kind in ("WIND_FIELD", "HERO_WAVE"):
        bpy.ops.ocean.layer_add(kind=kind)
    settings.layers[1].wind_field.wind_speed, settings.layers[2].hero_wave.crest_height = 9.0, 3.0

    def lines():
        drawn = []
        context = SimpleNamespace(scene=empty_scene)
        for layer in settings.layers:
            extension("ui.panels.layers").OCEAN_UL_layers.draw_item(
                None, context, Layout(drawn), settings, layer, 0, settings, "active_layer"
            )
        return [text for text in drawn if text != "muted"]

    assert lines() == ["2.5 m, 8 s", "Wind field, 9 m/s", "Hero wave, 3 m, 0 s"]
    empty_scene.unit_settings.scale_length = 0.01
    settings.layers[0].significant_wave_height, settings.layers[1].wind_field.wind_speed = 250.0, 900.0
    settings.layers[2].hero_wave.crest_height = 300.0
    assert lines() == ["2.5 m, 8 s", "Wind field, 9 m/s", "Hero wave, 3 m, 0 s"]


def test_a_mask_says_what_it_lacks(draw, item):
    mask = item.ocean_tweak.layers[0].mask

    def waits():
        return " ".join(draw(item)).partition("The sea waits for ")[2]

    mask.source = "IMAGE"
    assert waits().startswith("an image: choose one")
    mask.source = "VERTEX_GROUP"
    assert waits().startswith("weights: choose a mesh")
    mesh = bpy.data.objects.new("Beach", bpy.data.meshes.new("Beach"))
    mask.mesh = mesh
    assert waits().startswith("weights: choose the mesh's vertex group")
    mask.vertex_group = mesh.vertex_groups.new(name="Deep").name
    assert waits().startswith("weights: press Read Weights")
    mask.image = bpy.data.images.new("Read", 4, 4)
    assert waits() == ""
    mask.source = "DISTANCE"
    assert waits() == ""
    mesh.keyframe_insert("location", frame=1)
    mask.object = mesh
    bpy.context.view_layer.update()
    assert "Beach moves by itself" not in " ".join(draw(item))  # for it is followed
    item.driver_remove("ocean_tweak.mask_motion")
    assert "Beach moves by itself, which masks of a linked ocean do not follow" in " ".join(draw(item))


def test_a_number_and_its_unit_stay_in_one_line(extension):
    """Wherever the line breaks; the text itself stays as it is."""
    text = "The domain of 400 m holds 2.9 of the waves (138 m) and 73 % of the energy: 12 m/s, 4 samples"
    preferences = SimpleNamespace(system=SimpleNamespace(ui_scale=1.0))
    for width in range(150, 500, 7):
        drawn = []
        context = SimpleNamespace(region=SimpleNamespace(width=width), preferences=preferences)
        extension("ui.panels.drawing").message(Layout(drawn), context, text)
        assert " ".join(drawn) == text
        assert not any(line.startswith(("m ", "m)", "% ", "m/s")) for line in drawn)


def test_every_parameter_can_be_reached(draw, item, core):
    """What an expert may want to set stands somewhere, whatever the layer's models are."""
    drawn = set()
    layer = item.ocean_tweak.layers[0]
    models = (("WIND", "TMA", "COSINE_2S"), ("SEA_STATE", "GENERALIZED_AB", "FLAT"))
    for definition, spectrum, spreading in models:
        layer.definition, layer.spectrum, layer.spreading = definition, spectrum, spreading
        layer.spreading_mix = 0.3
        drawn.update(draw(item))
    settings = item.ocean_tweak
    bpy.context.view_layer.objects.active = item
    bpy.ops.ocean.import_measured(filepath=str(BUOY_FILES[0]), target="LAYER")
    drawn.update(draw(item))
    bpy.ops.ocean.layer_add(kind="WIND_FIELD")
    wind = settings.layers[settings.active_layer].wind_field
    for source, height in (("UNIFORM", "STEEPNESS"), ("IMAGE", "WIND_SPEED"), ("RECORDING", "STEEPNESS")):
        wind.source, wind.height = source, height
        drawn.update(draw(item))
    wind.source = "UNIFORM"
    bpy.ops.ocean.layer_add(kind="IMAGE")
    image = settings.layers[settings.active_layer].image_waves
    for kind in ("MODIFIED_PIERSON_MOSKOWITZ", "FRACTAL", "WATER_TEXTURE"):
        for animation in ("DISPERSION", "DOMINANT_BAND", "TRANSLATION"):
            image.filter, image.animation = kind, animation
            drawn.update(draw(item))
    bpy.ops.ocean.layer_add(kind="HERO_WAVE")
    drawn.update(draw(item))
    bpy.ops.ocean.patch_add()
    drawn.update(draw(item))
    with settings.quiet():
        settings.coast.use = True
    drawn.update(draw(item))
    fields = [
        core.OceanParameters, core.WaveLayer, core.Water, core.Foam, core.Timing, core.WindFieldLayer,
        core.ImageLayer, core.HeroWave, core.Patch, core.Current, core.Equaliser, core.Coast,
    ]  # fmt: skip
    names = {field.name for kind in fields for field in dataclasses.fields(kind)}
    elsewhere = {
        "layers",
        "water",
        "foam",
        "timing",
        "id",
        "muted",
        "loop_duration",
        "merged_resolution",
        "mask",
        "coast",
    }
    elsewhere |= {"fps", "stretch"}  # the scene's
    elsewhere |= {"measured", "carried_x", "carried_y"}  # a file's, and what follows from the current's keys
    in_lists = {"patches", "keys", "image"}  # as layers, recordings and images
    # behind a switch, or in a unit that Blender does not have
    drawn |= {name.removeprefix("use_") for name in drawn}
    drawn |= {"fetch"} if "fetch_km" in drawn else set()
    drawn |= {"drift"} if "drift_percent" in drawn else set()
    assert names - elsewhere - in_lists - drawn == set()
    assert {"image", "image_values", "image_speed", "objects", "ocean.record_wind"} <= drawn


def test_the_look_is_the_materials(draw, item):
    assert "ocean_tweak_water_colour" not in draw(item)
    bpy.context.view_layer.objects.active = item
    bpy.ops.ocean.use_water_material()
    owners = []
    drawn = draw(item, lambda owner, _name: owners.append(owner))
    assert "ocean_tweak_water_colour" in drawn
    names = {owner.name for owner in owners if isinstance(owner, bpy.types.NodeSocket)}
    assert {"Foam Amount", "Foam Size", "Slopes", "Gusts", "Crest Light"} <= names


def test_a_number_that_stands_for_none_is_a_switch(draw, item, empty_scene, make_parameters):
    empty_scene.unit_settings.scale_length = 0.01  # a kilometre is 100,000 units
    settings, layer = item.ocean_tweak, item.ocean_tweak.layers[0]
    settings.from_parameters(make_parameters(), empty_scene)
    drawn = draw(item)
    numbers = {"shortest_wavelength", "longest_wavelength", "short_wave_cutoff", "mesh_resolution"}
    assert not numbers & set(drawn)
    assert {"Auto", "All Waves", "None", "As the Sea"} <= set(drawn)
    before = settings.to_parameters(empty_scene)
    layer.use_longest_wavelength = layer.use_seed = settings.use_mesh_resolution = True
    assert (layer.seed, settings.mesh_resolution) == (0, 256)
    assert settings.to_parameters(empty_scene).layers[0].longest_wavelength == 100.0
    assert {"longest_wavelength", "mesh_resolution"} <= set(draw(item))
    layer.seed, layer.longest_wavelength = 7, 2500.0
    assert settings.to_parameters(empty_scene).layers[0].longest_wavelength == 25.0
    for _ in range(2):  # a second time changes nothing
        layer.use_longest_wavelength = layer.use_seed = settings.use_mesh_resolution = False
    assert settings.to_parameters(empty_scene) == before
    assert settings.mesh_resolution == 0
    layer.use_longest_wavelength = layer.use_seed = True
    assert (layer.seed, layer.longest_wavelength) == (7, 2500.0)


def test_tooltips_hold_no_range_that_says_nothing(item):
    """Angles turn as often as they are told to, and a place may be anywhere."""
    settings = item.ocean_tweak
    groups = [settings, settings.water, settings.foam, settings.timing, settings.layers[0]]
    groups += [getattr(settings.layers[0], name) for name in ("wind_field", "image_waves", "hero_wave")]
    texts = [prop.description for group in groups for prop in group.bl_rna.properties]
    assert [text for text in texts if "e+" in text or " rad)" in text or "1000000" in text] == []
    assert any(text.endswith("(0 to 100 m/s)") for text in texts)


def test_messages_name_what_the_window_names(extension):
    wording = extension("ui.wording")
    said = "layers.1.shortest_wavelength = 20.0: must be below longest_wavelength = 10 m"
    expected = "Layer 2, Shortest Wave = 20.0: must be below Longest Wave = 10 m"
    assert wording.readable(said) == expected
    assert wording.place("water.depth") == "Water, Depth"


def test_a_life_is_in_waves_or_in_seconds(ocean):
    """Of a wave in a wind field, and of spray."""
    settings = ocean.ocean_tweak
    named = [
        group.bl_rna.properties["life"].name for group in (settings.layers[0].wind_field, settings.spray)
    ]
    assert named == ["Life (waves)", "Life"]


def test_a_hero_wave_says_when_and_how_fast(draw, item, empty_scene):
    """In deep water crests run with √(g·λ/2π), the group half as fast."""
    item.ocean_tweak.dispersion = "DEEP"
    bpy.context.view_layer.objects.active = item
    for frame in (25, 37):
        empty_scene.frame_set(frame)
        bpy.ops.ocean.layer_add(kind="HERO_WAVE")
    wave = item.ocean_tweak.layers[2].hero_wave
    wave.wavelength, wave.crest_height = 25.0, 2.0
    drawn = draw(item)
    assert {"Frame 37", "6.25 m/s", "3.12 m/s"} <= set(drawn)
    assert "Hero wave 1: waves 25 m long break" in " ".join(drawn)
    wave.muted = True
    assert "Frame 37" not in draw(item)


def test_the_beaufort_number_is_that_of_the_wind(draw, item):
    item.ocean_tweak.layers[0].wind_speed = 15.0
    assert "7, Near gale" in draw(item)


@pytest.mark.parametrize(("phase", "count"), [("", "3 / 12, 1:02"), ("spray", "Spray 3 / 12, 1:02")])
def test_a_bake_under_way_shows_how_far_it_is(draw, item, extension, phase, count):
    process = extension("scene.bake_process")
    bake = SimpleNamespace(phase=phase, done=3, left=12, factor=0.25, seconds_left=62.0, is_stopped=False)
    process._running[item.session_uid] = bake
    try:
        drawn = draw(item)
    finally:
        del process._running[item.session_uid]
    assert count in drawn
    assert "ocean.stop_bake" in drawn
    assert "ocean.bake" not in drawn


def test_the_sea_and_what_it_means(draw, item, core, make_parameters):
    drawn = draw(item)
    once = {
        "time_scale", "choppiness", "domain_size", "viewport_resolution", "method", "use_foam",
        "coverage", "half_life", "drift_percent", "use_normals", "use_velocity", "repeats_x", "repeats_y",
        "dispersion", "gravity", "trough_damping", "orbital_motion", "start_frame", "use_loop", "loop_frames",
        "ocean_time", "spectrum", "peak_enhancement", "depth_factor", "definition", "amplitude_scale",
        "spreading", "use_shortest_wavelength", "OCEAN_UL_layers", "cache_folder", "ocean.bake",
        "ocean.match_sea_state", "OCEAN_MT_presets",
    }  # fmt: skip
    assert {name for name in once if drawn.count(name) != 1} == set()
    # in the first panel and in the active layer's, the water's or the foam's own
    assert drawn.count("source") == 3  # its own, of the layer's mask and of the sea's
    twice = {"wind_speed", "wind_direction", "fetch_km", "swell", "depth"}
    assert {name for name in twice if drawn.count(name) != 2} == set()
    statistics = core.Ocean(make_parameters()).statistics()
    assert f"{statistics.significant_wave_height:.2f} m" in drawn
    assert f"{statistics.seed.significant_wave_height:.2f} m" in drawn
    assert f"{statistics.peak_period:.1f} s" in drawn
    assert f"{statistics.wavelengths_per_domain:.1f} wavelengths" in drawn


def test_errors_and_warnings_can_be_read_in_a_narrow_sidebar(draw, item, make_parameters):
    item.ocean_tweak.from_parameters(make_parameters(domain_size=30.0), bpy.context.scene)
    item.scale = (2.0, 2.0, 2.0)
    bpy.context.view_layer.update()
    drawn = draw(item)
    text = " ".join(drawn)
    assert "holds only" in text
    assert "The object is scaled" in text
    item.ocean_tweak.resolution = 33
    drawn = draw(item)
    assert "resolution = 33: must be an even number from 16 to 8192" in " ".join(drawn)
    assert max(map(len, drawn)) < 45


def test_a_length_that_a_curve_took_beyond_its_range_is_told(draw, item, empty_scene):
    wind = item.ocean_tweak.layers[0]
    for frame, speed in ((1, 90.0), (11, 110.0)):
        with item.ocean_tweak.quiet():
            wind.wind_speed = speed
        wind.keyframe_insert("wind_speed", frame=frame)
    empty_scene.frame_set(1)
    assert "counts as" not in " ".join(draw(item))
    empty_scene.frame_set(11)
    assert "Layer 1, Wind Speed is out of range and counts as 100 m/s" in " ".join(draw(item))


def test_frames_without_a_file_are_told(draw, item, bake, ocean_object, make_parameters, empty_scene):
    ocean_object.use_sequence(item, empty_scene, bake(make_parameters(), 11, 12))
    empty_scene.frame_set(11)
    assert "has no file" not in " ".join(draw(item))
    empty_scene.frame_set(5)
    assert "Frame 5 has no file: frame 11 is held" in " ".join(draw(item))
    item.ocean_tweak.method = "DISPLACE"
    assert "frame 11 is held" in " ".join(draw(item))
    ocean_object.use_sequence(item, empty_scene, bake(make_parameters(), 7, 7, name="still"))
    assert "Frame 5 has no file: frame 7 is held" in " ".join(draw(item))


def test_drawing_computes_nothing(draw, item, core, monkeypatch):
    monkeypatch.setattr(core, "Ocean", None)
    for name in ("surface", "statistics"):
        monkeypatch.setattr(f"{core.__name__}.sea.ocean.Ocean.{name}", None)
    assert draw(item)
