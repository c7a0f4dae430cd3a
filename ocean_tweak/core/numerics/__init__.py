# SPDX-License-Identifier: GPL-3.0-or-later
"""Grids, random numbers, interpolation, and the cache for arrays."""
