# SPDX-License-Identifier: GPL-3.0-or-later
"""Values of a material that follow the scene: its seconds, its camera's pixels and a lamp.

Expressions as simple as these are evaluated without Python, and therefore also in untrusted files.
"""

from __future__ import annotations

from collections.abc import Mapping

import bpy

#: where a driver reads: an object or light and a path from it, or a path from the scene with the value for a
#: scene in which it leads nowhere
Source = tuple[bpy.types.ID, str] | tuple[None, str, float]


def follow_seconds(value: bpy.types.NodeSocket) -> None:
    """Let a number be the scene's seconds."""
    sources: dict[str, Source] = {
        "rate": (None, "render.fps", 24.0), "base": (None, "render.fps_base", 1.0),
    }  # fmt: skip
    _drive(value, "frame * base / rate", sources)


def follow_pixel_angle(value: bpy.types.NodeSocket) -> None:
    """Let a number be the angle that a pixel of the scene's camera sees, in rad."""
    sources: dict[str, Source] = {
        "sensor": (None, "camera.data.sensor_width", 36.0), "lens": (None, "camera.data.lens", 50.0),
        "width": (None, "render.resolution_x", 1920.0),
        "percent": (None, "render.resolution_percentage", 100.0),
    }  # fmt: skip
    _drive(value, "sensor / lens / (width * percent / 100)", sources)


def follow_lamp(
    direction: bpy.types.ShaderNodeCombineXYZ, light: bpy.types.ShaderNodeCombineXYZ, lamp: bpy.types.Object
) -> None:
    """Let two vectors be where a lamp's light comes from, in the world, and its red, green and blue."""
    for axis in range(3):
        _drive(direction.inputs[axis], "part", {"part": (lamp, f"matrix_world[2][{axis}]")})
        sources: dict[str, Source] = {
            "energy": (lamp.data, "energy"), "part": (lamp.data, f"color[{axis}]"),
        }  # fmt: skip
        _drive(light.inputs[axis], "energy * part", sources)


def lamp_of(direction: bpy.types.ShaderNodeCombineXYZ) -> bpy.types.Object | None:
    """The lamp that a vector follows; None where it follows none."""
    tree = direction.id_data
    path = direction.inputs[0].path_from_id("default_value")
    curves = tree.animation_data.drivers if tree.animation_data is not None else ()
    curve = next((curve for curve in curves if curve.data_path == path), None)
    variables = curve.driver.variables if curve is not None else ()
    return next((variable.targets[0].id for variable in variables), None)


def _drive(value: bpy.types.NodeSocket, expression: str, sources: Mapping[str, Source]) -> None:
    value.driver_remove("default_value")
    driver = value.driver_add("default_value").driver
    for name, (owner, path, *otherwise) in sources.items():
        variable = driver.variables.new()
        variable.name, variable.type = name, "CONTEXT_PROP" if owner is None else "SINGLE_PROP"
        target = variable.targets[0]
        if owner is None:
            target.context_property = "ACTIVE_SCENE"
            target.use_fallback_value, target.fallback_value = True, otherwise[0]
        else:
            target.id_type, target.id = owner.id_type, owner
        target.data_path = path
    driver.expression = expression
