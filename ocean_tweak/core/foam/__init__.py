# SPDX-License-Identifier: GPL-3.0-or-later
"""Foam: where it is born, how it lives, and from what compression on."""
