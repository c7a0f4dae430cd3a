# SPDX-License-Identifier: GPL-3.0-or-later
"""The sky of a scene: its settings, and the world, lamps, haze and exposure that show them.

The settings are the scene's, `Scene.ocean_tweak_sky`. What shows them are plain nodes and lamps, which need
no extension. Each change makes the world's nodes anew: settings are the one place of the truth.
"""

from __future__ import annotations

import logging
import math
from collections.abc import Iterator
from contextlib import AbstractContextManager
from dataclasses import fields
from typing import Protocol

import bpy

from . import panorama, spray, water_material
from .panorama import PanoramaError
from .settings import oceans_in
from .skies import SKIES, VIEW
from .sky import Colour, Sky
from .sky_world import fill, fill_with_image, new_world, set_lamp

_log = logging.getLogger(__name__)

#: custom property of worlds and lamps that are a scene's sky
_MARK = "ocean_tweak_sky"
_SUN, _MOON = "SUN", "MOON"
_NAMES = {_SUN: "Ocean Sun", _MOON: "Ocean Moon"}


class SkySettings(Protocol):
    """Settings of a scene's sky: a field for each of `Sky`, and these.

    use_exposure : whether the scene's own exposure follows
    hdri : a panorama in the sky's place
    hdri_rotation : counter-clockwise, rad
    hdri_strength : factor on its light
    error : why the panorama is not shown; "" where it is, or where there is none
    """

    use_exposure: bool
    hdri: bpy.types.Image | None
    hdri_rotation: float
    hdri_strength: float
    error: str

    def quiet(self) -> AbstractContextManager[None]:
        """While this is open, a changed property shows nothing."""


def settings_of(scene: bpy.types.Scene) -> SkySettings:
    """The settings of a scene's sky."""
    return scene.ocean_tweak_sky


def sky_of(scene: bpy.types.Scene) -> Sky:
    """The sky that a scene's settings say."""
    settings = settings_of(scene)
    return Sky(**{field.name: getattr(settings, field.name) for field in fields(Sky)})


def has_sky(scene: bpy.types.Scene) -> bool:
    """Whether the scene's world is a sky of ours, which follows the settings."""
    world = scene.world
    return world is not None and world.library is None and _MARK in world


def keep_world(scene: bpy.types.Scene) -> None:
    """Let the file keep a world of the artist's own that is about to be replaced."""
    world = scene.world
    if world is not None and world.library is None and not has_sky(scene):
        world.use_fake_user = True


def put(
    scene: bpy.types.Scene,
    sky: Sky,
    view: float | None = None,
    name: str = "",
    collection: bpy.types.Collection | None = None,
) -> None:
    """Give a scene a sky, whatever it had: settings, world, lamps, haze and, if it follows, exposure.

    view : where the camera looks, rad counter-clockwise from +x; by default where the scene's does
    name : of the world; by default that of a sky stays
    collection : of new lamps
    """
    settings = settings_of(scene)
    with settings.quiet():
        settings.hdri = None
        for field in fields(Sky):
            setattr(settings, field.name, getattr(sky, field.name))
    if not has_sky(scene):
        scene.world = new_world(name or "Sky", sky)
        scene.world[_MARK] = True
    elif name:
        scene.world.name = name
    show(scene, view, collection)


def preset_sky(key: str, scene: bpy.types.Scene) -> Sky:
    """A sky of SKIES, as the scene's camera sees it."""
    return SKIES[key].sky.turned(view_of(scene) - VIEW)


def show(
    scene: bpy.types.Scene, view: float | None = None, collection: bpy.types.Collection | None = None
) -> None:
    """Let a scene that has a sky look as its settings say, and with it those that have its world, as its
    linked copies do; one with another world stays as it is."""
    if not has_sky(scene):
        return
    settings, sky = settings_of(scene), sky_of(scene)
    image = _usable(scene)
    if image is None:
        fill(scene.world, sky)
    else:
        fill_with_image(scene.world, image, settings.hdri_rotation, settings.hdri_strength)
    copies = _copies(scene)
    for copy in copies:
        _tell(copy, scene)
        _light(copy, image, view_of(copy))
    # last: copies may share water that looks as this scene's camera sees it
    _light(scene, image, view_of(scene) if view is None else view, collection)


