# SPDX-License-Identifier: GPL-3.0-or-later
"""Imports USD files with Blender's own importer and saves what it shows: FIRST OUT.npz FRAMES NAME=FILE …

FIRST is the module that is imported first, bpy or pxr: both live in one process in either order.
"""

import importlib
import sys

import numpy as np

FIRST, OUT, FRAMES, *FILES = sys.argv[1:]
for name in (FIRST, "pxr.Usd", "bpy"):
    importlib.import_module(name)
bpy = sys.modules["bpy"]


def attribute(mesh, name):
    data = mesh.attributes[name].data
    vector = mesh.attributes[name].data_type == "FLOAT_VECTOR"
    values = np.empty(len(data) * (3 if vector else 1), np.float32)
    data.foreach_get("vector" if vector else "value", values)
    return values.reshape(-1, 3) if vector else values


def shown(scene, frame):
    """Every mesh that is shown at a frame, instances where there are any, and its matrix."""
    scene.frame_set(frame)
    instances = bpy.context.evaluated_depsgraph_get().object_instances
    found = [
        (instance.is_instance, np.array(instance.matrix_world), arrays(instance.object.data))
        for instance in instances
        if instance.object.type == "MESH"
    ]
    return [rest for is_instance, *rest in found if is_instance or not any(first for first, *_ in found)]


def arrays(mesh):
    """What stands at its vertices; read at once, for the next instance takes its place."""
    found = {"points": attribute(mesh, "position").astype(np.float64)}
    for name in ("foam", "cusp", "velocity"):
        if name in mesh.attributes:
            found[name] = attribute(mesh, name)
    uv = np.empty(2 * len(mesh.loops), np.float32)
    mesh.uv_layers[0].uv.foreach_get("vector", uv)
    corners = np.empty(len(mesh.loops), np.int32)
    mesh.attributes[".corner_vert"].data.foreach_get("value", corners)
    found["st"] = np.zeros((len(found["points"]), 2), np.float32)
    found["st"][corners] = uv.reshape(-1, 2)
    found["materials"] = np.array([material.name for material in mesh.materials if material])
    return found


def read(path):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    bpy.ops.wm.usd_import(
        filepath=path, set_frame_range=True, read_mesh_attributes=True, read_mesh_uvs=True,
        support_scene_instancing=True,
    )  # fmt: skip
    found = {"range": [scene.frame_start, scene.frame_end]}
    for frame in map(int, FRAMES.split(",")):
        for number, (matrix, values) in enumerate(shown(scene, frame)):
            values["points"] = values["points"] @ matrix[:3, :3].T + matrix[:3, 3]
            found.update({f"{frame}.{number}.{name}": value for name, value in values.items()})
    return found


if __name__ == "__main__":
    results = {}
    for argument in FILES:
        key, _, file = argument.partition("=")
        results.update({f"{key}.{name}": values for name, values in read(file).items()})
    np.savez(OUT, **results)
