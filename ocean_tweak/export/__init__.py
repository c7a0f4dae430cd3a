# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the core's fields to files for other programs. Never imports Blender."""
