# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes docs/papers anew: `python -m tools.papers`, or `make papers`."""

from __future__ import annotations

import argparse
import json
import os
import sys
import time

from .. import blender, environments
from ..project import BUILD, ROOT, ToolError, run_logged
from . import chen, horvath, lantz, li_wang, mastin
from .pages import PAGES, Table, Tables, page, updated

#: page → the tables that today's code makes
TABLES: dict[str, Tables] = {
    "horvath-2015": horvath.TABLES,
    "chen-2014": chen.TABLES,
    "mastin-1987": mastin.TABLES,
    "lantz": lantz.TABLES,
    "li-wang-2016": li_wang.TABLES,
}

#: bytes that all pictures together may have
_ALL_PICTURES = 3_000_000

_LOG = BUILD / "papers" / "papers.log"
_MEASURED = BUILD / "papers" / "measured.json"


def main() -> int:
    """Make tables, plots and renders; return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m tools.papers", description=__doc__)
    parser.add_argument("--tables", action="store_true", help="only the tables")
    arguments = parser.parse_args()
    begin = time.monotonic()
    try:
        for name, tables in TABLES.items():
            _write(name, tables)
        if not arguments.tables:
            _draw()
            _render()
    except (ToolError, OSError) as error:
        print(f"papers failed: {error}", file=sys.stderr)
        return 1
    print(f"docs/papers: {time.monotonic() - begin:.0f} s")
    return 0


def _write(name: str, tables: Tables) -> None:
    path = page(name)
    path.write_text(updated(path.read_text(encoding="utf-8"), tables), encoding="utf-8")


def _draw() -> None:
    environments.make_uv()
    environments.make("papers")
    run_logged(
        [str(environments.python("papers")), "-m", "tools.papers.figures"],
        _LOG,
        {**os.environ, "PYTHONPATH": str(ROOT)},
    )


def _render() -> None:
    script = ROOT / "tools" / "papers" / "render.py"
    run_logged(blender.command(str(script), ["--measured", str(_MEASURED)], where="5.2"), _LOG)
    measured = json.loads(_MEASURED.read_text(encoding="utf-8"))
    _write("chen-2014", {"frame-times": lambda: frame_times(measured)})
    size = sum(path.stat().st_size for path in PAGES.glob("*/*.*"))
    if size > _ALL_PICTURES:
        raise ToolError(f"the pictures of docs/papers have {size} bytes, more than {_ALL_PICTURES}")


def frame_times(measured: dict[str, float]) -> Table:
    """Chen's frame rates beside ours; `measured` holds milliseconds by samples."""
    rows = [["samples of a patch", "paper, GeForce GTX 460", "here"]]
    for samples, printed in (("128", 70), ("256", 49)):
        took = measured[samples]
        rows.append(
            [f"{samples} x {samples}", f"{printed} frames/s", f"{took:.0f} ms, {1e3 / took:.0f} frames/s"]
        )
    return rows


if __name__ == "__main__":
    sys.exit(main())
