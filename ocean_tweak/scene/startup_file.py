# SPDX-License-Identifier: GPL-3.0-or-later
"""The default objects of Blender's start-up file: a cube, a light and a camera."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial

import bpy

#: name → type, location, and rotation in rad, the same in all versions that are supported
_OBJECTS = {
    "Cube": ("MESH", (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)),
    "Light": ("LIGHT", (4.07625, 1.00545, 5.90386), (0.650328, 0.055217, 1.866391)),
    "Camera": ("CAMERA", (7.358891, -6.925791, 4.958309), (1.109319, 0.0, 0.814928)),
}
_CAMERA = {"lens": 50.0, "sensor_width": 36.0, "shift_x": 0.0, "shift_y": 0.0, "clip_end": 100.0}
_LIGHT = {"energy": 1000.0, "shadow_soft_size": 0.1}
_SURFACE = {"Metallic": 0.0, "Roughness": 0.5, "Alpha": 1.0, "Emission Strength": 0.0}
_CLOSE = 1e-4


def untouched_objects(scene: bpy.types.Scene) -> list[bpy.types.Object]:
    """The objects of a scene in which there are only those of the start-up file, as they were; else none."""
    objects = list(scene.objects)
    return objects if all(_is_untouched(item) for item in objects) else []


def remove(objects: Iterable[bpy.types.Object]) -> None:
    """Take objects out of the file, and of what they are made of all that nothing else uses."""
    for item in objects:
        parts = [item.data, *(slot.material for slot in item.material_slots)]
        bpy.data.objects.remove(item)
        for part in parts:
            if part.users == 0:
                bpy.data.batch_remove([part])


def _is_untouched(item: bpy.types.Object) -> bool:
    if item.name not in _OBJECTS or item.library is not None or item.override_library is not None:
        return False
    kind, location, rotation = _OBJECTS[item.name]
    return (
        item.type == kind
        and _is_close(item.location, location)
        and _is_close(item.rotation_euler, rotation)
        and _is_close(item.scale, (1.0, 1.0, 1.0))
        and len(item.users_scene) == 1
        and not any((item.parent, item.children, item.modifiers, item.constraints, item.animation_data))
        and not (item.hide_render or item.hide_viewport)
        and item.data.animation_data is None
        and item.data.users == 1
        and _OF_DATA[kind](item)
    )


def _is_cube(item: bpy.types.Object) -> bool:
    mesh = item.data
    corners = {tuple(round(part, 4) for part in vertex.co) for vertex in mesh.vertices}
    return (
        (len(mesh.vertices), len(mesh.polygons)) == (8, 6)
        and len(corners) == 8
        and all(abs(part) == 1.0 for corner in corners for part in corner)
        and mesh.shape_keys is None
        and not item.vertex_groups
        and [slot.material and _is_plain(slot.material) for slot in item.material_slots] == [True]
    )


def _is_plain(material: bpy.types.Material) -> bool:
    nodes = {node.type: node for node in material.node_tree.nodes} if material.node_tree else {}
    if material.name != "Material" or nodes.keys() != {"OUTPUT_MATERIAL", "BSDF_PRINCIPLED"}:
        return False
    values = {socket.name: socket.default_value for socket in nodes["BSDF_PRINCIPLED"].inputs}
    return _is_close(values["Base Color"][:3], (0.8, 0.8, 0.8)) and _has(values.__getitem__, _SURFACE)


def _is_camera(item: bpy.types.Object) -> bool:
    camera = item.data
    is_plain = camera.type == "PERSP" and not camera.dof.use_dof and not camera.background_images
    return is_plain and _has(partial(getattr, camera), _CAMERA)


def _is_light(item: bpy.types.Object) -> bool:
    light = item.data
    is_plain = light.type == "POINT" and _is_close(light.color, (1.0, 1.0, 1.0))
    return is_plain and _has(partial(getattr, light), _LIGHT)


_OF_DATA: dict[str, Callable[[bpy.types.Object], bool]] = {
    "MESH": _is_cube,
    "LIGHT": _is_light,
    "CAMERA": _is_camera,
}


def _has(value_of: Callable[[str], float], wanted: dict[str, float]) -> bool:
    return _is_close(map(value_of, wanted), wanted.values())


def _is_close(found: Iterable[float], wanted: Iterable[float]) -> bool:
    return all(abs(a - b) < _CLOSE for a, b in zip(found, wanted, strict=True))
