# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of a scene's sky, `Scene.ocean_tweak_sky`."""

from math import radians

import bpy
from bpy.props import BoolProperty, FloatProperty, PointerProperty, StringProperty

from ..scene import scene_sky
from .quiet import Quiet


def _changed(settings: bpy.types.PropertyGroup, _context: bpy.types.Context) -> None:
    if not settings.is_quiet:
        scene_sky.show(settings.id_data)


# no keys: what Blender plays back are the lamps and nodes that they set
_SHOWN = {"options": set(), "update": _changed}


def _angle(name: str, least: float, most: float, default: float, description: str) -> object:
    return FloatProperty(
        name=name, subtype="ANGLE", min=radians(least), max=radians(most), default=radians(default),
        precision=2, step=100, description=description, **_SHOWN,
    )  # fmt: skip


def _share(name: str, default: float, description: str) -> object:
    return FloatProperty(
        name=name, subtype="FACTOR", min=0.0, max=1.0, default=default, description=description, **_SHOWN
    )


class OCEAN_PG_sky(Quiet, bpy.types.PropertyGroup):
    """A scene's sky; see scene.scene_sky.SkySettings for what the scene needs of it."""

    __annotations__ = {
        "sun_elevation": _angle(
            "Sun Elevation", -90.0, 90.0, 34.0,
            "Height of the sun above the horizon. Below it, the moon lights the scene",
        ),
        "sun_azimuth": _angle(
            "Sun Direction", -360.0, 360.0, 165.0,
            "Direction in which the sun stands, counter-clockwise from the x axis",
        ),
        "moon_elevation": _angle(
            "Moon Elevation", -90.0, 90.0, 30.0,
            "Height of the moon above the horizon. It gives light where the sun has set",
        ),
        "moon_azimuth": _angle(
            "Moon Direction", -360.0, 360.0, 120.0,
            "Direction in which the moon stands, counter-clockwise from the x axis",
        ),
        "clouds": _share("Clouds", 0.35, "Part of the blue sky that fair-weather clouds cover"),
        "overcast": _share(
            "Overcast", 0.0, "From a clear sky to closed, torn cloud, which takes the sun's light"
        ),
        "sunlight": _share(
            "Sun Through Clouds", 0.0, "Part of the sun's light that comes through a break in closed cloud"
        ),
        "visibility": FloatProperty(
            name="Visibility (m)", min=100.0, max=1e6, soft_max=150e3, default=30e3, precision=0, step=10000,
            description="How far one sees in the air over the water: haze is denser where it is less",
            **_SHOWN,
        ),
        "use_exposure": BoolProperty(
            name="Set Exposure", default=False, **_SHOWN,
            description="Let the sky set the exposure of the scene's color management. On in scenes made by "
            "Ocean Tweak; any other scene keeps its own",
        ),
        "exposure": FloatProperty(
            name="Exposure", min=-10.0, max=16.0, soft_min=-3.0, soft_max=8.0, default=0.0,
            description="Exposure of the picture in stops, as in the scene's color management", **_SHOWN,
        ),
        "hdri": PointerProperty(
            name="HDRI", type=bpy.types.Image, **_SHOWN,
            description="A panorama in the place of this sky, its sun and its clouds",
        ),
        "hdri_rotation": _angle(
            "Rotation", -360.0, 360.0, 0.0, "Turns the panorama around the vertical axis, counter-clockwise"
        ),
        "hdri_strength": FloatProperty(
            name="Strength", min=0.0, soft_max=4.0, default=1.0,
            description="Multiplies the panorama's light", **_SHOWN,
        ),
        "error": StringProperty(options={"HIDDEN"}),
        "is_quiet": BoolProperty(options={"HIDDEN", "SKIP_SAVE"}),
    }  # fmt: skip


def register() -> None:
    """Give scenes a sky's settings."""
    bpy.types.Scene.ocean_tweak_sky = PointerProperty(type=OCEAN_PG_sky)


def unregister() -> None:
    """Take them back; the file keeps them."""
    del bpy.types.Scene.ocean_tweak_sky


CLASSES = (OCEAN_PG_sky,)
