# SPDX-License-Identifier: GPL-3.0-or-later
"""Set-up, build and test runs, with the standard library only: `python3 -m tools.setup`."""

import sys

if sys.version_info < (3, 9):  # noqa: UP036 - older ones start it all the same
    sys.exit(
        f"tools/ needs Python 3.9 or newer to start, this is {sys.version.split()[0]}: try make PYTHON=..."
    )
