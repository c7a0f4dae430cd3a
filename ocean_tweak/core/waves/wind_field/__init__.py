# SPDX-License-Identifier: GPL-3.0-or-later
"""Waves that follow a wind field: particles that each carry a bump of water (Li & Wang 2016)."""
