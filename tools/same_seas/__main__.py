# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether the working tree makes the same seas as another commit, bit for bit: `make same-seas BASE=COMMIT`.

Both are imported into one process, side by side, and read the seas of seas.json. Compared are arrays, numbers
and the text of node groups, never files: those hold names and versions that may change.
"""

from __future__ import annotations

import argparse
import importlib
import importlib.util
import io
import json
import subprocess
import sys
import tarfile
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

from ..project import ROOT, ToolError
from . import made

SEAS = Path(__file__).with_name("seas.json")


def main() -> int:
    """Compare; return 1 where something differs."""
    parser = argparse.ArgumentParser(prog="python -m tools.same_seas", description=__doc__)
    parser.add_argument("base", nargs="?", default="HEAD", help="a commit; HEAD by default")
    parser.add_argument("--sea", action="append", help="one of the seas of seas.json; all by default")
    arguments = parser.parse_args()
    seas: dict[str, Any] = json.loads(SEAS.read_text(encoding="utf-8"))
    unknown = set(arguments.sea or ()) - seas.keys()
    if unknown:
        parser.error(f"no such sea: {', '.join(sorted(unknown))}; there are {', '.join(seas)}")
    chosen = {name: sea for name, sea in seas.items() if name in (arguments.sea or seas)}
    begin = time.monotonic()
    try:
        with tempfile.TemporaryDirectory(prefix="same-seas-") as folder:
            unpack(arguments.base, Path(folder))
            base = imported("ocean_tweak_of_base", Path(folder) / "ocean_tweak")
            now = imported("ocean_tweak_of_now", ROOT / "ocean_tweak")
            count, differences = 0, []
            for things, difference in compared(base, now, chosen):
                count += things
                if difference:
                    print(f"DIFFERS {difference}", flush=True)
                    differences.append(difference)
    except ToolError as error:
        print(f"same-seas failed: {error}", file=sys.stderr)
        return 1
    print(
        f"{len(chosen)} seas, {count} things compared in {time.monotonic() - begin:.0f} s: "
        f"{f'{len(differences)} differ' if differences else 'all the same'}"
    )
    return 1 if differences or not count else 0


def unpack(commit: str, folder: Path) -> None:
    """Put the package of a commit into a folder."""
    answer = subprocess.run(
        ["git", "archive", "--format=tar", commit, "ocean_tweak"], cwd=ROOT, capture_output=True
    )
    if answer.returncode:
        raise ToolError(f"git archive {commit}: {answer.stderr.decode(errors='replace').strip()}")
    with tarfile.open(fileobj=io.BytesIO(answer.stdout)) as archive:
        archive.extractall(folder, filter="data")


def imported(name: str, folder: Path) -> ModuleType:
    """Import a copy of the package under a name of its own; its modules know each other relatively."""
    description = importlib.util.spec_from_file_location(
        name, folder / "__init__.py", submodule_search_locations=[str(folder)]
    )
    if description is None or description.loader is None:
        raise ToolError(f"{folder} holds no package")
    module = importlib.util.module_from_spec(description)
    sys.modules[name] = module
    description.loader.exec_module(module)
    return module


def compared(base: ModuleType, now: ModuleType, seas: dict[str, Any]) -> Iterator[tuple[int, str]]:
    """Yield how many things were compared, and what differs, if anything."""
    for name, sea in seas.items():
        for before, after in zip(made.of_sea(base, sea), made.of_sea(now, sea), strict=True):
            yield _pair(name, before, after)
    shot = next(iter(seas.values()))
    for of_kind in (made.of_usd, made.of_node_groups):
        before_all, after_all = dict(of_kind(base, shot)), dict(of_kind(now, shot))
        for label in before_all.keys() | after_all.keys():
            yield _pair("", (label, before_all.get(label)), (label, after_all.get(label)))


def _pair(sea: str, before: tuple[str, Any], after: tuple[str, Any]) -> tuple[int, str]:
    label = f"{sea}: {before[0]}" if sea else before[0]
    if before[0] != after[0]:
        return 1, f"{label} is {after[0]} now"
    return 1, made.difference(label, before[1], after[1])


if __name__ == "__main__":
    sys.exit(main())
