# SPDX-License-Identifier: GPL-3.0-or-later
"""Changes one thing in the core at a time and asks which test notices: `make mutate`.

Physical constants by 2 %, what formulas return by 5 %, and a random sample of operators and bounds into their
neighbours; see tools/mutants.py. The checkout is never touched: every change is made in a copy of its own.
"""

from __future__ import annotations

import argparse
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
from functools import partial
from pathlib import Path

from . import mutants
from .mutants import Mutant
from .project import ROOT, ToolError
from .run_tests import ONE_THREAD

TESTS = Path("tests/core")
COPIED = (
    "ocean_tweak", "tests/core", "tests/reference", "tests/coasts.py", "tests/layers.py",
    "tests/new_kinds.py", "pyproject.toml", "examples/horizon.json", "docs/cascades.md", "docs/python.md",
)  # fmt: skip
KINDS = ("constants", "formulas", "named", "structure")
AT_ONCE = 2

#: of all mutants, how many may go unnoticed
ALLOWED_SHARE = 0.05

#: these compare prose with the code; that prose must follow a constant says nothing about its value
LEFT_OUT = ("test_documentation.py", "test_pages.py")

#: the cheap tests of published numbers, which notice most; the others run only where these see nothing
FIRST = (
    "test_constants.py", "test_spectra.py", "test_published_numbers.py", "test_dispersion.py",
    "test_noise_synthesis.py",
)  # fmt: skip

#: changes after which the program does the same → why
EQUIVALENT = {
    "formula spectral.spreading.Shape.density x 1.05": "D is divided by its integral, which this makes too",
    "formula spectral.spreading.cosine_power x 1.05": "D is divided by its integral, which this makes too",
    "formula spectral.spreading.squared_sech x 1.05": "D is divided by its integral, which this makes too",
    "formula numerics.random.hash_wave_vectors x 1.05": "whole numbers, which are left as they are",
    "formula synthesis.transforms.term x 1.05": "whole numbers, which are left as they are",
    "formula waves.image.animation.dominant_band x 1.05": "truth values, which are left as they are",
    "formula waves.wind_field.life.divisions x 1.05": "whole numbers, which are left as they are",
    "formula waves.wind_field.wind_waves.WindWaves.shares x 1.05": "no numbers: they are made by the block",
    "structure waves.wind_field.shape.bump: distance < radius: < -> <=": "the bump is 0 at its radius",
    "structure waves.image.parameters.check: "
    "abs(a - b) > _WHOLE * max(1.0, patches): > -> >=": "a distance of the very limit",
    "structure statistics.sea_statistics.loop_warnings: "
    "statistics.loop_speed_change > _LARGEST_SPEED_CHANGE: > -> >=": "the very limit",
    "structure sea.query._sheets: "
    "np.hypot(x - start_x, y - start_y) < 2.0 * step: < -> <=": "a distance of the very limit",
    "structure sea.query._sheets: "
    "min(_NET, max(2, int(np.ceil(2.0 * reach / spacing)))): min -> max": "a finer net, which takes longer",
    "structure waves.wind_field.convolution.kernel: 2 * reach: * -> /": "no bump is wider than the patch",
    "structure sea.query.inside_quad: u < 1 + edge: < -> <=": "a place on the very edge",
    "structure parameters.former_json._path: "
    "len(found[1]) < 6: < -> <=": "no sea has a hundred thousand layers",
    "structure waves.hero.group._blocks: along * cosine: * -> /": "more places are tried, which hold no wave",
    "structure waves.image.filters._modified_pierson_moskowitz: "
    "grid.ky[rows[row], 0][:, np.newaxis, np.newaxis] + offset[:,: + -> -": "the offsets lie evenly about 0",
    "structure sea.query.newton: "
    "np.hypot(off_x, off_y) > _TOLERANCE * spacing: > -> >=": "an error of the very limit",
    "structure foam.drifting.missing: "
    "self._last > index: > -> >=": "made again where it is at hand, which only takes longer",
}

#: said of a change with which the core cannot even be imported: no test had to notice it
BROKEN = "cannot be imported"

#: a change may make the core wait for what never comes: longer than this many times what all tests take
PATIENCE = 10.0

#: of a test file, or of what all of them share
BROKEN_IMPORT = re.compile(r"^(?:ERROR |ImportError while loading conftest)", re.MULTILINE)
FAILED_TEST = re.compile(r"^(?:FAILED|ERROR) (.+?)(?: - .*)?$", re.MULTILINE)


@dataclass(frozen=True)
class Verdict:
    """Which test failed first with a change; None if all passed, BROKEN if none could run."""

    mutant: Mutant
    noticed_by: str | None
    seconds: float

    def __str__(self) -> str:
        answer = self.noticed_by or ("the same" if self.mutant.name in EQUIVALENT else "NOBODY NOTICED")
        return f"{self.mutant.name:70} {self.seconds:4.0f} s  {answer}"


