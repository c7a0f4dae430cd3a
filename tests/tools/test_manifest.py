# SPDX-License-Identifier: GPL-3.0-or-later
import re
import tomllib

import pytest

from tools import wheels
from tools.project import REQUIREMENTS, ROOT

MANIFEST = wheels.manifest()
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]


def pinned(requirements, package):
    match = re.search(rf"^{package}==(\S+)$", (REQUIREMENTS / requirements).read_text(), re.MULTILINE)
    assert match, f"{requirements} pins no {package}"
    return match[1]


def test_manifest_and_project_have_one_version():
    assert MANIFEST["version"] == PROJECT["version"]


def test_manifest_and_project_have_one_licence():
    assert MANIFEST["license"] == [f"SPDX:{PROJECT['license']}"]


def test_tagline_is_one_blender_accepts():
    assert 0 < len(MANIFEST["tagline"]) <= 64
    assert MANIFEST["tagline"][-1].isalnum()


@pytest.mark.parametrize("requirements", ["python-5.2.txt", "python-4.5.txt"])
def test_tests_run_with_the_openexr_that_is_shipped(requirements):
    shipped = {name.split("-")[1] for name in wheels.wheel_names()}
    assert shipped == {pinned(requirements, "OpenEXR")}


def test_blender_minimum_is_a_blender_the_tests_run_in():
    minimum = MANIFEST["blender_version_min"].split(".")[:2]
    assert pinned("python-4.5.txt", "bpy").split(".")[:2] == minimum


@pytest.mark.parametrize("python", ["cp311", "cp313", "cp314"])
@pytest.mark.parametrize(
    "platform", ["manylinux.*x86_64", "win_amd64", "win_arm64", "macosx.*arm64", "macosx.*x86_64"]
)
def test_every_blender_finds_its_wheel(python, platform):
    fitting = [
        name for name in wheels.wheel_names() if re.search(rf"-{python}-{python}-{platform}\.whl$", name)
    ]
    assert len(fitting) == 1


def test_pip_is_asked_for_exactly_the_wheel():
    assert wheels.pip_arguments("openexr-3.5.3-cp311-cp311-win_amd64.whl") == [
        "--no-deps",
        "--only-binary=:all:",
        "--implementation=cp",
        "--python-version=311",
        "--abi=cp311",
        "--platform=win_amd64",
        "openexr==3.5.3",
    ]


def test_only_the_wheels_of_the_manifest_stay(monkeypatch, tmp_path):
    folder = tmp_path / "wheels"
    folder.mkdir()
    (folder / "openexr-3.0.0-old.whl").touch()
    (folder / wheels.wheel_names()[0]).touch()
    asked = []
    monkeypatch.setattr(wheels, "WHEELS", folder)
    monkeypatch.setattr(wheels, "_download_one", asked.append)
    wheels.download()
    assert [file.name for file in folder.iterdir()] == wheels.wheel_names()[:1]
    assert asked == wheels.wheel_names()[1:]


def test_everything_has_that_version():
    """What is cited, what `--version` prints, and the name of the zip on every page."""
    version = MANIFEST["version"]
    assert f"\nversion: {version}\n" in (ROOT / "CITATION.cff").read_text()
    assert f'\n__version__ = "{version}"\n' in (ROOT / "ocean_tweak" / "__init__.py").read_text()
    pages = {
        page.name: page.read_text("utf-8") for page in (ROOT / "README.md", *(ROOT / "docs").glob("*.md"))
    }
    named = {name: set(re.findall(r"ocean_tweak-(\d[\w.]*)\.zip", text)) for name, text in pages.items()}
    assert {name: found for name, found in named.items() if found - {version}} == {}
    assert all(named[name] for name in ("README.md", "index.md", "first-sea.md"))


def test_every_platform_has_as_many_wheels():
    """Blender's own names, by the end of the wheels'."""
    ends = {
        "linux-x64": "manylinux_2_28_x86_64", "macos-arm64": "macosx_11_0_arm64",
        "macos-x64": "macosx_10_15_x86_64", "windows-arm64": "win_arm64", "windows-x64": "win_amd64",
    }  # fmt: skip
    assert sorted(MANIFEST["platforms"]) == sorted(ends)
    assert len(wheels.wheel_names()) == 3 * len(ends)
    for end in ends.values():
        assert sum(name.endswith(f"{end}.whl") for name in wheels.wheel_names()) == 3
