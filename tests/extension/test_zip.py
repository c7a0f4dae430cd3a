# SPDX-License-Identifier: GPL-3.0-or-later
import importlib.metadata
import os
import tomllib
import zipfile
from pathlib import Path

import bpy


def manifest_in(zip_file):
    return tomllib.loads(zipfile.ZipFile(zip_file).read("blender_manifest.toml").decode())


def test_zip_is_valid(run_blender, zip_file):
    answer = run_blender("--command", "extension", "validate", zip_file)
    assert answer.returncode == 0, answer.stdout + answer.stderr


def test_validation_refuses_a_zip_without_manifest(run_blender, tmp_path):
    broken = tmp_path / "broken.zip"
    with zipfile.ZipFile(broken, "w") as file:
        file.writestr("__init__.py", "")
    answer = run_blender("--command", "extension", "validate", broken)
    assert answer.returncode != 0
    assert "manifest" in answer.stdout + answer.stderr


def test_zip_holds_the_extension_and_nothing_else(zip_file):
    names = zipfile.ZipFile(zip_file).namelist()
    wheels = {path.removeprefix("./") for path in manifest_in(zip_file)["wheels"]}
    expected = {"__init__.py", "blender_manifest.toml", "LICENSE", "NOTICES.md", *wheels}
    code = {name for name in names if name.startswith("ocean_tweak/")}
    assert set(names) - code == expected
    assert "ocean_tweak/py.typed" in code
    assert {"ocean_tweak/registration.py", "ocean_tweak/core/__init__.py"} <= code
    assert not [name for name in code if "__pycache__" in name or "/." in name]


def test_blender_imports_the_wheel_of_the_manifest(package, zip_file):
    import OpenEXR

    site = Path(OpenEXR.__file__).resolve().parent
    assert Path(os.environ["BLENDER_USER_RESOURCES"]).resolve() in site.parents
    versions = {Path(wheel).name.split("-")[1] for wheel in manifest_in(zip_file)["wheels"]}
    assert versions == {importlib.metadata.version("OpenEXR")}


def test_installed_code_is_the_one_under_test(extension):
    assert extension("core").__name__.startswith("bl_ext.user_default.ocean_tweak.")


def test_enabled_extension_is_loaded_by_a_new_blender(run_blender, package):
    script = f"import sys; sys.exit(40 + ('{package}.ocean_tweak.registration' in sys.modules))"
    answer = run_blender("--background", "--python-expr", script)
    assert answer.returncode == 41, answer.stdout + answer.stderr


def test_nothing_is_written_beside_the_code(extension, package, empty_scene, tmp_path):
    """The extension's folder is Blender's: an update replaces it. What a session keeps goes elsewhere."""
    home = Path(extension("core").__file__).resolve().parents[2]

    def files():
        return {path for path in home.rglob("*") if path.is_file() and "__pycache__" not in path.parts}

    before = files()
    assert home / "blender_manifest.toml" in before
    empty_scene.frame_start, empty_scene.frame_end = 1, 2
    bpy.ops.mesh.ocean_tweak_add()
    sea = bpy.context.active_object.ocean_tweak
    sea.resolution, sea.use_foam = 32, False
    assert bpy.ops.ocean.bake() == {"FINISHED"}  # a file that was never saved
    assert sea.source == "SEQUENCE"
    bpy.ops.ocean.save_preset(title="My Sea")
    bpy.ops.ocean.export_parameters(filepath=str(tmp_path / "sea.json"))
    assert files() == before
    user = Path(os.environ["BLENDER_USER_RESOURCES"]).resolve()
    baked = Path(bpy.path.abspath(sea.sequence_maps.disp.filepath)).resolve()
    assert user in baked.parents
    assert home not in baked.parents
