# SPDX-License-Identifier: GPL-3.0-or-later
"""`python -m ocean_tweak`: the command line without Blender."""

import sys

from .cli import main

if __name__ == "__main__":
    sys.exit(main())
