# SPDX-License-Identifier: GPL-3.0-or-later
"""Waves that moving objects make: wakes of hulls, and rings of what falls in."""

from .elevation import wake_elevation

__all__ = ["wake_elevation"]
