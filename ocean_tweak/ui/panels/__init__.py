# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar tab. Panels only draw: nothing here computes a sea."""

from . import coast, details, floating, layers, masks, material, output, patches, sea, sky, spectrum, start
from .start import draw_add_menu

__all__ = ["CLASSES", "draw_add_menu"]

# Blender shows the panels of the tab in this order
CLASSES = (
    *start.CLASSES,
    *sea.CLASSES,
    *layers.CLASSES,
    *patches.CLASSES,
    *masks.CLASSES,
    *coast.CLASSES,
    *spectrum.CLASSES,
    *details.CLASSES,
    *material.CLASSES,
    *sky.CLASSES,
    *output.CLASSES,
    *floating.CLASSES,
)
