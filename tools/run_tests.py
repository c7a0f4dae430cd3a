# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the tests: each once, and in every Blender what can differ there (`--all`: every test everywhere).

Files are queued over the processors. A process takes many of them while many are left and single ones at the
end, so that few processes are started and none is waited for long (guided self-scheduling: Polychronopoulos
and Kuck 1987).
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import threading
import time
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from . import build, environments, real_blender
from .project import ROOT, TOOLS, ToolError

#: of files, processes and farms' programs, which are the same whatever Blender there is
ONCE = ("tests/farm", "tests/batch")
IN_EVERY_WHEEL = ("tests/blender", "tests/core", "tests/usd", "tests/cli", "tests/export", "tests/tools")
INSTALLED = ("tests/extension",)

#: of the suite for Blender, what depends on its version
OF_EVERY_VERSION = (
    "alembic", "animation", "assets", "every_operator", "files_of_0_1_0", "foreign_colours",
    "life_of_an_ocean", "node_trees", "old_groups", "overrides", "registration", "rendering",
    "scripting_documentation", "shot_files", "source_images", "stored_paths", "usd_import", "velocity_blur",
    "view_layers", "without_extension",
)  # fmt: skip
#: and what depends on whether the extension is installed, beside a Blender that is no module
OF_THE_ZIP = (
    "alembic", "assets", "every_operator", "life_of_an_ocean", "node_trees", "registration", "rendering",
    "scripting_documentation", "shot_files", "source_images", "without_extension",
)  # fmt: skip
#: of the core's, what depends on NumPy's version
OF_EVERY_NUMPY = ("energy", "fields", "foam", "surface", "surface_detail", "surface_query")

ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
NOT_FOR_TESTS = ("OCEAN_TWEAK_ZIP", "PYTHONDONTWRITEBYTECODE")
PYTEST = ("-p", "no:cacheprovider", "-q")
CLOSING_LINE = re.compile(
    r"^=* ?((?:no tests ran|\d+ [a-z]+(?:, \d+ [a-z]+)*) in [\d.]+s.*?)(?: =+)?$", re.MULTILINE
)
COUNT = re.compile(r"(\d+) ([a-z]+)")


@dataclass(frozen=True)
class Place:
    """Where tests run.

    command : before the arguments of pytest
    zip_file : the extension that is installed in `profile`; None where tests take it from source
    """

    name: str
    command: tuple[str, ...]
    zip_file: Path | None = None
    profile: Path | None = None

    def environment(self, slot: int) -> dict[str, str]:
        """Return the environment of a process: its own profile, with the zip where there is one."""
        env = test_environment(f"{self.name.replace(' ', '-')}-{slot}")
        if self.zip_file is not None and self.profile is not None:
            shutil.copytree(self.profile, env["BLENDER_USER_RESOURCES"], symlinks=True)
            env["OCEAN_TWEAK_ZIP"] = str(self.zip_file)
        return env


@dataclass(frozen=True)
class Result:
    """How files of one suite ended in one place.

    counts : tests by pytest's own word: passed, failed, skipped …
    """

    place: str
    suite: str
    passed: bool
    counts: Counter[str]
    closing_line: str
    seconds: float


