# SPDX-License-Identifier: GPL-3.0-or-later
"""Node groups, built in code and versioned."""
