# SPDX-License-Identifier: GPL-3.0-or-later
"""Spray: emission of drops from breaking crests, and their flight."""
