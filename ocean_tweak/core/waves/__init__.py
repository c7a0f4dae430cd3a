# SPDX-License-Identifier: GPL-3.0-or-later
"""The kinds of waves whose sum is the sea."""
