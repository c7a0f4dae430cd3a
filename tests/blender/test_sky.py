# SPDX-License-Identifier: GPL-3.0-or-later
"""The sky of a scene: its light in numbers and rendered, presets, exposure, panoramas, undo."""

import logging
import math
from types import SimpleNamespace

import bpy
import numpy as np
import pytest

#: what Blender 5.2's own sky texture (MULTIPLE_SCATTERING, no disc) sheds on level ground, in its units: the
#: sum over a panorama of 180 rows, by the sun's elevation in degrees, linear red, green and blue
SKYLIGHT = {
    0.0: (1.228, 1.298, 1.908), 5.0: (3.316, 4.781, 7.074), 10.0: (4.583, 7.338, 11.98),
    20.0: (6.024, 10.12, 17.37), 45.0: (7.844, 13.53, 23.82), 60.0: (8.489, 14.74, 26.13),
}  # fmt: skip
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


@pytest.fixture
def sky(extension):
    return SimpleNamespace(
        **{
            name: extension(f"scene.{name}")
            for name in ("sky", "sky_world", "scene_sky", "skies", "panorama")
        }
    )


@pytest.fixture
def scene(ocean, empty_scene, extension):
    """A scene with an ocean that has water."""
    water = extension("scene.water_material")
    water.assign(ocean, water.water_material())
    return empty_scene


@pytest.fixture
def irradiance(empty_scene, tmp_path):
    """What falls on level ground, linear red, green and blue: pi times the radiance of a white plane."""
    scene, plane = empty_scene, bpy.data.meshes.new("Plane")
    plane.from_pydata([(-9, -9, 0), (9, -9, 0), (9, 9, 0), (-9, 9, 0)], [], [(0, 1, 2, 3)])
    white = bpy.data.materials.new("White")
    if white.node_tree is None:
        white.use_nodes = True
    nodes = white.node_tree.nodes
    nodes.clear()
    diffuse, shown = nodes.new("ShaderNodeBsdfDiffuse"), nodes.new("ShaderNodeOutputMaterial")
    diffuse.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    white.node_tree.links.new(diffuse.outputs[0], shown.inputs[0])
    plane.materials.append(white)
    scene.collection.objects.link(bpy.data.objects.new("Plane", plane))
    scene.camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.camera.location.z = 2.0
    scene.collection.objects.link(scene.camera)
    scene.render.engine, scene.cycles.device = "CYCLES", "CPU"
    scene.cycles.samples, scene.cycles.max_bounces, scene.cycles.use_denoising = 256, 0, False
    scene.render.resolution_x = scene.render.resolution_y = 8
    scene.view_settings.view_transform = "Raw"
    settings = scene.render.image_settings
    settings.file_format, settings.color_depth, settings.color_mode = "OPEN_EXR", "32", "RGBA"
    scene.render.filepath = str(tmp_path / "seen.exr")

    def measure():
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(scene.render.filepath)
        texels = np.empty(4 * 64, np.float32)
        image.pixels.foreach_get(texels)
        bpy.data.images.remove(image)
        return math.pi * texels.reshape(64, 4)[:, :3].mean(axis=0)

    return measure


@pytest.mark.parametrize("elevation", SKYLIGHT)
def test_both_blenders_have_the_same_light(sky, irradiance, empty_scene, elevation):
    """The sky's as 5.2's texture has it, whichever Blender renders, and with the lamp the sun's on top."""
    angle = math.radians(elevation)
    sky.scene_sky.put(empty_scene, sky.sky.Sky(angle, 0.7, clouds=0.0))
    lamp = next(item for item in empty_scene.objects if item.type == "LIGHT")
    both = irradiance()
    lamp.hide_render = True
    alone = irradiance()
    assert alone == pytest.approx(sky.sky.EXPOSURE * np.array(SKYLIGHT[elevation]), rel=0.1)
    from_sun = math.sin(angle) * lamp.data.energy * np.array(lamp.data.color)
    assert both - alone == pytest.approx(from_sun, rel=0.03, abs=0.002)


