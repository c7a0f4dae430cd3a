# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs a script in a bpy wheel the way `blender --background [FILE.blend] --python SCRIPT` would.

python bpy_script.py [FILE.blend] SCRIPT.py -- [ARGUMENT ...]
"""

import runpy
import sys


def main() -> None:
    """Open the file if one is named, then run the script as the main program."""
    import bpy

    split = sys.argv.index("--")
    *blend, script = sys.argv[1:split]
    for path in blend:
        bpy.ops.wm.open_mainfile(filepath=path)
    sys.argv = [script, *sys.argv[split:]]
    runpy.run_path(script, run_name="__main__")


if __name__ == "__main__":
    main()
