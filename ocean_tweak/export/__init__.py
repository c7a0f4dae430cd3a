# SPDX-License-Identifier: GPL-3.0-or-later
"""Files for other programs, from the core's fields. Never imports Blender."""
