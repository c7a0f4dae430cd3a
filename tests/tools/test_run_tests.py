# SPDX-License-Identifier: GPL-3.0-or-later
import subprocess
import sys
from collections import Counter

import pytest

from tools import build, real_blender, run_tests
from tools.project import ROOT


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
    here = run_tests.Place("here", (sys.executable, "-m", "pytest", f"--rootdir={tmp_path}"))
    assert run_tests.run_files(here, [f"{tmp_path}/test_it.py"], {}).passed is passed


@pytest.mark.parametrize("everything", [False, True])
def test_every_test_file_is_queued_once_in_the_newest_blender(everything):
    queued = [file for place, file in run_tests.of_wheels(everything) if place.name == "bpy 5.2"]
    own_run = ("tests/ui/", "tests/extension/")
    files = [file.relative_to(ROOT).as_posix() for file in ROOT.glob("tests/**/test_*.py")]
    assert sorted(queued) == sorted(file for file in files if not file.startswith(own_run))


@pytest.mark.parametrize("everything", [False, True])
def test_what_is_queued_again_is_there(everything):
    queued = [file for place, file in run_tests.of_wheels(everything) if place.name == "bpy 4.5"]
    assert len(queued) > 15
    assert [file for file in queued if not (ROOT / file).is_file()] == []
    if everything:
        once = {file for _, file in run_tests.of_wheels(False)}
        assert {run_tests.suite_of(file) for file in once - set(queued)} == set(run_tests.ONCE)


def test_no_process_is_given_files_of_two_places():
    here, there = run_tests.Place("here", ()), run_tests.Place("there", ())
    files = [(place, f"tests/a/test_{n}.py") for place in (here, there) for n in range(13)]
    taken = list(iter(run_tests.Queue(files, slots=1).take, None))
    assert [(place, file) for place, batch in taken for file in batch] == files


def test_queue_gives_each_file_once_in_batches_of_a_suite_that_shrink():
    here, there = run_tests.Place("here", ()), run_tests.Place("there", ())
    files = [(here, f"tests/a/test_{n}.py") for n in range(40)] + [
        (there, f"tests/b/test_{n}.py") for n in range(9)
    ]
    queue = run_tests.Queue(files, slots=2)
    taken = list(iter(queue.take, None))
    assert [(place, file) for place, batch in taken for file in batch] == files
    assert all(len({run_tests.suite_of(file) for file in batch}) == 1 for _, batch in taken)
    sizes = [len(batch) for _, batch in taken]
    assert sizes[0] > 4
    assert sizes[-8:] == [1] * 8


@pytest.fixture
def one_good_test(monkeypatch, tmp_path):
    (tmp_path / "test_it.py").write_text("def test_a(): pass")
    here = run_tests.Place("here", (sys.executable, "-m", "pytest", f"--rootdir={tmp_path}"))
    monkeypatch.setattr(run_tests, "of_wheels", lambda everything: [(here, f"{tmp_path}/test_it.py")])


@pytest.mark.parametrize(("required", "code"), [("1", 1), ("0", 0)])
def test_run_without_real_blender_says_so_last(one_good_test, monkeypatch, capsys, required, code):
    def find():
        raise real_blender.NoBlender("none was found")

    monkeypatch.setattr(real_blender, "find", find)
    monkeypatch.setenv("OCEAN_TWEAK_REQUIRE_BLENDER", required)
    assert run_tests.main([]) == code
    told = capsys.readouterr().out
    assert told.splitlines()[-1].startswith("no real Blender")
    assert "1 passed" in told.partition("== summary")[2]


def test_extension_that_does_not_build_fails_the_run(one_good_test, monkeypatch, capsys, tmp_path):
    broken = real_blender.RealBlender(("false",), "Blender 5.2")
    monkeypatch.setattr(build, "BUILD", tmp_path)  # the zip of the run that this test is part of stays
    monkeypatch.setattr(real_blender, "find", lambda: broken)
    monkeypatch.setattr(build.wheels, "download", lambda: None)
    assert run_tests.main([]) == 1
    assert "`false --command extension build" in capsys.readouterr().out.splitlines()[-1]


def test_processes_of_a_suite_are_added_up():
    def result(suite, words, passed=True):
        return run_tests.Result("here", suite, passed, Counter(words), "a line", 1.0)

    lines = list(
        run_tests.summary(
            [result("tests/a", {"passed": 2}), result("tests/b", {"passed": 1}),
             result("tests/a", {"passed": 3, "failed": 1}, passed=False), result("tests/b", {}, passed=False)]
        )
    )  # fmt: skip
    assert len(lines) == 3
    assert lines[0].startswith("FAILED here")
    assert "5 passed, 1 failed" in lines[0]
    assert lines[1].startswith("FAILED here")
    assert "1 passed in" in lines[1]
    assert lines[2].strip() == "a line"


def test_what_python_compiles_is_kept_by_tests(monkeypatch, tmp_path):
    monkeypatch.setattr(run_tests, "TOOLS", tmp_path)
    monkeypatch.setenv("PYTHONDONTWRITEBYTECODE", "1")
    (tmp_path / "module.py").write_text("")
    command = [sys.executable, "-c", "import module"]
    subprocess.run(command, cwd=tmp_path, env=run_tests.test_environment("any"), check=True)
    assert list((tmp_path / "__pycache__").glob("module.*.pyc"))
