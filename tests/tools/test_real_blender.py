# SPDX-License-Identifier: GPL-3.0-or-later
import pytest

from tools import real_blender, setup
from tools.project import ToolError


def program(folder, name, version, code=0):
    folder.mkdir(exist_ok=True)
    path = folder / name
    path.write_text(f"#!/bin/sh\necho 'Blender {version}'\nexit {code}\n")
    path.chmod(0o755)
    return str(path)


@pytest.fixture
def none(monkeypatch, tmp_path):
    """A machine on which no Blender is installed and none can be made."""
    monkeypatch.delenv("BLENDER", raising=False)
    monkeypatch.delenv("OCEAN_TWEAK_REQUIRE_BLENDER", raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr(real_blender, "DEBIAN_ROOT", tmp_path / "blender-root")


def test_variable_comes_before_path(none, monkeypatch, tmp_path):
    program(tmp_path, "blender", "5.2.2 LTS")
    assert real_blender.find().version == "Blender 5.2.2 LTS"
    monkeypatch.setenv("BLENDER", program(tmp_path / "own", "b", "4.5.1"))
    assert real_blender.find().command == (str(tmp_path / "own" / "b"),)


@pytest.mark.parametrize(("version", "code"), [("4.4.9", 0), ("3.6.0", 0), ("5.2.0", 1)])
def test_unfit_variable_is_an_error_that_names_it(none, monkeypatch, tmp_path, version, code):
    monkeypatch.setenv("BLENDER", program(tmp_path, "b", version, code))
    with pytest.raises(ToolError, match=r"BLENDER=.*/b is not a Blender 4\.5 or newer"):
        real_blender.find()


def test_old_blender_on_path_is_passed_over(none, tmp_path):
    program(tmp_path, "blender", "3.4.1")
    with pytest.raises(real_blender.NoBlender, match="set BLENDER"):
        real_blender.find()


def test_version_is_compared_as_numbers(none, tmp_path):
    program(tmp_path, "blender", "10.0.0")
    assert real_blender.find().version == "Blender 10.0.0"


def test_missing_blender_fails_the_set_up_only_where_required(none, monkeypatch, capsys):
    assert setup._make("blender", setup._make_blender) == 0
    assert capsys.readouterr().err.startswith("no real Blender: `blender` 4.5 or newer is not on PATH")
    monkeypatch.setenv("OCEAN_TWEAK_REQUIRE_BLENDER", "1")
    assert setup._make("blender", setup._make_blender) == 1
    assert capsys.readouterr().err.startswith("set-up of blender failed: ")


def test_failed_installation_says_where_it_stopped(none, monkeypatch, tmp_path):
    (tmp_path / "apt-get").write_text("#!/bin/sh\necho 'E: no network'\nexit 100\n")
    (tmp_path / "apt-get").chmod(0o755)
    monkeypatch.setattr(real_blender, "LOG", tmp_path / "log")
    monkeypatch.setattr(real_blender.os, "geteuid", lambda: 0)
    with pytest.raises(real_blender.NoBlender, match=r"(?s)exit code 100.*E: no network"):
        real_blender.find(make=True)
    assert not (tmp_path / "blender-root").exists()
