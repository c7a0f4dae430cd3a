# SPDX-License-Identifier: GPL-3.0-or-later
"""Parameters as data: checked fields with units, JSON, rasters, frames, versions of forms."""
