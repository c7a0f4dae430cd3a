# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar tab. Panels only draw: nothing here computes a sea."""

from . import details, layers, output, patches, sea, spectrum, usd
from .sea import draw_add_menu

__all__ = ["CLASSES", "draw_add_menu"]

CLASSES = (
    *sea.CLASSES,
    *layers.CLASSES,
    *patches.CLASSES,
    *spectrum.CLASSES,
    *details.CLASSES,
    *output.CLASSES,
    *usd.CLASSES,
)
