# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers that describe a sea: heights, periods, slopes, curves."""
