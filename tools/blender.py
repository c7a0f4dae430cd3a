# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs a Python script with `bpy`, in a real Blender or in a bpy wheel; the script need not know in which.

python3 -m tools.blender [--in real|5.2|4.5] [FILE.blend] SCRIPT.py [-- ARGUMENT ...]

The script finds its own arguments behind "--" in `sys.argv`. Its failure is the exit code's.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
from collections.abc import Sequence

from . import environments, real_blender
from .project import ROOT, ToolError

BOOTSTRAP = ROOT / "tools" / "bpy_script.py"


def command(
    script: str, arguments: Sequence[str] = (), blend: str | None = None, where: str = "any"
) -> list[str]:
    """Return the command that runs a script.

    `where` is "real", "5.2" or "4.5" (the wheels), or "any": a real Blender, failing that the 5.2 wheel.
    Raises `NoBlender` if "real" is asked for and there is none.
    """
    if where in ("real", "any"):
        try:
            blender = real_blender.find().command
        except real_blender.NoBlender:
            if where == "real":
                raise
        else:
            options = ["--background", "--factory-startup", "--python-exit-code", "1"]
            files = [blend] if blend else []
            return [*blender, *options, *files, "--python", script, "--", *arguments]
    python = environments.python("python-5.2" if where == "any" else f"python-{where}")
    return [str(python), str(BOOTSTRAP), *([blend] if blend else []), script, "--", *arguments]


def main() -> int:
    """Run the script named on the command line; return its exit code."""
    arguments = sys.argv[1:]
    split = arguments.index("--") if "--" in arguments else len(arguments)
    parser = argparse.ArgumentParser(
        prog="python3 -m tools.blender",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--in", dest="where", choices=["any", "real", "5.2", "4.5"], default="any")
    parser.add_argument("blend", nargs="?", metavar="FILE.blend")
    parser.add_argument("script", metavar="SCRIPT.py")
    options = parser.parse_args(arguments[:split])
    try:
        run = command(options.script, arguments[split + 1 :], options.blend, options.where)
    except ToolError as error:
        print(f"no Blender to run {options.script} in: {error}", file=sys.stderr)
        return 1
    return subprocess.call(run, stdin=subprocess.DEVNULL)


if __name__ == "__main__":
    sys.exit(main())
