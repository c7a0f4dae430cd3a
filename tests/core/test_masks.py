# SPDX-License-Identifier: GPL-3.0-or-later
"""Masks: weights between 0 and 1, and seas whose waves are only where they let them."""

from __future__ import annotations

import dataclasses
import json

import numpy as np
import pytest

from ocean_tweak.core import (
    HeroWave,
    ImageLayer,
    Mask,
    Ocean,
    OceanParameters,
    ParameterError,
    Patch,
    Places,
    Raster,
    WaveLayer,
    WindFieldLayer,
)
from ocean_tweak.core.masks.weights import weights, weights_on_grid
from ocean_tweak.core.parameters.patch_seas import parts
from ocean_tweak.core.sea.part_waves import PartWaves
from ocean_tweak.core.sea.surfaces import Field, summed_field
from tests.layers import with_layers

SIZE, SAMPLES = 240.0, 64
GENERATOR = np.random.default_rng(5)
HARBOUR = Mask(x=60.0, y=90.0, inner_radius=20.0, outer_radius=80.0)
IMAGE = Mask(source="IMAGE", image=Raster(GENERATOR.uniform(size=(5, 7)), "coast"))
STORM = WaveLayer(wind_speed=12.0, fetch=30e3, wind_direction=0.3)
RIPPLES = WaveLayer(wind_speed=5.0, fetch=5e3, wind_direction=-1.0)


def sea(**changes: object) -> OceanParameters:
    masked = dataclasses.replace(STORM, mask=HARBOUR)
    parameters = OceanParameters(
        resolution=SAMPLES, domain_size=SIZE, seed=4, layers=(masked, RIPPLES), choppiness=0.8
    )
    return parameters.replace(**changes)


def only(parameters: OceanParameters, number: int) -> OceanParameters:
    """The sea of one of its layers, everywhere."""
    layers = tuple(
        dataclasses.replace(layer, mask=None, muted=index != number)
        for index, layer in enumerate(parameters.layers)
    )
    return parameters.replace(layers=layers)


def exact_field(parameters: OceanParameters, time: float = 2.0) -> Field:
    """The band-limited surface, with derivatives, at any rest positions."""
    waves = [PartWaves(part, SIZE, "double", None) for part in parts(parameters)]
    return summed_field([of_part.exact_field(time) for of_part in waves])


# weights


@pytest.mark.parametrize(
    ("distance", "weight"), [(0.0, 0.0), (20.0, 0.0), (35.0, 5 / 32), (50.0, 0.5), (80.0, 1.0), (100.0, 1.0)]
)
def test_a_distance_is_a_smooth_step(distance: float, weight: float) -> None:
    """3t² - 2t³ between near and far: 5/32 at a quarter of the way."""
    angle = GENERATOR.uniform(0.0, 2.0 * np.pi, 9)
    x, y = HARBOUR.x + distance * np.cos(angle), HARBOUR.y + distance * np.sin(angle)
    np.testing.assert_allclose(weights((HARBOUR,), SIZE, x, y).value, weight, atol=1e-12)
    inverted = dataclasses.replace(HARBOUR, inverted=True)
    np.testing.assert_allclose(weights((inverted,), SIZE, x, y).value, 1.0 - weight, atol=1e-12)


def test_an_image_is_its_texels_smoothed() -> None:
    """A quadratic B-spline: 3/4 of a texel and an eighth of its neighbours along each axis, at its centre."""
    rows, columns = 5, 7
    x, y = (np.arange(columns) + 0.5) / columns * SIZE, (np.arange(rows) + 0.5) / rows * SIZE
    texels = IMAGE.image.values[..., 0].astype(float)
    smoothed = 0.75 * texels + 0.125 * (np.roll(texels, 1, 0) + np.roll(texels, -1, 0))
    smoothed = 0.75 * smoothed + 0.125 * (np.roll(smoothed, 1, 1) + np.roll(smoothed, -1, 1))
    np.testing.assert_allclose(weights((IMAGE,), SIZE, x, y[:, np.newaxis]).value, smoothed, atol=1e-12)
    plain = Mask(source="IMAGE", image=Raster(np.full((3, 3), 0.4)))
    places = GENERATOR.uniform(-SIZE, 2 * SIZE, (2, 50))
    np.testing.assert_allclose(weights((plain,), SIZE, *places).value, 0.4, atol=1e-7)


