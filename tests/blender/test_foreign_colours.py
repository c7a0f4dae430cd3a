# SPDX-License-Identifier: GPL-3.0-or-later
"""A studio's OCIO configuration without "Non-Color" and with a gain on everything that is colour."""

import os
import subprocess
import sys
from pathlib import Path

import bpy

ROOT = Path(__file__).parents[2]
CONFIGURATION = """\
ocio_profile_version: 2
roles:
  {default: Twice, scene_linear: Linear, data: Numbers, color_picking: Linear, texture_paint: Linear,
   matte_paint: Linear, color_timing: Linear, compositing_log: Linear, default_byte: Twice,
   default_float: Twice, default_sequencer: Twice, aces_interchange: Linear, XYZ: Linear}
file_rules:
  - !<Rule> {name: Default, colorspace: default}
displays:
  Screen:
    - !<View> {name: Standard, colorspace: Linear}
active_displays: [Screen]
active_views: [Standard]
colorspaces:
  - !<ColorSpace> {name: Linear, family: linear, isdata: false}
  - !<ColorSpace>
    name: Twice
    family: linear
    isdata: false
    to_scene_reference: !<MatrixTransform> {matrix: [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1]}
  - !<ColorSpace> {name: Numbers, family: raw, isdata: true}
"""
# the oceans' heights at frame 2, as far as the process that runs this script can see them
SCRIPT = """
import importlib, sys
from pathlib import Path
import bpy
package, root, folder = sys.argv[-3:]
if package == "ocean_tweak":
    sys.path.insert(0, root)
    importlib.import_module("ocean_tweak.registration").register(package)
    home = "ocean_tweak"
else:
    home = package + ".ocean_tweak"
imported = lambda name: importlib.import_module(f"{home}.{name}")
image = bpy.data.images.new("probe", 16, 16)
names = [item.identifier for item in type(image.colorspace_settings).bl_rna.properties["name"].enum_items]
assert "Twice" in names and "Non-Color" not in names, names
core, scene = imported("core"), bpy.context.scene
sea = core.OceanParameters(resolution=16, domain_size=100.0)
ocean = core.Ocean(sea)
sink = imported("export.exr").ExrSequence(Path(folder), "sea", sea, "ZIP")
for frame in (1, 2):
    sink.write(frame, ocean.frame(frame))
sequence = imported("scene.image_sequence").find_sequence(folder)
for method in ("NODES", "DISPLACE"):
    for source in ("LIVE", "SEQUENCE"):
        item = imported("scene.ocean_object").add(scene, sea, method, source, sequence)
        scene.frame_set(1)
        scene.frame_set(2)
        mesh = item.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
        heights = ocean.surface(1 / 24).displacement[..., 2]
        for row, column in ((0, 0), (3, 5), (12, 7)):
            difference = mesh.vertices[row * 17 + column].co.z - heights[row, column]
            assert abs(difference) < 1e-4, (method, source, row, column, difference)
print("all in place", abs(heights).max())
"""


def test_colours_of_a_studio_change_no_number(package, tmp_path):
    configuration, script = tmp_path / "config.ocio", tmp_path / "script.py"
    configuration.write_text(CONFIGURATION)
    script.write_text(SCRIPT)
    frames = tmp_path / "frames"
    frames.mkdir()
    if "OCEAN_TWEAK_ZIP" in os.environ:
        command = [
            bpy.app.binary_path,
            "--background",
            "--python-exit-code",
            "1",
            "--python",
            script,
            "--",
            package,
        ]
    else:
        command = [sys.executable, script, "ocean_tweak"]
    answer = subprocess.run(
        [*map(str, command), str(ROOT), str(frames)],
        env={**os.environ, "OCIO": str(configuration)},
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert answer.returncode == 0, answer.stdout + answer.stderr
    assert "all in place" in answer.stdout
