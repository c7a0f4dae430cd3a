# SPDX-License-Identifier: GPL-3.0-or-later
"""The description of a sea: parameters, patches, shots and presets."""
