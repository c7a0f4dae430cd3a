# SPDX-License-Identifier: GPL-3.0-or-later
"""Statistics of a sea: wave heights, periods, slopes, spectrum curves."""
