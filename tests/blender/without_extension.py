# SPDX-License-Identifier: GPL-3.0-or-later
"""What a file shows in a new Blender that has not the extension."""

import json
import os
import subprocess
import sys

import bpy

READER = """
import json, sys
import bpy

assert not hasattr(bpy.types.Object, "ocean_tweak"), "the extension is here"
files, frames, answer = sys.argv[sys.argv.index("--") + 1 :]
found = {}
for file in json.loads(files):
    bpy.ops.wm.open_mainfile(filepath=file)
    for frame in json.loads(frames):
        bpy.context.scene.frame_set(frame)
        depsgraph = bpy.context.evaluated_depsgraph_get()
        for item in (item for item in depsgraph.objects if item.type == "MESH"):
            heights = [vertex.co.z for vertex in item.data.vertices]
            found.setdefault(file, {}).setdefault(item.name, {})[frame] = heights
with open(answer, "w") as stream:
    json.dump(found, stream)
"""


def heights_without_extension(folder, files, frames):
    """{file: {mesh object: {frame: heights}}} of all that can be seen, as such a Blender evaluates it.

    folder : of nothing else
    """
    script, answer = folder / "reader.py", folder / "found.json"
    script.write_text(READER)
    start = [sys.executable, script]
    if "OCEAN_TWEAK_ZIP" in os.environ:
        start = [bpy.app.binary_path, "--factory-startup", "--background", "--python", script]
    command = [*start, "--", json.dumps([str(file) for file in files]), json.dumps(list(frames)), answer]
    told = subprocess.run(
        [str(word) for word in command], stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=300
    )
    assert answer.exists(), told.stdout + told.stderr
    found = json.loads(answer.read_text())
    answer.unlink()
    return {
        file: {
            name: {int(frame): heights for frame, heights in shown.items()} for name, shown in items.items()
        }
        for file, items in found.items()
    }
