# SPDX-License-Identifier: GPL-3.0-or-later
"""Sky, sun and moon as plain Blender data: a world's nodes and two lamps.

The clear sky is Blender's physical one. That of 5.x scatters light many times, that of 4.5 once: here it gets
what it lacks, so that both have the same light.
"""

from __future__ import annotations

import math

import bpy
import numpy as np

from ..nodes.building import Socket
from ..nodes.shading import Shading
from ..nodes.versioned import lay_out
from .sky import CLOUD_HORIZON, EXPOSURE, GLOW_POWER, GLOWING, SUN, Colour, Sky, at

#: radiance at the horizon of light that was scattered more than once, in units of the texture: the sun's
#: elevation in degrees, then linear red, green and blue, in the mean over all directions. Measured as the
#: difference of MULTIPLE_SCATTERING in 5.2 and NISHITA in 4.5, of which one product per colour is fitted
_SCATTERED = np.array(
    [
        (-12.0, 0.0, 0.0, 0.02), (-9.0, 0.01, 0.02, 0.05), (-6.0, 0.01, 0.05, 0.12), (-4.0, 0.05, 0.07, 0.20),
        (-2.0, 0.32, 0.14, 0.36), (0.0, 1.55, 0.49, 0.70), (2.0, 2.27, 1.05, 1.32), (5.0, 2.85, 2.28, 2.69),
        (10.0, 2.88, 4.18, 5.09), (20.0, 3.41, 6.32, 7.62), (30.0, 5.62, 8.13, 9.17),
        (45.0, 9.21, 10.6, 11.09), (60.0, 12.19, 12.49, 12.55), (90.0, 15.26, 14.05, 13.78),
    ]
)  # fmt: skip
#: how much of it is seen above the horizon: sine of the elevation, share of red, green and blue
_SEEN_SCATTERED = (
    (0.009, (1.0, 1.0, 1.0)), (0.026, (0.81, 0.93, 0.99)), (0.061, (0.50, 0.735, 0.92)),
    (0.096, (0.336, 0.584, 0.84)), (0.148, (0.206, 0.434, 0.722)), (0.25, (0.107, 0.282, 0.551)),
    (0.431, (0.0475, 0.171, 0.385)), (0.713, (0.0086, 0.101, 0.261)), (1.0, (0.0, 0.061, 0.22)),
)  # fmt: skip

#: a closed cloud's radiance over sin(elevation): about three times as bright overhead as low down (Moon and
#: Spencer 1942), which makes foam as bright as the sky behind it
_OVERCAST = (
    (0.0, CLOUD_HORIZON), (0.05, (0.27, 0.305, 0.335)), (0.16, (0.16, 0.19, 0.22)),
    (0.42, (0.42, 0.47, 0.52)), (1.0, (0.92, 1.00, 1.07)),
)  # fmt: skip

#: of sun and moon, both half a degree wide
_WIDTH = math.radians(0.53)
#: radiance of a disc over its light on a surface: far below the true one, bright enough to be white
_DISC = 40.0
#: of light on a cloud, what comes back
_CLOUD = 0.13
#: columns of the map by which Cycles samples a sky. The discs are not in it, so a third of a degree is fine
#: enough; Cycles' own choice of 4096 takes seconds of each render, for light that is the same to 1e-5
_MAP = 1024


def has_multiple_scattering() -> bool:
    """Whether this Blender's sky texture scatters light more than once."""
    kinds = bpy.types.ShaderNodeTexSky.bl_rna.properties["sky_type"].enum_items
    return kinds.get("MULTIPLE_SCATTERING") is not None


def new_world(name: str, sky: Sky) -> bpy.types.World:
    """A world with this sky. Sun and moon are lamps, see `set_lamp`."""
    world = bpy.data.worlds.new(name)
    fill(world, sky)
    return world


