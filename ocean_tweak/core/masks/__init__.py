# SPDX-License-Identifier: GPL-3.0-or-later
"""Masks: where a layer's or a patch's waves are."""
