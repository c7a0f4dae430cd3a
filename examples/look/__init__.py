# SPDX-License-Identifier: GPL-3.0-or-later
"""Sky, water and camera of the example scenes: plain Blender data that needs no extension."""
