# SPDX-License-Identifier: GPL-3.0-or-later
"""Random keyed shots: none of what can be keyed is refused, and each frame is the core's of its numbers."""

import os
import random
from fractions import Fraction

import bpy
import numpy as np
import pytest

from .test_animation import key

LONG = os.environ.get("OCEAN_TWEAK_LONG_TESTS") == "1"
SAMPLES = 16
LAST = 25  # frame

#: what can be keyed, with its range in the core's units (docs/parameters.md), and how far keys go beyond it
RANGES = {
    "wind_speed": (0.0, 100.0),
    "fetch": (0.0, 20e6),
    "swell": (0.0, 4.0),
    "amplitude_scale": (0.0, 100.0),
}
DIRECTIONS = (-7.0, 7.0)
CHOPPINESS = (0.0, 4.0)
TIMES = (-50.0, 50.0)  # s
LENGTHS = ("wind_speed", "fetch")


def animatable(group):
    return {prop.identifier for prop in group.bl_rna.properties if prop.is_animatable}


def test_what_can_be_keyed_is_what_is_tried_here(ocean):
    settings = ocean.ocean_tweak
    layer = settings.layers[0]
    known = {"rna_type", "name"}
    # keys of a measured layer are tried with those layers
    assert animatable(layer) - known == {*RANGES, "wind_direction", "measured_time"}
    assert animatable(settings) - known == {"choppiness", "ocean_time", "mask_motion"}
    others = (settings.water, settings.foam, settings.timing, layer.mask, layer.wind_field, layer.hero_wave,
              layer.image_waves, settings.usd)  # fmt: skip
    assert not set().union(*map(animatable, others)) - known
    with pytest.raises(TypeError, match="not animatable"):
        settings.water.keyframe_insert("depth")


def some_number(chance, low, high):
    """One of a range, often an end of it or near to it."""
    near = low + (high - low) * 10.0 ** chance.uniform(-8.0, 0.0)
    return chance.choice((low, high, near, chance.uniform(low, high), min(max(10.0, low), high)))


def some_layer(core, chance):
    wave_layer = core.WaveLayer
    fields = wave_layer.__dataclass_fields__
    return wave_layer(
        wind_speed=chance.uniform(0.0, 30.0), fetch=10.0 ** chance.uniform(0.0, 6.0),
        wind_direction=chance.uniform(*DIRECTIONS), swell=chance.uniform(0.0, 1.0),
        limit_fetch=chance.random() < 0.7, amplitude_scale=chance.uniform(0.0, 2.0),
        **{name: chance.choice(fields[name].metadata["choices"]) for name in ("spectrum", "spreading")},
        definition=chance.choice(("WIND", "WIND", "WIND", "SEA_STATE")),
    )  # fmt: skip


def some_keys(chance, layers, metres):
    """Two keys in core units for some of what can be keyed, by path; lengths of curves may overshoot."""
    wanted = [("choppiness", CHOPPINESS), ("ocean_time", TIMES)]
    for index in range(layers):
        wanted += [(f"layers[{index}].{name}", limits) for name, limits in RANGES.items()]
        wanted.append((f"layers[{index}].wind_direction", DIRECTIONS))
    keys = {}
    for path, (low, high) in chance.sample(wanted, chance.randint(1, min(5, len(wanted)))):
        above = 1.5 * high if path.endswith(LENGTHS) and chance.random() < 0.25 else high
        unit = metres if path.endswith(LENGTHS) else 1.0
        first, last = (np.float32(some_number(chance, low, above) / unit) for _ in range(2))
        keys[path] = (float(first), float(last), unit, low, high)
    return keys


def at(frame, keys):
    """Each value in the middle of the line between its keys, held outside, and within its range."""
    share = min(max((frame - 1) / (LAST - 1), 0.0), 1.0)
    return {
        path: min(max((first + share * (last - first)) * unit, low), high)
        for path, (first, last, unit, low, high) in keys.items()
    }


def expected_positions(core, parameters, values, frame, metres):
    """(N, N, 3) Blender units, straight from the core."""
    data = parameters.to_dict()
    for path, value in values.items():
        if path.startswith("layers["):
            data["layers"][int(path[7])][path.partition(".")[2]] = value
        elif path == "choppiness":
            data[path] = value
    time = Fraction(frame - 1) / parameters.timing.fps
    if "ocean_time" in values:
        time = Fraction(float(np.float32(values["ocean_time"])))
    moved = core.Ocean(core.OceanParameters.from_dict(data)).surface(time).displacement.astype(np.float64)
    side = np.arange(SAMPLES) * parameters.domain_size / SAMPLES
    rest = np.stack([*np.meshgrid(side, side), np.zeros((SAMPLES, SAMPLES))], axis=-1)
    return (rest + moved) / metres


@pytest.mark.parametrize("part", range(15 if LONG else 1))
def test_each_frame_is_the_cores(ocean_object, core, empty_scene, part):
    for number in range(20 * part, 20 * (part + 1)):
        chance = random.Random(number)
        metres = chance.choice((1.0, 1.0, 0.01, 1000.0))
        empty_scene.unit_settings.scale_length = metres
        layers = tuple(some_layer(core, chance) for _ in range(chance.randint(1, 3)))
        parameters = core.OceanParameters(
            resolution=SAMPLES, domain_size=chance.choice((10.0, 200.0, 5000.0)), seed=number, layers=layers
        )
        item = ocean_object.add(empty_scene, parameters)
        settings = item.ocean_tweak
        settings.use_foam = settings.use_normals = settings.use_velocity = False
        keys = some_keys(chance, len(layers), metres)
        settings.use_ocean_time = "ocean_time" in keys
        with settings.quiet():
            for path, (first, last, *_) in keys.items():
                key(item, path, {1: first, LAST: last})
        for frame in (1, chance.randint(2, LAST - 1), LAST + chance.randint(0, 6)):
            empty_scene.frame_set(frame)
            assert not settings.error, (number, frame)
            wanted = expected_positions(core, parameters, at(frame, keys), frame, metres)
            mesh = item.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
            shown = np.empty(3 * len(mesh.vertices), np.float32)
            mesh.vertices.foreach_get("co", shown)
            shown = shown.reshape(SAMPLES + 1, SAMPLES + 1, 3)[:-1, :-1]
            # Blender's curves and places are float32, and a time of 50 s is good to 4 µs
            atol = 1e-4 * np.ptp(wanted[..., 2]) + 3e-7 * parameters.domain_size / metres
            np.testing.assert_allclose(shown, wanted, rtol=0.0, atol=atol, err_msg=f"{number} {frame}")
        bpy.data.meshes.remove(item.data)