def main(arguments: Sequence[str] | None = None) -> int:
    """Try the mutants of some kinds; return 1 where too many went unnoticed.

    Of changes of the structure 5 % may, of the others none.
    """
    parser = argparse.ArgumentParser(prog="python -m tools.mutate", description=__doc__)
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=KINDS, help="by default all")
    parser.add_argument("--only", default="", metavar="TEXT", help="those whose name holds this")
    parser.add_argument("--sample", type=int, default=100, help="changes of the structure, by default 100")
    parser.add_argument("--seed", type=int, default=0, help="of the sample")
    wishes = parser.parse_args(arguments)
    try:
        found = mutants.chosen(ROOT, wishes.kinds, wishes.sample, wishes.seed)
        asked = [mutant for mutant in found if wishes.only in mutant.name]
        if not asked:
            parser.error(f"no mutant's name holds {wishes.only!r}")
        return _try_all(asked)
    except ToolError as error:
        print(f"mutate failed: {error}", file=sys.stderr)
        return 1


def _try_all(asked: Sequence[Mutant]) -> int:
    begin = time.monotonic()
    failed = first_failure(None)
    if failed:
        raise ToolError(f"{failed} fails with nothing changed: mend that first")
    limit = PATIENCE * (time.monotonic() - begin)
    print(f"all tests pass unchanged; now {len(asked)} changes", flush=True)
    verdicts = []
    with ThreadPoolExecutor(AT_ONCE) as pool:
        for verdict in pool.map(partial(_judge, limit=limit), asked):
            print(verdict, flush=True)
            verdicts.append(verdict)
    tried = [verdict for verdict in verdicts if verdict.noticed_by != BROKEN]
    missed = [v.mutant.name for v in tried if v.noticed_by is None and v.mutant.name not in EQUIVALENT]
    print(f"{len(tried) - len(missed)} of {len(tried)} changes noticed, or equivalent")
    if len(tried) < len(verdicts):
        print(f"{len(verdicts) - len(tried)} more {BROKEN}, which says nothing of the tests")
    for name in missed:
        print(f"no test noticed: {name}")
    too_many = len(missed) > ALLOWED_SHARE * len(tried)
    return 1 if too_many or not all(name.startswith("structure ") for name in missed) else 0


def _judge(mutant: Mutant, limit: float) -> Verdict:
    begin = time.monotonic()
    return Verdict(mutant, first_failure(mutant, limit), time.monotonic() - begin)


def first_failure(mutant: Mutant | None, limit: float | None = None) -> str | None:
    """Return the core's first failing test with this change, BROKEN if none can run, None if all pass.

    limit : s; tests that take longer have noticed the change

    Raises `ToolError` if the tests could not be run.
    """
    with tempfile.TemporaryDirectory(prefix="ocean-tweak-mutant-") as name:
        copy = Path(name)
        copy_into(copy)
        own: tuple[str, ...] = ()
        if mutant is not None:
            (copy / mutants.LARGER).write_text(mutants.LARGER_SOURCE, encoding="utf-8")
            (copy / mutant.path).write_text(mutant.source, encoding="utf-8")
            own = tuple(test for test in mutant.tests if test.partition("::")[0] not in LEFT_OUT)
        files = sorted(path.name for path in (copy / TESTS).glob("test_*.py") if path.name not in LEFT_OUT)
        first = [file for file in FIRST if file in files]
        rest = [file for file in files if file not in FIRST]
        try:
            for tests in (own, first, rest):
                failed = _first_failure_of(tests, copy, limit)
                if failed:
                    return failed
        except subprocess.TimeoutExpired:
            return f"no end within {limit:.0f} s"
        return None


def copy_into(folder: Path) -> None:
    """Copy the core and its tests, with all that they import, into an empty folder."""
    for part in COPIED:
        _copy(ROOT / part, folder / part)


def _copy(source: Path, target: Path) -> None:
    target.parent.mkdir(parents=True, exist_ok=True)
    if source.is_dir():
        shutil.copytree(source, target, ignore=shutil.ignore_patterns("__pycache__"))
    else:
        shutil.copy(source, target)


def _first_failure_of(tests: Sequence[str], copy: Path, limit: float | None = None) -> str | None:
    if not tests:
        return None
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", "--tb=no"]
    answer = subprocess.run(
        [*command, *(str(TESTS / file) for file in tests)],
        cwd=copy,
        env={**os.environ, **ONE_THREAD, "PYTHONDONTWRITEBYTECODE": "1"},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        errors="replace",
        timeout=limit,
    )
    if answer.returncode == 0:
        return None
    found = FAILED_TEST.search(answer.stdout)
    if answer.returncode in (2, 3, 4) and BROKEN_IMPORT.search(answer.stdout):  # while they were collected
        return BROKEN
    if answer.returncode != 1 or not found:
        raise ToolError(f"the tests could not be run:\n{answer.stdout[-2000:]}")
    return found[1]


if __name__ == "__main__":
    sys.exit(main())
