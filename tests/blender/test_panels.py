# SPDX-License-Identifier: GPL-3.0-or-later
"""What stands in the sidebar, read from a layout that records it."""

from types import SimpleNamespace

import bpy
import pytest


class Layout:
    """Takes what a panel draws, and remembers it."""

    def __init__(self, drawn):
        self.drawn = drawn

    def part(self, *_positional, **_named):
        return Layout(self.drawn)

    row = column = box = split = part

    def label(self, text, icon="NONE"):
        self.drawn.append(text)

    def prop(self, owner, name, **_named):
        assert name in owner.bl_rna.properties
        self.drawn.append(name)

    def operator(self, name, **_named):
        module, _, function = name.partition(".")
        assert hasattr(bpy.types, f"{module.upper()}_OT_{function}")
        self.drawn.append(name)


@pytest.fixture
def draw(extension, empty_scene):
    """Draw all panels that show themselves; returns what was drawn."""

    def draw_all(item):
        drawn = []
        context = SimpleNamespace(
            active_object=item, scene=empty_scene, region=SimpleNamespace(width=300),
            preferences=SimpleNamespace(system=SimpleNamespace(ui_scale=1.0)),
        )  # fmt: skip
        for panel in extension("ui.panels").CLASSES:
            if panel.poll(context):
                panel.draw(SimpleNamespace(layout=Layout(drawn)), context)
        return drawn

    return draw_all


@pytest.fixture
def item(ocean_object, make_parameters, empty_scene):
    return ocean_object.add(empty_scene, make_parameters())


def test_without_an_ocean_there_is_a_way_to_one(draw):
    assert draw(None) == ["No ocean is active", "mesh.ocean_tweak_add"]


def test_the_sea_and_what_it_means(draw, item, core, make_parameters):
    drawn = draw(item)
    for name in ("wind_speed", "wind_direction", "fetch", "swell", "choppiness", "depth", "seed",
                 "domain_size", "viewport_resolution", "source", "method", "use_foam", "coverage",
                 "half_life", "drift", "use_normals", "use_velocity", "repeats_x", "repeats_y"):  # fmt: skip
        assert drawn.count(name) == 1
    assert drawn.count("resolution") == 2  # of the sea and of its foam
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
    item.ocean_tweak.water.depth = 0.0
    drawn = draw(item)
    assert "water.depth = 0.0: must be from 0.1 to 11000 m" in " ".join(drawn)
    assert max(map(len, drawn)) < 45


def test_frames_without_a_file_are_told(draw, item, bake, ocean_object, make_parameters, empty_scene):
    ocean_object.use_sequence(item, empty_scene, bake(make_parameters(), 11, 12))
    empty_scene.frame_set(11)
    assert "has no file" not in " ".join(draw(item))
    empty_scene.frame_set(5)
    assert "Frame 5 has no file: the nearest one is held" in " ".join(draw(item))
    item.ocean_tweak.method = "DISPLACE"
    assert "the nearest one is held" in " ".join(draw(item))
    ocean_object.use_sequence(item, empty_scene, bake(make_parameters(), 7, 7, name="still"))
    assert "Frame 5 has no file: the sea is flat" in " ".join(draw(item))


def test_drawing_computes_nothing(draw, item, core, monkeypatch):
    monkeypatch.setattr(core, "Ocean", None)
    for name in ("surface", "statistics"):
        monkeypatch.setattr(f"{core.__name__}.ocean.Ocean.{name}", None)
    assert draw(item)
