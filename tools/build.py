# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds and validates the extension's zip with Blender's own commands: `make build`."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from . import real_blender, wheels
from .project import BUILD, ROOT, ToolError


def zip_path() -> Path:
    """Return where the zip of this version is built."""
    manifest = wheels.manifest()
    return BUILD / f"{manifest['id']}-{manifest['version']}.zip"


def build(blender: real_blender.RealBlender) -> Path:
    """Build and validate the zip; return its path."""
    wheels.download()
    BUILD.mkdir(exist_ok=True)
    zip_path().unlink(missing_ok=True)
    extension(blender, "build", "--output-dir", str(BUILD))
    extension(blender, "validate", str(zip_path()))
    return zip_path()


def extension(blender: real_blender.RealBlender, *arguments: str, env: dict[str, str] | None = None) -> None:
    """Run `blender --command extension ...`; raise `ToolError` if it fails."""
    command = [*blender.command, "--command", "extension", *arguments]
    code = subprocess.call(command, cwd=ROOT, env=env, stdin=subprocess.DEVNULL)
    if code:
        raise ToolError(f"`{' '.join(command)}` failed with exit code {code}: its messages stand above")


def main() -> int:
    """Build the zip; return the exit code."""
    try:
        path = build(real_blender.find())
        print(f"built {path.relative_to(ROOT)}, {path.stat().st_size / 1e6:.1f} MB")
    except real_blender.NoBlender as missing:
        print(f"no real Blender to build with: {missing}", file=sys.stderr)
        return 1
    except ToolError as error:
        print(f"build failed: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
