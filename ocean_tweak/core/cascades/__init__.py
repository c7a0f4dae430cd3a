# SPDX-License-Identifier: GPL-3.0-or-later
"""Seas of several patches, each of its own size and turn, that share the wavelengths among them."""
