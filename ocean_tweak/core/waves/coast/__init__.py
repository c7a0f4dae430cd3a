# SPDX-License-Identifier: GPL-3.0-or-later
"""Waves over a bed: refraction, shoaling, diffraction and breaking on their way to a shore."""

from .march import propagate

__all__ = ["propagate"]
