# SPDX-License-Identifier: GPL-3.0-or-later
"""Waves that follow a wind field: particles that carry a bump of water each (Li & Wang 2016)."""
