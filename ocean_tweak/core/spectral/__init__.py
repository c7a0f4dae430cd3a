# SPDX-License-Identifier: GPL-3.0-or-later
"""Spectra: energy by frequency and direction, from the wind to a wave vector."""