def test_less_than_a_third_of_a_clear_days_light_is_the_skys(sky):
    """Diffuse light of clear days as measured at many places: 8 to 30 % of the whole with the sun 20 to 60
    degrees high, the share falling as it rises (Liu and Jordan 1960)."""
    shares = []
    for elevation in (20.0, 45.0, 60.0):
        angle = math.radians(elevation)
        direct = math.sin(angle) * LUMINANCE @ sky.sky.Sky(angle, 0.0).sun_irradiance
        diffuse = sky.sky.EXPOSURE * LUMINANCE @ SKYLIGHT[elevation]
        shares.append(diffuse / (diffuse + direct))
    assert 0.08 < shares[2] < shares[1] < shares[0] < 0.3


def test_the_moon_shines_where_the_sun_has_set(sky):
    day, dusk, night = (
        sky.sky.Sky(math.radians(sun), 0.0, moon_elevation=math.radians(30.0)) for sun in (1.0, -3.0, -20.0)
    )
    assert max(day.moon_irradiance) == 0.0 == max(night.sun_irradiance)
    assert 0.0 < max(dusk.moon_irradiance) < max(night.moon_irradiance)
    # eight stops below a sun in its place, and bluer
    sun = sky.sky.Sky(math.radians(30.0), 0.0).sun_irradiance
    shares = np.array(night.moon_irradiance) / sun
    assert math.log2(LUMINANCE @ shares) == pytest.approx(-8.0, abs=0.3)
    assert shares[2] > shares[0]


def test_haze_darkens_with_the_day(sky):
    brightness = [
        LUMINANCE @ sky.sky.Sky(math.radians(sun), 0.0, overcast=overcast, moon_elevation=-1.0).haze(math.pi)
        for overcast in (0.0, 1.0)
        for sun in (30.0, 5.0, 0.0, -4.0, -9.0)
    ]
    for clear_or_closed in (brightness[:5], brightness[5:]):
        assert clear_or_closed == sorted(clear_or_closed, reverse=True)
        assert clear_or_closed[-1] < 0.01 * clear_or_closed[0]


def lamps(scene):
    return {item.name: item for item in scene.objects if item.type == "LIGHT"}


def sky_texture(scene):
    return next(node for node in scene.world.node_tree.nodes if node.type == "TEX_SKY")


def haze_color(ocean):
    node = next(node for node in ocean.active_material.node_tree.nodes if node.type == "GROUP")
    return tuple(node.inputs["Haze Color"].default_value)[:3]


def test_every_preset_is_shown(scene, ocean, sky):
    """With the sun where the camera's view has it, by lamp, sky and haze; one world and one sun for all."""
    scene.camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.collection.objects.link(scene.camera)
    scene.camera.rotation_euler = (0.5 * math.pi, 0.0, math.radians(-60.0))  # looks along 30 degrees
    bpy.context.view_layer.update()
    hazes = set()
    for key, preset in sky.skies.SKIES.items():
        assert bpy.ops.ocean.use_sky(sky=key) == {"FINISHED"}
        settings, light = scene.ocean_tweak_sky, preset.sky
        turned = light.sun_azimuth - math.radians(60.0)
        assert settings.sun_azimuth == pytest.approx(turned, abs=1e-5)
        texture = sky_texture(scene)
        assert texture.sun_elevation == pytest.approx(light.sun_elevation, abs=1e-5)
        assert texture.sun_rotation == pytest.approx(0.5 * math.pi - turned, abs=1e-5)
        is_night = light.sun_elevation < 0.0
        lit = [name for name, lamp in lamps(scene).items() if lamp.data.energy > 0.0]
        # a closed cloud lets neither through
        assert lit == ([] if key == "OVERCAST" else ["Ocean Moon" if is_night else "Ocean Sun"])
        hazes.add(haze_color(ocean))
    assert len(hazes) == len(sky.skies.SKIES) == 6
    assert [world.name for world in bpy.data.worlds if world.users] == [scene.world.name]
    assert sorted(lamps(scene)) == ["Ocean Moon", "Ocean Sun"]


