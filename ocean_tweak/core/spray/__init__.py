# SPDX-License-Identifier: GPL-3.0-or-later
"""Spray: which drops are torn off breaking crests, and how they fly."""
