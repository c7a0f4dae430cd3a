# SPDX-License-Identifier: GPL-3.0-or-later
"""Parameters go into the panel and come out again, to the last bit."""

import dataclasses
import json
import math
import random
from fractions import Fraction

import pytest

from .conftest import SAMPLES

SCALES = (1.0, 0.01, 0.3048, 1000.0)


@pytest.fixture
def settings(ocean_object, make_parameters, empty_scene):
    return ocean_object.add(empty_scene, make_parameters()).ocean_tweak


def awkward(kind, chance, **given):
    """An instance with every plain field at a value that float32 cannot hold."""
    for field in dataclasses.fields(kind):
        meta = field.metadata
        if field.name in given or "kind" not in meta or field.default is None:
            continue
        if meta["kind"] is float:
            low, high = meta["minimum"], min(meta["maximum"], 1e4)
            given[field.name] = chance.uniform(max(low, -1e4), high)
        elif meta["kind"] is int:
            given[field.name] = chance.randint(max(meta["minimum"], 0), min(meta["maximum"], 2**31 - 1))
        elif meta["kind"] is str:
            given[field.name] = chance.choice(meta["choices"])
        elif meta["kind"] is bool:
            given[field.name] = not field.default
    return kind(**given)


def awkward_sea(core, seed):
    chance = random.Random(seed)
    fps = Fraction(chance.choice(["24", "24000/1001", "25", "12.5", "29.97"]))
    longest = 1e5 + chance.random()
    masks = [awkward_mask(core, chance) if index == seed % 4 else None for index in range(1 + seed % 3)]
    layers = [
        awkward(
            core.WaveLayer, chance, longest_wavelength=longest, mask=mask,
            measured=awkward_spectra(core, chance),
            equaliser=awkward(core.Equaliser, chance) if chance.random() < 0.5 else None,
        )
        for mask in masks
    ]  # fmt: skip
    timing = core.Timing(fps=fps, start_frame=9)
    given = {"resolution": SAMPLES, "merged_resolution": 0}
    if seed % 2:
        patches = awkward_patches(core, chance)
        given |= {"merged_resolution": SAMPLES, "patches": patches, "domain_size": patches[0].domain_size}
    if seed % 2 or any(masks):
        given["trough_damping"] = 0.0
    return awkward(
        core.OceanParameters, chance, layers=tuple(layers), timing=timing,
        water=awkward(core.Water, chance), foam=awkward(core.Foam, chance, resolution=20 + 2 * seed),
        loop_duration=Fraction(720) / fps, equaliser=awkward(core.Equaliser, chance),
        current=awkward(core.Current, chance, carried_x=0.0, carried_y=0.0), **given,
    )  # fmt: skip


def awkward_spectra(core, chance):
    numbers = [[chance.random() for _ in range(3)] for _ in range(2)]
    return core.MeasuredSpectra(
        frequencies=core.Raster([[[0.05, 0.01], [0.1, 0.02 + 0.01 * chance.random()], [0.3, 0.1]]]),
        energy=core.Raster(numbers), times=core.Raster([[0.0, 3600.0]]), absolute=False, tail=True,
    )  # fmt: skip


def awkward_mask(core, chance):
    near = chance.uniform(0.0, 50.0)
    if chance.random() < 0.5:
        return awkward(
            core.Mask, chance, source="DISTANCE", inner_radius=near, outer_radius=near + chance.random()
        )
    values = [[chance.random() for _ in range(3)] for _ in range(2)]
    return awkward(
        core.Mask,
        chance,
        source="IMAGE",
        image=core.Raster(values, f"Coast {near}"),
        inner_radius=near,
        outer_radius=99.1,
    )


def awkward_patches(core, chance):
    end = chance.uniform(5.0, 20.0)
    first = awkward(core.Patch, chance, shortest_wavelength=end, resolution=48)
    mask = awkward_mask(core, chance)
    second = awkward(core.Patch, chance, shortest_wavelength=end / 3, longest_wavelength=end, resolution=32)
    return first, dataclasses.replace(second, mask=mask)


@pytest.mark.parametrize("seed", range(12))
def test_same_json_same_parameters(settings, core, extension, empty_scene, seed):
    empty_scene.unit_settings.scale_length = SCALES[seed % len(SCALES)]
    sea = awkward_sea(core, seed)
    extension("scene.units").set_frame_rate(empty_scene, sea.timing.fps)
    settings.from_parameters(core.OceanParameters.from_json(sea.to_json()), empty_scene)
    assert settings.to_parameters(empty_scene).to_json() == sea.to_json()