def test_brighter_than_white_is_white() -> None:
    bright = Mask(source="IMAGE", image=Raster([[2.0, -1.0]]))
    found = weights((bright,), SIZE, np.linspace(0.0, SIZE, 200), np.zeros(200)).value
    assert found.min() >= 0.0
    assert found.max() <= 1.0
    assert found.max() > 0.7


@pytest.mark.parametrize(
    "masks", [(HARBOUR,), (IMAGE,), (HARBOUR, dataclasses.replace(IMAGE, inverted=True))]
)
def test_derivatives_are_those_of_the_weight(masks: tuple[Mask, ...]) -> None:
    x, y = GENERATOR.uniform(0.0, SIZE, (2, 200))
    found = weights(masks, SIZE, x, y)
    step = 1e-4
    for by, (dx, dy) in ((found.by_x, (step, 0.0)), (found.by_y, (0.0, step))):
        ahead, behind = (weights(masks, SIZE, x + s * dx, y + s * dy).value for s in (1, -1))
        np.testing.assert_allclose(by, (ahead - behind) / (2 * step), atol=2e-6)


@pytest.mark.parametrize("mask", [HARBOUR, IMAGE])
def test_it_repeats_with_the_domain(mask: Mask) -> None:
    x, y = GENERATOR.uniform(0.0, SIZE, (2, 50))
    here, there = weights((mask,), SIZE, x, y), weights((mask,), SIZE, x + 3 * SIZE, y - SIZE)
    np.testing.assert_allclose(here[:3], there[:3], atol=1e-9)


def test_a_grid_has_the_weights_of_its_samples() -> None:
    along = SIZE / 160 * np.arange(160)
    there = weights((HARBOUR, IMAGE), SIZE, along, along[:, np.newaxis])
    np.testing.assert_array_equal(weights_on_grid((HARBOUR, IMAGE), SIZE, 160)[:3], there[:3])


# lines

WALL = dataclasses.replace(HARBOUR, lines=Raster([[[60.0, 90.0, 120.0, 170.0]]]))  # 100 m long


@pytest.mark.parametrize(
    ("along", "aside", "weight"),
    [
        # beside it, 20 m to 80 m away: 3t² - 2t³
        (50.0, 0.0, 0.0), (50.0, 20.0, 0.0), (0.0, 35.0, 5 / 32), (100.0, 50.0, 0.5), (30.0, -65.0, 27 / 32),
        # beyond its ends: (30, 40) is 50 m from them
        (-35.0, 0.0, 5 / 32), (130.0, 40.0, 0.5), (-30.0, -40.0, 0.5),
    ],
)  # fmt: skip
def test_a_distance_from_a_line(along: float, aside: float, weight: float) -> None:
    """By the plane's geometry, the line's direction being (0.6, 0.8)."""
    x = np.array([60.0 + 0.6 * along - 0.8 * aside])
    y = np.array([90.0 + 0.8 * along + 0.6 * aside])
    np.testing.assert_allclose(weights((WALL,), 1000.0, x, y).value, weight, atol=1e-6)


def test_lines_of_no_length_are_places() -> None:
    places = GENERATOR.uniform(0.0, SIZE, (2, 100))
    point = dataclasses.replace(HARBOUR, lines=Raster([[[60.0, 90.0, 60.0, 90.0]]]))
    found, expected = (weights((mask,), SIZE, *places) for mask in (point, HARBOUR))
    np.testing.assert_allclose(found[:3], expected[:3], atol=1e-12)


def test_the_nearest_of_lines_that_repeat() -> None:
    """A diagonal nearly as long as the domain, whose repetitions are nearest to what is beside its ends."""
    lines = Raster([[[10.0, 10.0, 90.0, 90.0], [50.0, 10.0, 50.0, 10.0]]])
    mask = Mask(lines=lines, inner_radius=1.0, outer_radius=41.0)
    # (94, 10) is 16 m from (110, 10), which repeats (10, 10), and (6, 90) as far from (-10, 90)
    places = np.array([[94.0, 10.0], [6.0, 90.0], [50.0, 13.0]])
    found = weights((mask,), 100.0, *places.T).value
    part = (np.array([16.0, 16.0, 3.0]) - 1.0) / 40.0
    np.testing.assert_allclose(found, part**2 * (3.0 - 2.0 * part), atol=1e-9)


@pytest.mark.parametrize(
    "lines", [np.zeros((1, 501, 4)), [[[0.0, 0.0, 0.0, 4.1 * SIZE]]], [[[0.0, 0.0, 1.0]]]]
)
def test_lines_that_cannot_be(lines: object) -> None:
    with pytest.raises(ParameterError, match="lines"):
        sea(mask=Mask(lines=Raster(lines)))


