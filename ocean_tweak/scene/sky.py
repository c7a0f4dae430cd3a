# SPDX-License-Identifier: GPL-3.0-or-later
"""Sky and sun: Blender's physical sky with clouds in it, up to the closed cloud of a storm."""

from __future__ import annotations

import math
from dataclasses import dataclass

import bpy
import numpy as np

from ..nodes.building import Socket
from ..nodes.shading import Shading
from ..nodes.versioned import lay_out

#: brings a sunlit white surface to about 1: the sky texture counts in units of its own
EXPOSURE = 0.055

#: what Blender's sky has, measured by rendering it: elevation in degrees, then linear red, green and blue.
#: The sun's irradiance on a surface that faces it, which a lamp gives in both engines, while the texture's
#: own disc is for Cycles alone; and the mean radiance just above the horizon, which haze takes
_SUN = np.array(
    [
        (0.0, 14.0, 2.0, 0.0), (2.0, 33.6, 10.5, 0.07), (5.0, 71.7, 36.5, 8.3), (10.0, 107.4, 71.7, 32.3),
        (15.0, 125.8, 93.0, 52.7), (20.0, 136.7, 106.4, 67.6), (30.0, 148.5, 121.7, 86.6),
        (45.0, 156.6, 132.7, 101.5), (60.0, 160.3, 137.9, 108.9), (90.0, 162.6, 141.0, 113.6),
    ]
)  # fmt: skip
_HORIZONS = {
    "MULTIPLE_SCATTERING": np.array(
        [
            (0.0, 5.0, 2.0, 0.5), (2.0, 7.6, 3.7, 1.25), (5.0, 12.6, 8.6, 4.0), (10.0, 15.3, 13.3, 9.0),
            (20.0, 14.5, 14.9, 13.0), (30.0, 13.9, 15.2, 14.4), (90.0, 14.1, 16.3, 16.7),
        ]
    ),
    "NISHITA": np.array(
        [
            (0.0, 3.4, 1.2, 0.1), (2.0, 5.1, 2.2, 0.19), (5.0, 9.0, 5.3, 1.35), (10.0, 11.2, 8.0, 3.4),
            (20.0, 9.7, 8.1, 4.8), (30.0, 7.8, 7.1, 4.9), (60.0, 5.2, 5.3, 4.25), (90.0, 4.5, 4.6, 3.8),
        ]
    ),
}  # fmt: skip

#: what a clear horizon's radiance is beside that mean, away from the sun and towards it, and how narrow that
#: is: measured at 25° and 60° to 75° from a sun 14° to 34° high
_AROUND_SUN = (0.65, 1.77, 6.0)

#: a closed cloud's radiance over sin(elevation): about three times as bright overhead as low down (Moon and
#: Spencer 1942), which makes foam as bright as the sky behind it; at the horizon it thins out
_OVERCAST = (
    (0.0, (0.30, 0.335, 0.36)), (0.05, (0.27, 0.305, 0.335)), (0.16, (0.16, 0.19, 0.22)),
    (0.42, (0.42, 0.47, 0.52)), (1.0, (0.92, 1.00, 1.07)),
)  # fmt: skip
#: light beneath its edge towards the sun: colour, strength and how narrow it is
_GLOW = (1.0, 0.90, 0.76)
_GLOWING, _GLOW_POWER = 1.8, 24.0


@dataclass(frozen=True)
class Sky:
    """A sky.

    sun_elevation, sun_azimuth : rad; the azimuth counter-clockwise from +x
    clouds : 0…1, of the blue sky that fair-weather clouds cover
    overcast : 0…1, from a sky with a sun to closed, torn cloud with light beneath its edge
    sunlight : 0…1, of the sun's light that comes through a break in closed cloud
    """

    sun_elevation: float
    sun_azimuth: float
    clouds: float = 0.35
    overcast: float = 0.0
    sunlight: float = 0.0

    @property
    def sun_irradiance(self) -> tuple[float, float, float]:
        """Red, green and blue on a surface that faces the sun, W/m² of Blender's."""
        share = max((1.0 - self.overcast) ** 2, self.sunlight)
        return _at(_SUN, self.sun_elevation, EXPOSURE * share)

    def haze(self, azimuth: float) -> tuple[float, float, float]:
        """Radiance of the air at the horizon, towards an azimuth in rad."""
        facing = max(math.cos(azimuth - self.sun_azimuth), 0.0)
        aside, towards, power = _AROUND_SUN
        around = aside + towards * facing**power
        # a horizon without clouds: they take some of its light
        clear = np.array(_at(_HORIZONS[_sky_type()], self.sun_elevation, EXPOSURE * around))
        cloud = np.array(_OVERCAST[0][1]) + _GLOWING * facing**_GLOW_POWER * np.array(_GLOW)
        return tuple(float(part) for part in clear + self.overcast * (cloud - clear))


def _at(table: np.ndarray, elevation: float, factor: float) -> tuple[float, float, float]:
    degrees = math.degrees(elevation)
    return tuple(factor * float(np.interp(degrees, table[:, 0], part)) for part in table.T[1:])


def _sky_type() -> str:
    """Blender's best model of a clear sky, which 5.0 renamed."""
    kinds = bpy.types.ShaderNodeTexSky.bl_rna.properties["sky_type"].enum_items.keys()
    return "MULTIPLE_SCATTERING" if "MULTIPLE_SCATTERING" in kinds else "NISHITA"


