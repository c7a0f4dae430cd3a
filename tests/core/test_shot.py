# SPDX-License-Identifier: GPL-3.0-or-later
"""A shot: parameters and time of each frame."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from ocean_tweak.core import Mask, Ocean, OceanParameters, ParameterError, Patch, Raster, Timing, WaveLayer
from ocean_tweak.core.parameters.fingerprint import frame_fingerprint, shot_fingerprint
from ocean_tweak.core.parameters.shot import ANIMATED, Animation, Shot
from ocean_tweak.core.sea.bake import ShotSeas

SEA = OceanParameters(
    resolution=32, domain_size=120.0, layers=(WaveLayer(wind_speed=9.0), WaveLayer(wind_speed=4.0)),
    timing=Timing(fps=Fraction(24), start_frame=11),
)  # fmt: skip
GUSTS = {"first_frame": 10, "samples": {"layers.1.wind_speed": [4.0, 6.0, 10.0], "choppiness": [1, 0.5, 0]}}


@pytest.fixture
def shot() -> Shot:
    return Shot.from_dict({**SEA.to_dict(), "animation": GUSTS})


def test_a_frame_has_its_own_parameters(shot: Shot) -> None:
    for frame, wind, choppiness in (
        (10, 4.0, 1.0),
        (11, 6.0, 0.5),
        (Fraction("11.25"), 7.0, 0.375),
        (12, 10.0, 0.0),
    ):
        parameters = shot.at(frame).parameters
        assert parameters.layers[1].wind_speed == wind
        assert parameters.choppiness == choppiness
        assert parameters.layers[0] == SEA.layers[0]
        assert shot.at(frame).time == (frame - 11) / Fraction(24)
        assert shot.at(frame).rate == 1.0


def test_frames_beyond_the_samples_are_refused(shot: Shot) -> None:
    for frame in (9, 13, Fraction("12.5")):
        with pytest.raises(ParameterError, match="frames 10 to 12"):
            shot.at(frame)
    with pytest.raises(ParameterError, match="10 to 12"):
        shot.check((10, 11, 20))
    shot.check((10, 12))


def test_json_both_ways(shot: Shot) -> None:
    assert Shot.from_json(shot.to_json()) == shot
    assert Shot.from_json(SEA.to_json()) == Shot(SEA)
    with pytest.raises(ParameterError, match="animation"):
        OceanParameters.from_json(shot.to_json())


def test_ocean_time_slows_the_waves_and_their_velocity() -> None:
    ramp = [0.0, 0.25, 0.5, 0.5, 0.5]
    shot = Shot(SEA, Animation(1, (("ocean_time", tuple(ramp)),)))
    assert [shot.at(frame).time for frame in (1, 2, 3, 4)] == [
        0,
        Fraction(1, 4),
        Fraction(1, 2),
        Fraction(1, 2),
    ]
    # a quarter of a second in a frame of a 24th: six times as fast; half of that where it stops
    assert [shot.at(frame).rate for frame in (1, 2, Fraction("2.5"), 3, 4, 5)] == [
        6.0,
        6.0,
        6.0,
        3.0,
        0.0,
        0.0,
    ]
    fields = ShotSeas(shot).frame(2, {"displacement", "velocity"})
    expected = Ocean(SEA).surface(0.25, {"displacement", "velocity"})
    np.testing.assert_array_equal(fields.displacement, expected.displacement)
    np.testing.assert_array_equal(fields.velocity, np.float32(6.0) * expected.velocity)


def test_frames_of_several_patches_are_several() -> None:
    patches = (Patch(100.0, 0.0, 10.0, resolution=32), Patch(70.0, 0.4, 3.0, 10.0, 48))
    surfaces = ShotSeas(Shot(SEA.replace(patches=patches)))
    made = surfaces.frames(2, {"displacement"})
    assert [fields.displacement.shape for fields in made] == [(32, 32, 3), (48, 48, 3)]
    with pytest.raises(ValueError, match="several patches"):
        surfaces.frame(2, {"displacement"})


def test_velocity_follows_the_clock_between_frames() -> None:
    """Against differences of the surface in scene time."""
    times = tuple(0.3 * math.sin(0.5 * frame) for frame in range(8))
    shot = Shot(SEA, Animation(1, (("ocean_time", times),)))
    surfaces = ShotSeas(shot)
    step = Fraction(1, 512)
    middle = Fraction("3.5")
    before, after = (
        surfaces.frame(middle + s, {"displacement"}).displacement.astype(float) for s in (-step, step)
    )
    moved = (after - before) / float(2 * step / SEA.timing.fps)
    velocity = surfaces.frame(middle, {"velocity"}).velocity
    np.testing.assert_allclose(moved, velocity, atol=2e-3 * np.abs(velocity).max())


@pytest.mark.parametrize(
    ("animation", "said"),
    [
        ({"first_frame": 1, "samples": {"water.depth": [1, 2]}}, "constant over a shot: depth, gravity"),
        ({"first_frame": 1, "samples": {"seed": [1, 2]}}, "another seed is another sea"),
        ({"first_frame": 1, "samples": {"domain_size": [1, 2]}}, "which waves there are"),
        ({"first_frame": 1, "samples": {"loop_duration": [1, 2]}}, "speed of every wave"),
        ({"first_frame": 1, "samples": {"dispersion": [1, 2]}}, "speed of every wave"),
        ({"first_frame": 1, "samples": {"layers.0.spectrum": [1, 2]}}, "only layers"),
        ({"first_frame": 1, "samples": {"layers.x.amplitude_scale": [1, 2]}}, "only layers"),
        ({"first_frame": 1, "samples": {"layers.7.amplitude_scale": [1, 2]}}, "only 2 layers"),
        ({"first_frame": 1, "samples": {f"layers.{'9' * 5000}.amplitude_scale": [1, 2]}}, "only layers"),
        (
            {"first_frame": 1, "samples": {"layers.0.amplitude_scale": [1, -2]}},
            "layers.0.amplitude_scale = -2.0: must be from 0",
        ),
        ({"first_frame": 1, "samples": {"layers.0.amplitude_scale": [1, "2"]}}, "layers.0.amplitude_scale.1"),
        ({"first_frame": 1, "samples": {"layers.0.amplitude_scale": [1, float("nan")]}}, "finite"),
        (
            {"first_frame": 1, "samples": {"layers.0.amplitude_scale": [1], "choppiness": [1, 1]}},
            "as many samples",
        ),
        ({"first_frame": 1, "samples": {"layers.0.amplitude_scale": []}}, "from 1 to"),
        ({"first_frame": 1, "samples": {"layers.0.amplitude_scale": [10**400]}}, "finite"),
        ({"first_frame": 10**400, "samples": {"layers.0.amplitude_scale": [1]}}, "at most"),
        ({"first_frame": 1, "samples": {"choppiness": 3}}, "must be a list"),
        ({"first_frame": 1, "samples": {}}, "at least one"),
        ({"first_frame": 1.5, "samples": {"choppiness": [1]}}, "whole number"),
        ({"samples": {"choppiness": [1]}}, "first_frame and samples"),
        ([], "first_frame and samples"),
    ],
)  # fmt: skip
def test_what_cannot_be_animated_says_why(animation: object, said: str) -> None:
    with pytest.raises(ParameterError, match=r"animation") as raised:
        Shot.from_dict({**SEA.to_dict(), "animation": animation})
    assert said in str(raised.value)


def test_fingerprints_are_of_the_sea_alone(shot: Shot) -> None:
    again = Shot.from_json(json.dumps(json.loads(shot.to_json()), sort_keys=True))
    assert frame_fingerprint(again, 11) == frame_fingerprint(shot, 11)
    assert shot_fingerprint(again) == shot_fingerprint(shot)
    # every input that changes a frame changes it
    others = [
        frame_fingerprint(shot, 10),
        frame_fingerprint(Shot(SEA), 11),
        frame_fingerprint(Shot(SEA.replace(seed=1)), 11),
        frame_fingerprint(Shot(SEA.replace(timing=Timing(fps=Fraction(25), start_frame=11))), 11),
        frame_fingerprint(shot, 11),
    ]
    assert len(set(others)) == len(others)


def test_a_change_elsewhere_leaves_a_frame_alone(shot: Shot) -> None:
    """A frame is of its own parameters: where the animation differs later, this frame does not."""
    later = {"first_frame": 10, "samples": {**GUSTS["samples"], "choppiness": [1, 0.5, 0.2]}}
    changed = Shot.from_dict({**SEA.to_dict(), "animation": later})
    assert frame_fingerprint(changed, 11) == frame_fingerprint(shot, 11)
    assert frame_fingerprint(changed, 12) != frame_fingerprint(shot, 12)
    assert shot_fingerprint(changed) != shot_fingerprint(shot)


def test_a_stretched_shot_is_slower_and_says_so_only_where_it_is() -> None:
    timing = Timing(fps=Fraction(24), start_frame=11, stretch=Fraction(3))
    stretched = Shot(SEA.replace(timing=timing))
    # frame 36 of the shot is frame 12 of its animation
    assert stretched.at(36).time == Fraction(1, 24)
    assert stretched.at(36).rate == pytest.approx(1 / 3)
    assert timing.frame(1 / 24) == pytest.approx(36)
    assert stretched.to_dict()["timing"]["stretch"] == 3
    assert Shot.from_json(stretched.to_json()) == stretched
    # the hash of a shot without one is what it was before there were such
    assert "stretch" not in Shot(SEA).to_dict()["timing"]


def test_what_can_change_during_a_shot_is_what_the_documentation_says():
    """docs/batch.md: of a layer these six, of the sea choppiness and its time, of masks where they are, of
    equalisers their ten bands, and the current."""
    of_layers = ("wind_speed", "wind_direction", "fetch", "swell", "amplitude_scale", "measured_time")
    of_masks = [f"{of}mask.{name}" for of in ("", "layers.*.", "patches.*.") for name in ("x", "y", "lines")]
    bands = ("longer_3", "longer_2", "longer_1", "peak", *(f"shorter_{octave}" for octave in range(1, 7)))
    of_equalisers = [f"{of}equaliser.{band}" for of in ("", "layers.*.") for band in bands]
    expected = (
        *(f"layers.*.{name}" for name in of_layers), "choppiness", *of_masks, *of_equalisers,
        "current.speed", "current.direction", "ocean_time",
    )  # fmt: skip
    assert expected == ANIMATED


# masks that move

PIER = [[[10.0, 20.0, 30.0, 20.0]], [[14.0, 20.0, 34.0, 24.0]], [[14.0, 26.0, 34.0, 30.0]]]
MOVING = {
    "first_frame": 10,
    "samples": {
        "mask.x": [1.0, 3.0, 3.0],
        "layers.1.mask.y": [5.0, 5.0, 9.0],
        "layers.0.mask.lines": {"values": PIER},
    },
}  # fmt: skip


@pytest.fixture
def masked() -> OceanParameters:
    mask = Mask(inner_radius=4.0, outer_radius=9.0)
    layers = tuple(replace(layer, mask=mask) for layer in SEA.layers)
    return SEA.replace(mask=mask, layers=layers)


def test_masks_move(masked: OceanParameters) -> None:
    shot = Shot.from_dict({**masked.to_dict(), "animation": MOVING})
    assert Shot.from_json(shot.to_json()) == shot
    for frame, x, y, line in (
        (10, 1.0, 5.0, [10.0, 20.0, 30.0, 20.0]),
        (Fraction("10.5"), 2.0, 5.0, [12.0, 20.0, 32.0, 22.0]),
        (Fraction("11.25"), 3.0, 6.0, [14.0, 21.5, 34.0, 25.5]),
        (12, 3.0, 9.0, [14.0, 26.0, 34.0, 30.0]),
    ):
        parameters = shot.at(frame).parameters
        assert parameters.mask == replace(masked.mask, x=x)
        assert parameters.layers[1].mask == replace(masked.mask, y=y)
        assert parameters.layers[0].mask == replace(masked.mask, lines=Raster([[line]]))
    others = {**MOVING, "samples": {**MOVING["samples"], "mask.x": [1.0, 3.0, 3.5]}}
    other = Shot.from_dict({**masked.to_dict(), "animation": others})
    assert shot_fingerprint(other) != shot_fingerprint(shot)
    assert frame_fingerprint(other, 12) != frame_fingerprint(shot, 12)
    assert frame_fingerprint(other, 11) == frame_fingerprint(shot, 11)


def test_masks_of_patches_move(masked: OceanParameters) -> None:
    patches = (Patch(SEA.domain_size, 0.0, 20.0, 1e6, 32), Patch(44.0, 0.7, 9.0, 20.0, 32, masked.mask))
    sea = SEA.replace(patches=patches)
    shot = Shot(sea, Animation(1, (("patches.1.mask.x", (2.0, 7.0)),)))
    assert shot.at(2).parameters == sea.replace(patches=(patches[0], replace(patches[1], mask=Mask(
        x=7.0, inner_radius=4.0, outer_radius=9.0))))  # fmt: skip


@pytest.mark.parametrize(
    ("path", "values", "told"),
    [
        ("layers.0.mask.x", (1.0, 2.0), "there is no mask"),
        ("patches.0.mask.x", (1.0, 2.0), "the sea has only 0 patches"),
        ("mask.x", (0.0, 2e6), r"mask\.x"),
        ("mask.x", Raster(PIER), "must be numbers"),
        ("mask.lines", (1.0, 2.0), "a raster with a row per frame"),
        ("mask.lines", Raster([[[1.0, 2.0]]]), "4 channels"),
        ("mask.lines", Raster([PIER[0], [[0.0, 0.0, 9e3, 0.0]]]), "480 m long"),
        ("mask.strength", (1.0, 2.0), "can change during a shot"),
    ],
)
def test_masks_that_cannot_move_so(path: str, values: object, told: str) -> None:
    sea = SEA.replace(mask=Mask(inner_radius=4.0, outer_radius=9.0))
    with pytest.raises(ParameterError, match=told):
        Shot(sea, Animation(1, ((path, values),)))
