# SPDX-License-Identifier: GPL-3.0-or-later
"""Foam as the water material draws it: how much it covers, where its holes lie, and that both engines agree.

The square is as large as the period of the material's patterns on a mesh that is no ocean.
"""

import math

import bpy
import numpy as np
import pytest

SIDE = 100.0  # m
PIXELS = 160
BREEZE, GALE = 9.0, 22.0  # m/s: 5 and 9 Beaufort


@pytest.fixture
def square(extension, empty_scene):
    """A flat square with the water material, which shows nothing but how much foam covers each point."""
    half = 0.5 * SIDE
    mesh = bpy.data.meshes.new("Flat")
    mesh.from_pydata(
        [(-half, -half, 0), (half, -half, 0), (half, half, 0), (-half, half, 0)], [], [(0, 1, 2, 3)]
    )
    item = bpy.data.objects.new("Flat", mesh)
    empty_scene.collection.objects.link(item)
    water = extension("scene.water_material")
    material = water.water_material()
    water.assign(item, material)
    tree = material.node_tree
    group = next(node for node in tree.nodes if node.type == "GROUP")
    shown = tree.nodes.new("ShaderNodeEmission")
    tree.links.new(group.outputs["Foam"], shown.inputs["Color"])
    output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    tree.links.new(shown.outputs[0], output.inputs["Surface"])
    for link in group.inputs["Pixel Angle"].links:
        tree.links.remove(link)
    return item


@pytest.fixture
def inputs(square):
    """The group's inputs; patterns are drawn however fine they are."""
    tree = square.active_material.node_tree
    group = next(node for node in tree.nodes if node.type == "GROUP")
    group.inputs["Pixel Angle"].default_value = 0.0
    return group.inputs


@pytest.fixture
def cover(square, inputs, empty_scene, extension, tmp_path):
    """Seen from above: takes what the mesh says of foam, gives the covered share of pixels [y, x]."""
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.data.type, camera.data.ortho_scale, camera.location.z = "ORTHO", SIDE, 50.0
    camera.data.clip_end = 1e5
    empty_scene.collection.objects.link(camera)
    empty_scene.camera = camera
    render, cycles = empty_scene.render, empty_scene.cycles
    cycles.device, cycles.samples, cycles.use_denoising = "CPU", 1, False
    cycles.pixel_filter_type = "BOX"
    render.filter_size = 0.01  # of EEVEE: one point a pixel
    empty_scene.eevee.taa_render_samples = 1
    render.resolution_x = render.resolution_y = PIXELS
    empty_scene.view_settings.view_transform = "Raw"
    render.image_settings.file_format, render.filepath = "OPEN_EXR", str(tmp_path / "seen.exr")

    def look(share, age=None, breaking=0.0, wind=BREEZE, height=50.0, side=SIDE, engine="CYCLES"):
        camera.location.z, camera.data.ortho_scale = height, side
        extension("scene.surroundings").set_engine(empty_scene, engine)
        square["ocean_tweak_wind_speed"] = wind
        told = {"foam": share} if age is None else {"foam": share, "foam_age": age, "breaking": breaking}
        attributes = square.data.attributes
        for name in ("foam", "foam_age", "breaking"):
            if name in attributes:
                attributes.remove(attributes[name])
        for name, value in told.items():
            values = np.full(4, value, np.float32)
            attributes.new(name, "FLOAT", "POINT").data.foreach_set("value", values)
        square.data.update()
        square.update_tag()
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(render.filepath)
        pixels = np.empty(4 * PIXELS**2, np.float32)
        image.pixels.foreach_get(pixels)
        bpy.data.images.remove(image)
        return pixels.reshape(PIXELS, PIXELS, 4)[..., 0].astype(np.float64)

    return look


def edges(shown, axis):
    """How often a line along an axis meets a rim of foam, a pixel."""
    return float(np.mean(np.diff(shown > 0.5, axis=axis)))


@pytest.mark.parametrize("wind", [BREEZE, GALE])
def test_a_share_of_foam_covers_that_share(cover, wind):
    for age, breaking in ((0.0, 1.0), (1.5, 0.0), (6.0, 0.0), (40.0, 0.0)):
        for share in (0.04, 0.3, 0.7, 0.96):
            shown = cover(share, age, breaking, wind)
            assert shown.mean() == pytest.approx(share, rel=0.07, abs=0.01), (age, share)
            assert np.mean(shown > 0.5) == pytest.approx(share, rel=0.10, abs=0.01), (age, share)
            assert 0.0 <= shown.min() <= shown.max() <= 1.0


def test_it_covers_as_much_from_afar_and_pales_into_its_mean(cover, inputs):
    inputs["Pixel Angle"].default_value = 1e-3
    spread = []
    for height in (50.0, 400.0, 3e3, 3e4):
        shown = cover(0.3, 5.0, height=height)
        assert shown.mean() == pytest.approx(0.3, rel=0.06), height
        spread.append(shown.std())
    assert spread == sorted(spread, reverse=True)
    # the largest cells are 9 m wide, a pixel's footprint is as many mm as the camera is m away
    assert spread[0] > 0.4
    assert spread[-1] < 1e-3


def test_no_foam_covers_nothing(cover):
    assert cover(0.0).max() == 0.0
    assert cover(0.0, 0.0).max() == 0.0


def test_holes_grow_with_age(cover):
    rims = [
        edges(cover(0.4, age, breaking, side=30.0), 1)
        for age, breaking in ((0.0, 1.0), (2.0, 0.0), (12.0, 0.0))
    ]
    assert rims[0] > 1.1 * rims[1] > 1.1**2 * rims[2]


def test_old_foam_lies_in_streaks_from_7_beaufort_on(cover, inputs):
    """The wind blows along x: means over 12 m along it differ more than means over 12 m across."""

    def longer(**said):
        shown = cover(0.2, 15.0, **said)
        along, across = (np.var(each.reshape(PIXELS, -1, 20).mean(axis=2)) for each in (shown, shown.T))
        return along / across

    assert longer(wind=BREEZE) < 1.3
    assert longer(wind=GALE) > 2.0
    inputs["Foam Streaks"].default_value = 0.0
    assert longer(wind=GALE) < 1.3
    inputs["Foam Streaks"].default_value = 1.0
    assert longer(wind=BREEZE) > 2.0


def test_foam_that_says_nothing_of_its_age_has_the_age_that_thinned_it_out(cover):
    """2.5 s for each half."""
    for share in (0.15, 0.6):
        np.testing.assert_allclose(cover(share), cover(share, -2.5 * math.log2(share)), atol=1e-3)


def test_foam_of_a_map_has_not_the_age_of_the_sea_s_own(cover, inputs):
    alone = cover(0.6)
    inputs["Foam Map"].default_value = 0.6
    np.testing.assert_allclose(cover(0.0, 30.0), alone, atol=1e-3)


def test_eevee_draws_the_same_foam(cover, inputs):
    inputs["Pixel Angle"].default_value = 3e-4
    for share, height in ((0.2, 50.0), (0.6, 50.0), (0.3, 2000.0)):
        engines = [cover(share, 4.0, wind=GALE, height=height, engine=each) for each in ("CYCLES", "EEVEE")]
        shares = [shown.mean() for shown in engines]
        assert shares[1] == pytest.approx(shares[0], rel=0.03)
        assert np.corrcoef(*(shown.ravel() for shown in engines))[0, 1] > 0.95
