# SPDX-License-Identifier: GPL-3.0-or-later
"""All node groups that the extension can build, those inside of others first."""

from __future__ import annotations

from . import (
    averaged,
    averages,
    camera_grid,
    camera_patch,
    camera_surface,
    contact,
    extension_check,
    floating,
    frame_warnings,
    grid,
    horizon,
    ocean,
    patch,
    patch_points,
    sample,
    shown_frame,
    surface,
    water,
)

ALL_KINDS = (
    extension_check.ABSENCE,
    grid.GRID,
    shown_frame.SHOWN_FRAME,
    patch.PATCH,
    patch_points.PATCH_POINTS,
    frame_warnings.WARNINGS,
    *(ocean.ocean_group(patches) for patches in range(1, ocean.MOST_ADDED + 1)),
    surface.GRID_FACTS,
    surface.CELL,
    surface.SURFACE,
    sample.SAMPLE,
    floating.STENCIL,
    floating.RIDE,
    floating.FLOAT,
    floating.CARRIER,
    horizon.HORIZON,
    camera_grid.CAMERA_GRID,
    averages.AVERAGES,
    averaged.AVERAGED,
    camera_patch.CAMERA_PATCH,
    camera_surface.CAMERA_SURFACE,
    water.WATER,
    contact.CONTACT,
    contact.WET_BAND,
    contact.COLLAR,
    contact.RIPPLE_NORMAL,
)
