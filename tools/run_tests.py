# SPDX-License-Identifier: GPL-3.0-or-later
"""Every test there is: from source in both bpy wheels, and of the installed zip in a real Blender."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from . import build, real_blender, venvs
from .project import ROOT, TOOLS, ToolError

SOURCE_SUITES = (
    "tests/core",
    "tests/export",
    "tests/cli",
    "tests/usd",
    "tests/tools",
    "tests/blender",
)
# of files, processes and farms' programs, which are the same whatever Blender there is
ONCE = ("tests/farm", "tests/batch")
INSTALLED_SUITES = ("tests/blender", "tests/extension")
ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
CLOSING_LINE = re.compile(
    r"^=* ?((?:no tests ran|\d+ [a-z]+(?:, \d+ [a-z]+)*) in [\d.]+s.*?)(?: =+)?$", re.MULTILINE
)
PYTEST = ("-p", "no:cacheprovider", "-q")


@dataclass(frozen=True)
class Result:
    """How one suite ended in one place."""

    place: str
    suite: str
    passed: bool
    closing_line: str

    def __str__(self) -> str:
        return f"{'ok    ' if self.passed else 'FAILED'} {self.place:12} {self.suite:16} {self.closing_line}"


def main() -> int:
    """Run everything; return the exit code."""
    begin = time.monotonic()
    with ThreadPoolExecutor(2) as pool:  # two cores are common, and each of these keeps one busy
        of_wheels = [
            pool.submit(run_source_suites, "5.2", (*ONCE, *SOURCE_SUITES)),
            pool.submit(run_source_suites, "4.5", SOURCE_SUITES),
        ]
        of_zip = pool.submit(run_installed_suites_if_possible)
    installed, last_line, missing = of_zip.result()
    results = [result for of_one in of_wheels for result in of_one.result()] + installed
    failed = missing or not all(result.passed for result in results)
    print("\n== summary", *results, sep="\n")
    print(f"{'FAILED' if failed else 'all passed'} in {time.monotonic() - begin:.0f} s")
    print(last_line)
    return 1 if failed else 0


def run_source_suites(blender: str, suites: Sequence[str]) -> list[Result]:
    """Run suites from source in the environment of this Blender's wheel."""
    command = [str(venvs.python(blender)), "-m", "pytest", *PYTEST]
    env = test_environment(f"bpy-{blender}")
    return [run_suite(f"bpy {blender}", suite, [*command, suite], env) for suite in suites]


def run_installed_suites_if_possible() -> tuple[list[Result], str, bool]:
    """Results of the installed zip, a line on the Blender they are of, and whether its lack is a failure."""
    try:
        blender = real_blender.find()
        return run_installed_suites(blender), f"real Blender: {blender}", False
    except real_blender.NoBlender as reason:
        text = f"no real Blender, so the installed extension was not tested: {reason}"
        return [], text, real_blender.required()
    except ToolError as error:
        return [], f"the extension was not tested: {error}", True


def run_installed_suites(blender: real_blender.RealBlender) -> list[Result]:
    """Build the zip, install it into a fresh profile as an artist would, and test it there."""
    zip_file = build.build(blender)
    env = {**test_environment("real-blender"), "OCEAN_TWEAK_ZIP": str(zip_file)}
    install(blender, zip_file, env)
    options = [
        "--background",
        "--python-exit-code",
        "1",
        "--python",
        str(ROOT / "tools/pytest_in_blender.py"),
    ]
    command = [*blender.command, *options, "--", str(venvs.PYTEST_IN_BLENDER), *PYTEST, f"--rootdir={ROOT}"]
    return [run_suite("real Blender", suite, [*command, suite], env) for suite in INSTALLED_SUITES]


def install(blender: real_blender.RealBlender, zip_file: Path, env: Mapping[str, str]) -> None:
    """Install and enable the zip in the profile of this environment."""
    options = ("install-file", "-r", "user_default", "--enable", str(zip_file))
    build.extension(blender, *options, env=dict(env))


def test_environment(place: str) -> dict[str, str]:
    """Return the environment of a test run: an empty profile of its own, and no threads beside the tests'."""
    profile = TOOLS / "test-profiles" / place
    shutil.rmtree(profile, ignore_errors=True)
    own = {name: value for name, value in os.environ.items() if name != "OCEAN_TWEAK_ZIP"}
    return {**own, **ONE_THREAD, "BLENDER_USER_RESOURCES": str(profile)}


def run_suite(place: str, suite: str, command: Sequence[str], env: Mapping[str, str]) -> Result:
    """Run one suite, print what it said when it is through, and return how it ended."""
    answer = subprocess.run(
        command,
        cwd=ROOT,
        env=env,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        errors="replace",
    )
    print(f"\n== {place}: {suite}\n{answer.stdout.rstrip()}", flush=True)
    return Result(place, suite, answer.returncode == 0, closing_line(answer.stdout, answer.returncode))


def closing_line(output: str, code: int) -> str:
    """Return pytest's own last word, or say that there was none."""
    found = CLOSING_LINE.findall(output)
    if found:
        return found[-1]
    return f"ended with exit code {code} before pytest was through"


if __name__ == "__main__":
    sys.exit(main())
