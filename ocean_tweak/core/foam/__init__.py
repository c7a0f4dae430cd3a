# SPDX-License-Identifier: GPL-3.0-or-later
"""Foam: thresholds, birth, drift and decay."""
