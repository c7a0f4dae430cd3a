# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares the seas of two commits."""
