# SPDX-License-Identifier: GPL-3.0-or-later
"""How the pictures of the tiny shot show a sea: for what makes the shot, and what reads the pictures."""

PIXELS = 32
#: how much light a metre of displacement is, and none
PER_METRE, NOTHING = 0.05, 0.5
