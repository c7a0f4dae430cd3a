# SPDX-License-Identifier: GPL-3.0-or-later
import sys

import pytest

from tools import build, real_blender, run_tests


@pytest.mark.parametrize(
    ("output", "expected"),
    [
        ("...\n12 passed in 3.20s\n", "12 passed in 3.20s"),
        ("FAILED a\n1 failed, 2 passed, 1 warning in 75.01s (0:01:15)\n\nBlender quit\n",
         "1 failed, 2 passed, 1 warning in 75.01s (0:01:15)"),
        ("no tests ran in 0.01s\n", "no tests ran in 0.01s"),
        ("Segmentation fault", "ended with exit code -11 before pytest was through"),
    ],
)  # fmt: skip
def test_closing_line_is_pytests_own(output, expected):
    assert run_tests.closing_line(output, -11) == expected


@pytest.mark.parametrize(
    ("source", "passed"),
    [("def test_a(): pass", True), ("def test_a(): assert False", False), ("", False)],
)
def test_empty_suite_fails_like_a_failing_one(tmp_path, source, passed):
    (tmp_path / "test_it.py").write_text(source)
    command = [sys.executable, "-m", "pytest", f"--rootdir={tmp_path}", str(tmp_path)]
    assert run_tests.run_suite("here", "suite", command, {}).passed is passed


@pytest.fixture
def source_suites(monkeypatch):
    good = run_tests.Result("bpy", "tests/core", True, "1 passed in 1s")
    monkeypatch.setattr(run_tests, "run_source_suites", lambda blender, suites: [good])


@pytest.mark.parametrize(("required", "code"), [("1", 1), ("0", 0)])
def test_run_without_real_blender_says_so_last(source_suites, monkeypatch, capsys, required, code):
    def find():
        raise real_blender.NoBlender("none was found")

    monkeypatch.setattr(real_blender, "find", find)
    monkeypatch.setenv("OCEAN_TWEAK_REQUIRE_BLENDER", required)
    assert run_tests.main() == code
    assert capsys.readouterr().out.splitlines()[-1].startswith("no real Blender")


def test_extension_that_does_not_build_fails_the_run(source_suites, monkeypatch, capsys):
    broken = real_blender.RealBlender(("false",), "Blender 5.2")
    monkeypatch.setattr(real_blender, "find", lambda: broken)
    monkeypatch.setattr(build.wheels, "download", lambda: None)
    assert run_tests.main() == 1
    assert "`false --command extension build" in capsys.readouterr().out.splitlines()[-1]