def fill(world: bpy.types.World, sky: Sky) -> None:
    """Make the nodes of a world anew, for this sky."""
    shade = _emptied(world)
    direction = shade.node("ShaderNodeTexCoord").outputs["Generated"]
    above = shade.math("MAXIMUM", shade.separate(direction)[2], 0.0)
    # what water mirrors lies above the horizon: rays that a bent normal sends below it see the horizon
    x, y, _ = shade.separate(direction)
    lifted = shade.combine(x, y, shade.math("MAXIMUM", above, 0.004))
    seen = _clear(shade, lifted, above, sky.sun_elevation, sky.sun_azimuth)
    if sky.night > 0.0:
        moonlit = _clear(shade, lifted, above, sky.moon_elevation, sky.moon_azimuth)
        seen = shade.vector("MULTIPLY_ADD", moonlit, sky.moonlight, seen)
    mask = None
    if sky.clouds > 0.0:
        seen, mask = _with_clouds(shade, sky, seen, direction, above)
    seen = _with_discs(shade, sky, seen, direction, mask)
    if sky.overcast > 0.0:
        seen = shade.mix_vectors(sky.overcast, seen, _overcast(shade, sky, direction, above))
    _show(shade, seen, 1.0)
    world.cycles.sampling_method, world.cycles.sample_map_resolution = "MANUAL", _MAP


def fill_with_image(world: bpy.types.World, image: bpy.types.Image, turn: float, strength: float) -> None:
    """Make the nodes of a world anew, for a panorama of a sky.

    turn : counter-clockwise, rad
    """
    shade = _emptied(world)
    direction = shade.node("ShaderNodeTexCoord").outputs["Generated"]
    turned = shade.node(
        "ShaderNodeVectorRotate", {"Vector": direction, "Angle": -turn}, rotation_type="Z_AXIS"
    )
    panorama = shade.node("ShaderNodeTexEnvironment", {"Vector": turned.outputs[0]}, image=image)
    _show(shade, panorama.outputs[0], strength)
    world.cycles.sampling_method = "AUTOMATIC"  # as fine as the image


def set_lamp(item: bpy.types.Object, irradiance: Colour, elevation: float, azimuth: float) -> None:
    """Give a sun lamp a direction, colour and strength, and the size of sun and moon."""
    light = item.data
    light.energy = max(irradiance)
    light.color = [part / light.energy if light.energy > 0.0 else 1.0 for part in irradiance]
    light.angle = _WIDTH
    item.rotation_euler = (0.5 * math.pi - elevation, 0.0, azimuth + 0.5 * math.pi)


def _emptied(world: bpy.types.World) -> Shading:
    if world.node_tree is None:  # a world has nodes from the start since Blender 5.0
        world.use_nodes = True
    return Shading(world.node_tree)


def _show(shade: Shading, seen: Socket, strength: float) -> None:
    background = shade.node("ShaderNodeBackground", {"Color": seen, "Strength": strength})
    shown = shade.node("ShaderNodeOutputWorld")
    shade.tree.links.new(background.outputs[0], shown.inputs["Surface"])
    lay_out(shade.tree)


def _clear(shade: Shading, direction: Socket, above: Socket, elevation: float, azimuth: float) -> Socket:
    """The cloudless sky with the sun, or a moon, at an elevation and azimuth in rad."""
    kind = "MULTIPLE_SCATTERING" if has_multiple_scattering() else "NISHITA"
    texture = shade.node("ShaderNodeTexSky", sky_type=kind)
    texture.sun_elevation = elevation
    texture.sun_rotation = 0.5 * math.pi - azimuth  # Blender's runs clockwise from +y
    texture.sun_disc = False
    shade.tree.links.new(direction, texture.inputs[0])
    seen = shade.scale(texture.outputs[0], EXPOSURE)
    if not has_multiple_scattering():
        shares = shade.ramp(above, _SEEN_SCATTERED, "LINEAR")
        seen = shade.vector("MULTIPLY_ADD", shares, at(_SCATTERED, elevation, EXPOSURE), seen)
    return seen


