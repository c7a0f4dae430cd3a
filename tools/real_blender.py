# SPDX-License-Identifier: GPL-3.0-or-later
"""A real `blender` program: `$BLENDER`, the one on PATH, or Debian's in a root file system of its own."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass

from . import stamps
from .project import ROOT, TOOLS, ToolError, run_logged

MINIMUM = (4, 5)
DEBIAN_ROOT = TOOLS / "blender-root"
DEBIAN_SUITE = "sid"
# the extension commands of Debian's Blender fail without these Python packages
PYTHON_PACKAGES = ("python3-numpy", "python3-requests", "python3-cattr", "python3-zstandard")
# drawing, a display and a mouse without hardware
DISPLAY_PACKAGES = ("libgl1-mesa-dri", "libgl1", "libegl1", "libglx-mesa0", "xvfb", "xauth", "xdotool")
DEBIAN_PACKAGES = ("blender", *PYTHON_PACKAGES, *DISPLAY_PACKAGES)
LOG = TOOLS / "logs" / "blender.log"


class NoBlender(ToolError):
    """No real Blender can be had on this machine; the text says why."""


@dataclass(frozen=True)
class RealBlender:
    """A Blender program that was run and answered."""

    command: tuple[str, ...]
    version: str

    def __str__(self) -> str:
        return f"{self.version} ({' '.join(self.command)})"


def required() -> bool:
    """Whether a run without a real Blender must fail."""
    return os.environ.get("OCEAN_TWEAK_REQUIRE_BLENDER", "0") not in ("", "0")


def find(make: bool = False) -> RealBlender:
    """Return the real Blender of this machine, if need be and `make` is set after making one.

    Raises `ToolError` if `$BLENDER` is set and unfit, `NoBlender` if there is none.
    """
    if os.environ.get("BLENDER"):
        command = (os.environ["BLENDER"],)
        found = _try(command)
        if found is None:
            raise ToolError(
                f"BLENDER={command[0]} is not a Blender {_minimum()} or newer that runs: correct or unset it"
            )
        return found
    if shutil.which("blender"):
        found = _try(("blender",))
        if found is not None:
            return found
    if not stamps.is_made(DEBIAN_ROOT, _recipe()):
        if not make:
            raise NoBlender("none was found: set BLENDER, or run `make setup`")
        _make_debian_root()
    found = _try((str(ROOT / "tools" / "in-blender-root"), "blender"))
    if found is None:
        raise NoBlender(f"Debian's in {DEBIAN_ROOT} does not run here: set BLENDER to one that does")
    return found


def _try(command: Sequence[str]) -> RealBlender | None:
    try:
        answer = subprocess.run(
            [*command, "--version"], stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=120
        )
    except (OSError, subprocess.TimeoutExpired):
        return None
    match = re.search(r"^Blender (\d+)\.(\d+).*$", answer.stdout, re.MULTILINE)
    if answer.returncode or not match or (int(match[1]), int(match[2])) < MINIMUM:
        return None
    return RealBlender(tuple(command), match[0].strip())


def _minimum() -> str:
    return ".".join(map(str, MINIMUM))


def _recipe() -> str:
    return f"Debian {DEBIAN_SUITE}: {' '.join(DEBIAN_PACKAGES)}"


def _make_debian_root() -> None:
    if shutil.which("apt-get") is None or os.geteuid() != 0:
        raise NoBlender(
            f"`blender` {_minimum()} or newer is not on PATH, and only root on a Debian machine can install "
            "one into .tools: set BLENDER=/path/to/blender"
        )
    apt = {**os.environ, "DEBIAN_FRONTEND": "noninteractive"}
    try:
        run_logged(["apt-get", "update"], LOG, apt)
        if shutil.which("mmdebstrap") is None:
            run_logged(["apt-get", "install", "-y", "--no-install-recommends", "mmdebstrap"], LOG, apt)
        with stamps.making(DEBIAN_ROOT, _recipe()):
            run_logged(
                ["unshare", "--mount", "--propagation", "private", *_mmdebstrap(_debian_mirror())], LOG, apt
            )
            mtab = DEBIAN_ROOT / "etc" / "mtab"
            if not mtab.is_symlink():
                mtab.symlink_to("/proc/self/mounts")
    except ToolError as error:
        raise NoBlender(f"Debian's could not be installed: {error}") from error


def _mmdebstrap(mirror: str) -> list[str]:
    return [
        "mmdebstrap",
        "--mode=root",
        "--variant=apt",
        '--aptopt=Acquire::Check-Valid-Until "false"',
        f"--include={','.join(DEBIAN_PACKAGES)}",
        DEBIAN_SUITE,
        str(DEBIAN_ROOT),
        mirror,
    ]


def _debian_mirror() -> str:
    """Return the mirror this machine's own apt takes Debian's main archive from."""
    wanted = ["Created-By: Packages", "Origin: Debian", "Label: Debian", "Component: main"]
    answer = subprocess.run(
        ["apt-get", "indextargets", "--format", "$(REPO_URI)", *wanted],
        stdin=subprocess.DEVNULL, capture_output=True, text=True,
    )  # fmt: skip
    mirrors = answer.stdout.split()
    if not mirrors:
        raise NoBlender(
            "this machine's apt sources name no mirror of Debian's main archive: set BLENDER=/path/to/blender"
        )
    return mirrors[0]