class Queue:
    """Test files that wait for a process, in order: pairs of a place and a file."""

    def __init__(self, files: Sequence[tuple[Place, str]], slots: int) -> None:
        self._files = list(files)
        self._slots = slots
        self._lock = threading.Lock()

    def add(self, files: Sequence[tuple[Place, str]]) -> None:
        """Append files."""
        with self._lock:
            self._files.extend(files)

    def take(self) -> tuple[Place, list[str]] | None:
        """Return the files that a process should run next, all of one suite; None if none are left."""
        with self._lock:
            if not self._files:
                return None
            place, first = self._files[0]
            most = max(len(self._files) // (4 * self._slots), 1)
            batch = [first]
            for other, file in self._files[1:most]:
                if other is not place or suite_of(file) != suite_of(first):
                    break
                batch.append(file)
            del self._files[: len(batch)]
            return place, batch


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the tests; return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m tools.run_tests", description=__doc__)
    parser.add_argument("--all", action="store_true", help="every test in every Blender")
    everything = parser.parse_args(arguments).all
    begin = time.monotonic()
    slots = max(len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1, 1)
    queue = Queue(of_wheels(everything), slots)
    with ThreadPoolExecutor(slots) as pool:
        of_zip = pool.submit(install_and_queue, queue, everything)
        runs = [pool.submit(run_queued, queue, slot) for slot in range(slots)]
        last_line, missing = of_zip.result()
        # a slot that found the queue empty before the zip was installed has ended
        runs.append(pool.submit(run_queued, queue, slots))
        results = [result for run in runs for result in run.result()]
    failed = missing or not results or not all(result.passed for result in results)
    print("\n== summary", *summary(results), sep="\n")
    print(f"{'FAILED' if failed else 'all passed'} in {time.monotonic() - begin:.0f} s")
    print(last_line)
    return 1 if failed else 0


def of_wheels(everything: bool) -> list[tuple[Place, str]]:
    """Return the files to run from source: the slowest suite first."""
    newest, oldest = (
        Place(f"bpy {blender}", (str(environments.python(f"python-{blender}")), "-m", "pytest"))
        for blender in ("5.2", "4.5")
    )
    once = [(newest, file) for suite in (*IN_EVERY_WHEEL, *ONCE) for file in files_of(suite)]
    if everything:
        return [*once, *((oldest, file) for suite in IN_EVERY_WHEEL for file in files_of(suite))]
    again = [*chosen("tests/blender", OF_EVERY_VERSION), *chosen("tests/core", OF_EVERY_NUMPY)]
    return [*once, *((oldest, file) for file in again)]


def files_of(suite: str) -> list[str]:
    """Return the test files of a suite, the longest first."""
    files = sorted((ROOT / suite).glob("test_*.py"), key=lambda file: -file.stat().st_size)
    return [file.relative_to(ROOT).as_posix() for file in files]


def chosen(suite: str, names: Sequence[str]) -> list[str]:
    """Return the files of a suite with these names."""
    return [f"{suite}/test_{name}.py" for name in names]


def suite_of(file: str) -> str:
    """Return the folder of a test file: `tests/core`."""
    return file.rpartition("/")[0]


def install_and_queue(queue: Queue, everything: bool) -> tuple[str, bool]:
    """Queue what the installed zip is tested with; return a line on it, and whether that is a failure."""
    try:
        blender = real_blender.find()
        place = installed(blender)
    except real_blender.NoBlender as reason:
        text = f"no real Blender, so the installed extension was not tested: {reason}"
        return text, real_blender.required()
    except ToolError as error:
        return f"the extension was not tested: {error}", True
    of_blender = files_of("tests/blender") if everything else chosen("tests/blender", OF_THE_ZIP)
    own = [file for suite in INSTALLED for file in files_of(suite)]
    queue.add([(place, file) for file in (*of_blender, *own)])
    return f"real Blender: {blender}", False


def installed(blender: real_blender.RealBlender) -> Place:
    """Build the zip and install it into a profile, which is copied for each process."""
    zip_file = build.build(blender)
    env = test_environment("installed")
    install(blender, zip_file, env)
    script = ["--python-exit-code", "1", "--python", str(ROOT / "tools/pytest_in_blender.py")]
    command = [*blender.command, "--background", *script, "--", str(environments.PYTEST_IN_BLENDER)]
    profile = Path(env["BLENDER_USER_RESOURCES"])
    return Place("real Blender", (*command, f"--rootdir={ROOT}"), zip_file, profile)


def install(blender: real_blender.RealBlender, zip_file: Path, env: Mapping[str, str]) -> None:
    """Install and enable the zip in the profile of this environment, as an artist would."""
    options = ("install-file", "-r", "user_default", "--enable", str(zip_file))
    build.extension(blender, *options, env=dict(env))


def test_environment(profile_name: str) -> dict[str, str]:
    """Return the environment of a test run: an empty profile of its own, and no threads beside the tests'.

    Modules stay compiled, wherever else they may not: to compile bpy's and ours takes longer than most files.
    """
    profile = TOOLS / "test-profiles" / profile_name
    shutil.rmtree(profile, ignore_errors=True)
    own = {name: value for name, value in os.environ.items() if name not in NOT_FOR_TESTS}
    return {**own, **ONE_THREAD, "BLENDER_USER_RESOURCES": str(profile)}


def run_queued(queue: Queue, slot: int) -> list[Result]:
    """Run files until none are left."""
    results = []
    while (taken := queue.take()) is not None:
        place, files = taken
        results.append(run_files(place, files, place.environment(slot)))
    return results


def run_files(place: Place, files: Sequence[str], env: Mapping[str, str]) -> Result:
    """Run files of a suite in one process, print what it said when it is through; return how it ended."""
    begin = time.monotonic()
    answer = subprocess.run(
        [*place.command, *PYTEST, *files],
        cwd=ROOT,
        env=env,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        errors="replace",
    )
    suite, line = suite_of(files[0]), closing_line(answer.stdout, answer.returncode)
    names = ", ".join(Path(file).stem.removeprefix("test_") for file in files)
    print(f"\n== {place.name}: {suite}: {names}\n{answer.stdout.rstrip()}", flush=True)
    counts = Counter({word: int(count) for count, word in COUNT.findall(line.partition(" in ")[0])})
    passed = answer.returncode == 0
    return Result(place.name, suite, passed, counts, line, time.monotonic() - begin)


def closing_line(output: str, code: int) -> str:
    """Return pytest's own last word, or say that there was none."""
    found = CLOSING_LINE.findall(output)
    if found:
        return found[-1]
    return f"ended with exit code {code} before pytest was through"


def summary(results: Sequence[Result]) -> Iterator[str]:
    """Yield a line for each suite in each place, its processes added up, and one for each that broke off."""
    for key in dict.fromkeys((result.place, result.suite) for result in results):
        of_one = [result for result in results if (result.place, result.suite) == key]
        counts: Counter[str] = sum((result.counts for result in of_one), Counter())
        told = ", ".join(f"{count} {word}" for word, count in counts.items()) or "no tests ran"
        verdict = "ok    " if all(result.passed for result in of_one) else "FAILED"
        seconds = sum(result.seconds for result in of_one)
        yield f"{verdict} {key[0]:12} {key[1]:16} {told} in {seconds:.0f} s"
        yield from (f"       {result.closing_line}" for result in of_one if not result.counts)


if __name__ == "__main__":
    sys.exit(main())
