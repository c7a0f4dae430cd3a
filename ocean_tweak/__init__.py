# SPDX-License-Identifier: GPL-3.0-or-later
"""Ocean Tweak: directional wave spectra with true wave heights, for Blender and for batch rendering."""

__version__ = "0.1.0"
