# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures and arrays in files, as rasters that parameters can hold.

Their numbers are data: no colour space is applied. Transparency is left out.
"""

from .reading import read_picture
from .references import with_pictures

__all__ = ["read_picture", "with_pictures"]
