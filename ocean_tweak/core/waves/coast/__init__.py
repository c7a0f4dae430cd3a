# SPDX-License-Identifier: GPL-3.0-or-later
"""Waves over a bottom: how they turn, shorten, rise and break on their way to a shore."""

from .march import propagate

__all__ = ["propagate"]
