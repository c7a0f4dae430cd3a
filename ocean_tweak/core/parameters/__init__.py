# SPDX-License-Identifier: GPL-3.0-or-later
"""What a sea is: parameters, patches, shots and presets, without any waves."""
