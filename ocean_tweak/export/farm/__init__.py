# SPDX-License-Identifier: GPL-3.0-or-later
"""Jobs for render farms: what they are given to bake, verify and render a shot on many machines."""
