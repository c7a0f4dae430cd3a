# SPDX-License-Identifier: GPL-3.0-or-later
"""Spectra: wave energy over frequency, direction and wave vector."""
