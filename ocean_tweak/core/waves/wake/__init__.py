# SPDX-License-Identifier: GPL-3.0-or-later
"""Waves of moving objects: wakes of hulls, and rings around objects that fall in."""

from .elevation import wake_elevation

__all__ = ["wake_elevation"]
