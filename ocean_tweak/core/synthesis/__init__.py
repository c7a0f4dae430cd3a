# SPDX-License-Identifier: GPL-3.0-or-later
"""Waves: coefficients, their motion, transforms, and the channels made of them."""