def new_world(name: str, sky: Sky) -> bpy.types.World:
    """A world with this sky. The sun is a lamp, see `new_sun`."""
    world = bpy.data.worlds.new(name)
    if world.node_tree is None:  # a world has nodes from the start since Blender 5.0
        world.use_nodes = True
    shade = Shading(world.node_tree)
    direction = shade.node("ShaderNodeTexCoord").outputs["Generated"]
    above = shade.math("MAXIMUM", shade.separate(direction)[2], 0.0)
    # what water mirrors lies above the horizon: rays that a bent normal sends below it see the horizon
    x, y, _ = shade.separate(direction)
    lifted = shade.combine(x, y, shade.math("MAXIMUM", above, 0.004))
    seen = _clear(shade, sky, lifted)
    if sky.clouds > 0.0:
        seen = _with_clouds(shade, sky, seen, direction, above)
    if sky.overcast > 0.0:
        seen = shade.mix_vectors(sky.overcast, seen, _overcast(shade, sky, direction, above))
    background = shade.node("ShaderNodeBackground", {"Color": seen, "Strength": 1.0})
    shown = shade.node("ShaderNodeOutputWorld")
    shade.tree.links.new(background.outputs[0], shown.inputs["Surface"])
    lay_out(shade.tree)
    return world


def new_sun(name: str, sky: Sky) -> bpy.types.Object:
    """A lamp with the sun's direction, colour, strength and size; in no collection yet."""
    light = bpy.data.lights.new(name, "SUN")
    irradiance = sky.sun_irradiance
    light.energy = max(irradiance)
    light.color = [part / light.energy if light.energy > 0.0 else 1.0 for part in irradiance]
    light.angle = math.radians(0.53)
    item = bpy.data.objects.new(name, light)
    item.rotation_euler = (0.5 * math.pi - sky.sun_elevation, 0.0, sky.sun_azimuth + 0.5 * math.pi)
    return item


def _clear(shade: Shading, sky: Sky, direction: Socket) -> Socket:
    texture = shade.node("ShaderNodeTexSky", sky_type=_sky_type())
    texture.sun_elevation = sky.sun_elevation
    texture.sun_rotation = 0.5 * math.pi - sky.sun_azimuth  # Blender's runs clockwise from +y
    texture.sun_disc = False
    shade.tree.links.new(direction, texture.inputs[0])
    return shade.scale(texture.outputs[0], EXPOSURE)


def _with_clouds(shade: Shading, sky: Sky, clear: Socket, direction: Socket, above: Socket) -> Socket:
    """Heaps of cloud on a plane overhead, lit by the sun from behind or before, lost in haze far away."""
    plane = _plane(shade, direction, above, 0.055)
    large = shade.noise(plane, 0.42, Detail=8.0, Roughness=0.55, Distortion=0.25)
    edge = 0.70 - 0.36 * sky.clouds
    mask = shade.smooth(large, edge, edge + 0.16)
    mask = shade.math("MULTIPLY", mask, shade.smooth(above, 0.005, 0.10))
    sunlit = np.array(_at(_SUN, sky.sun_elevation, EXPOSURE)) * 0.13
    facing = shade.number("DOT_PRODUCT", direction, _direction(sky))
    lit = shade.smooth(facing, -1.0, 1.0, 0.75, 1.15)
    dense = shade.smooth(large, edge + 0.04, edge + 0.34, 1.0, 0.45)  # the middle is thick, and dark beneath
    bright = shade.scale(tuple(float(part) for part in sunlit), shade.math("MULTIPLY", lit, dense))
    cloud = shade.vector("ADD", bright, shade.scale(clear, 0.45))
    return shade.mix_vectors(mask, clear, cloud)


def _overcast(shade: Shading, sky: Sky, direction: Socket, above: Socket) -> Socket:
    """A storm's layer of torn cloud, dark overhead, open at the horizon beneath the sun."""
    gradient = shade.ramp(above, _OVERCAST)
    plane = _plane(shade, direction, above, 0.09)
    large = shade.noise(plane, 0.55, Detail=7.0, Roughness=0.56, Distortion=0.35)
    contrast = shade.smooth(above, 0.0, 0.12, 0.35, 1.0)
    torn = shade.math("MULTIPLY_ADD", shade.smooth(large, 0.33, 0.67, -0.55, 0.60), contrast, 1.0)
    ragged = shade.noise(shade.vector("MULTIPLY", direction, (1.0, 1.0, 5.0)), 2.6, Detail=6.0, Roughness=0.6)
    edge = shade.math("ADD", above, shade.math("MULTIPLY_ADD", ragged, 0.16, -0.08))
    low = shade.smooth(edge, 0.05, 0.16, _GLOWING, 0.0)
    flat = (math.cos(sky.sun_azimuth), math.sin(sky.sun_azimuth), 0.0)
    facing = shade.math("MAXIMUM", shade.number("DOT_PRODUCT", direction, flat), 0.0)
    glow = shade.math("MULTIPLY", shade.math("POWER", facing, _GLOW_POWER), low)
    return shade.vector("ADD", shade.scale(gradient, torn), shade.scale(_GLOW, glow))


def _plane(shade: Shading, direction: Socket, above: Socket, bend: float) -> Socket:
    """Where a ray meets the layer of cloud; `bend` brings the horizon nearer, as the Earth's does."""
    x, y, _ = shade.separate(direction)
    away = shade.math("ADD", above, bend)
    return shade.combine(shade.math("DIVIDE", x, away), shade.math("DIVIDE", y, away))


def _direction(sky: Sky) -> tuple[float, float, float]:
    level = math.cos(sky.sun_elevation)
    return (
        level * math.cos(sky.sun_azimuth), level * math.sin(sky.sun_azimuth), math.sin(sky.sun_elevation)
    )  # fmt: skip