def test_a_pulled_sun_moves_all_of_it(scene, ocean):
    bpy.ops.ocean.use_sky(sky="NOON")
    sun, before = lamps(scene)["Ocean Sun"], haze_color(ocean)
    energy = sun.data.energy
    scene.ocean_tweak_sky.sun_elevation = math.radians(4.0)
    scene.ocean_tweak_sky.sun_azimuth = math.radians(200.0)
    bpy.context.view_layer.update()
    towards = sun.matrix_world.col[2]
    level = math.cos(math.radians(4.0))
    expected = (level * math.cos(math.radians(200.0)), level * math.sin(math.radians(200.0)))
    assert tuple(towards)[:2] == pytest.approx(expected, abs=1e-5)
    assert sun.data.energy < 0.5 * energy
    assert sky_texture(scene).sun_elevation == pytest.approx(math.radians(4.0), abs=1e-6)
    assert sum(haze_color(ocean)) < sum(before)


def test_a_linked_copy_of_a_scene_has_one_sky_with_it(scene, ocean):
    """The world and the lamps are both scenes': so are the settings, whichever scene's are changed."""
    bpy.ops.ocean.use_sky(sky="NOON")
    bpy.ops.scene.new(type="LINK_COPY")
    copy = next(each for each in bpy.data.scenes if each != scene)
    assert copy.world == scene.world
    copy.ocean_tweak_sky.use_exposure = True
    for changed, other, degrees in ((scene, copy, 4.0), (copy, scene, 12.0)):
        changed.ocean_tweak_sky.sun_elevation = math.radians(degrees)
        assert other.ocean_tweak_sky.sun_elevation == pytest.approx(math.radians(degrees), abs=1e-6)
        assert sky_texture(scene).sun_elevation == pytest.approx(math.radians(degrees), abs=1e-6)
    scene.ocean_tweak_sky.exposure = 1.5
    assert copy.view_settings.exposure == pytest.approx(1.5)
    assert scene.view_settings.exposure == pytest.approx(0.0)  # it does not follow
    assert list(lamps(copy)) == list(lamps(scene))
    # one with a world of its own goes its own way
    copy.world = copy.world.copy()
    copy.ocean_tweak_sky.sun_elevation = math.radians(30.0)
    assert scene.ocean_tweak_sky.sun_elevation == pytest.approx(math.radians(12.0), abs=1e-6)


def test_a_world_of_ones_own_stays_until_a_sky_is_chosen(scene):
    own = bpy.data.worlds.new("Mine")
    scene.world = own
    scene.ocean_tweak_sky.sun_elevation = 0.1
    assert scene.world == own
    assert not lamps(scene)
    bpy.ops.ocean.use_sky(sky="DUSK")
    assert scene.world != own
    assert own.use_fake_user


@pytest.mark.parametrize("is_ours", [True, False])
def test_exposure_is_the_scenes_own_unless_we_made_it(quick, empty_scene, is_ours, capfd):
    if not is_ours:
        empty_scene.collection.objects.link(bpy.data.objects.new("Mine", None))
    view = empty_scene.view_settings
    view.exposure = 0.7
    bpy.ops.ocean.add_scene(mood="CALM")
    assert view.exposure == pytest.approx(0.0 if is_ours else 0.7)
    bpy.ops.ocean.use_sky(sky="MOONLIT_NIGHT")
    assert view.exposure == pytest.approx(4.0 if is_ours else 0.7)
    told = "exposure stays 0.7, this sky is made for 4.0"
    assert (told in capfd.readouterr().out) == (not is_ours)
    empty_scene.ocean_tweak_sky.use_exposure = True
    assert view.exposure == pytest.approx(4.0)


