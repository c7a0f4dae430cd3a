# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds the documentation site into build/site, strictly: `make docs`.

Pages that the navigation lacks, links and anchors that lead nowhere, and docstrings that cannot be read are
errors. The site fetches nothing, and nothing is published from here.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

from . import environments
from .project import BUILD, ROOT, ToolError, run_logged

SITE = BUILD / "site"


def build() -> Path:
    """Build the site; return its first page. Raises ToolError with mkdocs' words where a page is wrong."""
    environments.make_uv()
    environments.make("docs")
    environment = {
        **os.environ,
        "PATH": os.pathsep.join([str(environments.python("docs").parent), os.environ.get("PATH", "")]),
        "NO_MKDOCS_2_WARNING": "1",
    }
    run_logged(
        [
            str(environments.python("docs")),
            "-m",
            "mkdocs",
            "build",
            "--strict",
            "--quiet",
            "--site-dir",
            str(SITE),
        ],
        BUILD / "logs" / "docs.log",
        environment,
    )
    return SITE / "index.html"


def main() -> int:
    """Build the site; return the exit code."""
    try:
        print(f"built: {build().relative_to(ROOT)}")
    except ToolError as error:
        print(f"docs failed: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
