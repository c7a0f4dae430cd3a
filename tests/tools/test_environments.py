# SPDX-License-Identifier: GPL-3.0-or-later
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tools import environments
from tools.project import REQUIREMENTS, ROOT, ToolError


@pytest.fixture
def bare(monkeypatch, tmp_path):
    """A machine without any Python: an empty home, an empty folder on PATH and a place for environments."""
    for name in ("PYENV_ROOT", "UV_PYTHON_INSTALL_DIR", "UV_PYTHON"):
        monkeypatch.delenv(name, raising=False)
    for folder in ("bin", "tools", ".pyenv/shims"):
        (tmp_path / folder).mkdir(parents=True)
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("PATH", f"{tmp_path}/.pyenv/shims:{tmp_path}/bin")
    monkeypatch.setenv("UV_OFFLINE", "1")
    (tmp_path / "tools" / "uv").symlink_to(environments.TOOLS / "uv")
    monkeypatch.setattr(environments, "TOOLS", tmp_path / "tools")
    return tmp_path


def test_every_environment_has_requirements():
    assert all((REQUIREMENTS / f"{name}.txt").is_file() for name in environments.PYTHON_OF)


def test_missing_python_is_one_clear_line_and_nothing_counts_as_made(bare):
    with pytest.raises(ToolError) as failure:
        environments.make("python-5.2")
    first = str(failure.value).splitlines()[0]
    assert "Python 3.13, needed for python-5.2.txt, was not found" in first
    assert "uv python install 3.13" in first
    assert not (environments.TOOLS / "python-5.2" / ".made-by").exists()


def test_pyenv_versions_are_found_and_its_shims_passed_over(bare, monkeypatch):
    this = "{}.{}".format(*sys.version_info)
    shim = bare / ".pyenv/shims" / f"python{this}"
    shim.write_text("#!/bin/sh\necho 'pyenv: command not found' >&2\nexit 127\n")
    shim.chmod(0o755)
    real = bare / f".pyenv/versions/{this}.0/bin/python{this}"
    real.parent.mkdir(parents=True)
    real.symlink_to(Path(sys.base_prefix, "bin", f"python{this}"))
    monkeypatch.setitem(environments.PYTHON_OF, "empty", this)
    monkeypatch.setattr(environments, "REQUIREMENTS", bare)
    (bare / "empty.txt").write_text("# nothing\n")
    environments.make("empty")
    answer = subprocess.run([environments.python("empty"), "-c", "import sys; print(sys.version_info[:2])"],
                            capture_output=True, text=True, check=True)  # fmt: skip
    assert answer.stdout.strip() == str(sys.version_info[:2])
    made = environments.python("empty").stat().st_ino
    environments.make("empty")  # stands already: with an empty PATH it could not be made again
    assert environments.python("empty").stat().st_ino == made


def test_set_up_without_venv_ends_with_1_and_says_what_is_missing(tmp_path):
    shutil.copytree(ROOT / "tools", tmp_path / "tools")
    script = "import sys; sys.executable = '/bin/false'; from tools import setup; sys.exit(setup.main())"
    answer = subprocess.run(
        [sys.executable, "-c", script, "python-5.2"], cwd=tmp_path, capture_output=True, text=True, timeout=60
    )
    assert answer.returncode == 1
    assert "set-up of uv failed: /bin/false cannot make virtual environments" in answer.stderr.splitlines()[0]
    assert "make PYTHON=" in answer.stderr.splitlines()[0]


def test_tools_refuse_an_old_python_in_one_line():
    source = (ROOT / "tools" / "__init__.py").read_text()
    script = f"import sys; sys.version_info = (3, 8); sys.version = '3.8.1'; exec({source!r})"
    answer = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    assert answer.returncode == 1
    assert "Python 3.9 or newer" in answer.stderr
