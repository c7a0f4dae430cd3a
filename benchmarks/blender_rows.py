# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs `in_blender.py` in the bpy wheel and in a real Blender, and takes its rows over."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Iterator
from typing import Any

from tools import blender, real_blender

from .plan import SCRATCH, Plan
from .rows import Row

GROUP = "Blender"
PLACES = {"5.2": "bpy 5.2 wheel", "real": "real Blender"}
_SCRIPT = "benchmarks/in_blender.py"

#: what each Blender said about itself in this process
versions: dict[str, dict[str, Any]] = {}


def rows(plan: Plan) -> Iterator[Row]:
    """All rows of every Blender that is here; the smoke run is content with the wheel."""
    places = ["5.2"]
    if not plan.smoke:
        places += ["real"] * _has_real_blender()
    for where in places:
        report = run_script(plan, where)
        versions[PLACES[where]] = {key: report[key] for key in ("blender", "python", "numpy")}
        yield from (Row.from_dict(row) for row in report["rows"])


def _has_real_blender() -> bool:
    try:
        real_blender.find()
    except real_blender.NoBlender as missing:
        print(f"no real Blender: {missing}", flush=True)
        return False
    return True


def run_script(plan: Plan, where: str) -> dict[str, Any]:
    """What the script reports. Raises RuntimeError with the end of its output if it fails."""
    SCRATCH.mkdir(parents=True, exist_ok=True)
    out = SCRATCH / f"blender-{where}.json"
    out.unlink(missing_ok=True)
    arguments = [
        "--sizes", *map(str, plan.scene), "--latency", str(plan.latency), "--rounds", str(plan.rounds),
        "--judge", str(plan.scene[-1]), "--place", PLACES[where], "--out", str(out),
        *["--bake-horizon"] * ("baked horizon" not in plan.left_out),
    ]  # fmt: skip
    command = blender.command(_SCRIPT, arguments, where=where)
    answer = subprocess.run(
        command, cwd=blender.ROOT, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT, text=True, errors="replace",
    )  # fmt: skip
    if answer.returncode or not out.exists():
        tail = "\n".join(answer.stdout.splitlines()[-20:])
        raise RuntimeError(f"{_SCRIPT} failed in {PLACES[where]}, exit code {answer.returncode}:\n{tail}")
    return json.loads(out.read_text(encoding="utf-8"))
