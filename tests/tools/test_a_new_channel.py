# SPDX-License-Identifier: GPL-3.0-or-later
"""A channel more is a formula and a row in one file: everything else of a copy of the program follows."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tools.project import ROOT

TABLE = Path("ocean_tweak/core/synthesis/channels.py")
FORMULA = '''def speed(rows: PositionRows, out: RealArray) -> None:
    """(N, N) m/s: how fast the water moves."""
    np.square(rows.position(X, "t"), out=out)
    out += rows.position(Y, "t") ** 2
    out += rows.position(Z, "t") ** 2
    np.sqrt(out, out=out)


'''
ROW = """    Channel(
        "speed", "of the water, without its direction", "m/s", 0, SCALAR, speed, _MOTION,
        attribute="speed", switch="", usd=UsdAttribute("primvars:speed", "FloatArray", halved=True),
    ),
"""
BEFORE = {
    "class UsdAttribute(": FORMULA,
    ")  # fmt: skip\n\n#: by name\n": ROW,
    "}\n\n#: maps for which a precision of 2^-11": '    "speed": ("speed",),\n',
}
SEA = {"resolution": 16, "domain_size": 90.0, "timing": {"fps": 24}}

SCRIPT = """
import json, sys
from pathlib import Path

import bpy
import numpy as np
from ocean_tweak import cli, registration
from ocean_tweak.core import OceanParameters
from ocean_tweak.core.sea.bake import ShotSeas
from ocean_tweak.core.parameters.shot import Shot
from ocean_tweak.export.exr import read_image
from ocean_tweak.export.frame_files import BAKED
from ocean_tweak.export.usd.attributes import ATTRIBUTES
from ocean_tweak.scene import ocean_object
from pxr import Usd
from tools import parameters_doc

sea, folder = Path(sys.argv[1]), Path(sys.argv[2])
parameters = OceanParameters.from_json(sea.read_text())
fields = ShotSeas(Shot(parameters)).frame(2, {"speed", "velocity"})
found = {"field": fields.speed.tolist(), "velocity": fields.velocity.tolist()}

bake = ["--params", str(sea), "--frames", "2", "--maps", "disp,speed", "--out", str(folder)]
assert cli.main(["bake", *bake, "--compression", "ZIP"]) == 0
assert cli.main(["verify", *bake, "--compression", "ZIP"]) == 0
(image,) = folder.glob("*/*/*_speed.0002.exr")
pixels, header = read_image(image)
found["image"], found["unit"] = pixels.tolist(), header["unit"]

layers = ["--params", str(sea), "--frames", "2", "--form", "points", "--attributes", "speed", "--half"]
assert cli.main(["usd", *layers, "--out", str(folder / "sea.usd")]) == 0
stage = Usd.Stage.Open(str(folder / "sea.usd"))
given = [prim.GetAttribute("primvars:speed") for prim in stage.Traverse()]
(primvar, *_) = [each for each in given if each]
found["primvar"] = [str(primvar.GetTypeName()), np.array(primvar.Get(2), float).tolist()]

registration.register("ocean_tweak")
bpy.ops.wm.read_homefile(use_empty=True)
bpy.context.scene.frame_set(2)
item = ocean_object.add(bpy.context.scene, parameters)
attribute = item.evaluated_get(bpy.context.evaluated_depsgraph_get()).data.attributes["speed"]
found["attribute"] = [attribute.data_type, [number.value for number in attribute.data]]
found["choices"] = [list(ATTRIBUTES), list(BAKED)]
found["documented"] = [row for row in parameters_doc.channels().splitlines() if "`speed`" in row]
(folder / "found.json").write_text(json.dumps(found))
"""


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    """What a copy with one file changed makes of the channel."""
    pytest.importorskip("bpy")
    pytest.importorskip("pxr")
    copy = tmp_path_factory.mktemp("copy")
    for part in ("ocean_tweak", "tools"):
        shutil.copytree(ROOT / part, copy / part, ignore=shutil.ignore_patterns("__pycache__"))
    text = (copy / TABLE).read_text(encoding="utf-8")
    for place, added in BEFORE.items():
        assert text.count(place) == 1
        text = text.replace(place, added + place)
    (copy / TABLE).write_text(text, encoding="utf-8")
    (copy / "sea.json").write_text(json.dumps(SEA))
    (copy / "script.py").write_text(SCRIPT)
    subprocess.run(
        [sys.executable, "script.py", "sea.json", "made"],
        cwd=copy, check=True, timeout=300, env={**os.environ, "PYTHONPATH": str(copy)},
    )  # fmt: skip
    return json.loads((copy / "made" / "found.json").read_text())


@pytest.fixture
def speeds(found):
    """(N, N) m/s, from the velocity."""
    speed = np.linalg.norm(np.array(found["velocity"]), axis=-1)
    assert speed.std() > 0.05
    return speed


def closed(field):
    """The samples of a mesh: the first row and column stand at the end too."""
    return np.pad(field, ((0, 1), (0, 1)), "wrap").ravel()


def test_it_is_a_field(found, speeds):
    np.testing.assert_allclose(found["field"], speeds, rtol=1e-5)


def test_it_is_an_image_that_the_command_line_bakes_and_verifies(found, speeds):
    image = np.array(found["image"])
    np.testing.assert_allclose(image[..., 0], speeds, rtol=1e-5)
    assert not image[..., 1:].any()
    assert found["unit"] == "m/s"


def test_it_is_a_primvar(found, speeds):
    kind, values = found["primvar"]
    assert kind == "half[]"
    np.testing.assert_allclose(values, closed(speeds), rtol=2**-10)


def test_it_is_an_attribute_of_the_mesh(found, speeds):
    kind, values = found["attribute"]
    assert kind == "FLOAT"
    np.testing.assert_allclose(values, closed(speeds), rtol=1e-5)


def test_it_stands_behind_the_others_by_whose_order_files_know_them(found):
    """Flags in .blend files are counted, and fingerprints of bakes list their maps."""
    attributes, baked = found["choices"]
    others = ["breaking", "foam_age", "speed"]
    assert attributes == ["velocities", "normals", "foam", "cusp", "displayColor", *others]
    images = ["disp", "foam", "normal", "vel", "slope", "strain", "foam_age", "hs", "qb", "direction"]
    assert baked == [*images, "speed", "points", "coast", "wakes"]


def test_it_is_documented(found):
    row = "of the water, without its direction | 1 | m/s | `speed` R | `speed` | `primvars:speed` |"
    assert found["documented"] == [f"| `speed` | {row}  |"]