def test_one_undo_takes_a_sky_back(scene, window):
    with window.override():
        bpy.ops.ed.undo_push(message="before")
        bpy.ops.ocean.use_sky(sky="GOLDEN_HOUR")
        bpy.ops.ed.undo_push(message="golden")
        bpy.ops.ocean.use_sky(sky="MOONLIT_NIGHT")
        bpy.ops.ed.undo_push(message="night")
        bpy.ops.ed.undo()
        scene = bpy.context.scene
        assert math.degrees(scene.ocean_tweak_sky.sun_elevation) == pytest.approx(6.0, abs=1e-4)
        assert sky_texture(scene).sun_elevation == pytest.approx(math.radians(6.0), abs=1e-5)
        assert list(lamps(scene)) == ["Ocean Sun"]
        bpy.ops.ed.undo()
        assert not lamps(bpy.context.scene)


def test_without_an_ocean_it_says_so(empty_scene):
    with pytest.raises(RuntimeError, match="no ocean in this scene"):
        bpy.ops.ocean.use_sky(sky="NOON")
    with pytest.raises(RuntimeError, match="no sky of Ocean Tweak"):
        bpy.ops.ocean.load_hdri(filepath="sky.hdr")


def test_other_suns_are_told(scene, capfd):
    scene.collection.objects.link(bpy.data.objects.new("Key", bpy.data.lights.new("Key", "SUN")))
    bpy.ops.ocean.use_sky(sky="NOON")
    assert "also lit by Key" in capfd.readouterr().out


def test_a_copy_of_the_sun_is_told(scene, capfd):
    bpy.ops.ocean.use_sky(sky="NOON")
    assert "also lit" not in capfd.readouterr().out
    twin = scene.objects["Ocean Sun"].copy()
    twin.data = twin.data.copy()
    scene.collection.objects.link(twin)
    bpy.ops.ocean.use_sky(sky="NOON")
    assert "also lit by Ocean Sun.001" in capfd.readouterr().out


def test_the_sun_of_a_former_file_goes_on(scene, ocean, extension):
    sun = bpy.data.objects.new("Ocean Sun", bpy.data.lights.new("Ocean Sun", "SUN"))
    scene.collection.objects.link(sun)
    extension("scene.water_material").light_by(ocean.active_material, sun)
    bpy.ops.ocean.use_sky(sky="NOON")
    assert list(lamps(scene).values()) == [sun]
    assert sun.data.energy > 5.0


@pytest.fixture
def hdri(tmp_path):
    """A panorama, 32 x 16, whose rows are brighter upwards and whose half towards +y is red."""
    image = bpy.data.images.new("Made", 32, 16, float_buffer=True)
    texels = np.zeros((16, 32, 4), np.float32)
    texels[..., 1] = np.linspace(0.0, 1.5, 16)[:, np.newaxis]
    texels[:, 8:24, 0] = 0.0
    texels[:, 4:12, 0] = 2.0
    image.pixels.foreach_set(texels.ravel())
    image.filepath_raw, image.file_format = str(tmp_path / "studio.hdr"), "HDR"
    image.save()
    bpy.data.images.remove(image)
    return tmp_path / "studio.hdr"


def is_panorama(scene):
    return any(node.type == "TEX_ENVIRONMENT" for node in scene.world.node_tree.nodes)


def test_a_panorama_takes_the_skys_place(scene, ocean, hdri):
    bpy.ops.ocean.use_sky(sky="NOON")
    before = haze_color(ocean)
    assert bpy.ops.ocean.load_hdri(filepath=str(hdri)) == {"FINISHED"}
    assert is_panorama(scene)
    assert scene.world.cycles.sampling_method == "AUTOMATIC"
    assert lamps(scene)["Ocean Sun"].data.energy == 0.0
    assert haze_color(ocean) != before
    bpy.ops.ocean.remove_hdri()
    assert not is_panorama(scene)
    assert scene.world.cycles.sampling_method == "MANUAL"
    assert lamps(scene)["Ocean Sun"].data.energy > 5.0
    assert haze_color(ocean) == pytest.approx(before)


