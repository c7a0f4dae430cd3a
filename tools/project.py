# SPDX-License-Identifier: GPL-3.0-or-later
"""Where things are, and how a command is run."""

from __future__ import annotations

import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# a work tree may have a link to those of another checkout
TOOLS = (ROOT / ".tools").resolve()
REQUIREMENTS = ROOT / "tools" / "requirements"
BUILD = ROOT / "build"
WHEELS = ROOT / "wheels"


class ToolError(Exception):
    """A failure the user can mend; its text is one clear line, followed by a log where there is one."""


def run_logged(command: Sequence[str], log: Path, env: Mapping[str, str] | None = None) -> None:
    """Run a command with its output appended to `log`; raise `ToolError` with the log's end if it fails."""
    log.parent.mkdir(parents=True, exist_ok=True)
    with log.open("ab") as output:
        output.write(f"$ {' '.join(command)}\n".encode())
        output.flush()
        code = subprocess.call(
            command, cwd=ROOT, env=env, stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.STDOUT
        )
    if code:
        tail = log.read_text(errors="replace").splitlines()[-20:]
        raise ToolError("\n".join([f"{command[0]} failed with exit code {code}; {log} ends with:", *tail]))