def _light(
    scene: bpy.types.Scene,
    image: bpy.types.Image | None,
    view: float,
    collection: bpy.types.Collection | None = None,
) -> None:
    """Set a scene's lamps, the air over its water and, if it follows, its exposure by its settings.

    image : a panorama in the sky's place
    view : where the camera looks, rad
    """
    settings, sky = settings_of(scene), sky_of(scene)
    haze, lights = sky.haze(view), (sky.sun_irradiance, sky.moon_irradiance)
    if image is not None:  # which has its own sun
        haze = panorama.horizon(image, view - settings.hdri_rotation, settings.hdri_strength)
        lights = None, None
    sun = _lamp(scene, _SUN, lights[0], sky.sun_elevation, sky.sun_azimuth, collection)
    moon = _lamp(scene, _MOON, lights[1], sky.moon_elevation, sky.moon_azimuth, collection)
    brighter = moon if moon is not None and (sun is None or moon.data.energy > sun.data.energy) else sun
    for material in _waters(scene):
        water_material.set_air(material, sky.visibility, haze)
        if brighter is not None:
            water_material.light_by(material, brighter)
    for ocean in oceans_in(scene):
        spray.put_in_air(ocean)
    if settings.use_exposure:
        scene.view_settings.exposure = sky.exposure


def _copies(scene: bpy.types.Scene) -> list[bpy.types.Scene]:
    """Other scenes with a scene's world."""
    return [
        each for each in bpy.data.scenes if each != scene and each.world == scene.world and each.is_editable
    ]


def _tell(copy: bpy.types.Scene, scene: bpy.types.Scene) -> None:
    """Let a scene with another's world have that scene's settings."""
    own, others = settings_of(copy), settings_of(scene)
    names = [field.name for field in fields(Sky)] + ["hdri", "hdri_rotation", "hdri_strength", "error"]
    with own.quiet():
        for name in names:
            setattr(own, name, getattr(others, name))


def look_for_panoramas() -> None:
    """A file was opened, or a render begins: panoramas that are gone, or there again, show it."""
    for scene in bpy.data.scenes:
        if scene.library is None and settings_of(scene).hdri is not None:
            show(scene)


def view_of(scene: bpy.types.Scene) -> float:
    """Where a scene's camera looks, rad counter-clockwise from +x; along +y where it has none."""
    if scene.camera is None:
        return VIEW
    forward = -scene.camera.matrix_world.col[2]
    level = math.hypot(forward[0], forward[1])
    return math.atan2(forward[1], forward[0]) if level > 1e-3 else VIEW


def other_suns(scene: bpy.types.Scene) -> list[str]:
    """Names of sun lamps in a scene that do not follow its sky, such as copies of its sun."""
    own = [_marked(scene, role) for role in _NAMES]
    return [
        item.name
        for item in scene.objects
        if item.type == "LIGHT" and item.data.type == "SUN" and item not in own and not item.hide_render
    ]


def _marked(scene: bpy.types.Scene, role: str) -> bpy.types.Object | None:
    """The lamp that is a scene's sun or moon."""
    return next((item for item in scene.objects if item.get(_MARK) == role), None)


def _usable(scene: bpy.types.Scene) -> bpy.types.Image | None:
    """The panorama of a scene, if there is one that can be shown; says why not, once a reason."""
    settings = settings_of(scene)
    before, error, image = settings.error, "", settings.hdri
    if image is not None:
        try:
            panorama.check_image(image)
        except PanoramaError as refusal:
            error, image = str(refusal), None
    if error != before:
        settings.error = error
    if error:
        _log.warning("%s: %s; the sky of the settings is shown", scene.name, error)
    return image


def _lamp(
    scene: bpy.types.Scene,
    role: str,
    irradiance: Colour | None,
    elevation: float,
    azimuth: float,
    collection: bpy.types.Collection | None,
) -> bpy.types.Object | None:
    """The scene's sun or moon, made where it has to shine and there is none."""
    light = irradiance or (0.0, 0.0, 0.0)
    item = _marked(scene, role) or (_former_sun(scene) if role == _SUN else None)
    if item is None:
        if max(light) <= 0.0:
            return None
        name = _NAMES[role]
        item = bpy.data.objects.new(name, bpy.data.lights.new(name, "SUN"))
        (collection or scene.collection).objects.link(item)
    item[_MARK] = role
    set_lamp(item, light, elevation, azimuth)
    return item


def _former_sun(scene: bpy.types.Scene) -> bpy.types.Object | None:
    """The lamp that lights the crests of the scene's water, from before lamps were marked."""
    suns = (water_material.sun_of(material) for material in _waters(scene))
    return next(
        (sun for sun in suns if sun is not None and sun.name in scene.objects and _MARK not in sun), None
    )


def _waters(scene: bpy.types.Scene) -> Iterator[bpy.types.Material]:
    """The water materials of a scene's oceans, each once."""
    slots = (slot.material for ocean in oceans_in(scene) for slot in ocean.material_slots)
    for material in dict.fromkeys(slots):
        if (
            material is not None
            and material.library is None
            and water_material.water_node(material) is not None
        ):
            yield material
