# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs pytest inside a real Blender: `blender --background --python THIS -- PYTEST_FOLDER ARGUMENT ...`."""

import sys

folder, *arguments = sys.argv[sys.argv.index("--") + 1 :]
sys.path.insert(0, folder)  # a real Blender does not read PYTHONPATH

import pytest  # noqa: E402

sys.exit(pytest.main(arguments))