def test_awkward_values_are_awkward(core):
    sea = awkward_sea(core, 0)
    assert math.frexp(sea.domain_size)[0] * 2**24 % 1 != 0


@pytest.mark.parametrize(
    ("metres_per_unit", "blender_units", "metres"),
    [(1.0, 1234.5, 1234.5), (0.01, 40000.0, 400.0), (0.01, 12345.6, 123.456), (0.3048, 100.0, 30.48)],
)
def test_a_typed_length_is_the_decimal_that_was_typed(
    settings, empty_scene, metres_per_unit, blender_units, metres
):
    empty_scene.unit_settings.scale_length = metres_per_unit
    settings.domain_size = blender_units
    settings.layers[0].fetch = blender_units
    parameters = settings.to_parameters(empty_scene)
    assert parameters.domain_size == metres
    assert parameters.layers[0].fetch == metres


def test_one_changed_property_changes_one_field(settings, core, extension, empty_scene):
    sea = awkward_sea(core, 1)
    extension("scene.units").set_frame_rate(empty_scene, sea.timing.fps)
    settings.from_parameters(sea, empty_scene)
    settings.layers[1].wind_speed = 7.7
    changed = json.loads(settings.to_parameters(empty_scene).to_json())
    before = json.loads(sea.to_json())
    assert changed["layers"][1].pop("wind_speed") == 7.7
    before["layers"][1].pop("wind_speed")
    assert changed == before


def test_wind_speed_has_blender_units(settings, empty_scene):
    empty_scene.unit_settings.scale_length = 0.5
    settings.layers[0].wind_speed = 24.0
    settings.layers[0].wind_direction = 1.5
    layer = settings.to_parameters(empty_scene).layers[0]
    assert layer.wind_speed == 12.0
    assert layer.wind_direction == 1.5


def test_layers_keep_their_exact_values_when_one_is_removed(settings, core, extension, empty_scene):
    sea = awkward_sea(core, 2)
    extension("scene.units").set_frame_rate(empty_scene, sea.timing.fps)
    settings.from_parameters(sea, empty_scene)
    settings.layers.remove(0)
    assert settings.to_parameters(empty_scene).layers == sea.layers[1:]


@pytest.mark.parametrize(
    ("fps", "base", "exact"),
    [(24, 1.0, "24"), (24, 1.001, "24000/1001"), (30, 1.001, "30000/1001"), (60, 1.001, "60000/1001"),
     (25, 2.0, "25/2")],
)  # fmt: skip
def test_frame_rate_is_an_exact_fraction(settings, empty_scene, extension, fps, base, exact):
    empty_scene.render.fps, empty_scene.render.fps_base = fps, base
    assert settings.to_parameters(empty_scene).timing.fps == Fraction(exact)
    empty_scene.render.fps, empty_scene.render.fps_base = 1, 1.0
    extension("scene.units").set_frame_rate(empty_scene, Fraction(exact))
    assert settings.to_parameters(empty_scene).timing.fps == Fraction(exact)
    if base == 1.001:  # as Blender's own presets write it
        assert empty_scene.render.fps == fps


@pytest.mark.parametrize("fps", ["0.02", "1000", "29.97", "23.976", "120000/1001", "1/3"])
def test_unusual_frame_rates_are_kept(settings, empty_scene, extension, fps):
    extension("scene.units").set_frame_rate(empty_scene, Fraction(fps))
    assert settings.to_parameters(empty_scene).timing.fps == Fraction(fps)


def test_ranges_and_units_of_the_core_reach_the_panel(settings, core):
    shown = settings.bl_rna.properties
    layer = settings.layers[0].bl_rna.properties
    by_name = {field.name: field for field in dataclasses.fields(core.WaveLayer)}
    swell = by_name["swell"]
    assert swell.metadata["description"] in layer["swell"].description
    assert (layer["swell"].hard_min, layer["swell"].hard_max) == (0.0, swell.metadata["maximum"])
    assert (shown["domain_size"].unit, layer["wind_speed"].unit) == ("LENGTH", "VELOCITY")
    assert layer["wind_direction"].subtype == "ANGLE"
    assert shown["resolution"].hard_max == 8192


@pytest.mark.parametrize(
    ("stretch", "old", "new"),
    [("2", 100, 200), ("1/3", 99, 33), ("900", 1, 900), ("7/900", 900, 7), ("1000", 1, 900), ("1", 100, 100)],
)
def test_time_stretching_is_exact_where_blender_can_hold_it(extension, empty_scene, stretch, old, new):
    extension("scene.units").set_time_stretch(empty_scene, Fraction(stretch))
    assert (empty_scene.render.frame_map_old, empty_scene.render.frame_map_new) == (old, new)
