# SPDX-License-Identifier: GPL-3.0-or-later
"""Downloads into wheels/ exactly the files the manifest names, and no others stay there."""

from __future__ import annotations

import subprocess
import sys
import tomllib
from pathlib import Path

from .project import ROOT, WHEELS, ToolError


def manifest() -> dict:
    """Return the extension's manifest."""
    return tomllib.loads((ROOT / "blender_manifest.toml").read_text())


def wheel_names() -> list[str]:
    """Return the file names of the wheels the manifest lists."""
    return [Path(path).name for path in manifest()["wheels"]]


def download() -> None:
    """Make wheels/ hold what the manifest lists."""
    WHEELS.mkdir(exist_ok=True)
    names = wheel_names()
    for file in WHEELS.iterdir():
        if file.name not in names:
            file.unlink()
    for name in names:
        if not (WHEELS / name).exists():
            _download_one(name)


def pip_arguments(wheel: str) -> list[str]:
    """Return the arguments of `pip download` that fetch this wheel and no other."""
    project, version, python, abi, platforms = wheel.removesuffix(".whl").split("-")
    platform_arguments = [f"--platform={platform}" for platform in platforms.split(".")]
    interpreter = [f"--implementation={python[:2]}", f"--python-version={python[2:]}", f"--abi={abi}"]
    return ["--no-deps", "--only-binary=:all:", *interpreter, *platform_arguments, f"{project}=={version}"]


def _download_one(wheel: str) -> None:
    pip = [sys.executable, "-m", "pip", "download", "--quiet", "--dest", str(WHEELS), *pip_arguments(wheel)]
    code = subprocess.call(pip, stdin=subprocess.DEVNULL)
    if code or not (WHEELS / wheel).exists():
        raise ToolError(
            f"{wheel} could not be downloaded (pip's exit code {code}): correct `wheels` in "
            "blender_manifest.toml, or try again when the package index can be reached"
        )