def _with_clouds(
    shade: Shading, sky: Sky, clear: Socket, direction: Socket, above: Socket
) -> tuple[Socket, Socket]:
    """Heaps of cloud on a plane overhead, lit by the sun from behind or before, lost in haze far away.

    Returns the sky with them, and how much of it they cover.
    """
    plane = _plane(shade, direction, above, 0.055)
    large = shade.noise(plane, 0.42, Detail=8.0, Roughness=0.55, Distortion=0.25)
    edge = 0.70 - 0.36 * sky.clouds
    mask = shade.smooth(large, edge, edge + 0.16)
    mask = shade.math("MULTIPLY", mask, shade.smooth(above, 0.005, 0.10))
    dense = shade.smooth(large, edge + 0.04, edge + 0.34, 1.0, 0.45)  # the middle is thick, and dark beneath
    cloud = shade.scale(clear, 0.45)
    sun, moon = at(SUN, sky.sun_elevation, EXPOSURE), at(SUN, sky.moon_elevation, EXPOSURE)
    moonlit = tuple(part * share for part, share in zip(moon, sky.moonlight, strict=True))
    for light, towards in (
        (sun, _direction(sky.sun_elevation, sky.sun_azimuth)),
        (moonlit, _direction(sky.moon_elevation, sky.moon_azimuth)),
    ):
        if max(light) > 0.0:
            facing = shade.number("DOT_PRODUCT", direction, towards)
            lit = shade.math("MULTIPLY", shade.smooth(facing, -1.0, 1.0, 0.75, 1.15), dense)
            cloud = shade.vector("ADD", shade.scale(tuple(_CLOUD * part for part in light), lit), cloud)
    return shade.mix_vectors(mask, clear, cloud), mask


def _with_discs(shade: Shading, sky: Sky, seen: Socket, direction: Socket, mask: Socket | None) -> Socket:
    """The sun and the moon themselves, for the camera alone: elsewhere the lamps are their light."""
    discs = (
        (sky.sun_irradiance, sky.sun_elevation, sky.sun_azimuth),
        (sky.moon_irradiance, sky.moon_elevation, sky.moon_azimuth),
    )
    for light, elevation, azimuth in discs:
        if max(light) > 0.0:
            away = shade.number("DISTANCE", direction, _direction(elevation, azimuth))
            disc = shade.math("LESS_THAN", away, 0.5 * _WIDTH)
            looks = shade.math("MULTIPLY", disc, shade.node("ShaderNodeLightPath").outputs["Is Camera Ray"])
            if mask is not None:
                looks = shade.math("MULTIPLY", looks, shade.smooth(mask, 0.0, 1.0, 1.0, 0.0))
            seen = shade.vector("ADD", shade.scale(tuple(_DISC * part for part in light), looks), seen)
    return seen


def _overcast(shade: Shading, sky: Sky, direction: Socket, above: Socket) -> Socket:
    """A storm's layer of torn cloud, dark overhead, open at the horizon beneath the sun."""
    gradient = shade.vector("MULTIPLY", shade.ramp(above, _OVERCAST), sky.cloud_light)
    plane = _plane(shade, direction, above, 0.09)
    large = shade.noise(plane, 0.55, Detail=7.0, Roughness=0.56, Distortion=0.35)
    contrast = shade.smooth(above, 0.0, 0.12, 0.35, 1.0)
    torn = shade.math("MULTIPLY_ADD", shade.smooth(large, 0.33, 0.67, -0.55, 0.60), contrast, 1.0)
    ragged = shade.noise(shade.vector("MULTIPLY", direction, (1.0, 1.0, 5.0)), 2.6, Detail=6.0, Roughness=0.6)
    edge = shade.math("ADD", above, shade.math("MULTIPLY_ADD", ragged, 0.16, -0.08))
    low = shade.smooth(edge, 0.05, 0.16, GLOWING, 0.0)
    facing = shade.number("DOT_PRODUCT", direction, _direction(0.0, sky.sun_azimuth))
    near = shade.math("POWER", shade.math("MAXIMUM", facing, 0.0), GLOW_POWER)
    glow = shade.scale(sky.glow, shade.math("MULTIPLY", near, low))
    return shade.vector("ADD", shade.scale(gradient, torn), glow)


def _plane(shade: Shading, direction: Socket, above: Socket, bend: float) -> Socket:
    """Where a ray meets the layer of cloud; `bend` brings the horizon nearer, as the Earth's does."""
    x, y, _ = shade.separate(direction)
    away = shade.math("ADD", above, bend)
    return shade.combine(shade.math("DIVIDE", x, away), shade.math("DIVIDE", y, away))


def _direction(elevation: float, azimuth: float) -> Colour:
    level = math.cos(elevation)
    return level * math.cos(azimuth), level * math.sin(azimuth), math.sin(elevation)