@pytest.mark.parametrize("degrees", [0.0, 90.0, 180.0, -90.0])
def test_haze_takes_the_panoramas_horizon(sky, hdri, empty_scene, irradiance, degrees):
    """As Cycles shows it to a camera that looks there."""
    image = bpy.data.images.load(str(hdri))
    world = empty_scene.world = bpy.data.worlds.new("World")
    sky.sky_world.fill_with_image(world, image, 0.3, 1.5)
    found = sky.panorama.horizon(image, math.radians(degrees) - 0.3, 1.5)
    bpy.data.objects["Plane"].hide_render = True
    empty_scene.camera.rotation_euler = (math.radians(92.0), 0.0, math.radians(degrees - 90.0))
    empty_scene.camera.data.angle = math.radians(4.0)
    empty_scene.cycles.samples = 4
    seen = irradiance() / math.pi
    assert found == pytest.approx(seen, rel=0.1, abs=0.1)


@pytest.mark.parametrize(
    ("content", "told"),
    [
        (None, "studio2.hdr cannot be read"),
        (b"no picture", "is no Radiance (.hdr) or EXR image"),
        (b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 400000 +X 800000\n", "scale it to a width of at most"),
    ],
)  # fmt: skip
def test_a_panorama_is_measured_before_it_is_loaded(scene, tmp_path, content, told):
    path = tmp_path / "studio2.hdr"
    if content is not None:
        path.write_bytes(content)
    bpy.ops.ocean.use_sky(sky="NOON")
    with pytest.raises(RuntimeError) as refusal:
        bpy.ops.ocean.load_hdri(filepath=str(path))
    assert told in str(refusal.value)
    assert path.name not in bpy.data.images
    assert not is_panorama(scene)


def test_a_panorama_that_is_gone_is_told_and_the_rest_is_rendered(scene, hdri, tmp_path, caplog):
    bpy.ops.ocean.use_sky(sky="NOON")
    bpy.ops.ocean.load_hdri(filepath=str(hdri))
    file = tmp_path / "shot.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(file))
    hdri.rename(tmp_path / "away.hdr")
    with caplog.at_level(logging.WARNING):
        bpy.ops.wm.open_mainfile(filepath=str(file))
    scene = bpy.context.scene
    assert "studio.hdr cannot be read" in caplog.text
    assert "studio.hdr cannot be read" in scene.ocean_tweak_sky.error
    assert not is_panorama(scene)
    assert lamps(scene)["Ocean Sun"].data.energy > 5.0
    (tmp_path / "away.hdr").rename(hdri)
    bpy.ops.wm.open_mainfile(filepath=str(file))
    scene = bpy.context.scene
    assert is_panorama(scene)
    assert scene.ocean_tweak_sky.error == ""


def test_a_panorama_moves_with_its_project(scene, hdri, tmp_path):
    """Without the extension too: its image is then read by Blender alone."""
    project, moved = tmp_path / "project", tmp_path / "deep" / "moved"
    project.mkdir()
    moved.parent.mkdir()
    hdri = hdri.rename(project / hdri.name)
    bpy.ops.wm.save_as_mainfile(filepath=str(project / "shot.blend"))
    bpy.ops.ocean.use_sky(sky="NOON")
    bpy.ops.ocean.load_hdri(filepath=str(hdri))
    bpy.ops.wm.save_mainfile()
    assert scene.ocean_tweak_sky.hdri.filepath == "//studio.hdr"
    project.rename(moved)
    bpy.ops.wm.open_mainfile(filepath=str(moved / "shot.blend"))
    scene = bpy.context.scene
    assert is_panorama(scene)
    assert scene.ocean_tweak_sky.error == ""