def test_strength_is_a_share_of_what_it_takes() -> None:
    x, y = GENERATOR.uniform(0.0, SIZE, (2, 100))
    whole = weights((HARBOUR,), SIZE, x, y)
    found = weights((dataclasses.replace(HARBOUR, strength=0.75),), SIZE, x, y)
    np.testing.assert_allclose(1.0 - found.value, 0.75 * (1.0 - whole.value), atol=1e-12)
    np.testing.assert_allclose(
        (found.by_x, found.by_y), 0.75 * np.array((whole.by_x, whole.by_y)), atol=1e-12
    )
    none = weights((dataclasses.replace(HARBOUR, strength=0.0),), SIZE, x, y)
    np.testing.assert_array_equal(none.value, 1.0)


def test_json_keeps_strength_and_lines_and_has_neither_by_default() -> None:
    made = sea(mask=dataclasses.replace(WALL, strength=0.0))
    assert OceanParameters.from_json(made.to_json()) == made
    plain = json.loads(sea().to_json())
    assert "mask" not in plain
    assert {"strength", "lines"}.isdisjoint(plain["layers"][0]["mask"])


# masked seas


@pytest.mark.parametrize("hero", [(), (HeroWave(crest_height=2.0, x=90.0, y=120.0, time=3.0),)])
def test_a_mask_over_the_sea_lies_over_all_its_waves(hero: tuple[HeroWave, ...]) -> None:
    places = Places(*GENERATOR.uniform(0.0, SIZE, (2, 30)))
    bare = sea(layers=(STORM, RIPPLES, *hero))
    plain, found = (
        Ocean(parameters, "double").surface(3.0, {"displacement"}, places).displacement
        for parameters in (bare, bare.replace(mask=WALL))
    )
    weight = weights((WALL,), SIZE, places.x, places.y).value[..., np.newaxis]
    assert weight.min() < 0.1
    np.testing.assert_allclose(found, weight * plain, atol=1e-6)


def test_a_hero_wave_is_not_under_the_mask_of_another_layer() -> None:
    hero = HeroWave(crest_height=2.0, x=HARBOUR.x, y=HARBOUR.y, time=3.0)
    masked = sea(layers=(dataclasses.replace(STORM, mask=HARBOUR), hero))
    assert Ocean(masked, "double").height_at(HARBOUR.x, HARBOUR.y, 3.0) == pytest.approx(2.0, abs=0.05)


def test_the_sea_is_the_weighted_sum_of_its_layers() -> None:
    weight = weights_on_grid((HARBOUR,), SIZE, SAMPLES).value[..., np.newaxis]
    storm, ripples = (
        Ocean(only(sea(), number), "double").surface(3.0, {"displacement", "velocity"}) for number in (0, 1)
    )
    found = Ocean(sea(), "double").surface(3.0, {"displacement", "velocity"})
    for name in ("displacement", "velocity"):
        expected = weight * getattr(storm, name) + getattr(ripples, name)
        np.testing.assert_allclose(getattr(found, name), expected, atol=1e-12)


def test_slopes_and_strains_are_those_of_the_masked_surface() -> None:
    """By differences of the displacement itself, between samples: the exact surface of the sum."""
    field = exact_field(sea(layers=(dataclasses.replace(STORM, mask=IMAGE), RIPPLES)))
    x, y = GENERATOR.uniform(0.0, SIZE, (2, 40))
    values, _ = field(x, y, False)
    step = 1e-3
    for by, (dx, dy) in ((values.by_x, (step, 0.0)), (values.by_y, (0.0, step))):
        (ahead, *_), _ = field(x + dx, y + dy, False)
        (behind, *_), _ = field(x - dx, y - dy, False)
        np.testing.assert_allclose(by, (ahead - behind) / (2 * step), atol=1e-5)


def test_the_velocity_anywhere_is_that_of_the_masked_surface() -> None:
    """By differences in time of the displacement itself."""
    masked = sea(layers=(dataclasses.replace(STORM, mask=IMAGE), RIPPLES))
    x, y = GENERATOR.uniform(0.0, SIZE, (2, 40))
    _, velocity = exact_field(masked)(x, y, True)
    step = 1e-3
    (later, *_), _ = exact_field(masked, 2.0 + step)(x, y, False)
    (earlier, *_), _ = exact_field(masked, 2.0 - step)(x, y, False)
    np.testing.assert_allclose(velocity, (later - earlier) / (2 * step), atol=1e-4)


