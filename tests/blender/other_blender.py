# SPDX-License-Identifier: GPL-3.0-or-later
"""Opens a file in a Blender that has not the extension and keeps what it shows: a script of its own.

FILE.blend OUT.npz NAMES FRAMES: of each of these objects, vertices and warnings at each frame, in the
viewport and, where it is rendered, in a render.
"""

import json
import subprocess
import sys
from pathlib import Path

import bpy
import numpy as np


def look(blend, names, frames, out):
    """Open the file in a Blender of its own. Returns what was kept, and what it said.

    out : folder for what is kept
    """
    said = run_script(
        Path(__file__), str(blend), str(out / "seen.npz"), json.dumps(names), json.dumps(frames)
    )
    assert said.returncode == 0, said.stdout + said.stderr
    with np.load(out / "seen.npz") as kept:
        return {key: kept[key] for key in kept}, said.stdout + said.stderr


def run_script(script, *arguments, blend=None):
    """Run a script in a Blender like this one that has not the extension, in a file where one is given."""
    given = [] if blend is None else [str(blend)]
    program = [sys.executable, "-c", OPEN_AND_RUN, str(script), *given, "--"]
    if bpy.app.binary_path:
        program = [
            bpy.app.binary_path, "--background", "--factory-startup", *given, "--python-exit-code", "1",
            "--python", str(script), "--",
        ]  # fmt: skip
    return subprocess.run([*program, *arguments], capture_output=True, text=True, timeout=300)


#: as a Blender would; bpy 4.5 may hang at the end of a process that has rendered
OPEN_AND_RUN = """
import os, runpy, sys
import bpy
script, *given = sys.argv[1 : sys.argv.index("--")]
for blend in given:
    bpy.ops.wm.open_mainfile(filepath=blend)
code = 0
try:
    runpy.run_path(script, run_name="__main__")
except SystemExit as end:
    code = end.code
sys.stdout.flush()
sys.stderr.flush()
os._exit(code)
"""


meshes = {}


class Probe(bpy.types.RenderEngine):
    """An engine that keeps the vertices it is given, by the names of the objects."""

    bl_idname, bl_label = "OCEAN_TEST_PROBE", "Probe"

    def render(self, depsgraph):
        """Keep the vertices of all meshes, and of those that only nodes read."""
        for item in depsgraph.objects:
            if item.type == "MESH":
                meshes[item.name] = vertices(item.data)


def vertices(mesh):
    flat = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.attributes["position"].data.foreach_get("vector", flat)
    return flat.reshape(-1, 3)


def main(blend, out, names, frames):
    bpy.ops.wm.open_mainfile(filepath=blend)
    assert not hasattr(bpy.types.Object, "ocean_tweak"), "this Blender has the extension"
    scene, kept = bpy.context.scene, {}
    if scene.camera is None:
        scene.camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
        scene.collection.objects.link(scene.camera)
    bpy.utils.register_class(Probe)
    scene.render.engine = Probe.bl_idname
    scene.render.resolution_x = scene.render.resolution_y = 8
    for frame in json.loads(frames):
        scene.frame_set(frame)
        depsgraph = bpy.context.evaluated_depsgraph_get()
        for name in json.loads(names):
            item = bpy.data.objects[name]
            kept[f"{name} viewport {frame}"] = vertices(item.evaluated_get(depsgraph).data)
            warnings = [warning.message for each in item.modifiers if each.type == "NODES"
                        for warning in each.node_warnings]  # fmt: skip
            kept[f"{name} warnings {frame}"] = np.array(warnings, dtype=str)
        bpy.ops.render.render()
        kept |= {f"{name} render {frame}": meshes[name] for name in json.loads(names) if name in meshes}
    np.savez(out, **kept)
    bpy.utils.unregister_class(Probe)  # bpy 4.5 hangs at the end of a process that leaves one behind


if __name__ == "__main__":
    main(*sys.argv[-4:])
