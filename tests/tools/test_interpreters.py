# SPDX-License-Identifier: GPL-3.0-or-later
import shutil
import subprocess
import sys

import pytest

from tools import interpreters
from tools.project import ROOT, ToolError

THIS = "{}.{}".format(*sys.version_info)


def executable(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    path.chmod(0o755)
    return path


@pytest.fixture
def bare(monkeypatch, tmp_path):
    """A machine without any Python: an empty home and an empty folder on PATH."""
    (tmp_path / "bin").mkdir()
    for name in ("PYENV_ROOT", "UV_PYTHON_INSTALL_DIR"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("PATH", str(tmp_path / "bin"))
    return tmp_path


def test_missing_python_is_one_clear_line(bare):
    with pytest.raises(ToolError) as failure:
        interpreters.find_interpreter("3.13", "Blender 5.2")
    message = str(failure.value)
    assert "\n" not in message
    assert "Python 3.13, needed for Blender 5.2, was not found" in message
    assert "pyenv install 3.13" in message


def test_broken_shim_on_path_is_passed_over(bare):
    executable(bare / "bin" / f"python{THIS}", "#!/bin/sh\necho 'pyenv: command not found' >&2\nexit 127\n")
    real = executable(
        bare / f".pyenv/versions/{THIS}.0/bin/python{THIS}", f'#!/bin/sh\nexec {sys.executable} "$@"\n'
    )
    assert interpreters.find_interpreter(THIS, "a test") == str(real)


def test_python_under_a_false_name_is_passed_over(bare):
    executable(bare / "bin" / "python3.99", f'#!/bin/sh\nexec {sys.executable} "$@"\n')
    with pytest.raises(ToolError, match=r"Python 3\.99"):
        interpreters.find_interpreter("3.99", "a test")


def test_python_that_cannot_make_environments_is_passed_over(bare):
    executable(
        bare / "bin" / f"python{THIS}", f'#!/bin/sh\nexec {sys.executable} -S -c "import no_ensurepip"\n'
    )
    with pytest.raises(ToolError):
        interpreters.find_interpreter(THIS, "a test")


def test_set_up_without_python_ends_with_1_before_anything_is_downloaded(tmp_path):
    shutil.copytree(ROOT / "tools", tmp_path / "tools")
    answer = subprocess.run(
        [sys.executable, "-m", "tools.setup"],
        cwd=tmp_path,
        env={"PATH": str(tmp_path), "HOME": str(tmp_path)},
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert answer.returncode == 1
    assert answer.stderr.count("\n") == 1
    assert "Python 3.13" in answer.stderr
    assert [path.name for path in (tmp_path / ".tools").iterdir()] == ["lock"]


def test_tools_refuse_an_old_python_in_one_line():
    source = (ROOT / "tools" / "__init__.py").read_text()
    script = f"import sys; sys.version_info = (3, 8); sys.version = '3.8.1'; exec({source!r})"
    answer = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    assert answer.returncode == 1
    assert "Python 3.9 or newer" in answer.stderr