def test_a_grid_has_the_slopes_and_strains_of_the_masked_surface() -> None:
    outputs = {"slope", "strain", "jacobian", "cusp"}
    parameters = sea()
    found = Ocean(parameters, "double").surface(2.0, outputs)
    along = SIZE / SAMPLES * np.arange(SAMPLES)
    x, y = (part.ravel() for part in np.meshgrid(along, along))
    values, _ = exact_field(parameters)(x, y, False)
    by_x, by_y = (part.reshape(SAMPLES, SAMPLES, 3) for part in (values.by_x, values.by_y))
    np.testing.assert_allclose(found.slope, np.stack((by_x[..., 2], by_y[..., 2]), axis=-1), atol=1e-8)
    gradient = np.stack((by_x[..., :2], by_y[..., :2]), axis=-1) + np.eye(2)
    np.testing.assert_allclose(found.jacobian, np.linalg.det(gradient), atol=1e-8)
    symmetric = 0.5 * (gradient + np.swapaxes(gradient, -1, -2))
    least = np.linalg.eigvalsh(symmetric)[..., 0]
    np.testing.assert_allclose(found.cusp, np.maximum(1.0 - least, 0.0), atol=1e-8)


@pytest.mark.parametrize("mask", [HARBOUR, IMAGE])
def test_the_displacement_is_continuous(mask: Mask) -> None:
    """Over texels, over the mask's edge and over the domain's: a step of δ moves it by a rate times δ."""
    cascade = Ocean(sea(layers=(dataclasses.replace(STORM, mask=mask),)), "double")
    along = np.linspace(-0.2 * SIZE, 1.2 * SIZE, 30_001)
    moved = cascade.surface(1.0, on=Places(along, 0.4 * SIZE + 0.1 * along)).displacement
    jumps = np.abs(np.diff(moved, axis=0)).max()
    rates = np.abs(np.diff(moved[::10], axis=0)).max() / 10.0
    assert jumps < 3.0 * rates


def test_calm_in_the_harbour() -> None:
    calm = dataclasses.replace(STORM, mask=HARBOUR)
    cascade = Ocean(sea(layers=(calm,)))
    inside = cascade.surface(
        5.0, {"displacement", "foam"}, on=Places(HARBOUR.x + np.array([-9.0, 0.0, 12.0]), HARBOUR.y)
    )
    assert np.all(inside.displacement == 0.0)
    assert np.all(inside.foam == 0.0)
    outside = cascade.surface(5.0, on=Places(HARBOUR.x + np.array([81.0, 110.0]), HARBOUR.y)).displacement
    whole = Ocean(sea(layers=(STORM,))).surface(
        5.0, on=Places(HARBOUR.x + np.array([81.0, 110.0]), HARBOUR.y)
    )
    np.testing.assert_array_equal(outside, whole.displacement)


def test_a_patch_has_a_mask_of_its_own() -> None:
    patches = (Patch(SIZE, 0.0, 12.0, 1e6, 64), Patch(61.0, 0.5, 3.0, 12.0, 64, IMAGE))
    parameters = sea(layers=(STORM, RIPPLES)).replace(patches=patches)
    free = parameters.replace(patches=(patches[0], dataclasses.replace(patches[1], mask=None)))
    x, y = GENERATOR.uniform(0.0, SIZE, (2, 60))
    weight = weights((IMAGE,), SIZE, x, y).value[:, np.newaxis]
    found = Ocean(parameters, "double").surface(1.0, on=Places(x, y)).displacement
    both = Ocean(free, "double").surface(1.0, on=Places(x, y)).displacement
    first = Ocean(parameters.replace(patches=patches[:1]).replace(patches=(patches[0],)), "double")
    long = Ocean(first.parameters, "double").surface(1.0, on=Places(x, y)).displacement
    np.testing.assert_allclose(found, long + weight * (both - long), atol=1e-6)


