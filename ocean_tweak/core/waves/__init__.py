# SPDX-License-Identifier: GPL-3.0-or-later
"""Kinds of waves: what a sea is the sum of."""
