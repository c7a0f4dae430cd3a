# SPDX-License-Identifier: GPL-3.0-or-later
"""Parameters as data: validated fields with units, JSON, rasters, frame numbers, format versions."""