@pytest.mark.parametrize("kind", ["IMAGE", "WIND_FIELD"])
def test_layers_of_all_kinds_have_masks(kind: str) -> None:
    layer = {
        "IMAGE": ImageLayer(mask=HARBOUR, noise_resolution=64, significant_wave_height=1.0),
        "WIND_FIELD": WindFieldLayer(mask=HARBOUR, wind_speed=14.0),
    }[kind]
    free = dataclasses.replace(layer, mask=None)
    fields = [
        Ocean(with_layers(sea(layers=(RIPPLES,)), **{kind: found})).surface(20.0).displacement
        for found in ((layer,), (free,), ())
    ]
    weight = weights_on_grid((HARBOUR,), SIZE, SAMPLES).value[..., np.newaxis]
    assert np.abs(fields[1] - fields[2]).max() > 0.05
    np.testing.assert_allclose(fields[0], fields[2] + weight * (fields[1] - fields[2]), atol=2e-5)


def test_a_hero_wave_is_there_once_and_under_no_mask() -> None:
    hero = HeroWave(x=60.0, y=90.0, time=2.0, wavelength=40.0, crest_height=2.0)
    with_wave, without = (
        Ocean(with_layers(sea(), HERO_WAVE=waves), "double").surface(2.0).displacement
        for waves in ((hero,), ())
    )
    alone = Ocean(with_layers(only(sea(), 1), HERO_WAVE=(hero,)), "double").surface(2.0).displacement
    plain = Ocean(only(sea(), 1), "double").surface(2.0).displacement
    np.testing.assert_allclose(with_wave - without, alone - plain, atol=1e-9)
    assert np.abs(alone - plain).max() > 1.0


def test_the_height_above_a_place_is_that_of_the_masked_surface() -> None:
    x, y = GENERATOR.uniform(0.0, SIZE, (2, 50))
    points = Ocean(sea(), "double").points_at(x, y, 2.0, surface="exact", velocity=True)
    values, velocity = exact_field(sea())(points.rest[:, 0], points.rest[:, 1], True)
    np.testing.assert_allclose(points.rest[:, 0] + values.value[:, 0], x, atol=1e-4)
    np.testing.assert_allclose(points.height, values.value[:, 2], atol=1e-9)
    np.testing.assert_allclose(points.velocity, velocity, atol=1e-9)


def test_a_sample_is_found_above_the_place_to_which_it_was_moved() -> None:
    masked = Ocean(sea(), "double")
    moved = masked.surface(2.0).displacement[5:60:9, 3:60:7].reshape(-1, 3)
    rest = SIZE / SAMPLES * np.stack(np.meshgrid(np.arange(3, 60, 7), np.arange(5, 60, 9)), axis=-1)
    x, y = (rest.reshape(-1, 2) + moved[:, :2]).T
    np.testing.assert_allclose(masked.height_at(x, y, 2.0), moved[:, 2], atol=1e-4)


def test_a_muted_mask_masks_nothing() -> None:
    muted = sea(layers=(dataclasses.replace(STORM, mask=HARBOUR, muted=True), RIPPLES))
    assert not muted.is_masked
    assert isinstance(Ocean(muted), Ocean)


def test_waves_are_those_of_the_sea_without_masks() -> None:
    """Statistics and seeds: a mask takes no layer's waves, it only says where they are."""
    free = only(sea(), 0).replace(layers=(STORM, RIPPLES))
    assert Ocean(sea()).statistics().resolved == Ocean(free).statistics().resolved


# values


def test_masks_are_json_and_left_out_where_there_are_none() -> None:
    parameters = sea(layers=(dataclasses.replace(STORM, mask=IMAGE), RIPPLES))
    assert OceanParameters.from_json(parameters.to_json()) == parameters
    assert "mask" not in OceanParameters(layers=(STORM,)).to_json()
    assert parameters != sea()


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        ({"source": "IMAGE"}, "image"),
        ({"inner_radius": 90.0}, "inner_radius"),
        ({"outer_radius": 0.0}, "outer_radius"),
        ({"x": float("nan")}, "x"),
        ({"source": "OBJECT"}, "source"),
        ({"source": "IMAGE", "image": Raster(np.zeros((2, 2, 2)))}, "image"),
    ],
)
def test_what_is_no_mask_is_refused(changes: dict[str, object], named: str) -> None:
    with pytest.raises(ParameterError, match=rf"^{named}"):
        dataclasses.replace(HARBOUR, **changes)


def test_troughs_are_not_damped_under_masks() -> None:
    with pytest.raises(ParameterError, match=r"trough_damping = 0.5: must be 0 in a sea with masks"):
        sea(trough_damping=0.5)


def test_a_masked_sea_has_no_coefficients_of_one_sum() -> None:
    with pytest.raises(ValueError, match="is several sums of waves, or has masks"):
        Ocean(sea()).initial_state  # noqa: B018
