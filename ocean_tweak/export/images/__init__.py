# SPDX-License-Identifier: GPL-3.0-or-later
"""Images and arrays in files, as rasters that parameters can hold.

Their numbers are data: no colour space is applied. Transparency is left out.
"""

from .reading import read_raster
from .references import with_rasters

__all__ = ["read_raster", "with_rasters"]
