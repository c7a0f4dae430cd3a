# SPDX-License-Identifier: GPL-3.0-or-later
"""What is changed in a source, and what is not."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tools import mutants, mutate
from tools.project import ROOT, ToolError

SOURCE = '''"""α, a module."""
FIRST = 9.81  # m/s²
SECOND = -2.5; ω = 4.0

def function():
    inner = 3.0
    return inner
'''


def test_every_number_at_the_top_is_found() -> None:
    found = mutants.constants(SOURCE)
    assert [(constant.name, constant.value) for constant in found] == [
        ("FIRST", 9.81),
        ("SECOND", -2.5),
        ("ω", 4.0),
    ]


@pytest.mark.parametrize(
    ("index", "before", "after"),
    [
        (0, "FIRST = 9.81  #", "FIRST = 10.0062  #"),
        (1, "= -2.5;", "= -2.55;"),
        (2, "ω = 4.0\n", "ω = 4.08\n"),
    ],
)
def test_only_the_one_number_changes(index: int, before: str, after: str) -> None:
    constant = mutants.constants(SOURCE)[index]
    assert mutants.changed(SOURCE, constant) == SOURCE.replace(before, after)


def test_what_is_no_number_on_one_line_is_refused() -> None:
    with pytest.raises(ToolError, match="line 2"):
        mutants.constants("\nA = (1.0,\n2.0)\n")


def test_unknown_names_are_refused(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as end:
        mutate.main(["--kinds", "constants", "--only", "GRAVITIY"])
    assert end.value.code == 2
    assert "GRAVITIY" in capsys.readouterr().err


def test_formulas_are_those_of_the_document_and_return_more() -> None:
    found = {mutant.name: mutant for mutant in mutants.of_formulas(ROOT)}
    assert len(found) > 60
    mutant = found["formula spectral.spectra.jonswap x 1.05"]
    assert "test_spectra.py::test_jonswap_parameters" in mutant.tests
    source = (ROOT / mutant.path).read_text(encoding="utf-8").splitlines()
    added = [line for line in mutant.source.splitlines() if line not in source]
    assert len(added) == 1
    assert mutant.source.splitlines().index(added[0]) + 1 == mutant.source.splitlines().index("def jonswap(")
    namespace: dict = {}
    exec(mutants.LARGER_SOURCE, namespace)
    array, pair = np.ones(3, np.float32), namespace["larger"](lambda: (2.0, np.arange(3)))()
    namespace["larger"](lambda out: None)(array)
    np.testing.assert_allclose(array, 1.05)
    assert array.dtype == np.float32
    assert pair[0] == pytest.approx(2.1)
    assert pair[1].tolist() == [0, 1, 2]


def test_operators_bounds_and_functions_are_taken_for_their_neighbours(tmp_path: Path) -> None:
    folder = tmp_path / mutants.CORE
    folder.mkdir(parents=True)
    (folder / "one.py").write_text("def f(a, b):\n    return max(a - 2.0 * b, 0.0) if a < b else 'α' + a\n")
    found = {mutant.source.splitlines()[1].strip() for mutant in mutants.of_structure(tmp_path, 100, 0)}
    assert found == {
        "return min(a - 2.0 * b, 0.0) if a < b else 'α' + a",
        "return max(a + 2.0 * b, 0.0) if a < b else 'α' + a",
        "return max(a - 2.0 / b, 0.0) if a < b else 'α' + a",
        "return max(a - 2.0 * b, 0.0) if a <= b else 'α' + a",
        "return max(a - 2.0 * b, 0.0) if a < b else 'α' - a",
    }
    assert len(list(mutants.of_structure(tmp_path, 2, 1))) == 2


def test_what_is_named_is_there() -> None:
    assert len(list(mutants.of_names(ROOT))) == len(mutants.NAMED)
    formulas = {mutant.name for mutant in mutants.of_formulas(ROOT)}
    assert {name for name in mutate.EQUIVALENT if name.startswith("formula ")} <= formulas


def test_what_cannot_be_imported_says_nothing_of_the_tests(tmp_path: Path) -> None:
    folder = tmp_path / mutate.TESTS
    folder.mkdir(parents=True)
    (folder / "test_one.py").write_text("import nothing_of_this_name\ndef test_a(): assert False\n")
    (folder / "test_two.py").write_text("def test_a(): assert False\n")
    assert mutate._first_failure_of(["test_one.py"], tmp_path) == mutate.BROKEN
    assert mutate._first_failure_of(["test_two.py"], tmp_path) == "tests/core/test_two.py::test_a"
    (folder / "conftest.py").write_text("1 / 0\n")
    assert mutate._first_failure_of(["test_two.py"], tmp_path) == mutate.BROKEN


def test_a_change_without_end_is_noticed(tmp_path: Path) -> None:
    folder = tmp_path / mutate.TESTS
    folder.mkdir(parents=True)
    (folder / "test_one.py").write_text("import time\ndef test_a(): time.sleep(60.0)\n")
    with pytest.raises(subprocess.TimeoutExpired):
        mutate._first_failure_of(["test_one.py"], tmp_path, limit=1.0)


def test_the_copy_holds_all_that_the_tests_import(tmp_path: Path) -> None:
    mutate.copy_into(tmp_path)
    files = [path for path in (tmp_path / mutate.TESTS).glob("test_*.py") if path.name not in mutate.LEFT_OUT]
    command = [
        sys.executable,
        "-m",
        "pytest",
        "-q",
        "-p",
        "no:cacheprovider",
        "--collect-only",
        *map(str, files),
    ]
    answer = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert answer.returncode == 0, answer.stdout[-2000:]
