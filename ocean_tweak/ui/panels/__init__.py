# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar tab. Panels only draw: nothing here computes a sea."""

from . import details, floating, layers, material, output, scene, sea, spectrum, usd
from .sea import draw_add_menu

__all__ = ["CLASSES", "draw_add_menu"]

# Blender shows the panels of the tab in this order
CLASSES = (
    *sea.CLASSES,
    *scene.CLASSES,
    *layers.CLASSES,
    *spectrum.CLASSES,
    *details.CLASSES,
    *output.CLASSES,
    *usd.CLASSES,
    *material.CLASSES,
    *floating.CLASSES,
)
