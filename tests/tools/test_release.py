# SPDX-License-Identifier: GPL-3.0-or-later
"""What `make release` refuses to publish."""

import re
import tomllib
import zipfile

import pytest

from tools import release, wheels
from tools.project import ROOT, ToolError


def faults_of(tmp_path, source, name="scene/a.py"):
    path = tmp_path / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(source)
    return list(release.code_faults(tmp_path))


def test_the_extension_as_it_is_has_no_faults():
    assert list(release.manifest_faults(wheels.manifest())) == []
    assert list(release.code_faults(ROOT / "ocean_tweak")) == []


@pytest.mark.parametrize(
    ("source", "told"),
    [
        ("import urllib.request", "urllib"),
        ("from http import client", "http"),
        ("def f():\n    import socket", "socket"),
        ("import sys\nsys.path.append('x')", "sys.path"),
        ("import sys\nsys.path[:0] = ['x']", "sys.path"),
        ("import sys\ndel sys.path[0]", "sys.path"),
        ("import sys\nsys.path += ['x']", "sys.path"),
    ],
)
def test_network_and_search_path_are_faults(tmp_path, source, told):
    (fault,) = faults_of(tmp_path, source)
    assert told in fault
    assert "scene/a.py" in fault


@pytest.mark.parametrize(
    "source", ["import sys\nfor entry in sys.path:\n    print(entry)", "from . import http", "import json"]
)
def test_what_only_looks_like_it_is_none(tmp_path, source):
    assert faults_of(tmp_path, source) == []


def test_what_is_allowed_in_one_file_is_not_in_another(tmp_path):
    assert faults_of(tmp_path, "import socket", "cli/stopping.py") == []
    assert len(faults_of(tmp_path, "import socket", "cli/other.py")) == 1


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"tagline": "Ends with a full stop."}, "tagline"),
        ({"permissions": {"files": "x" * 65}}, "files"),
        ({"permissions": {"network": "Fetch tides"}}, "offline"),
        ({"version": "1.0"}, "version"),
    ],
)
def test_manifests_that_are_sent_back(change, told):
    (fault,) = release.manifest_faults({**wheels.manifest(), **change})
    assert told in fault


def test_a_website_is_written_into_the_zips_manifest_and_nothing_else_changes(tmp_path):
    path, told = tmp_path / "a.zip", 'SPDX = "GPL"\n\n[permissions]\nfiles = "Bake"\n'
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as file:
        file.writestr("blender_manifest.toml", told)
        file.writestr("wheels/a.whl", b"0" * 1000)
    release.put_website(path, "https://example.org/sea?page=1")
    with zipfile.ZipFile(path) as file:
        assert file.namelist() == ["blender_manifest.toml", "wheels/a.whl"]
        assert file.read("wheels/a.whl") == b"0" * 1000
        assert file.getinfo("wheels/a.whl").compress_type == zipfile.ZIP_DEFLATED
        manifest = tomllib.loads(file.read("blender_manifest.toml").decode())
    assert manifest == {"website": "https://example.org/sea?page=1", **tomllib.loads(told)}
    with pytest.raises(ToolError, match="already"):
        release.put_website(path, "https://example.org")


@pytest.mark.parametrize(
    "website", ["http://example.org", "example.org", "https://", "https://a b.org", "www"]
)
def test_what_is_no_address_is_refused(website):
    (fault,) = release.website_faults(website)
    assert website in fault


def test_no_website_is_no_fault_but_said(monkeypatch, capsys, tmp_path):
    assert list(release.website_faults("")) == []
    (tmp_path / "CHANGELOG.md").write_text(f"## [{wheels.manifest()['version']}]\n\nAll.\n")
    monkeypatch.setattr(release, "ROOT", tmp_path)
    monkeypatch.setattr(release, "FOLDER", tmp_path)
    monkeypatch.setattr(release, "_build", lambda blender, website: [])
    monkeypatch.setattr(release.real_blender, "find", lambda: None)
    monkeypatch.setattr(release, "code_faults", lambda package: [])
    monkeypatch.setattr("sys.argv", ["release"])
    assert release.main() == 0
    assert "make release WEBSITE=https://" in capsys.readouterr().out
    monkeypatch.setattr("sys.argv", ["release", "--website", "https://example.org"])
    assert release.main() == 0
    assert capsys.readouterr().out.endswith("website https://example.org\n")


def test_zips_hold_nothing_else(tmp_path):
    path = tmp_path / "a.zip"
    names = [
        "LICENSE", "NOTICES.md", "blender_manifest.toml", "ocean_tweak/ui/thumbnails/gale.jpg",
        "wheels/openexr-3.5.3-cp313-cp313-win_amd64.whl",
    ]  # fmt: skip
    with zipfile.ZipFile(path, "w") as file:
        for name in names:
            file.writestr(name, "")
    assert list(release.zip_faults(path)) == []
    with zipfile.ZipFile(path, "a") as file:
        file.writestr("ocean_tweak/library.so", "")
        file.writestr("ocean_tweak/photo.jpg", "")
    assert [fault.split(" holds ")[1].split(":")[0].split(",")[0] for fault in release.zip_faults(path)] == [
        "ocean_tweak/library.so", "ocean_tweak/photo.jpg",
    ]  # fmt: skip


def test_notes_are_those_of_the_version(tmp_path):
    path = tmp_path / "a.zip"
    path.write_bytes(b"x" * 1_500_000)
    version = wheels.manifest()["version"]
    notes = release.release_notes([path], version)
    assert notes.startswith(f"# Ocean Tweak {version}\n")
    assert "| `a.zip` | 1.5 MB |" in notes
    assert "### Added" in notes
    assert "## [" not in notes
    # beside the zips there are no documents
    assert re.findall(r"\]\((?!https?:)[^)]*\)", notes) == []
    with pytest.raises(ToolError, match=r"no section \[9\.9\.9\]"):
        release.release_notes([path], "9.9.9")
