# SPDX-License-Identifier: GPL-3.0-or-later
"""Changes each physical constant of the core by 2 % in turn and asks which test notices: `make mutate`.

The checkout is never touched: every change is made in a copy of its own.
"""

from __future__ import annotations

import argparse
import ast
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from .project import ROOT, ToolError
from .run_tests import ONE_THREAD

CONSTANTS = Path("ocean_tweak/core/constants.py")
TESTS = Path("tests/core")
COPIED = ("ocean_tweak", "tests/core", "tests/reference", "pyproject.toml")
FACTOR = 1.02
AT_ONCE = 2

#: these compare prose with the code; that prose must follow a constant says nothing about its value
LEFT_OUT = ("test_documentation.py",)

#: the cheap tests of published numbers, which notice most; the others run only where these see nothing
FIRST = (
    "test_constants.py", "test_spectra.py", "test_published_numbers.py", "test_dispersion.py",
    "test_noise_synthesis.py",
)  # fmt: skip

FAILED_TEST = re.compile(r"^(?:FAILED|ERROR) (.+?)(?: - .*)?$", re.MULTILINE)


@dataclass(frozen=True)
class Constant:
    """A number in the source: where it stands, and what it is."""

    name: str
    value: float
    line: int
    start: int
    end: int


@dataclass(frozen=True)
class Verdict:
    """Which test failed first with a constant changed; None if all passed."""

    constant: Constant
    noticed_by: str | None
    seconds: float

    def __str__(self) -> str:
        change = f"{self.constant.value:g} -> {self.constant.value * FACTOR:g}"
        answer = self.noticed_by or "NOBODY NOTICED"
        return f"{self.constant.name:26} {change:22} {self.seconds:4.0f} s  {answer}"


def main(arguments: Sequence[str] | None = None) -> int:
    """Try every constant, or those named; return 1 if a change went unnoticed."""
    parser = argparse.ArgumentParser(prog="python -m tools.mutate", description=__doc__)
    parser.add_argument("name", nargs="*", help="constants to change; all of them by default")
    names = parser.parse_args(arguments).name
    found = constants((ROOT / CONSTANTS).read_text(encoding="utf-8"))
    unknown = set(names) - {constant.name for constant in found}
    if unknown:
        parser.error(f"no such constant in {CONSTANTS}: {', '.join(sorted(unknown))}")
    chosen = [constant for constant in found if not names or constant.name in names]
    try:
        return _try_all(chosen)
    except ToolError as error:
        print(f"mutate failed: {error}", file=sys.stderr)
        return 1


def _try_all(chosen: Sequence[Constant]) -> int:
    failed = first_failure(None)
    if failed:
        raise ToolError(f"{failed} fails with nothing changed: mend that first")
    print(f"all tests pass unchanged; now {len(chosen)} constants, times {FACTOR:g} each", flush=True)
    verdicts = []
    with ThreadPoolExecutor(AT_ONCE) as pool:
        for verdict in pool.map(_judge, chosen):
            print(verdict, flush=True)
            verdicts.append(verdict)
    missed = [verdict.constant.name for verdict in verdicts if verdict.noticed_by is None]
    print(f"{len(verdicts) - len(missed)} of {len(verdicts)} changes noticed")
    if missed:
        print(f"no test noticed: {', '.join(missed)}")
    return 1 if missed else 0


def _judge(constant: Constant) -> Verdict:
    begin = time.monotonic()
    return Verdict(constant, first_failure(constant), time.monotonic() - begin)


def constants(source: str) -> list[Constant]:
    """Return every `NAME = number` at the top level of a module."""
    found = []
    for statement in ast.parse(source).body:
        if not isinstance(statement, ast.Assign) or not isinstance(statement.targets[0], ast.Name):
            continue
        value = ast.literal_eval(statement.value)
        node = statement.value
        if node.end_lineno != node.lineno or node.end_col_offset is None:
            raise ToolError(f"line {node.lineno}: a constant must stand on one line")
        name = statement.targets[0].id
        found.append(Constant(name, value, node.lineno, node.col_offset, node.end_col_offset))
    return found


def changed(source: str, constant: Constant) -> str:
    """Return the source with the constant times `FACTOR`."""
    lines = source.splitlines(keepends=True)
    line = lines[constant.line - 1].encode()  # ast counts bytes
    value = f"{constant.value * FACTOR:.12g}".encode()
    lines[constant.line - 1] = (line[: constant.start] + value + line[constant.end :]).decode()
    return "".join(lines)


def first_failure(constant: Constant | None) -> str | None:
    """Return the core's first failing test with this constant changed, None if all pass.

    Raises `ToolError` if the tests could not be run.
    """
    with tempfile.TemporaryDirectory(prefix="ocean-tweak-mutant-") as name:
        copy = Path(name)
        for part in COPIED:
            _copy(ROOT / part, copy / part)
        if constant:
            source = (copy / CONSTANTS).read_text(encoding="utf-8")
            (copy / CONSTANTS).write_text(changed(source, constant), encoding="utf-8")
        files = sorted(path.name for path in (copy / TESTS).glob("test_*.py") if path.name not in LEFT_OUT)
        first = [file for file in FIRST if file in files]
        rest = [file for file in files if file not in FIRST]
        return _first_failure_of(first, copy) or _first_failure_of(rest, copy)


def _copy(source: Path, target: Path) -> None:
    target.parent.mkdir(parents=True, exist_ok=True)
    if source.is_dir():
        shutil.copytree(source, target, ignore=shutil.ignore_patterns("__pycache__"))
    else:
        shutil.copy(source, target)


def _first_failure_of(files: Sequence[str], copy: Path) -> str | None:
    if not files:
        return None
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", "--tb=no"]
    answer = subprocess.run(
        [*command, *(str(TESTS / file) for file in files)],
        cwd=copy,
        env={**os.environ, **ONE_THREAD, "PYTHONDONTWRITEBYTECODE": "1"},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        errors="replace",
    )
    if answer.returncode == 0:
        return None
    found = FAILED_TEST.search(answer.stdout)
    if answer.returncode != 1 or not found:
        raise ToolError(f"the tests could not be run:\n{answer.stdout[-2000:]}")
    return found[1]


if __name__ == "__main__":
    sys.exit(main())
