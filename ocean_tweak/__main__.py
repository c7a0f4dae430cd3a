# SPDX-License-Identifier: GPL-3.0-or-later
"""`python -m ocean_tweak`: the command line without Blender."""

import os
import sys

if __name__ == "__main__":
    # Python looks for modules in the current folder first, where files of others may lie. Before anything is
    # imported that is not built in; a checkout that one stands in stays
    if not sys.flags.safe_path and os.path.join(sys.path[0], "ocean_tweak", "__main__.py") != __file__:  # noqa: PTH118
        del sys.path[0]
    from .cli import main

    sys.exit(main())
